#!/usr/bin/env bash
# docs/results.md as its reader follows it: the commands of the page, run in an empty folder. A folder that is not filled
# is bad input, a right model in Python and in Octave passes, and wrong ones fail in at most sixty lines of text.
# Octave is left out, and said so, where it is not installed, and Python where NumPy
# cannot be had.
#
#     tests/results_folder.sh [PROGRAM]      # default: target/release/epicyclic
set -euo pipefail
root=$(realpath "$(dirname "$0")/..")
program=$(realpath "${1:-$root/target/release/epicyclic}")
page=$root/docs/results.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
ln -s "$root/examples" examples
mkdir commands
ln -s "$program" commands/epicyclic
PATH=$folder/commands:$PATH

fail() {
    echo "results folder: $*" >&2
    exit 1
}

# The commands of the page's block that holds a text.
block() {
    awk -v text="$1" '
        /^```sh$/ { inside = 1; lines = ""; next }
        /^```$/ { if (inside && index(lines, text)) { printf "%s", lines; found = 1; exit } inside = 0 }
        inside { lines = lines $0 "\n" }
        END { exit !found }' "$page" || fail "no block of $page has \`$1\`"
}

# Runs commands, of which the last must end with a code and the others with 0; what the last prints is in last.txt.
ends_with() {
    local code=$1 commands=$2 found=0
    head -n -1 <<<"$commands" >first.sh
    tail -n 1 <<<"$commands" >last.sh
    bash -e first.sh >first.txt 2>&1 || fail "$commands: $(cat first.txt)"
    bash last.sh >last.txt 2>errors.txt || found=$?
    [ "$found" = "$code" ] || fail "exit code $found, expected $code: $commands $(cat last.txt errors.txt)"
}

says() {
    grep -q -- "$1" "$2" || fail "expected \`$1\` in: $(cat "$2")"
}

commands=$(block "results new")
for lines in 2 3; do
    rm -rf my_results
    # `results check` ends with 2 here too: of the first three commands only one leads to each.
    ends_with 2 "$(sed -n "1p;${lines}p" <<<"$commands")"
    says "modes.csv:2: column .* is empty" errors.txt
done
echo "a folder that is not filled is bad input"

# A right model, then each mistake in place of the one that the page shows.
judge() {
    local right=$1 language=$2 mistake lines
    ends_with 0 "$right"
    says "0 failed" last.txt
    says "kind lumped" last.txt
    echo "$language, right model: $(tail -n 1 last.txt)"
    for mistake in ring_angle_sign inertia_not_over_r2 equal_spacing; do
        ends_with 1 "$(wrong "$mistake")"
        lines=$(wc -l <last.txt)
        [ "$lines" -le 60 ] || fail "$mistake: $lines lines"
        echo "$language, $mistake: $(tail -n 1 last.txt) in $lines lines"
    done
}

wrong() { block "--mistake" | sed "s/ring_angle_sign/$1/"; }
languages=0
if python3 -m venv probe && probe/bin/pip download --quiet --no-deps --dest probe numpy 2>probe.txt; then
    judge "$(block lumped_model.py)" Python
    languages=1
else
    echo "NumPy cannot be had: the example in Python was not run: $(tail -n 1 probe.txt)"
fi

if command -v octave-cli >/dev/null; then
    wrong() { block octave-cli | sed "s/('from_octave')/('wrong', '$1')/; s/from_octave/wrong/"; }
    judge "$(block octave-cli)" Octave
    languages=$((languages + 1))
    types() { cut -d, -f1,3,4 "$1/modes.csv" | tr -d '\r'; }
    [ ! -e from_python ] || cmp <(types from_octave) <(types from_python) || fail "types differ between Python and Octave"
else
    echo "Octave is not installed: its example was not run"
fi
[ "$languages" -gt 0 ] || echo "neither NumPy nor Octave can be had: no model was judged"
echo "results folder: done in $SECONDS s"
