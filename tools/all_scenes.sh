#!/usr/bin/env bash
# Renders every file under scenes/ by its name alone, small, once the fields are made that are missing; fails if one
# does not render. Nothing but the size and the samples is asked for: keys have defaults, fields are where scenes look.
#   tools/all_scenes.sh [ARGS]     after `tools/setup.sh`'s build; ARGS go to vkvol (default: --width 16 --spp 1)
set -u
source "$(dirname "$0")/setup.sh"

[ $# -gt 0 ] || set -- --width 16 --spp 1
"$vkvol_root/build/make_field" --all "$vkvol_root/density_fields" >/dev/null || die "make_field failed"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count=0 failures=0
while IFS= read -r -d '' scene; do
    count=$((count + 1))
    if ! "$vkvol_root/build/vkvol" "$scene" "$@" -q -o "$work/picture.exr" 2>"$work/said"; then
        failures=$((failures + 1))
        printf '%s: %s\n' "${scene#"$vkvol_root/"}" "$(tail -n 1 "$work/said")"
    fi
done < <(find "$vkvol_root/scenes" -name '*.xml' -print0 | sort -z)
printf '%d scenes, %d failures\n' "$count" "$failures"
[ "$count" -gt 0 ] && [ "$failures" -eq 0 ]
