#!/usr/bin/env bash
# The path of a new user with a set of their own (21/39/99 teeth, module 10, three planets), from an empty folder to
# natural frequencies, excitation rules, a static mesh cycle, a modal test and a speed sweep. Each step uses what the
# step before printed; the seconds each takes are context, nothing judges them.
#
#     tests/new_user.sh [PROGRAM]      # default: target/release/epicyclic
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../target/release/epicyclic}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
    echo "new user: $*" >&2
    exit 1
}

# Runs a verb, shows its seconds, keeps its output in last.txt; exit code 0 is expected.
step() {
    local name=$1 start=$SECONDS
    shift
    "$program" "$@" >last.txt 2>errors.txt || fail "$name: exit $? $(cat errors.txt)"
    echo "$name: $((SECONDS - start)) s"
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

# The set of their own, without [lumped]: mesh and static supply its numbers.
cat >own.toml <<'SCENE'
format = 1
kind = "planetary"
title = "21/39/99, module 10, three planets"

[planets]
count = 3

[teeth]
sun = 21
planet = 39
ring = 99

[geometry]
center_distance_mm = 300.0
face_width_mm = 100.0
rack = { module_mm = 10.0, pressure_angle_deg = 20.0 }

[geometry.sun]
tip_diameter_mm = 230.0
root_diameter_mm = 185.0
bore_diameter_mm = 120.0

[geometry.planet]
tip_diameter_mm = 410.0
root_diameter_mm = 365.0
bore_diameter_mm = 250.0

[geometry.ring]
tip_diameter_mm = 974.0
root_diameter_mm = 1015.0
rim_diameter_mm = 1120.0

[geometry.carrier]
bore_diameter_mm = 400.0
outer_diameter_mm = 760.0

[material]
young_modulus_pa = 207e9
poisson_ratio = 0.3
density_kg_per_m3 = 7850

[sun]
motion = "free"
bearing_n_per_m = 1e8

[ring]
motion = "held"

[carrier]
motion = "rotation_held"
bearing_n_per_m = 5e9

[planet]
bearing_n_per_m = 2e9

[operation]
fixed = "ring"
input = "sun"
speed_rpm = 300
torque_nm = 20000
SCENE
step "scene check" scene check own.toml
says "a valid scene"
step "rules" rules own.toml
step "mesh" mesh own.toml --format json
masses=$(python3 -c '
import json
bodies = {b["body"]: b for b in json.load(open("last.txt"))["bodies"]}
pick = lambda key: ", ".join(f"{n} = {bodies[n][key]:.4g}" for n in ("sun", "planet", "ring", "carrier"))
print("mass_kg = {", pick("mass_kg"), "}")
print("inertia_kg_m2 = {", pick("polar_inertia_kg_m2"), "}")
')
step "static" static own.toml --positions 42 --format json
stiffness=$(python3 -c '
import json
meshes = json.load(open("last.txt"))["torques"][0]["meshes"]
mean = lambda kind: next(m["mean_secant_stiffness_n_per_m"] for m in meshes if m["mesh"] == kind)
print("mesh_n_per_m = { sun_planet = %.4g, ring_planet = %.4g }" % (mean("sun_planet"), mean("ring_planet")))
')
printf '\n[lumped]\n%s\n%s\n' "$masses" "$stiffness" >>own.toml
step "scene check (with [lumped])" scene check own.toml
step "modes" modes own.toml
says "rotational"
says "translational"
step "impulse" impulse own.toml
says "translational"
step "sweep" sweep own.toml --speeds-rpm 100:500:100 --tolerance 1e-6 --between-cycles 0 --out results
test -s results/sweep.csv || fail "the sweep left no table"
step "sweep (resumed)" sweep own.toml --speeds-rpm 100:500:100 --tolerance 1e-6 --between-cycles 0 --out results
echo "new user: done in $SECONDS s"
