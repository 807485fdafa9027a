#!/usr/bin/env bash
# The frame of its parts, as NAME.FRAME.exr and .png, with the bits of one render (but for particles).
#   merge_frame.sh FRAME PARTS NAME
#   VKVOL=PROGRAM  in place of vkvol
set -euo pipefail
export LC_ALL=C # numbers have points

[ $# -eq 3 ] || { echo "merge_frame.sh: expected FRAME PARTS NAME" >&2; exit 2; }
frame=$1 parts=$2 name=$3
inputs=()
for ((part = 1; part <= parts; ++part)); do
    inputs+=("$name.$frame.$part-of-$parts.exr")
done
if [ "$parts" -eq 1 ]; then
    cp "${inputs[0]}" "$name.$frame.exr"
    "${VKVOL:-vkvol}" develop "$name.$frame.exr" -q -o "$name.$frame.png"
else
    "${VKVOL:-vkvol}" merge "${inputs[@]}" -o "$name.$frame.exr" -o "$name.$frame.png"
fi
