#!/usr/bin/env bash
# Heavier validation than tools/test.sh, in parts; names choose among them, and without any all are run.
#   hard        scenes/hard on the device and by the reference, against the means that their files derive (2 minutes)
#   scenes      every file under scenes/ by its name alone, small (2 minutes): tools/all_scenes.sh
#   crossed     150 scenes whose features are crossed at random, each by unlike estimators (20 minutes): tools/crossed_scenes.py
#   large       a grid of 342 MiB, larger than a storage buffer of Mesa's software driver, against its Fp8 form (1 minute)
#   tests       tests on the device, of which many take a share of what they could combine, with all of it
#   python      `pip install .` in a fresh environment: types, tests, the notebook (5 minutes; PyPI has to be there)
#   view        every control of the page of `vkvol view`, in Debian's Chromium (2 minutes; likewise)
#   pbrt        scenes of one feature each against what pbrt-v4 made of them (4 minutes): tools/peers/pbrt_features.py
#   denoise     the test of tools/denoise with the denoiser (1 minute; likewise)
#   farm        tools/farm by Open Job Description, Snakemake and Slurm, as far as they are installed (2 minutes)
#   schedules   the table of all integrators, flights and transmittances by both schedules, on whatever driver it is (2 minutes; SwiftShader: 13)
#   estimators  the tables of all unbiased combinations of estimators, of looks and flights under wide lights, of particles, of the bias of
#               marches, and of transmittances alone
#   pictures    whole scenes with large grids, rendered by vkvol and by the scalar reference with different seeds, judged by
#               `vkvol compare` (per-pixel z-test, Sidak-corrected, and a test of the means; a significance of 0.001 per
#               scene, so that a table of this length raises a false alarm once in a hundred runs)
# All but `tests` takes more than an hour on two cores. Each part ends with a table; fails if anything differs.
#   tools/validate.sh [--driver NAME] [hard|scenes|crossed|large|tests|python|view|pbrt|denoise|farm|schedules|estimators|pictures ...] [FILE.nvdb ...]
#       a driver as in tools/test.sh; further grids for pictures: in the thesis' bunny scenes
set -eu
source "$(dirname "$0")/setup.sh"

parts=()
grids=()
driver=
if [ "${1:-}" = --driver ]; then
    driver=${2:?--driver needs a name: lavapipe or swiftshader}
    shift 2
fi
for argument in "$@"; do
    case $argument in
    hard | scenes | crossed | large | tests | python | view | pbrt | denoise | farm | schedules | estimators | pictures) parts+=("$argument") ;;
    *.nvdb) grids+=("$argument") ;;
    *) die "'$argument' is neither a part (hard, scenes, crossed, large, tests, python, view, pbrt, denoise, farm, schedules, estimators, pictures) nor a .nvdb file" ;;
    esac
done
[ ${#parts[@]} -gt 0 ] || parts=(hard scenes crossed large tests python view pbrt denoise farm schedules estimators pictures)

install_packages
[ -z "$driver" ] || use_driver "$driver"
build release vkvol vkvol_tests make_field reference_render
fields=$vkvol_root/density_fields
make_fields --all "$fields"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

run_hard() {
    say "Hard cases"
    python3 "$vkvol_root/tools/hard_cases.py" || failed=1
}

run_scenes() {
    say "Every scene by its name alone"
    "$vkvol_root/tools/all_scenes.sh" || failed=1
}

run_crossed() {
    say "Features crossed at random"
    python3 "$vkvol_root/tools/crossed_scenes.py" "$vkvol_root/build/vkvol" --scenes 1..150 || failed=1
}

# Fp8 keeps a leaf's values to half of 1/255 of their range, here 7/440: 3.1e-5. Over the longest ray, 762 voxels of
# sigma_t 0.02, that is at most 5e-4 of the radiance, less than the comparison can see.
run_large() {
    make_fields ramp --size 440 --type fp8 --if-missing -o "$fields/ramp-440-fp8.nvdb"
    say "A grid larger than a storage buffer"
    local scene=$vkvol_root/scenes/large_grid.xml
    "$vkvol_root/build/vkvol" "$scene" --seed 1 -o "$work/float.exr" -q --report "$work/float.json" || die "large grid: vkvol failed"
    grep -E '"specialization"|"deviceBytes"' "$work/float.json"
    "$vkvol_root/build/vkvol" "$scene" --seed 2 -o "$work/fp8.exr" -q --grid "$fields/ramp-440-fp8.nvdb" || die "large grid: vkvol failed"
    "$vkvol_root/build/vkvol" compare "$work/float.exr" "$work/fp8.exr" --significance 0.001 || failed=1
}

run_tests() {
    say "Every combination of what tests combine"
    (cd "$work" && VKVOL_THOROUGH=1 "$vkvol_root/build/vkvol_tests" "[gpu]~[bench]") || failed=1
}

# What cannot be set up has failed, and others go on.
lacks() {
    echo "FAIL  $*" >&2
    failed=1
}

# What the notebook shows is kept with it.
run_python() {
    say "pip install . in a fresh environment"
    local python=$work/venv/bin/python notebook=$vkvol_root/tools/notebooks/first_steps.ipynb
    python3 -m venv "$work/venv" || { lacks "python: needs python3-venv: apt-get install python3-venv"; return; }
    "$python" -m pip install -q "$vkvol_root" mypy nbclient ipykernel matplotlib || { lacks "python: pip install . failed"; return; }
    "$python" -m mypy --strict "$vkvol_root/host/python/vkvol" || failed=1
    (cd "$work" && VKVOL_INSTALLED=1 VKVOL_BUILD="$vkvol_root/build" PYTHONDONTWRITEBYTECODE=1 "$python" -W error -m unittest discover \
        -p "*_test.py" -s "$vkvol_root/tests/python") || failed=1
    (cd "$work" && "$work/venv/bin/jupyter-execute" --inplace "$notebook") || failed=1
}

run_view() {
    say "The page of vkvol view"
    command -v chromium >/dev/null || { lacks "view: needs a browser: apt-get install chromium"; return; }
    python3 -m venv "$work/browser" && "$work/browser/bin/pip" install -q playwright ||
        { lacks "view: playwright cannot be installed, which needs python3-venv and PyPI"; return; }
    "$work/browser/bin/python" "$vkvol_root/tools/view_check.py" --vkvol "$vkvol_root/build/vkvol" -o "$vkvol_root/build/view_check" || failed=1
}

run_pbrt() {
    say "Scenes of pbrt-v4"
    /usr/bin/python3 "$vkvol_root/tools/peers/pbrt_features.py" --vkvol "$vkvol_root/build/vkvol" || failed=1
}

run_denoise() {
    say "tools/denoise"
    /usr/bin/python3 -m venv --system-site-packages "$work/oidn" && "$work/oidn/bin/pip" install -q pyoidn ||
        { lacks "denoise: pyoidn cannot be installed, which needs python3-venv and PyPI"; return; }
    "$work/oidn/bin/python" "$vkvol_root/tools/denoise" --self-test || failed=1
}

run_farm() {
    say "tools/farm"
    "$vkvol_root/tools/farm/farm_check.sh" || failed=1
}

# print_tables NAME...: which hidden tests print.
print_tables() {
    local table
    echo "commit $(git -C "$vkvol_root" describe --always --dirty=+ --exclude='*' 2>/dev/null || echo unknown)"
    for table in "$@"; do
        (cd "$work" && "$vkvol_root/build/vkvol_tests" "[.${table}_table]" -o "$work/log") >"$work/$table.txt" || failed=1
        cat "$work/$table.txt"
    done
}

run_schedules() {
    say "Estimators by both schedules"
    print_tables schedules
}

run_estimators() {
    say "Estimators against each other"
    print_tables agreement lights particles bias transmittance
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
