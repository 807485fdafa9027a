#!/usr/bin/env bash
# What the demo cloud costs: samples and tentative collisions per second, seconds by pass, and the scalar reference on
# the same scene for the ratio. Medians over runs in alternation. A measurement, not a test.
#   tools/benchmark.sh [RUNS]      default 5
set -eu
source "$(dirname "$0")/setup.sh"

runs=${1:-5}
install_packages
build release vkvol make_field reference_render
make_fields --all "$vkvol_root/density_fields"
python3 "$vkvol_root/tools/benchmark.py" "$vkvol_root" "$runs"
