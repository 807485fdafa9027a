#!/usr/bin/env bash
# Reads damaged scenes, grids, meshes, images, maps, phase functions and command lines by the million, in the build with AddressSanitizer and
# UndefinedBehaviorSanitizer, and prints what came of it; about an hour on two cores. Inputs that break a promise are left
# in the current directory, with the command that replays them (see vkvol_fuzz --help), and make the exit code 1.
#   tools/fuzz.sh [--seed S] [TARGET=RUNS ...]      in place of the defaults, e.g. scene=5000 grid=100
set -eu
source "$(dirname "$0")/setup.sh"

declare -A runs=([scene]=1000000 [pbrt]=200000 [grid]=100000 [vdb]=20000 [mesh]=200000 [image]=100000 [sky]=50000 [phase]=200000 [options]=200000)
order=(scene pbrt grid vdb mesh image sky phase options)
seed=1
while [ $# -gt 0 ]; do
    case $1 in
    --seed)
        seed=$2
        shift
        ;;
    *=*)
        [ -n "${runs[${1%%=*}]:-}" ] || die "unknown target ${1%%=*}; known are ${order[*]}"
        runs[${1%%=*}]=${1#*=}
        ;;
    *) die "unknown argument $1; expected --seed S or TARGET=RUNS" ;;
    esac
    shift
done

out=$PWD
install_packages
build sanitize vkvol_fuzz

fuzz=$vkvol_root/build-sanitize/vkvol_fuzz
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
for target in "${order[@]}"; do # two processes, one on each half
    half=$((runs[$target] / 2))
    "$fuzz" "$target" --seed "$seed" --out "$out" --runs "$half" >"$work/$target.1" &
    "$fuzz" "$target" --seed "$seed" --out "$out" --first "$half" --runs $((runs[$target] - half)) >"$work/$target.2" || failed=1
    wait $! || failed=1
done

say "Seed $seed, AddressSanitizer and UndefinedBehaviorSanitizer"
printf '%-8s %9s %9s %9s %9s %9s %10s\n' target runs accepted seconds findings slowest memory
for target in "${order[@]}"; do
    cat "$work/$target".[12] | awk -v target="$target" '
        { runs += $2; accepted += $4; findings += $8; seconds = $6 > seconds ? $6 : seconds
          slowest = $11 > slowest ? $11 : slowest; memory = $17 > memory ? $17 : memory }
        END { printf "%-8s %9d %9d %9.0f %9d %7.2f s %6.1f MiB\n", target, runs, accepted, seconds, findings, slowest, memory }'
done
exit $failed
