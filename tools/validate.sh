#!/usr/bin/env bash
# Heavier validation than tools/test.sh, in three parts; names choose among them, and without any all are run.
#   hard        scenes/hard on the device and by the reference, against the means that their files derive (2 minutes)
#   estimators  the tables of all unbiased combinations of estimators, of the bias of marches, and of transmittances alone
#   pictures    whole scenes with large grids, rendered by vkvol and by the scalar reference with different seeds, judged by
#               `vkvol compare` (per-pixel z-test, Sidak-corrected, and a test of the means; a significance of 0.001 per
#               scene, so that a table of this length raises a false alarm once in a hundred runs)
# All takes about an hour on two cores. Each part ends with a table; fails if anything differs.
#   tools/validate.sh [hard|estimators|pictures ...] [FILE.nvdb ...]      further grids for pictures: in the thesis' bunny scenes
set -eu
source "$(dirname "$0")/setup.sh"

parts=()
grids=()
for argument in "$@"; do
    case $argument in
    hard | estimators | pictures) parts+=("$argument") ;;
    *.nvdb) grids+=("$argument") ;;
    *) die "'$argument' is neither a part (hard, estimators, pictures) nor a .nvdb file" ;;
    esac
done
[ ${#parts[@]} -gt 0 ] || parts=(hard estimators pictures)

install_packages
build release vkvol vkvol_tests make_field reference_render
fields=$vkvol_root/density_fields
make_fields --all "$fields"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

run_hard() {
    local type
    for type in fp4 fp8; do
        make_fields ramp --type $type --if-missing -o "$fields/ramp-$type.nvdb"
    done
    say "Hard cases"
    python3 "$vkvol_root/tools/hard_cases.py" || failed=1
}

run_estimators() {
    say "Estimators against each other"
    local table
    for table in agreement bias transmittance; do
        (cd "$work" && "$vkvol_root/build/vkvol_tests" "[.${table}_table]" -o "$work/log") >"$work/$table.txt" || failed=1
        cat "$work/$table.txt"
    done
}

rows=()

# check NAME SPP ARGUMENTS...: the arguments go to both renderers.
check() {
    local name=$1 spp=$2 verdict
    shift 2
    "$vkvol_root/build/vkvol" "$@" --spp "$spp" --seed 1 -o "$work/a.exr" -q --strict ||
        [ $? -eq 5 ] || die "$name: vkvol failed"
    "$vkvol_root/build/reference_render" "$@" --spp "$spp" --seed 2 -o "$work/b.exr" >/dev/null || die "$name: the reference failed"
    if "$vkvol_root/build/vkvol" compare "$work/a.exr" "$work/b.exr" --significance 0.001 >"$work/out"; then
        verdict=same
    else
        verdict=DIFFERENT
        failed=1
        cat "$work/out"
    fi
    rows+=("$(printf '%-44s %5s  %-24s %-22s %s' "$name" "$spp" "$(sed -n 's/^mean ratio *//p' "$work/out")" \
        "$(sed -n 's/^mean z *//p' "$work/out")" "$verdict")")
}

run_pictures() {
    say "Rendering"
    check "cumulus" 256 "$vkvol_root/scenes/cumulus.xml" --width 96
    check "cumulus, no light" 64 "$vkvol_root/scenes/cumulus.xml" --width 96 --integrator deltaTracking
    local field grid integrator
    for field in sphere ramp checker spike tiles explosion "${grids[@]}"; do
        grid=$field
        [ -f "$grid" ] || grid=$fields/$field.nvdb
        for integrator in deltaTracking ratioTracking; do
            check "$(basename "$grid" .nvdb), $integrator" 256 "$vkvol_root/scenes/thesis/bunny-$integrator.xml" --grid "$grid" --width 64
        done
    done
    say "Device against reference"
    printf '%-44s %5s  %-24s %-22s %s\n' scene spp "ratio of means (r g b)" "z of means (r g b)" verdict
    printf '%s\n' "${rows[@]}"
}

for part in "${parts[@]}"; do
    "run_$part"
done
exit $failed
