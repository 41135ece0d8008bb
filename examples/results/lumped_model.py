"""The lumped model of planetary gear sets (Lin & Parker 1999), written from docs/results.md alone: builds M and K of
five sets, computes frequencies, types and multiplicities of their modes, and writes all as a results folder.

    python3 lumped_model.py FOLDER                             # needs NumPy
    epicyclic validate --recorded FOLDER                       # exit code 0
    python3 lumped_model.py FOLDER --mistake ring_angle_sign   # exit code 1: a wrong model is found
"""

import argparse
import csv
import os

import numpy as np

CARRIER, RING, SUN = 0, 1, 2  # bodies in the order of the coordinates; planet n is body 3 + n
DEGREE = np.pi / 180


def sets(mistake):
    """The sets by id of their scene. SI units; `inertia` is I/r², kg."""
    lin_parker = {
        "mass": {"carrier": 5.43, "ring": 2.35, "sun": 0.4, "planet": 0.66},
        "inertia": {"carrier": 6.29, "ring": 3.00, "sun": 0.39, "planet": 0.61},
        "bearing": {"carrier": 1e8, "ring": 1e8, "sun": 1e8, "planet": 1e8},
        "torsion": {"ring": 1e9},
        "mesh": {"sun": 5e8, "ring": 5e8},
        "angle": {"sun": 24.6 * DEGREE, "ring": 24.6 * DEGREE},
        "held": [],
    }
    polar = {"carrier": 49.7e-3, "sun": 0.483e-3, "planet": 1.27e-3}  # I, kg m²
    printed_radius = {"carrier": 88.9e-3, "sun": 35.2e-3, "planet": 45.63e-3}
    as_published = {
        "mass": {"carrier": 5.43, "sun": 0.40, "planet": 0.66},
        "inertia": over_r2(polar, printed_radius, mistake),
        "bearing": {"carrier": 87.6e6, "sun": 87.6e6, "planet": 87.6e6},
        "torsion": {},
        "mesh": {"sun": 350e6, "ring": 350e6},
        "angle": {"sun": 24.6 * DEGREE, "ring": 24.6 * DEGREE},
        # The ring is held, and the rotation of the carrier.
        "held": [(RING, 0), (RING, 1), (RING, 2), (CARRIER, 2)],
    }
    # Base radii go with numbers of teeth, 27, 35 and 99; operating pressure angles follow from them.
    distance, planet = 88.9e-3, 91.26e-3 / 2
    sun, ring = planet * 27 / 35, planet * 99 / 35
    consistent = dict(as_published)
    consistent["inertia"] = over_r2(
        polar, {"carrier": distance, "sun": sun, "planet": planet}, mistake
    )
    consistent["angle"] = {
        "sun": np.arccos((sun + planet) / distance),
        "ring": np.arccos((ring - planet) / distance),
    }
    spacing = 2 * np.pi / (27 + 99) * np.array([0, -31, 63, 32])
    if mistake == "equal_spacing":
        spacing = equal(4)
    return {
        "lin_parker_1999_3p": {**lin_parker, "psi": equal(3)},
        "lin_parker_1999_4p": {**lin_parker, "psi": equal(4)},
        "oh58_3p_as_published": {**as_published, "psi": equal(3)},
        "oh58_4p_as_published": {**as_published, "psi": equal(4)},
        "oh58_4p": {**consistent, "psi": spacing},
    }


def equal(count):
    return 2 * np.pi * np.arange(count) / count


def over_r2(polar, radius, mistake):
    if mistake == "inertia_not_over_r2":
        return polar
    return {body: polar[body] / radius[body] ** 2 for body in polar}


def matrices(given, mistake):
    """M and K on the coordinates that are not held, and those coordinates as (body, axis)."""
    psi = given["psi"]
    names = ["carrier", "ring", "sun"] + ["planet"] * len(psi)
    size = 3 * len(names)
    mass, stiffness = np.zeros((size, size)), np.zeros((size, size))

    def add(k, *terms):
        """A spring of stiffness k whose deflection is the sum of coefficient times coordinate."""
        row = np.zeros(size)
        for body, axis, coefficient in terms:
            row[3 * body + axis] += coefficient
        stiffness[:] += k * np.outer(row, row)

    for body, name in enumerate(names):
        m, inertia = given["mass"].get(name, 0.0), given["inertia"].get(name, 0.0)
        mass[3 * body : 3 * body + 3, 3 * body : 3 * body + 3] = np.diag([m, m, inertia])
    for body, name in enumerate(names[:3]):
        add(given["bearing"].get(name, 0.0), (body, 0, 1.0))
        add(given["bearing"].get(name, 0.0), (body, 1, 1.0))
        add(given["torsion"].get(name, 0.0), (body, 2, 1.0))
    alpha_s, alpha_r = given["angle"]["sun"], given["angle"]["ring"]
    if mistake == "ring_angle_sign":
        alpha_r = -alpha_r
    for n, angle in enumerate(psi):
        planet = 3 + n
        at = angle - alpha_s
        add(
            given["mesh"]["sun"],
            (SUN, 0, -np.sin(at)), (SUN, 1, np.cos(at)), (SUN, 2, 1.0),
            (planet, 0, -np.sin(alpha_s)), (planet, 1, -np.cos(alpha_s)), (planet, 2, 1.0),
        )
        at = angle + alpha_r
        add(
            given["mesh"]["ring"],
            (RING, 0, -np.sin(at)), (RING, 1, np.cos(at)), (RING, 2, 1.0),
            (planet, 0, np.sin(alpha_r)), (planet, 1, -np.cos(alpha_r)), (planet, 2, -1.0),
        )
        cos, sin = np.cos(angle), np.sin(angle)
        bearing = given["bearing"]["planet"]
        add(bearing, (CARRIER, 0, cos), (CARRIER, 1, sin), (planet, 0, -1.0))
        add(bearing, (CARRIER, 0, -sin), (CARRIER, 1, cos), (CARRIER, 2, 1.0), (planet, 1, -1.0))
    free = [(i // 3, i % 3) for i in range(size) if (i // 3, i % 3) not in given["held"]]
    index = [3 * body + axis for body, axis in free]
    return mass[np.ix_(index, index)], stiffness[np.ix_(index, index)], free


def kinds(free, psi):
    """Orthonormal bases of the rotational and the translational subspace. Planets are equal, so that coordinates
    scaled by the root of the mass have the same patterns."""
    rotational, translational = [], []
    for i, (body, axis) in enumerate(free):
        if body <= SUN:
            (rotational if axis == 2 else translational).append(np.eye(len(free))[i])
    for axis in range(3):
        pattern = np.zeros((3, len(free)))
        for n, angle in enumerate(psi):
            pattern[:, free.index((3 + n, axis))] = 1.0, np.cos(angle), np.sin(angle)
        rotational.append(pattern[0])
        translational.extend(pattern[1:])
    return [np.linalg.qr(np.array(rows).T)[0] for rows in (rotational, translational)]


def modes(mass, stiffness, free, psi):
    """Frequency (Hz), type and multiplicity of every mode, ascending."""
    root = np.sqrt(np.diag(mass))
    squares, vectors = np.linalg.eigh(stiffness / np.outer(root, root))  # of M^½ q
    near = 1e-9 * squares[-1]
    squares[np.abs(squares) < near] = 0.0  # rigid-body motion
    bases = kinds(free, psi)
    ends = [i for i in range(1, len(squares)) if squares[i] - squares[i - 1] > near]
    found = []
    for group in np.split(np.arange(len(squares)), ends):
        # How many dimensions of the group lie in each subspace; neither is a planet mode.
        shares = [np.sum((basis.T @ vectors[:, group]) ** 2) for basis in bases]
        counts = {
            "rotational": shares[0],
            "translational": shares[1],
            "planet": len(group) - sum(shares),
        }
        if any(abs(count - round(count)) > 1e-6 for count in counts.values()):
            counts = {"mixed": len(group)}
        frequency = np.sqrt(np.mean(squares[group])) / (2 * np.pi)
        found += [(frequency, kind, round(c)) for kind, c in counts.items() if round(c) > 0]
    return found


RESULTS = """format = 1
kind = "lumped"
program = "lumped_model.py"
version = "1.0"

[convention]
order = ["carrier", "ring", "sun", "planets"]
planets = "radial_tangential"
rotation = "arc"
radius = "base"
sense = "counter_clockwise"
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    mistakes = ["ring_angle_sign", "inertia_not_over_r2", "equal_spacing"]
    parser.add_argument("--mistake", choices=mistakes)
    given = parser.parse_args()
    os.makedirs(os.path.join(given.folder, "matrices"), exist_ok=True)
    with open(os.path.join(given.folder, "results.toml"), "w", encoding="utf-8") as file:
        file.write(RESULTS)
    with open(os.path.join(given.folder, "modes.csv"), "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["scene", "frequency_hz", "mode_type", "multiplicity"])
        for scene, parameters in sets(given.mistake).items():
            mass, stiffness, free = matrices(parameters, given.mistake)
            for letter, matrix in (("M", mass), ("K", stiffness)):
                path = os.path.join(given.folder, "matrices", f"{scene}.{letter}.csv")
                np.savetxt(path, matrix, fmt="%.10g", delimiter=",")
            for frequency, kind, count in modes(mass, stiffness, free, parameters["psi"]):
                table.writerow([scene, f"{frequency:.10g}", kind, count])


if __name__ == "__main__":
    main()
