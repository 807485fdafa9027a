#!/bin/bash
# Tests the tests: makes one error at a time in a copy of the sources, rebuilds, and requires that the tests named for
# it fail. Keeps which error was caught by what, and at which commit, in tools/results/mutations.txt. Fails if an error
# survives, if the text that it replaces is no longer in the sources, or if the tests fail without any error. The errors
# are those of tools/mutation_table.txt.
#
#   tools/mutation_check.sh [WORD]       WORD: only the errors whose name contains it
#   tools/mutation_check.sh --minutes N  begins no further error after so long
#   tools/mutation_check.sh --share K/N  every Nth of the errors, from the Kth on: N runs at a time, each in a DIR of its own
#   tools/mutation_check.sh --dry-run    only whether every text to be replaced is there, and how many rows are of now
#   MUTATION_DIR=DIR                     where the copy and its build are kept
#
# A row is of now as long as the row itself, the code around the error and the test that caught it are the same
# (tools/mutation_keys.py); others are made again, those that were never made first. All takes some hours on two cores.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
dry_run= only= minutes=1000000 share=1/1
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help)
        sed -n '2,/^set /s/^# \?//p' "$0"
        exit
        ;;
    --dry-run) dry_run=yes ;;
    --minutes) minutes=${2:?--minutes needs a number}; shift ;;
    --share) share=${2:?--share needs K/N}; shift ;;
    *) only=$1 ;;
    esac
    shift
done
results=$root/tools/results/mutations.txt
tab=$(printf '\t')
work=${MUTATION_DIR:-${TMPDIR:-/tmp}/vkvol-mutation}
copy=$work/source
build=$work/build

mutations() {
    sed '/^#/d' "$root/tools/mutation_table.txt"
}

check_texts() {
    python3 -c '
import sys
missing = 0
for line in sys.stdin:
    name, path, texts = line.split(" ~ ")[:3]
    try:
        content = open(path).read()
    except OSError:
        content = ""
    for text in texts.split(" ^ "):
        if text not in content:
            missing += 1
            print(f"{name}: {path} does not contain \"{text}\"; bring tools/mutation_table.txt up to date")
sys.exit(missing > 0)'
}
source=$root
stale() { # rows that are not of now, those that have no line at all first
    mutations | awk -F ' ~ ' -v word="$only" 'index($1, word)' | python3 "$source/tools/mutation_keys.py" "$source" "$results"
}

if [ -n "$dry_run" ]; then
    cd "$root"
    mutations | check_texts
    echo "$(mutations | wc -l) errors, of which $(stale | wc -l) were not made since something that they rest on changed"
    exit
fi

# Changed files only, with a new time, so that what was built of an earlier error is built again.
refresh_copy() {
    mkdir -p "$copy"
    local file
    while IFS= read -r -d '' file; do
        if [ -L "$root/$file" ]; then # to a folder, as it may be
            mkdir -p "$copy/$(dirname "$file")"
            ln -sfn "$(readlink "$root/$file")" "$copy/$file"
            continue
        fi
        [ -f "$root/$file" ] || continue
        cmp -s "$root/$file" "$copy/$file" && continue
        mkdir -p "$copy/$(dirname "$file")"
        cp "$root/$file" "$copy/$file"
    done < <(git -C "$root" ls-files -z --cached --others --exclude-standard)
    (cd "$copy" && find . -type f -print0) | while IFS= read -r -d '' file; do
        [ -f "$root/$file" ] || rm "$copy/$file"
    done
}

# replace FILE TEXT REPLACEMENT: all places; fails if there is none.
replace() {
    python3 - "$@" <<'END'
import sys
path, texts, replacements = sys.argv[1:]
content = open(path).read()
for text, replacement in zip(texts.split(" ^ "), replacements.split(" ^ "), strict=True):
    if text not in content:
        sys.exit(f"{path}: no longer contains \"{text}\"; bring tools/mutation_table.txt up to date")
    content = content.replace(text, replacement.replace("\\n", "\n"))
open(path, "w").write(content)
END
}

build_tests() {
    cmake --build "$build" --target vkvol_tests </dev/null >"$work/build.log" 2>&1 || {
        tail -30 "$work/build.log" >&2
        echo "the copy does not build: $work/build.log" >&2
        return 1
    }
}

run_tests() { # SPECIFICATION: 0 if they pass
    (cd "$build" && timeout 600 ./vkvol_tests "$1" --abort -w NoTests </dev/null >"$work/tests.log" 2>&1)
}

# The first test that failed: Catch2's console reporter puts its name between two lines of dashes.
first_failure() {
    grep -q "FAILED:" "$work/tests.log" || return 1
    awk '/^------/ { if (named) named = 0; else { getline; name = $0; named = 1 } } /FAILED:/ { print name; exit }' \
        "$work/tests.log"
}

# A specification of one test; long names were cut off.
as_specification() { # NAME
    sed 's/[][,\\"*]/\\&/g; s/.$/&*/' <<<"$1"
}

# The test that caught an error the last time: that one is asked first. Nothing if there is none.
last_caught_by() { # NAME
    as_specification "$(awk -F ' *[|] *' -v name="$1" '$1 == name && $2 !~ /^(NOTHING|NOT |NO TEST)/ { print $2 }' "$results")"
}

# One row's verdict: the test that caught it, or, in capitals, why none did.
try_error() { # NAME FILE TEXT REPLACEMENT TESTS
    local verdict caught
    caught=$(last_caught_by "$1")
    cp "$copy/$2" "$work/original"
    if ! replace "$copy/$2" "$3" "$4"; then
        verdict="NOT MADE"
    elif ! build_tests; then
        verdict="NOT BUILT"
    elif [ -n "$caught" ] && ! run_tests "$caught" && verdict=$(first_failure); then
        : # nothing else need be asked
    elif run_tests "$5" && VKVOL_THOROUGH=1 run_tests "$5"; then # of long lists of cases the first has a part
        verdict="NOTHING: $5 passed"
    else
        verdict=$(first_failure) || verdict="NO TEST: the program failed, $work/tests.log"
    fi
    cp "$work/original" "$copy/$2"
    echo "$verdict"
}

# In the order of the table; lines of errors that are no longer made go. One run at a time writes.
keep() { # NAME VERDICT KEY
    local line name fresh=$work/results lock
    exec {lock}<"$results"
    flock "$lock"
    {
        echo "Each error alone, in a copy of the sources of that commit; what it rests on has the key: tools/mutation_check.sh."
        echo
        while IFS= read -r line; do
            name=${line%% ~ *}
            if [ "$name" = "$1" ]; then
                printf '%-56s | %-90s | %s | %s\n' "$name" "$2" "$commit" "$3"
            else
                awk -F ' *[|] *' -v name="$name" '$1 == name' "$results"
            fi
        done < <(mutations)
    } >"$fresh"
    cp "$fresh" "$results"
    exec {lock}<&-
}

mkdir -p "$work"
touch "$results" "$work/sound"
git -C "$root" rev-parse >/dev/null
mutations | cut -d'~' -f1 | grep -F -- "$only" >/dev/null || { echo "no error's name contains '$only'" >&2; exit 1; }
refresh_copy
source=$copy # which stays as it is while rows are made
mapfile -t selected < <(stale | awk -v first="${share%/*}" -v of="${share#*/}" 'NR % of == first % of')
[ ${#selected[@]} -gt 0 ] || { echo "every such error was caught, and nothing that it rests on has changed since"; exit; }
changed=$(git -C "$root" status --porcelain -- CMakeLists.txt host scenes shaders tests tools/make_field | wc -l)
commit=$(git -C "$root" rev-parse --short HEAD)$([ "$changed" = 0 ] || echo "+")
# An error may leave something unused, which is no error of its own.
cmake -S "$copy" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DVKVOL_UNITY=OFF \
    -DCMAKE_CXX_FLAGS="-Wno-unused-parameter -Wno-unused-variable -Wno-unused-function" >"$work/build.log"

# Whether a test fails by itself is asked once of a commit.
check_sound() { # NAME
    ! grep -qxF "$commit $1" "$work/sound" || return 0
    build_tests
    if ! run_tests "$(as_specification "$1")"; then
        tail -30 "$work/tests.log" >&2
        echo "'$1' fails without any error made: $work/tests.log" >&2
        exit 1
    fi
    [[ "$commit" == *+ ]] || echo "$commit $1" >>"$work/sound"
}

bad=0
made=0
for line in "${selected[@]}"; do
    [ $((SECONDS / 60)) -lt "$minutes" ] || break
    IFS=$tab read -r name file text replacement tests <<<"${line// ~ /$tab}"
    verdict=$(try_error "$name" "$file" "$text" "$replacement" "$tests")
    # A test that would fail anyway has caught nothing; a build and its tests are dear, so that is asked of failures alone.
    case $verdict in
    NO[T\ ]*) ;;
    *) check_sound "$verdict" ;;
    esac
    keep "$name" "$verdict" "$(python3 "$source/tools/mutation_keys.py" "$source" --key "$line" "$verdict")"
    printf '%-56s %s\n' "$name" "$verdict"
    made=$((made + 1))
    [[ "$verdict" != NO[T\ ]* ]] || bad=1
done
echo "$made errors made, $((${#selected[@]} - made)) left; $results"
exit $bad
