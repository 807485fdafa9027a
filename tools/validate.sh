#!/usr/bin/env bash
# Heavier validation than tools/test.sh. First the tables of all unbiased combinations of estimators, of the bias of
# marches, and of transmittances alone. Then whole scenes with large grids, rendered by vkvol and by the scalar reference
# with different seeds, judged by `vkvol compare` (per-pixel z-test, Sidak-corrected, and a test of the means; a
# significance of 0.001 per scene, so that a table of this length raises a false alarm once in a hundred runs).
# Takes about an hour on two cores. Ends with a table and fails if any scene differs.
#   tools/validate.sh [FILE.nvdb ...]      further grids are tried in the thesis' bunny scenes
set -eu
source "$(dirname "$0")/setup.sh"

install_packages
build release vkvol vkvol_tests make_field reference_render
make_fields --all "$vkvol_root/density_fields"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rows=()
failed=0

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

say "Estimators against each other"
for table in agreement bias transmittance; do
    (cd "$work" && "$vkvol_root/build/vkvol_tests" "[.${table}_table]" -o "$work/log") >"$work/$table.txt" || failed=1
    cat "$work/$table.txt"
done

say "Rendering"
fields=$vkvol_root/density_fields
check "cumulus" 256 "$vkvol_root/scenes/cumulus.xml" --width 96
check "cumulus, no light" 64 "$vkvol_root/scenes/cumulus.xml" --width 96 --integrator deltaTracking
for field in sphere ramp checker spike tiles explosion "$@"; do
    grid=$field
    [ -f "$grid" ] || grid=$fields/$field.nvdb
    for integrator in deltaTracking ratioTracking; do
        check "$(basename "$grid" .nvdb), $integrator" 256 "$vkvol_root/scenes/thesis/bunny-$integrator.xml" --grid "$grid" --width 64
    done
done

say "Device against reference"
printf '%-44s %5s  %-24s %-22s %s\n' scene spp "ratio of means (r g b)" "z of means (r g b)" verdict
printf '%s\n' "${rows[@]}"
exit $failed
