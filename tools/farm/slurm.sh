#!/usr/bin/env bash
# Frames of a scene, each in parts, as an array of Slurm's, and a job that merges them when all are done.
#   tools/farm/slurm.sh SCENE FRAMES PARTS NAME [further arguments of vkvol ...]
#     FRAMES: 1-48, 1-48:4, 1,5,9, or still for a scene without the key F
#   SBATCH_ARGUMENTS="--partition=render --time=2:00:00"   for sbatch
#   VKVOL=PROGRAM                                          in place of vkvol
# Prints the number of the job that merges. A part that fails is tried three times more, and goes on where it ended, also when
# its node is lost and Slurm begins it again. NAME has to be in a directory that all nodes see.
set -euo pipefail
export LC_ALL=C # numbers have points

[ $# -ge 4 ] || { echo "slurm.sh: expected SCENE FRAMES PARTS NAME" >&2; exit 2; }
scene=$1 frames=$2 parts=$3 name=$4
shift 4
farm=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
list=(still)
if [ "$frames" != still ]; then
    list=()
    IFS=, read -r -a spans <<<"${frames:-none}"
    for span in "${spans[@]}"; do
        [[ $span =~ ^([0-9]+)(-([0-9]+)(:([0-9]+))?)?$ ]] ||
            { echo "slurm.sh: frames '$frames': expected 1-48, 1-48:4, 1,5,9 or still" >&2; exit 2; }
        first=$((10#${BASH_REMATCH[1]})) step=$((10#${BASH_REMATCH[5]:-1})) # 008 is no octal number
        last=$((10#${BASH_REMATCH[3]:-$first}))
        [ "$step" -gt 0 ] && [ "$last" -ge "$first" ] ||
            { echo "slurm.sh: frames '$span': expected the first, not above the last, and a step above 0" >&2; exit 2; }
        for ((frame = first; frame <= last; frame += step)); do
            [[ " ${list[*]} " == *" $frame "* ]] || list+=("$frame") # two tasks of one part would be in each other's way
        done
    done
fi
mkdir -p -- "$(dirname -- "$name")" # into which the logs go, too
read -r -a sbatch <<<"${SBATCH_ARGUMENTS:-}"
quoted=$(printf ' %q' "$@")

# Tasks go through the parts of one frame after another.
logs=${name//%/%%}
render=$(sbatch "${sbatch[@]}" --parsable --requeue --job-name="vkvol $name" --output="$logs.%a.log" \
    --array="0-$((${#list[@]} * parts - 1))" <<END
#!/usr/bin/env bash
export VKVOL=$(printf %q "${VKVOL:-vkvol}")
frames=(${list[*]})
frame=\${frames[SLURM_ARRAY_TASK_ID / $parts]} part=\$((SLURM_ARRAY_TASK_ID % $parts + 1))
for attempt in 1 2 3 4; do
    bash $(printf %q "$farm")/render_part.sh $(printf %q "$scene") "\$frame" "\$part" $parts $(printf %q "$name")$([ $# -eq 0 ] || echo "$quoted") && exit
done
exit 1
END
)
sbatch "${sbatch[@]}" --parsable --job-name="vkvol $name, merge" --output="$logs.merge.log" --dependency="afterok:${render%%;*}" --kill-on-invalid-dep=yes <<END
#!/usr/bin/env bash
set -e
export VKVOL=$(printf %q "${VKVOL:-vkvol}")
for frame in ${list[*]}; do
    bash $(printf %q "$farm")/merge_frame.sh "\$frame" $parts $(printf %q "$name")
done
END
