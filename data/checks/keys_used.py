#!/usr/bin/env python3
"""Which keys of a scene change the result of which verb? Measured: every key is given, altered, and the results compared.

    python3 checks/keys_used.py [PROGRAM] [--check] [--keys GLOB]

PROGRAM is target/release/epicyclic if left out. Base scenes are small and coarse; between them every key of the schema is
given. A value is altered so that the scene stays valid: a number by some percent, a whole number by some steps, a word into
each other one. The table has a row for each key and a column for each verb, `sweep` at each fidelity:

    x  changes the result    .  changes nothing    r  the verb refuses a scene with this key    –  never computed

Never computed are keys that cannot be altered alone, and settings chosen for an amplitude, which take minutes.

Behind the table stand keys that change no verb at all, and for each base scene the keys that it gives and no verb that runs
on it uses. At "modal" and "full" sets are asked only of keys that change something else. --check compares the columns with
`changes` of docs/scene_keys.md, and with each scene what `scene check` calls idle there. It takes four minutes of CPU time.

Exit codes: 0, 1 with --check and a difference, 2 bad arguments.
"""

import argparse
import copy
import fnmatch
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from itertools import count
from pathlib import Path

SWEEP = ("sweep", "--method", "marching", "--most-cycles", "2", "--between-cycles", "0", "--harmonics", "2")
# Column: fidelity, command.
VERBS = {
    "modes": (None, ("modes",)),
    "rules": (None, ("rules",)),
    "mesh": (None, ("mesh",)),
    "static": (None, ("static", "--positions", "3")),
    "impulse": (None, ("impulse", "--band-hz", "500:2500", "--step-us", "20", "--duration-ms", "15")),
    "mesh_law": ("mesh_law", SWEEP),
    "quasi_static": ("quasi_static", SWEEP),
    "modal": ("modal", SWEEP),
    "full": ("full", SWEEP),
    "branches": (None, ("branches", "--over", "damping", "--damping-factors", "0.999:1", "--max-points", "2")),
}
# What results repeat of scene and command, and times.
ECHO = set("""scene version title source fidelity body_modes steps_per_cycle seconds solve_seconds work speed_rpm driven held
    input_torque_nm sun_torque_nm sun_torque_ratio damping_factor
    lumped_mass_kg lumped_inertia_kg_m2""".split())
FACTORS = (1.03, 0.97, 1.005, 0.995, 1.0005, 0.9995)

PAIR = """
format = 1
kind = "gear_pair"
mesh = "sun_planet"
teeth = { sun = 18, planet = 18 }
[geometry]
center_distance_mm = 54.0
face_width_mm = 20.0
rack = { module_mm = 3.0, pressure_angle_deg = 22.5 }
thickness = { sun_planet_backlash_mm = 0.1, planet_share = 0.49 }
[geometry.sun]
tip_diameter_mm = 59.4
root_diameter_mm = 46.5
bore_diameter_mm = 30.0
fillet_radius_mm = 0.8
tip_relief = { start_diameter_mm = 56.5, amount_um = 4.0, shape = "linear" }
[geometry.planet]
tip_diameter_mm = 59.4
root_diameter_mm = 46.5
bore_diameter_mm = 30.0
fillet_radius_mm = 0.8
tip_relief = { start_diameter_mm = 56.5, amount_um = 4.0, shape = "linear" }
[material]
young_modulus_pa = 206e9
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[sun]
motion = "free"
bearing_n_per_m = 8e7
[planet]
motion = "free"
bearing_n_per_m = 9e7
torsional_n_per_m = 1e7
[lumped]
mass_kg = { sun = 0.3, planet = 0.3 }
inertia_kg_m2 = { sun = 1e-4, planet = 1e-4 }
radius_mm = { sun = 24.9, planet = 24.9 }
mesh_n_per_m = { sun_planet = 3e8 }
pressure_angle_deg = { sun_planet = 22.5 }
[damping]
mass_proportional_per_s = 142.9
stiffness_proportional_s = 2.21e-6
bearing_s = 3e-6
[operation]
input = "sun"
speed_rpm = 1500
torque_nm = 100
[fe_contact]
plane = "strain"
element = "linear"
flank_elements = 6
flank_layer = "whole"
contact_cells = 24
cell_layout = "graded"
cell_layout_at_rest = "even"
matching_depth_mm = 0.8
matching_points = 2
mean_positions = 4
[dynamics]
steps_per_cycle = 16
gyroscopic = "off"
kinematics = "about_mean"
fidelity = "quasi_static"
"""
SET = PAIR.replace('"gear_pair"\nmesh = "sun_planet"', '"planetary"').replace("planet = 18 }", "planet = 18, ring = 54 }")
# Overlays: `path` to a value, None takes the key away.
RING = {
    "geometry.ring": {
        "tip_diameter_mm": 156.9, "root_diameter_mm": 169.5, "rim_diameter_mm": 190.0, "fillet_radius_mm": 0.8,
        "tip_relief": {"start_diameter_mm": 165.0, "amount_um": 4.0, "shape": "linear"},
    },
    "geometry.thickness.ring_planet_backlash_mm": 0.1,
}
CARRIER = {
    "geometry.carrier": {"bore_diameter_mm": 60.0, "outer_diameter_mm": 150.0, "pin_seat_diameter_mm": 15.0, "body": "flexible"}
}
AS_SET = RING | CARRIER | {
    "planets": {"count": 2},
    "operation.fixed": "ring",
    "sun": {"motion": "free", "bearing_n_per_m": 8e7},
    "ring": {"motion": "free", "bearing_n_per_m": 1e9, "torsional_n_per_m": 1e9},
    "carrier": {"motion": "free", "bearing_n_per_m": 8e7, "torsional_nm_per_rad": 1e6},
    "planet": {"bearing_n_per_m": 8e7, "added_mass_kg": 0.1, "added_inertia_kg_m2": 1e-5},
    "lumped": None,
}
NO_CIRCLES = {"geometry.sun": None, "geometry.planet": None, "geometry.center_distance_mm": None,
              "fe_contact.matching_depth_mm": None, "fe_contact.matching_depth_elements": 1.2, "fe_contact.flank_elements": 8,
              "fe_contact.matching_points": 1}
RACK = {"geometry.rack": {
    "module_mm": 3.0, "pressure_angle_deg": 22.5, "addendum": 0.95, "dedendum": 1.25, "fillet_radius": 0.3}}
LUMPED_SET = {
    "lumped": {
        "mass_kg": {"sun": 0.3, "planet": 0.3, "ring": 1.0, "carrier": 2.0},
        "inertia_kg_m2": {"sun": 1e-4, "planet": 1e-4, "ring": 7e-3, "carrier": 5e-3},
        "radius_mm": {"sun": 24.9, "planet": 24.9, "ring": 74.8, "carrier": 54.0},
        "mesh_n_per_m": {"sun_planet": 3e8, "ring_planet": 3.5e8},
        "pressure_angle_deg": {"sun_planet": 22.5, "ring_planet": 22.5},
    },
}
OVER_R2 = {
    "lumped.inertia_kg_m2": None,
    "lumped.inertia_over_r2_kg": {"sun": 0.16, "planet": 0.16, "ring": 1.3, "carrier": 1.7},
}
AS_RING_PAIR = RING | {
    "mesh": "ring_planet", "teeth": {"planet": 18, "ring": 54}, "geometry.center_distance_mm": 54.0,
    "geometry.thickness": {"ring_planet_backlash_mm": 0.1, "planet_share": 0.49}, "sun": None, "geometry.sun": None,
    "planet": None, "lumped": None, "operation": None, "damping": None,
}
NO_GEOMETRY = {"geometry": None, "fe_contact": None, "damping": None, "operation": None, "teeth": None}


def auto(**keys):
    own = {"flank_elements": None, "element": None, "contact_cells": None, "matching_depth_mm": None}
    own = {f"fe_contact.{key}": value for key, value in own.items()}
    return AS_SET | own | {"carrier": {"motion": "rotation_held", "bearing_n_per_m": 8e7}, "dynamics": {
        "fidelity": "auto", "tolerance_percent": 60.0, **keys}}


# Name: text, overlay, verbs that are asked, all if None and then of all keys, otherwise of those of `dynamics`. A key is
# settled by the first scene in which it changes a result.
BASES = {
    "pair": (PAIR, {}, None),
    "pair with shafts": (PAIR, {
        "geometry.rack": None, "geometry.planet_base_diameter_mm": 49.889, "lumped.inertia_kg_m2": None,
        "lumped.inertia_over_r2_kg": {"sun": 0.16, "planet": 0.16}, "sun.torsional_n_per_m": 1e6,
        "planet.torsional_n_per_m": None, "planet.torsional_nm_per_rad": 1e4,
        "sun.mass_kg": 0.4, "sun.inertia_kg_m2": 2e-4, "planet.mass_kg": 0.4, "planet.inertia_kg_m2": 2e-4,
    }, None),
    "softer pair": (PAIR, {"fe_contact.flexibility_factor": {"sun_planet": 1.1}}, None),
    "pair of base pitch": (PAIR, {
        "geometry.rack": None, "geometry.base_pitch_mm": 8.7073, "sun.torsional_nm_per_rad": 1e3, "lumped": None,
        "planet.torsional_n_per_m": None}, None),
    "modal pair": (PAIR, {"dynamics.fidelity": "modal", "dynamics.modes": 1}, ("impulse", "quasi_static", "branches")),
    "pair of the rack": (PAIR, NO_CIRCLES | RACK | {"lumped": None, "geometry.thickness": {
        "profile_shift": {"sun": 0.1, "planet": 0.05}, "thinning_mm": {"sun": 0.04, "planet": 0.05}}}, None),
    "ring pair": (PAIR, AS_RING_PAIR, None),
    "ring pair of the rack": (PAIR, AS_RING_PAIR | NO_CIRCLES | RACK | {"geometry.ring": None, "geometry.thickness": {
        "profile_shift": {"planet": 0.05, "ring": 0.1, "ring_sign": "outward"},
        "thinning_mm": {"planet": 0.05, "ring": 0.05}}}, None),
    "parameters": (SET, AS_SET | LUMPED_SET | NO_GEOMETRY | {
        "sun.torsional_n_per_m": 1e7, "planets": {"count": 3, "positions_deg": [0.0, 120.0, 240.0]}, "planet_override": [{
            "planet": 1, "mass_kg": 0.31, "inertia_over_r2_kg": 0.17, "bearing_n_per_m": 7e7,
            "sun_planet_n_per_m": 2.9e8, "ring_planet_n_per_m": 3.4e8}]}, None),
    "parameters over r²": (SET, AS_SET | LUMPED_SET | NO_GEOMETRY | OVER_R2 | {
        "planets": {"count": 3}, "teeth": {"sun": 18, "planet": 18, "ring": 54},
        "ring.torsional_n_per_m": None, "ring.torsional_nm_per_rad": 1e6, "sun.torsional_nm_per_rad": 1e3}, None),
    "set": (SET, AS_SET, None),
    "set with lumped": (SET, AS_SET | LUMPED_SET | {
        "planets": {"count": 2, "position_steps": [0, 35]}, "geometry.carrier": None, "planet_override": [
            {"planet": 1, "bearing_n_per_m": 7e7}],
        "geometry.rack": None, "geometry.planet_base_diameter_mm": 49.889,
        "lumped.radius_mm": {"carrier": 54.0}, "lumped.pressure_angle_deg": None,
        "ring": {"motion": "free", "bearing_n_per_m": 1e9, "torsional_nm_per_rad": 1e6},
        "carrier": {"motion": "free", "bearing_n_per_m": 8e7, "torsional_n_per_m": 1e8}}, None),
    "set with ring input": (SET, AS_SET | LUMPED_SET | OVER_R2 | {
        "planets": {"count": 2, "positions_deg": [0.0, 175.0]}, "geometry.carrier": None,
        "sun": {"motion": "free", "bearing_n_per_m": 8e7, "torsional_n_per_m": 1e8},
        "ring": {"motion": "free", "bearing_n_per_m": 1e9}, "operation.fixed": "sun", "operation.input": "ring"}, None),
    "set of the rack": (SET, AS_SET | NO_CIRCLES | RACK | {
        "sun": {"motion": "free", "bearing_n_per_m": 8e7, "torsional_nm_per_rad": 1e5},
        "ring": {"motion": "free", "bearing_n_per_m": 1e9}, "operation.fixed": "sun", "operation.input": "ring",
        "geometry.ring": None, "geometry.center_distance_mm": 54.0, "geometry.thickness": {
            "profile_shift": {"sun": 0.05, "planet": -0.05, "ring": 0.05, "ring_sign": "outward"},
            "thinning_mm": {"sun": 0.03, "planet": 0.04, "ring": 0.05}}}, None),
    "set with held members": (SET, AS_SET | {
        "sun": {"motion": "rotation_held"}, "ring": {"motion": "free", "bearing_n_per_m": 1e9}, "carrier": {"motion": "held"},
        "planets": {"count": 3}, "operation.fixed": "sun", "operation.input": "ring"}, None),
    "softer set": (SET, AS_SET | {"planets": {"count": 3}, "ring": {"motion": "held"}, "carrier": {"motion": "rotation_held"},"fe_contact.flexibility_factor": {"sun_planet": 1.1, "ring_planet": 1.1}}, None),
    "auto frequency": (SET, auto(quantity="natural_frequency", mode_type="rotational", mode_number=1), ("modes",)),
    "auto transmission error": (SET, auto(quantity="transmission_error"), ("static",)),
}


def overlaid(text, changes):
    """The scene with these changes."""
    scene = tomllib.loads(text)
    for path, value in changes.items():
        put(scene, path, copy.deepcopy(value))
    return scene


def put(scene, path, value):
    """Sets the value at a path, or takes it away."""
    *tables, name = path.split(".")
    for table in tables:
        if value is None and table not in scene:
            return
        scene = scene[0] if isinstance(scene, list) else scene
        scene = scene.setdefault(table, {})
    scene = scene[0] if isinstance(scene, list) else scene
    if value is None:
        scene.pop(name, None)
    else:
        scene[name] = value


def leaves(scene, path=""):
    """Every key of a scene with its value, of an array of tables those of its first."""
    for name, value in scene.items():
        own = f"{path}.{name}" if path else name
        if isinstance(value, list) and value and isinstance(value[0], dict):
            value = value[0]
        if isinstance(value, dict):
            yield from leaves(value, own)
        else:
            yield own, value


def toml(scene):
    """The scene as text: every table inline."""
    def shown(value):
        if isinstance(value, dict):
            return "{ " + ", ".join(f"{key} = {shown(own)}" for key, own in value.items()) + " }"
        if isinstance(value, list):
            return "[" + ", ".join(map(shown, value)) + "]"
        return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
    return "".join(f"{key} = {shown(value)}\n" for key, value in scene.items())


def columns():
    """The verbs in the last column of the page of keys, of every key."""
    table, found = "", {}
    for line in Path("docs/scene_keys.md").read_text().splitlines():
        if line.startswith("## "):
            table = "" if "[" not in line else line.strip("# []") + "."
        elif line.startswith("| `"):
            cells = [cell.strip() for cell in line.strip("|").split(" | ")]
            found[table + cells[0].strip("`")] = cells[-1].strip("| ").split(", ")
    return found


def schema_keys(schema, path=""):
    """Every key of the schema that holds a value, with its schema."""
    for name, own in schema.get("properties", {}).items():
        full = f"{path}.{name}" if path else name
        inner = own.get("items", own) if own.get("type") == "array" else own
        if inner.get("type") == "object":
            yield from schema_keys(inner, full)
        else:
            yield full, own


def others(key, value, own):
    """Values to put in place of this one."""
    if "enum" in own:
        return [word for word in own["enum"] if word != value]
    if own.get("type") == "string":
        return [value + " altered"]
    if own.get("type") == "array":
        step = 1 if own["items"]["type"] == "integer" else 5.0
        return [value[:-1] + [value[-1] + sign * step] for sign in (-1, 1)]
    if own.get("type") == "integer":
        low, high = own["minimum"], own["maximum"]
        return [value + step for step in (1, -1, 2, -2, 4, 8) if low <= value + step <= high]
    signs = (-1,) if key == "operation.speed_rpm" else ()
    return [value * factor for factor in signs + FACTORS]


class Bench:
    """Runs of the program, each once."""

    def __init__(self, program):
        self.program, self.folder, self.numbers = program, tempfile.TemporaryDirectory(), count()

    def run(self, scene, arguments):
        """Exit code, JSON and messages of a verb on a scene."""
        path = Path(self.folder.name) / f"{next(self.numbers)}.toml"
        path.write_text(toml(scene), encoding="utf-8")
        line = [self.program, *arguments, str(path), "--format", "json"]
        environment = os.environ | {"RAYON_NUM_THREADS": "1"}
        done = subprocess.run(line, capture_output=True, encoding="utf-8", env=environment)
        path.unlink()
        if done.returncode > 2:
            sys.exit(f"{' '.join(line)}: exit {done.returncode}\n{done.stderr}\n{toml(scene)}")
        return (json.loads(done.stdout) if done.returncode == 0 else None), done.stderr

    def check(self, scene):
        """What `scene check` says of it, None of a scene that is refused."""
        return self.run(scene, ("scene", "check"))[0]

    def verb(self, scene, verb):
        """The result of a verb at its fidelity, None if it is refused."""
        fidelity, arguments = VERBS[verb]
        scene = copy.deepcopy(scene)
        dynamics = scene.setdefault("dynamics", {})
        # At "quasi_static" the scene's own fidelity stands, which is that or is altered.
        if fidelity not in (None, "quasi_static"):
            dynamics |= {"fidelity": fidelity}
            if fidelity == "modal":
                dynamics.setdefault("modes", 1)
        if dynamics.get("fidelity") == "auto":
            arguments = arguments[:1]
        if arguments[0] == "sweep":
            rpm = abs(scene.get("operation", {}).get("speed_rpm", 1000))
            arguments = (*arguments, "--speeds-rpm", f"{rpm}:{rpm}:1")
        if arguments[0] == "static" and scene["kind"] == "gear_pair" and "operation" not in scene:
            arguments = (*arguments, "--normal-force-n", "2000")
        return self.run(scene, arguments)


def differs(one, other):
    """Whether two results differ beyond rounding, apart from what they repeat of the scene."""
    if isinstance(one, dict) and isinstance(other, dict):
        return any(key not in one or key not in other or differs(one[key], other[key])
                   for key in (one.keys() | other.keys()) - ECHO)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) != len(other) or any(map(differs, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return not math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-15)
    return one != other


class Base:
    """A base scene and what its keys change."""

    def __init__(self, bench, name, scene, verbs):
        self.bench, self.name, self.scene = bench, name, scene
        self.summary = bench.check(scene)
        if self.summary is None:
            sys.exit(f"base scene {name}:\n{bench.run(scene, ('scene', 'check'))[1]}")
        self.keys = dict(leaves(scene))
        if verbs:
            self.keys = {key: value for key, value in self.keys.items() if key.startswith("dynamics.")}
        self.results = {verb: bench.verb(scene, verb) for verb in verbs or VERBS}

    def answer(self, key, verb, value, own):
        """What altering a key does to a verb: x, ., r or –, and the message of a refusal."""
        base, message = self.results.get(verb, (None, ""))
        if base is None:
            return ("r" if f"`{key}`" in re.sub(r"\.0\.", ".", message) else "–"), message
        answer = "–"
        for other in others(key, value, own):
            scene = copy.deepcopy(self.scene)
            put(scene, key, other)
            if self.bench.check(scene) is None:
                continue
            result, message = self.bench.verb(scene, verb)
            if result is not None and differs(base, result):
                return "x", ""
            if result is not None:
                answer = "."
                if "enum" not in own and key != "operation.speed_rpm":
                    break
        return answer, message


def best(answers):
    return next((sign for sign in "x.r" if sign in answers), "–")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", default="target/release/epicyclic")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--keys", default="*")
    given = parser.parse_args()
    if not os.access(given.program, os.X_OK):
        parser.error(f"{given.program} is no program")
    bench = Bench(str(Path(given.program).resolve()))
    schema = dict(schema_keys(json.loads(subprocess.check_output([given.program, "scene", "schema"]))))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        bases = list(pool.map(lambda item: Base(bench, item[0], overlaid(*item[1][:2]), item[1][2]), BASES.items()))
        keys = [key for key in schema if fnmatch.fnmatch(key, given.keys)]
        rows = list(pool.map(lambda key: row(bases, key, schema[key]), keys))
    show(keys, [cells for cells, *_ in rows])
    print("change no verb:", ", ".join(key for key, (cells, *_) in zip(keys, rows) if "x" not in cells.values()))
    faults = []
    for base in bases:
        idle = {key for key, (_, idle, _) in zip(keys, rows) if base.name in idle}
        used = {key for key, (_, _, used) in zip(keys, rows) if base.name in used}
        noted = {re.sub(r"\.\d+\.", ".", key) for key in base.summary.get("idle", [])} & base.keys.keys()
        print(f"{base.name}: idle {', '.join(sorted(idle)) or 'nothing'}")
        faults += [f"{base.name}: `scene check` calls {key} idle, which is used" for key in noted & used]
    declared = columns()
    for key, (cells, *_) in zip(keys, rows):
        faults += against_column(key, cells, declared[key])
    print(*(faults if given.check else []), sep="\n")
    return 1 if given.check and faults else 0


def show(keys, rows):
    """Prints the table."""
    width = max(map(len, keys))
    print(" " * width, *VERBS)
    for key, cells in zip(keys, rows):
        print(key.ljust(width), *(cells[verb].center(len(verb)) for verb in VERBS))


def against_column(key, cells, declared):
    """Where what is measured contradicts the column of a key; what was never computed contradicts nothing."""
    groups = {}
    for column, (_, arguments) in VERBS.items():
        groups.setdefault(arguments[0], []).append(cells[column])
    for verb, answers in groups.items():
        answer = best(answers)
        if answer == "x" and verb not in declared:
            yield f"{key} changes {verb}, which its column leaves out"
        if answer == "." and verb in declared:
            yield f"{key} does not change {verb}, which is in its column"


def row(bases, key, own):
    """What a key does to each verb, and the base scenes that give it where nothing uses it, and where something does."""
    cells, idle, used = dict.fromkeys(VERBS, "–"), [], []
    for base in bases:
        value = base.keys.get(key)
        if value is None:
            continue
        own_answers = []
        for verb in base.results:
            if cells[verb] == "x" and ("x" in own_answers or base.results[verb][0] is None):
                continue
            if verb in ("modal", "full") and base.scene["kind"] == "planetary" and "x" not in own_answers:
                continue
            answer, _ = base.answer(key, verb, value, own)
            if base.results[verb][0] is not None:
                own_answers.append(answer)
            cells[verb] = best([cells[verb], answer])
        if "x" in own_answers:
            used.append(base.name)
        elif set(own_answers) == {"."}:
            idle.append(base.name)
    return cells, idle, used


if __name__ == "__main__":
    sys.exit(main())
