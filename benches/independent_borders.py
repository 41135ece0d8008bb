"""Borders of parametric instability of lumped sets, by a second program.

    python3 -m venv venv && venv/bin/pip install --quiet mpmath numpy
    venv/bin/python benches/independent_borders.py > b.csv && mv b.csv reference/independent_borders.csv   # 5 seconds

Mass, stiffness, mesh phases, contact ratios and frequencies are those of independent_routes.py. Between two switches of
a mesh's stiffness the motion is exp(A t), here by its power series; their product over a mesh cycle is the monodromy
matrix. A pair of modes is unstable while a Floquet multiplier is larger than 1. The pairs are those of
data/dataset/stability.csv, of which only the names are read.
"""

import csv
import pathlib
import tomllib

import independent_routes as routes
import mpmath as mp
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
VARIATION = 0.02            # half of the peak-to-peak stiffness of a mesh over its mean
GROWS = 1e-6                # a multiplier that is larger than 1 by more than this


def exponential(matrix):
    """exp(matrix) by its power series of the matrix over 2^k, squared k times."""
    halvings = max(0, int(np.ceil(np.log2(np.abs(matrix).sum(axis=1).max()))) + 3)
    small = matrix / 2.0**halvings
    total = term = np.eye(len(matrix))
    for order in range(1, 20):
        term = term @ small / order
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


class Set:
    """A lumped set whose mesh stiffness is a rectangular wave."""

    def __init__(self, name):
        scene = tomllib.loads((ROOT / "scenes" / f"{name}.toml").read_text(), parse_float=mp.mpf)
        self.angles = [2 * mp.pi * turn for turn in routes.turns_of_planets(scene)]
        names, mass, self.mean = self.model(scene)
        self.mass = np.array([float(m) for m in mass])
        bases = routes.subspaces(names, self.angles)
        rows = routes.frequencies(mass, self.mean, bases)
        self.hz = {f"{kind}_{number}": float(value) for quantity, kind, number, value, _ in rows
                   if quantity == "frequency"}
        known = {(quantity, body): float(value) for quantity, body, _, value, _ in routes.geometry_rows(scene)}
        # Part of the cycle with one more pair, its begin, and what the mesh adds to the stiffness at a variation of 1.
        self.meshes = []
        for mesh in ["sun", "ring"]:
            for n in range(len(self.angles)):
                high = known["contact_ratio", f"{mesh}_mesh"] % 1
                begin = -known["mesh_phase", f"{mesh}_mesh_{n}"] % 1
                self.meshes.append((high, begin, self.of_mesh(scene, mesh, n)))
        self.mean = self.numbers(self.mean)
        switches = [0.0, 1.0] + [t % 1 for high, begin, _ in self.meshes for t in (begin, begin + high)]
        self.times = sorted(set(round(t, 12) for t in switches))

    @staticmethod
    def numbers(matrix):
        return np.array(matrix.tolist(), dtype=float)

    def model(self, scene):
        return routes.lumped_model(scene, self.angles)

    def of_mesh(self, scene, mesh, n):
        """Stiffness of that mesh alone: what it loses where that mesh is missing, by difference of two sets."""
        key = {"sun": "sun_planet", "ring": "ring_planet"}[mesh]
        with_one = routes.lumped_model({**scene, "lumped": {**scene["lumped"], "mesh_n_per_m": {
            "sun_planet": 0, "ring_planet": 0, key: scene["lumped"]["mesh_n_per_m"][key]}}}, self.angles)
        names, _, full = with_one
        none = routes.lumped_model({**scene, "lumped": {**scene["lumped"], "mesh_n_per_m": {
            "sun_planet": 0, "ring_planet": 0}}}, self.angles)[2]
        meshes = full - none
        # A mesh couples its planet's coordinates u with all others: column u of the planet is k times its direction.
        u = names.index(f"planet_{n}_u")
        direction = self.numbers(meshes)[:, u]
        return np.outer(direction, direction) / direction[u]

    def largest_multiplier(self, mesh_hz):
        size = len(self.mass)
        monodromy = np.eye(2 * size)
        rate = 2 * np.pi * mesh_hz          # velocities are in units of rate times displacements
        for start, end in zip(self.times, self.times[1:]):
            if end - start < 1e-11:
                continue
            stiffness, middle = self.mean.copy(), (start + end) / 2
            for high, begin, matrix in self.meshes:
                wave = 2 * (1 - high) if (middle - begin) % 1 < high else -2 * high
                stiffness += VARIATION * wave * matrix
            root = np.sqrt(self.mass)
            motion = np.zeros((2 * size, 2 * size))
            motion[:size, size:] = rate * np.eye(size)
            motion[size:, :size] = -stiffness / np.outer(root, root) / rate
            monodromy = exponential(motion * (end - start) / mesh_hz) @ monodromy
        return np.abs(np.linalg.eigvals(monodromy)).max()

    def borders(self, subject, harmonic):
        first, second = (self.hz[name] for name in subject.split())
        centre = (first + second) / harmonic
        grows = lambda hz: self.largest_multiplier(hz) > 1 + GROWS
        inside = next(hz for k in range(200) for hz in (centre * (1 + 2e-5 * k), centre * (1 - 2e-5 * k)) if grows(hz))
        for sign in [-1, 1]:
            within, step = inside, 1e-4 * centre
            while grows(inside + sign * step):
                within, step = inside + sign * step, 2 * step
            beyond = inside + sign * step
            while abs(beyond - within) > 1e-10 * centre:
                middle = (within + beyond) / 2
                within, beyond = (middle, beyond) if grows(middle) else (within, middle)
            yield (within + beyond) / 2


def main():
    with open(ROOT / "data/dataset/stability.csv", newline="") as file:
        pairs = [(row["scene"], row["subject"], int(row["harmonic"])) for row in csv.DictReader(file)
                 if row["quantity"] == "lower_border"]
    sets = {name: Set(name) for name in dict.fromkeys(scene for scene, _, _ in pairs)}
    print("scene,subject,harmonic,lower_border,upper_border")
    for scene, subject, harmonic in pairs:
        low, high = sets[scene].borders(subject, harmonic)
        print(f"{scene},{subject},{harmonic},{float(low)!r},{float(high)!r}")


if __name__ == "__main__":
    main()
