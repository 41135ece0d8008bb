"""Natural modes of a planetary set by the equations of Lin & Parker (1999), as a results folder.

    python3 lin_parker.py right      # writes right/results.toml and right/modes.csv
    python3 lin_parker.py wrong      # the same with the pressure angle of the ring mesh of the wrong sign

Needs NumPy. It shares no code with epicyclic.
"""
import sys
from pathlib import Path

import numpy as np

# Model set of the paper: N/m, kg; inertias as I/r².
ANGLE = np.radians(24.6)
MESH, BEARING, RING_TORSION = 5e8, 1e8, 1e9
MASSES = {"carrier": (5.43, 6.29), "ring": (2.35, 3.00), "sun": (0.40, 0.39), "planet": (0.66, 0.61)}


def modes(planets, ring_angle):
    """Frequencies in Hz with the types of their modes; coordinates x, y, u = rθ of carrier, ring, sun, planets."""
    bodies = ["carrier", "ring", "sun"] + ["planet"] * planets
    size = 3 * len(bodies)
    mass = np.diag([m for body in bodies for m in (MASSES[body][0], MASSES[body][0], MASSES[body][1])])
    stiffness = np.zeros((size, size))

    def spring(k, **rows):
        """A spring whose stretch is linear in the coordinates of the bodies named."""
        stretch = np.zeros(size)
        for name, row in rows.items():
            place = {"carrier": 0, "ring": 1, "sun": 2}.get(name, 3 + n)
            stretch[3 * place : 3 * place + 3] = row
        stiffness[:] += k * np.outer(stretch, stretch)

    sin, cos = np.sin, np.cos
    for n in range(planets):
        psi = 2 * np.pi * n / planets
        at_sun, at_ring = psi - ANGLE, psi + ring_angle
        spring(MESH, sun=[-sin(at_sun), cos(at_sun), 1], planet=[-sin(ANGLE), -cos(ANGLE), 1])
        spring(MESH, ring=[-sin(at_ring), cos(at_ring), 1], planet=[sin(ring_angle), -cos(ring_angle), -1])
        spring(BEARING, carrier=[cos(psi), sin(psi), 0], planet=[-1, 0, 0])
        spring(BEARING, carrier=[-sin(psi), cos(psi), 1], planet=[0, -1, 0])
    for name in ("carrier", "ring", "sun"):
        spring(BEARING, **{name: [1, 0, 0]})
        spring(BEARING, **{name: [0, 1, 0]})
    spring(RING_TORSION, ring=[0, 0, 1])

    root = np.diag(1 / np.sqrt(np.diag(mass)))
    squares, vectors = np.linalg.eigh(root @ stiffness @ root)
    vectors = root @ vectors
    for square, vector in zip(squares, vectors.T):
        vector = vector / np.linalg.norm(vector)
        turns, moves = vector[2:9:3], vector[[0, 1, 3, 4, 6, 7]]
        if np.abs(vector[:9]).max() < 1e-6:
            kind = "planet"
        else:
            kind = "rotational" if np.abs(moves).max() < np.abs(turns).max() else "translational"
        yield np.sqrt(max(square, 0)) / (2 * np.pi), kind


name = sys.argv[1]
ring_angle = {"right": ANGLE, "wrong": -ANGLE}[name]
folder = Path(__file__).parent / name
folder.mkdir(exist_ok=True)
(folder / "results.toml").write_text(
    f'format = 1\nkind = "lumped"\nprogram = "lin_parker.py {name}"\nversion = "1"\n'
)
with open(folder / "modes.csv", "w") as table:
    table.write("scene,frequency_hz,mode_type\n")
    for planets in (3, 4):
        for frequency, kind in modes(planets, ring_angle):
            table.write(f"lin_parker_1999_{planets}p,{frequency:.1f},{kind}\n")
