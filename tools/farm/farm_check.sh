#!/usr/bin/env bash
# Runs the farm files here, on a small scene, and kills a part amid its work: whether it is rendered again and nothing else is,
# and whether the pictures have the bits of plain renders.
#   tools/farm/farm_check.sh [openjd|snakemake|slurm ...]
#   --need     what is not installed is an error, and not passed over
# openjd is PyPI's openjd-cli; snakemake and slurm-wlm are packages of Debian. Slurm is started as a farm of one node, which needs
# root, and ended again.
set -euo pipefail

farm=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=${VKVOL:-$farm/../../build/vkvol}
kinds=()
need=
for word in "$@"; do
    case $word in
    openjd | snakemake | slurm) kinds+=("$word") ;;
    --need) need=yes ;;
    *) echo "farm_check.sh: '$word' is neither openjd, snakemake, slurm nor --need" >&2; exit 2 ;;
    esac
done
[ ${#kinds[@]} -gt 0 ] || kinds=(openjd snakemake slurm)
work=$(mktemp -d)
daemons=()
end() {
    if [ ${#daemons[@]} -gt 0 ]; then
        kill "${daemons[@]}" 2>/dev/null || true
        wait "${daemons[@]}" 2>/dev/null || true # they still write
    fi
    rm -rf "$work"
}
trap end EXIT
failed=0
frames="1 2" parts=3
export VKVOL=$work/vkvol

claim() { # TEXT COMMAND...
    local text=$1
    shift
    if "$@"; then
        echo "ok    $text"
    else
        echo "FAIL  $text"
        failed=1
    fi
}

# A program that says when it begins to render.
cat >"$VKVOL" <<END
#!/usr/bin/env bash
case " \$* " in *" --crop "*) echo "\$*" >>"$work/begun" ;; esac
exec "$program" "\$@"
END
chmod +x "$VKVOL"
cat >"$work/scene.xml" <<'END'
<options><sphere/><noise octaves="4"/><sigma_s>12</sigma_s><width>64</width><height>48</height><light x="1" y="1" r="3" g="2" b="1"/>
<camera lookAt="0 0 0" distance="5" azimuth="${= 40*F}" fov="30"/><backgroundColor r="0.1" g="0.2" b="0.3"/></options>
END
arguments=(--spp 400 --seed 3)
for frame in $frames; do
    "$program" "$work/scene.xml" -D "F=$frame" "${arguments[@]}" -q -o "$work/plain.$frame.exr"
done

kill_one() { # NAME: the first that renders, when it has done so for a moment
    local i
    for ((i = 0; i < 300; ++i)); do
        if pgrep -f -- "--crop .* $1.*partial" >/dev/null; then
            sleep 0.6
            pkill -KILL -n -f -- "--crop .* $1.*partial"
            return
        fi
        sleep 0.1
    done
}

is_same() { # FRAME NAME
    "$program" compare "$2.$1.exr" "$work/plain.$1.exr" 2>/dev/null | grep -qE '^pixels +([0-9]+) compared, \1 identical'
}

check() { # KIND: what it made
    local frame
    for frame in $frames; do
        claim "$1: frame $frame has the bits of one render" is_same "$frame" "$work/$1"
    done
    claim "$1: the part that was killed was begun again, and no other ($(wc -l <"$work/begun") times for 6 parts)" \
        [ "$(wc -l <"$work/begun")" -eq 7 ]
}

run_openjd() {
    local job=(openjd run "$farm/openjd.yaml" -p "Scene=$work/scene.xml" -p Frames=1-2 -p Parts=$parts -p "Name=$work/openjd" -p "Vkvol=$VKVOL"
        -p "Farm=$farm" -p Samples=400 -p Seed=3)
    kill_one "$work/openjd" &
    claim "openjd: a part that is killed fails its job" fails "${job[@]}" --step Render
    claim "openjd: the job goes on" quietly "${job[@]}" --step Merge --run-dependencies
    claim "openjd: progress is told" grep -qE "openjd_progress: 100" "$work/log"
    check openjd
}

fails() { ! quietly "$@"; }
quietly() { "$@" >"$work/log" 2>&1; }

run_snakemake() {
    kill_one "$work/snakemake" &
    claim "snakemake: the job ends well" quietly snakemake -s "$farm/Snakefile" -d "$work" -j 1 --config "scene=$work/scene.xml" \
        "name=$work/snakemake" frames=1-2 parts=$parts "vkvol=$VKVOL" "arguments=${arguments[*]}"
    check snakemake
}

# A farm of this machine alone.
start_slurm() {
    local host
    host=$(hostname -s)
    mkdir -p "$work/state" "$work/spool" /run/munge
    dd if=/dev/urandom of="$work/munge.key" bs=1024 count=1 2>/dev/null
    chmod 600 "$work/munge.key"
    munged --force --foreground --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" --log-file="$work/munge.log" \
        --seed-file="$work/munge.seed" >/dev/null 2>&1 &
    daemons+=($!)
    cat >"$work/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$host
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1
NodeName=$host CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
    export SLURM_CONF=$work/slurm.conf
    sleep 1
    slurmctld -D >/dev/null 2>&1 &
    daemons+=($!)
    slurmd -D >/dev/null 2>&1 &
    daemons+=($!)
    local i
    for ((i = 0; i < 60; ++i)); do
        ! sinfo -h -o %T 2>/dev/null | grep -q idle || return 0
        sleep 0.5
    done
    tail -n 5 "$work/slurmctld.log" "$work/slurmd.log" "$work/munge.log" >&2 || true
    return 1
}

run_slurm() {
    local job i
    claim "slurm: a farm of one node" start_slurm
    squeue -h >/dev/null 2>&1 || return 0 # it has been told
    job=$("$farm/slurm.sh" "$work/scene.xml" 1-2 $parts "$work/slurm" "${arguments[@]}")
    kill_one "$work/slurm"
    for ((i = 0; i < 200; ++i)); do
        [ -n "$(squeue -h -j "$job" 2>/dev/null)" ] || break
        sleep 0.5
    done
    check slurm
}

has() {
    case $1 in
    openjd | snakemake) command -v "$1" >/dev/null ;;
    slurm) command -v slurmctld >/dev/null && command -v munged >/dev/null && [ "$(id -u)" -eq 0 ] ;;
    esac
}

for kind in "${kinds[@]}"; do
    if has "$kind"; then
        : >"$work/begun"
        "run_$kind"
    else
        echo "pass  $kind is not installed here"
        [ -z "$need" ] || failed=1
    fi
done
exit $failed
