#!/usr/bin/env bash
# Installs what is missing, builds, with warnings as errors, and runs every test on the devices there are (Mesa's software
# driver where there is no GPU).
#   tools/test.sh              the release build
#   tools/test.sh --long       and what takes long besides: proofs of what shorter tests have found every known error of
#   tools/test.sh --sanitize   host code under AddressSanitizer and UndefinedBehaviorSanitizer
#   tools/test.sh --driver D   on a software driver: lavapipe or swiftshader (fetched; several times slower)
#   tools/test.sh ... ARGS     further arguments go to ctest, e.g. -R density
set -eu
source "$(dirname "$0")/setup.sh"

preset=release
driver=
labels=(-LE long)
while true; do
    case ${1:-} in
    --sanitize) preset=sanitize ;;
    --long) labels=() ;;
    --driver)
        driver=${2:?--driver needs a name: lavapipe or swiftshader}
        shift
        ;;
    *) break ;;
    esac
    shift
done
start=$SECONDS
install_packages
[ -z "$driver" ] || use_driver "$driver"
limit=1500 # seconds, of a group
[ "$preset" = release ] && [ "$driver" != swiftshader ] || limit=4500
build "$preset" -DVKVOL_WERROR=ON

say "Scene files against their schema"
find "$vkvol_root/scenes" -name '*.xml' -print0 |
    xargs -0 xmllint --noout --schema "$vkvol_root/scenes/vkvol.xsd" 2>&1 | grep -v ' validates$' && die "a scene does not validate"

say "Tests ($preset${driver:+, $driver})"
directory=$vkvol_root/build
[ "$preset" = release ] || directory=$vkvol_root/build-$preset
# Software drivers compile kernels on one thread, and some tests wait: two groups more than cores, unless ARGS say otherwise;
# of many cores eight, since some go by time.
# Drivers keep memory until the process ends: leaks are looked for in our code by other means.
ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "$directory" --no-tests=error --timeout $limit --output-on-failure --parallel $(($(nproc) < 7 ? $(nproc) + 2 : 8)) "${labels[@]}" "$@" || die "tests failed"
say "All tests passed ($((SECONDS - start)) s in all)"
