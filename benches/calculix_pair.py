#!/usr/bin/env python3
"""One gear mesh at a prescribed approach: ours against CalculiX, an independent solver.

Purpose: to check whether another program's elements and contact give the same force, load sharing and peak
pressure for the same teeth. The deck (`fe_contact::export::calculix`) has the geometry and phase of this
project, but not its mechanics: it uses eight-node elements throughout, and contact by face-to-face penalty on
elements whose length is a twelfth of the contact patch's half-width.

Method: the driving race is turned by approach / base radius, the driven race is held. CalculiX's normal
force is the moment of the driving race's reactions over the base radius. With a penalty, flanks overlap by
pressure / penalty stiffness; each deck is therefore solved with two penalties a factor of ten apart, and the
force is extrapolated to zero overlap (linearly in 1/penalty). Peak pressure: from a parabola fitted to the
squares of the faces' mean pressures (in this project: the cells'), only for flank contact, since the pressure
at a corner is singular. This project's program solves the same case at its default settings.

Times: that of CalculiX is one run with one penalty; that of this project is meshing, factorising and solving,
and solving alone. Both are measured on the same machine, for the order of magnitude of the ratio only.

Needs CalculiX (Debian: calculix-ccx) and our command, built with `cargo build --release`; of Python
only the standard library. Time: some ten minutes; `--convergence` some ten more.

    python3 benches/calculix_pair.py                  # all cases
    python3 benches/calculix_pair.py --case sun_interior --convergence
    python3 benches/calculix_pair.py --write          # also reference/calculix_<version>.toml
    python3 benches/calculix_pair.py --deck pair.inp  # an existing deck, CalculiX alone
"""

import argparse
import collections
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent

# id, scene, phase in cycles, approach in µm, teeth kept on either side (None: all), what it shows
Case = collections.namedtuple("Case", "id scene phase approach_um teeth what")
CASES = [
    Case("sun_interior", "oh58_sun_planet_pair", 0.7, 20.0, None, "one pair, mid-path"),
    Case("sun_corner_start", "oh58_sun_planet_pair", 0.9, 20.0, None,
         "planet's tip corner 0.1 base pitches before the path"),
    Case("sun_corner_end", "oh58_sun_planet_pair", 0.5, 20.0, None,
         "sun's tip corner 0.04 base pitches beyond the path"),
    Case("ring_interior", "oh58_ring_planet_pair", 0.3, 12.0, 8, "two pairs, mid-path"),
]

# N/mm³. The lower one lets flanks overlap by 0.1 µm at 1 GPa, the higher one by 0.01 µm.
PENALTIES = [1e7, 1e8]

# (contact elements per half-width, elements along the other flanks)
CONVERGENCE = [(4, 12), (6, 12), (12, 12), (24, 12), (12, 8), (12, 16)]

# Required agreement: force without corner contact, force with corner contact, peak pressure. Percent.
WANTED = {"interior": 1.0, "corner": 2.0, "pressure": 5.0}


def say(text):
    print(text, file=sys.stderr, flush=True)


def version_of(ccx):
    done = subprocess.run([ccx, "-v"], stdout=subprocess.PIPE, text=True)
    found = re.search(r"Version\s+(\S+)", done.stdout)
    return found[1] if found else "unknown"


class Deck:
    """Data that the script needs from an input deck."""

    def __init__(self, text):
        self.text = text
        self.head = dict(re.findall(r"^\*\* (\w+) = (.*)$", text, re.M))
        self.pairs = [
            dict(re.findall(r"(\w+) = (\S+)", line))
            for line in re.findall(r"^\*\* pair (.*)$", text, re.M)
        ]
        self.nodes, self.elements, self.faces = {}, {}, {}
        kind = None
        for line in text.splitlines():
            if line.startswith("*"):
                kind = line.split(",")[0] if not line.startswith("**") else kind
                name = re.search(r"NAME=(\w+)", line)
                if kind == "*SURFACE" and name:
                    surface = self.faces.setdefault(name[1].upper(), [])
                continue
            fields = line.split(",")
            if kind == "*NODE":
                self.nodes[int(fields[0])] = (float(fields[1]), float(fields[2]))
            elif kind == "*ELEMENT":
                self.elements[int(fields[0])] = [int(n) for n in fields[1:]]
            elif kind == "*SURFACE":
                surface.append((int(fields[0]), int(fields[1][1:]) - 1))
            elif kind == "*STEP":
                break

    def with_penalty(self, penalty):
        card = r"(PRESSURE-OVERCLOSURE=LINEAR\n).*"
        return re.sub(card, rf"\g<1>{penalty:.6e}", self.text)

    def middles(self, surface):
        """Element: (middle along the flank, length) of its face, mm."""
        found, at, end = {}, 0.0, None
        for element, edge in self.faces[surface]:
            corners = self.elements[element]
            a, b = self.nodes[corners[edge]], self.nodes[corners[(edge + 1) % 4]]
            length = math.dist(a, b)
            found[element] = (at + 0.5 * length, length)
            at += length
        return found


def solve(ccx, deck, penalty, folder):
    """Runs CalculiX; returns its results and the time in seconds."""
    name = "pair"
    (folder / f"{name}.inp").write_text(deck.with_penalty(penalty))
    start = time.monotonic()
    done = subprocess.run(
        [ccx, "-i", name], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    seconds = time.monotonic() - start
    if "Job finished" not in done.stdout:
        sys.exit(f"{ccx} failed:\n{done.stdout[-2000:]}")
    return read(deck, (folder / f"{name}.dat").read_text()) | {"seconds": seconds}


def block(text, title):
    """Rows of numbers below the last line that starts with `title`."""
    rows = []
    for line in text[text.rindex(title):].splitlines()[1:]:
        fields = line.split()
        try:
            rows.append([float(f) for f in fields])
        except ValueError:
            break
    return [row for row in rows if row]


def read(deck, dat):
    head = deck.head
    cx, cy = map(float, head["driver_centre_mm"].split())
    moment = 0.0
    for node, fx, fy, _ in block(dat, f" forces (fx,fy,fz) for set RACE_{head['driver'].upper()} "):
        x, y = deck.nodes[int(node)]
        moment += (x - cx) * fy - (y - cy) * fx
    pressures = collections.defaultdict(list)
    for element, _, pressure, _, _ in block(dat, " contact stress (slave element+face"):
        pressures[int(element)].append(pressure)
    pairs = []
    for pair in deck.pairs:
        slave = pair["slave"].upper()
        middles = deck.middles(slave)
        faces = [
            (*middles[e], sum(p) / len(p)) for e, p in sorted(pressures.items()) if e in middles
        ]
        faces.sort()
        force = 0.0
        title = f" statistics for slave set {slave},"
        if faces and title in dat:
            rest = dat[dat.rindex(title):]
            force = -block(rest[:rest.index("shear force (size)") + 300], "   area,  normal")[0][1]
        # Force from the faces' mean pressures, printed as a check of the data for the fit.
        total = sum(p * length for _, length, p in faces) * float(head["face_width_mm"])
        fit = fitted(faces) if pair["location"] == "path" else None
        pairs.append({
            "index": int(pair["index"]), "location": pair["location"], "force_n": force,
            "faces": len(faces), "from_faces_n": total, "fit": fit,
        })
    return {"force_n": abs(moment) / float(head["driver_base_radius_mm"]), "pairs": pairs}


def fitted(faces):
    """(peak pressure in MPa, half-width in mm) of the ellipse fitted to the faces' mean pressures.

    The first and the last face are left out: they are loaded on a part of their length only.
    """
    inner = faces[1:-1]
    if len(inner) < 4:
        return None
    middle = sum(x for x, _, _ in inner) / len(inner)
    scale = max(abs(x - middle) for x, _, _ in inner)
    points = [((x - middle) / scale, p * p) for x, _, p in inner]
    # Normal equations of c0 + c1 t + c2 t², by Gauss-Jordan.
    rows = [
        [sum(t ** (i + j) for t, _ in points) for j in range(3)]
        + [sum(y * t ** i for t, y in points)]
        for i in range(3)
    ]
    for i in range(3):
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for k in range(3):
            if k != i:
                rows[k] = [v - rows[k][i] * w for v, w in zip(rows[k], rows[i])]
    c0, c1, c2 = (row[3] for row in rows)
    top = c0 - c1 * c1 / (4.0 * c2)
    if c2 >= 0.0 or top <= 0.0:
        return None
    return math.sqrt(top), scale * math.sqrt(top / -c2)


def hard(values):
    """Limit at infinite penalty of values that are linear in the inverse penalty."""
    soft, stiff = (1.0 / p for p in PENALTIES)
    return values[1] + (values[1] - values[0]) * stiff / (soft - stiff)


def export(arguments, case, folder, per_half_width=None, flank_elements=None):
    """Deck, result of this project and the command for both."""
    deck = folder / f"{case.id}.inp"
    command = [str(arguments.binary), "static", f"scenes/{case.scene}.toml"]
    command += ["--phase", str(case.phase), "--approach-um", str(case.approach_um)]
    if case.teeth is not None:
        command += ["--export-teeth", str(case.teeth)]
    if per_half_width is not None:
        command += ["--export-per-half-width", str(per_half_width)]
    if flank_elements is not None:
        command += ["--export-flank-elements", str(flank_elements)]
    shown = " ".join(["epicyclic", *command[1:], "--export-inp", f"{case.id}.inp"])
    command += ["--export-inp", str(deck), "--format", "json"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return Deck(deck.read_text()), json.loads(done.stdout), shown


def percent(ours, theirs):
    return 100.0 * (ours - theirs) / theirs


def compare(arguments, case, folder):
    deck, own, command = export(arguments, case, folder)
    runs = []
    for penalty in PENALTIES:
        say(f"{case.id}: CalculiX with {penalty:.0e} N/mm³, {len(deck.elements)} elements …")
        runs.append(solve(arguments.ccx, deck, penalty, folder))
    force = hard([run["force_n"] for run in runs])
    print(f"\n{case.id}: {deck.head['mesh']} mesh, phase {case.phase}, approach {case.approach_um} µm")
    print(f"  {case.what}; {len(deck.nodes)} nodes, {len(deck.elements)} elements")
    print(f"  {'':28}{'1e7':>12}{'1e8':>12}{'hard':>12}{'ours':>12}{'ours −':>9}")

    def row(label, values, limit, ours, digits=1):
        cells = "".join(f"{v:12.{digits}f}" for v in [*values, limit, ours])
        print(f"  {label:28}{cells}{percent(ours, limit):8.2f}%")

    row("force, N", [r["force_n"] for r in runs], force, own["force_n"])
    loaded = [p["location"] for p in runs[1]["pairs"] if p["force_n"] > 0.0]
    wanted = WANTED["interior" if set(loaded) == {"path"} else "corner"]
    sound = abs(percent(own["force_n"], force)) <= wanted
    pairs = []
    for k, pair in enumerate(runs[1]["pairs"]):
        ours = next(p for p in own["pairs"] if p["index"] == pair["index"])
        forces = [r["pairs"][k]["force_n"] for r in runs]
        found = {key: pair[key] for key in ("index", "location", "faces")}
        found["force_n"], found["forces_n"] = hard(forces), forces
        if pair["force_n"] > 0.0:
            row(f"  pair {pair['index']} ({pair['location']}), N", forces, hard(forces), ours["force_n"])
        fits = [r["pairs"][k]["fit"] for r in runs]
        if all(fits) and ours["peak_pressure_pa"]:
            peaks = [fit[0] for fit in fits]
            found["peak_pressures_mpa"], found["half_width_mm"] = peaks, fits[1][1]
            ours_mpa = ours["peak_pressure_pa"] * 1e-6
            found["peak_pressure_mpa"] = hard(peaks)
            row(f"    peak of {pair['faces']} faces, MPa", peaks, hard(peaks), ours_mpa)
            sound &= abs(percent(ours_mpa, hard(peaks))) <= WANTED["pressure"]
            print(f"    faces' means over force: {pair['from_faces_n'] / pair['force_n']:.4f}")
        pairs.append(found)
    seconds = [r["seconds"] for r in runs]
    print(f"  CalculiX {seconds[0]:.1f} s and {seconds[1]:.1f} s", end="")
    if "seconds" in own:
        print(f"; ours {own['seconds']:.2f} s, contact {own.get('solve_seconds', 0):.4f} s", end="")
    print(f"\n  {'within' if sound else 'OUTSIDE'} what was aimed at (force {wanted} %, "
          f"pressure {WANTED['pressure']} %)", flush=True)
    return {
        "case": case, "deck": deck, "command": command, "runs": runs, "force_n": force,
        "pairs": pairs, "sound": sound,
    }


def converge(arguments, case, folder):
    print(f"\n{case.id}: refinement of the deck, penalty {PENALTIES[1]:.0e} N/mm³")
    print("  per half-width  flank   elements    force N  peaks MPa")
    rows = []
    for per_half_width, flank in CONVERGENCE:
        deck, _, _ = export(arguments, case, folder, per_half_width, flank)
        say(f"{case.id}: {per_half_width} per half-width, {flank} along other flanks …")
        run = solve(arguments.ccx, deck, PENALTIES[1], folder)
        peaks = [p["fit"][0] for p in run["pairs"] if p["fit"]]
        shown = ", ".join(f"{p:.1f}" for p in peaks)
        print(f"  {per_half_width:14}  {flank:5}   {len(deck.elements):8}  {run['force_n']:9.1f}  {shown}",
              flush=True)
        rows.append((case.id, per_half_width, flank, len(deck.elements), run["force_n"], peaks))
    return rows


def toml(version, results, convergence):
    def numbers(values, digits):
        return "[" + ", ".join(f"{v:.{digits}f}" for v in values) + "]"

    lines = [
        "# One mesh at a prescribed approach, solved by CalculiX. Written by",
        "# `python3 benches/calculix_pair.py --convergence --write`; see there for the method.",
        'kind = "other code"',
        f'source = "CalculiX {version} (Dhondt), Debian calculix-ccx, SPOOLES"',
        f'command = "ccx -i pair"',
        f"penalties_n_per_mm3 = {[float(p) for p in PENALTIES]}",
        "# `force_n` and `peak_pressure_mpa` are extrapolated to a hard contact, linearly in the inverse",
        "# penalty; the lists are what was found with each. `force_n` of a case is the moment on the",
        "# driving race over its base radius, that of a pair the resultant of its contact pressures.",
    ]
    for result in results:
        case, deck = result["case"], result["deck"]
        lines += [
            "", "[[case]]", f'id = "{case.id}"', f'scene = "scenes/{case.scene}.toml"',
            f'what = "{case.what}"', f"phase = {case.phase}", f"approach_um = {case.approach_um}",
            f'deck = "{result["command"]}"', f"nodes = {len(deck.nodes)}",
            f"elements = {len(deck.elements)}",
            f"elements_per_half_width = {deck.head['elements_per_half_width']}",
            f"flank_elements = {deck.head['flank_elements']}",
            f'teeth_kept_either_side = "{deck.head["teeth_kept_either_side"]}"',
            f"force_n = {result['force_n']:.2f}",
            f"forces_n = {numbers([r['force_n'] for r in result['runs']], 2)}",
        ]
        for pair in result["pairs"]:
            lines += [
                "", "[[case.pair]]", f"index = {pair['index']}", f'location = "{pair["location"]}"',
                f"force_n = {pair['force_n']:.2f}", f"forces_n = {numbers(pair['forces_n'], 2)}",
            ]
            if "peak_pressure_mpa" in pair:
                lines += [
                    f"peak_pressure_mpa = {pair['peak_pressure_mpa']:.2f}",
                    f"peak_pressures_mpa = {numbers(pair['peak_pressures_mpa'], 2)}",
                    f"half_width_mm = {pair['half_width_mm']:.5f}",
                    f"loaded_faces = {pair['faces']}",
                ]
    for case, per_half_width, flank, count, force, peaks in convergence:
        lines += [
            "", "[[convergence]]", f'case = "{case}"', f"elements_per_half_width = {per_half_width}",
            f"flank_elements = {flank}", f"elements = {count}",
            f"penalty_n_per_mm3 = {PENALTIES[1]}", f"force_n = {force:.2f}",
            f"peak_pressures_mpa = {numbers(peaks, 2)}",
        ]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/epicyclic")
    parser.add_argument("--ccx", default="ccx")
    parser.add_argument("--case", action="append", choices=[c.id for c in CASES])
    parser.add_argument("--convergence", action="store_true", help="refine the deck of each case")
    parser.add_argument("--write", action="store_true", help="write reference/calculix_<version>.toml")
    parser.add_argument("--deck", type=pathlib.Path, help="a ready deck: CalculiX alone")
    arguments = parser.parse_args()
    if shutil.which(arguments.ccx) is None:
        sys.exit(f"{arguments.ccx}: not found; install CalculiX (Debian: apt-get install calculix-ccx)")
    version = version_of(arguments.ccx)
    print(f"CalculiX {version}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if arguments.deck:
            deck = Deck(arguments.deck.read_text())
            for penalty in PENALTIES:
                run = solve(arguments.ccx, deck, penalty, folder)
                print(f"penalty {penalty:.0e} N/mm³: force {run['force_n']:.2f} N, {run['seconds']:.1f} s")
                for pair in run["pairs"]:
                    print(f"  pair {pair['index']} ({pair['location']}): {pair['force_n']:.2f} N, "
                          f"peak MPa and half-width mm {pair['fit']}")
            return
        if not arguments.binary.exists():
            sys.exit(f"{arguments.binary}: not found; build it with `cargo build --release`")
        wanted = [c for c in CASES if not arguments.case or c.id in arguments.case]
        results = [compare(arguments, case, folder) for case in wanted]
        convergence = []
        if arguments.convergence:
            refined = [c for c in wanted if c.id == "sun_interior"] or wanted[:1]
            convergence = converge(arguments, refined[0], folder)
        if arguments.write:
            path = ROOT / "reference" / f"calculix_{version.replace('.', '_')}.toml"
            path.write_text(toml(version, results, convergence))
            print(f"\nwritten: {path}")
    sys.exit(0 if all(r["sound"] for r in results) else 1)


if __name__ == "__main__":
    main()
