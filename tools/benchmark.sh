#!/usr/bin/env bash
# What the demo cloud costs: samples and tentative collisions per second, seconds by pass, and the scalar reference on
# the same scene for the ratio. Medians over runs in alternation. A measurement, not a test.
#   tools/benchmark.sh [RUNS]      default 5
#   tools/benchmark.sh --against REF [ARGS]   efficiency against a commit, which is built in build/against: tools/against.py ARGS.
#                                  Fails if that of a scene is less by more than its interval
set -eu
source "$(dirname "$0")/setup.sh"

python=/usr/bin/python3 # which knows the packages of the distribution
[ -x "$python" ] || python=python3
if [ "${1:-}" = --against ]; then
    commit=$(git -C "$vkvol_root" rev-parse --short --verify "${2:?--against needs a commit}^{commit}")
    shift 2
    install_packages
    build release vkvol make_field
    make_fields --all "$vkvol_root/density_fields"
    other=$vkvol_root/build/against/$commit
    [ -d "$other" ] || git clone -q "$vkvol_root" "$other"
    git -C "$other" checkout -q "$commit"
    (cd "$other" && cmake --preset release >/dev/null && cmake --build --preset release --target vkvol)
    exec "$python" "$vkvol_root/tools/against.py" "$other/build/vkvol" "$vkvol_root/build/vkvol" "$@"
fi
runs=${1:-5}
install_packages
build release vkvol make_field reference_render
make_fields --all "$vkvol_root/density_fields"
"$python" "$vkvol_root/tools/benchmark.py" "$vkvol_root" "$runs"
