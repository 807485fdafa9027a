#!/usr/bin/env bash
# One task of a farm: a window of a frame, one of PARTS from the top, as NAME.FRAME.PART-of-PARTS.exr. As many PARTS as the
# picture has rows are the most; readings of few pixels are parted by --sample-offset.
#   render_part.sh SCENE FRAME PART PARTS NAME [further arguments of vkvol ...]
#     FRAME: a number, the scene's key F; or "still" for a scene without one
#   VKVOL=PROGRAM      in place of vkvol
#   FARM_LINES=openjd  progress and failures in the words of Open Job Description
# A part that is there was rendered to its end and is not rendered again, nor taken for one of another scene or other arguments;
# with --strict it fails again if limits cut some of its light off. Of one that was killed what its last checkpoint has is gone
# on from, if the same arguments, a device of the same bits and the same vkvol began it. Windows of a picture have the bits that
# they have in the whole (but for particles): ranges of samples would not, to the last.
set -euo pipefail
export LC_ALL=C # numbers have points

[ $# -ge 5 ] || { echo "render_part.sh: expected SCENE FRAME PART PARTS NAME" >&2; exit 2; }
scene=$1 frame=$2 part=$3 parts=$4 name=$5
shift 5
output=$name.$frame.$part-of-$parts.exr
for argument in "$@"; do
    case $argument in
    -o* | -[a-z]o* | --output* | --report*)
        echo "render_part.sh: error: $argument: all parts would write the same file; merge_frame.sh writes the frames" >&2
        [ "${FARM_LINES:-}" != openjd ] || echo "openjd_fail: $argument: all parts would write the same file"
        exit 2
        ;;
    esac
done
mkdir -p -- "$(dirname -- "$name")"
asked=$(cksum <"$scene")$(printf ' %q' "$@")
request=$name.$frame.$part-of-$parts.request
readonly caps_hit=5 # vkvol's exit code: the picture is whole, and --strict wants none of this kind
if [ -f "$output" ]; then
    if [ -f "$request" ] && [ "$(head -n 1 "$request")" != "$asked" ]; then
        echo "render_part.sh: error: $output is of another scene or other arguments; remove it, or take another NAME" >&2
        [ "${FARM_LINES:-}" != openjd ] || echo "openjd_fail: $output is of another scene or other arguments"
        exit 2
    fi
    echo "$output is there"
    [ "$(tail -n +2 "$request" 2>/dev/null)" = "$caps_hit" ] || exit 0
    [ "${FARM_LINES:-}" != openjd ] || echo "openjd_fail: limits cut off light in $output, and --strict wants none of that"
    exit $caps_hit
fi
define=()
[ "$frame" = still ] || define=(-D "F=$frame")
window=$(awk -v part="$part" -v parts="$parts" 'BEGIN { printf "0.0,1.0,%.12f,%.12f", (part - 1) / parts, part / parts }')
partial=$name.$frame.$part-of-$parts.partial

# vkvol's lines as they are, or as the farm reads them.
tell() {
    if [ "${FARM_LINES:-}" != openjd ]; then
        cat
        return
    fi
    local line last=
    while IFS= read -r line; do
        case $line in
        '{"progress"'*)
            awk -F '[:,]' '{ printf "openjd_progress: %.1f\n", 100 * $2 }' <<<"$line"
            continue
            ;;
        *error:*) last=$line ;;
        esac
        echo "$line"
    done
    [ -z "$last" ] || echo "openjd_fail: $last"
}

style=(--progress none)
[ "${FARM_LINES:-}" != openjd ] || style=(--progress json)
printf '%s\n' "$asked" >"$request"
checkpoint=$partial.checkpoint
code=0
render() {
    code=0
    "${VKVOL:-vkvol}" "$scene" "${define[@]}" --crop "$window" --checkpoint 30s --resume "${style[@]}" -o "$partial.exr" "$@" 2>&1 |
        tee -- "$partial.log" | tell || code=$?
}
echo "rendering $output"
render "$@"
# By other arguments, of more samples, on another device or by another vkvol: its bits are of no use here.
if [ $code -eq 2 ] && [ -f "$checkpoint" ] && grep -qE -e '--resume: the checkpoint (is of|has)|no checkpoint to go on from' "$partial.log"; then
    echo "$output begins anew"
    rm -- "$checkpoint"
    render "$@"
fi
rm -f -- "$partial.log"
# What ends early writes what it has, and that is not the part: it gets the part's name when all of it is there.
[ $code -eq 0 ] || [ $code -eq $caps_hit ] || exit $code
[ $code -eq 0 ] || echo "$code" >>"$request"
mv -- "$partial.exr" "$output"
rm -f -- "$checkpoint" # there yet where --time ended it: what is removed to be rendered again begins anew
exit $code
