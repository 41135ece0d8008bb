#!/usr/bin/env bash
# The path of a new user, from an empty folder and the six numbers of the README to natural frequencies, excitation
# rules, a static mesh cycle, a modal test and a speed sweep. Each step uses what the step before printed, no number is
# copied; the seconds each takes are context, nothing judges them.
#
#     tests/new_user.sh [PROGRAM]      # default: target/release/epicyclic
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../target/release/epicyclic}")
readme=$(realpath "$(dirname "$0")/../README.md")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
    echo "new user: $*" >&2
    exit 1
}

# Seconds since a time, or since the beginning.
began=$EPOCHREALTIME
seconds() {
    LC_ALL=C awk -v from="${1:-$began}" -v to="$EPOCHREALTIME" 'BEGIN { printf "%.1f", to - from }'
}

# Runs a verb, shows its seconds, keeps its output in last.txt; exit code 0 is expected.
step() {
    local name=$1 start=$EPOCHREALTIME
    shift
    "$program" "$@" >last.txt 2>errors.txt || fail "$name: exit $? $(cat errors.txt)"
    echo "$name: $(seconds "$start") s"
}

says() {
    grep -q -- "$1" last.txt || fail "expected \`$1\` in: $(cat last.txt)"
}

# A commented scene to start from; its own numbers are a valid set, and it is never overwritten.
step "scene new" scene new own.toml
step "scene check (template)" scene check own.toml
says "a valid scene"
"$program" scene new own.toml 2>errors.txt && fail "an existing scene was overwritten"
grep -q "own.toml" errors.txt || fail "the refusal does not name the file"

# Teeth changed alone: the messages name what no longer fits, all at once.
sed -e 's/^sun = 27/sun = 21/' -e 's/^planet = 35/planet = 39/' own.toml >half.toml
"$program" scene check half.toml 2>errors.txt && fail "27/35/99 geometry was accepted with 21/39/99 teeth"
grep -q "faults\|fault" errors.txt || fail "no faults are listed"

# The set of six numbers that the README shows, as it stands there.
sed -n '/^```toml$/,/^```$/p' "$readme" | grep -v '^```' >six.toml
test "$(wc -l <six.toml)" -le 8 || fail "the README's scene has more than eight lines"
step "scene check (six numbers)" scene check six.toml
says "a valid scene"
says "chosen: .geometry.center_distance_mm"
step "modes" modes six.toml --format csv
says "rotational"
says "translational"
cp last.txt modes.csv
step "rules" rules six.toml
step "mesh" mesh six.toml
step "static" static six.toml
step "impulse" impulse six.toml
says "translational"
step "sweep" sweep six.toml --speeds-rpm 100:500:100 --out results
test -s results/sweep.csv || fail "the sweep left no table"
step "sweep (resumed)" sweep six.toml --speeds-rpm 100:500:100 --out results

# A list of frequencies beside the set, and the parameters taken from the geometry as a table of the scene.
step "compare" compare modes.csv --scene six.toml
says " 0 do not"
step "modes --parameters" modes six.toml --parameters
{ cat six.toml; echo; cat last.txt; } >lumped.toml
step "modes (with [lumped])" modes lumped.toml
says "translational"
echo "new user: done in $(seconds) s"
