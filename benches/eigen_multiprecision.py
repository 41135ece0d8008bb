"""Natural frequencies of 1000 lumped sets with widely spread stiffnesses and masses, in 60-digit arithmetic.

    python3 benches/eigen_multiprecision.py > kept/spread_frequencies.csv      # five minutes; needs mpmath

Every stiffness and mass is drawn from a range of 12 decades (uniform in the logarithm), angles and numbers of planets
uniformly. A row holds the scene's numbers as they stand in its file, then all natural frequencies (Hz) ascending with
15 digits. The matrices are those of Lin & Parker (1999), eqs. (1) to (6), written down independently of the program.
"""

import random

import mpmath as mp

mp.mp.dps = 60
SCENES = 1000


def drawn(generator):
    """The numbers of one scene, as text."""
    stiffness = lambda: f"{10 ** generator.uniform(3, 15):.2e}"
    mass = lambda: f"{10 ** generator.uniform(-8, 4):.2e}"
    count = generator.choice([3, 4, 5])
    positions = ["0"]
    for n in range(1, count):
        positions.append(f"{360 * n / count + generator.choice([0, 0, 1, -2.5]):.1f}")
    support = lambda: generator.choice([stiffness(), stiffness(), "0"])
    return {
        "positions": " ".join(positions),
        "sun_bearing": support(),
        "ring_bearing": support(),
        "carrier_bearing": support(),
        "sun_torsion": support(),
        "ring_torsion": support(),
        "carrier_torsion": support(),
        "planet_bearing": stiffness(),
        "sun_mesh": stiffness(),
        "ring_mesh": stiffness(),
        "sun_angle": f"{generator.uniform(14.5, 30):.1f}",
        "ring_angle": f"{generator.uniform(14.5, 30):.1f}",
        **{f"{body}_mass": mass() for body in ("sun", "ring", "carrier", "planet")},
        **{f"{body}_inertia": mass() for body in ("sun", "ring", "carrier", "planet")},
    }


def frequencies(scene):
    """All natural frequencies, Hz, ascending."""
    psi = [mp.mpf(x) * mp.pi / 180 for x in scene["positions"].split()]
    value = {key: mp.mpf(x) for key, x in scene.items() if key != "positions"}
    alpha_s, alpha_r = value["sun_angle"] * mp.pi / 180, value["ring_angle"] * mp.pi / 180
    # x, y, u of carrier, ring, sun; radial, tangential, u of the planets
    size = 9 + 3 * len(psi)
    rows = []
    for k, body in enumerate(["carrier", "ring", "sun"]):
        rows.append((value[f"{body}_bearing"], {3 * k: 1}))
        rows.append((value[f"{body}_bearing"], {3 * k + 1: 1}))
        rows.append((value[f"{body}_torsion"], {3 * k + 2: 1}))
    for n, angle in enumerate(psi):
        p = 9 + 3 * n
        s, r = angle - alpha_s, angle + alpha_r
        rows.append((value["sun_mesh"], {
            6: -mp.sin(s), 7: mp.cos(s), 8: 1,
            p: -mp.sin(alpha_s), p + 1: -mp.cos(alpha_s), p + 2: 1,
        }))
        rows.append((value["ring_mesh"], {
            3: -mp.sin(r), 4: mp.cos(r), 5: 1,
            p: mp.sin(alpha_r), p + 1: -mp.cos(alpha_r), p + 2: -1,
        }))
        rows.append((value["planet_bearing"], {0: mp.cos(angle), 1: mp.sin(angle), p: -1}))
        rows.append((value["planet_bearing"], {0: -mp.sin(angle), 1: mp.cos(angle), 2: 1, p + 1: -1}))
    mass = []
    for body in ["carrier", "ring", "sun"] + ["planet"] * len(psi):
        mass += [value[f"{body}_mass"], value[f"{body}_mass"], value[f"{body}_inertia"]]
    a = mp.zeros(size)
    for stiffness, row in rows:
        for i, b in row.items():
            for j, c in row.items():
                a[i, j] += stiffness * b * c / mp.sqrt(mass[i] * mass[j])
    squares = mp.eigsy(a, eigvals_only=True)
    largest = max(squares)
    hertz = [mp.sqrt(x) / (2 * mp.pi) if x > largest * mp.mpf(10) ** -50 else mp.mpf(0) for x in squares]
    return sorted(hertz)


def main():
    generator = random.Random(1999)
    names = list(drawn(random.Random(0)))
    print("# 1000 lumped sets over 12 decades of stiffness and mass: scene, then all natural frequencies, Hz.")
    print("# python3 benches/eigen_multiprecision.py > kept/spread_frequencies.csv (mpmath, 60 digits)")
    print(",".join(names + ["frequencies_hz"]))
    for _ in range(SCENES):
        scene = drawn(generator)
        found = " ".join(mp.nstr(f, 15) if f else "0" for f in frequencies(scene))
        print(",".join([scene[name] for name in names] + [found]))


if __name__ == "__main__":
    main()
