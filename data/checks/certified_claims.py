"""Three published claims from the tables of certified values alone; exit code 1 if one does not hold.

Of Table 3 the lumped column is a claim. The finite-element column is shown: values of it that the model misses are
listed with their analysis in checks/misses.toml.

    epicyclic dataset values && python3 checks/certified_claims.py values     # needs pandas

Parker, Agashe & Vijayakar (2000), J. Mech. Design 122, 304-310: Table 3, planet phasing of four planets, section 4.2.
"""

import sys

import pandas as pd

read = lambda name: pd.read_csv(f"{sys.argv[1]}/{name}.csv")
failed = []


def claim(holds, words):
    print("holds" if holds else "FAILS", words, sep=": ")
    failed.extend([] if holds else [words])


# Table 3: lumped values to the last printed digit.
table3 = pd.DataFrame({
    "mode": ["translational", "rotational", "planet", "translational", "rotational", "translational"],
    "lumped": [769, 1156, 1690, 1710, 1781, 2175], "fe_contact": [778, 1144, 1729, 1676, 1723, 2110]})
modes = read("modes").query("quantity == 'frequency' and value > 1")
for kind, scene in [("lumped", "oh58_4p_as_published"), ("fe_contact", "oh58_4p")]:
    ours = modes.query("kind == @kind and scene == @scene")
    off = max((ours.value[ours.subject == row["mode"]] - row[kind]).abs().min() for _, row in table3.iterrows())
    words = f"Table 3, {kind}: at most {off:.2f} Hz off"
    claim(off <= 0.5, words + ", 0.5 Hz allowed") if kind == "lumped" else print("shown", words, sep=": ")

# Phasing of four planets: the sun rotates in even harmonics alone and translates in odd ones alone.
sun = read("steady_states").query("scene == 'oh58_4p' and subject == 'sun'")
for coordinate, parity in [("rotation", 0), ("translation", 1)]:
    largest = sun[sun.coordinate == coordinate].groupby("harmonic").value.max()
    there, not_there = largest[largest.index % 2 == parity], largest[largest.index % 2 != parity]
    share = not_there.max() / there.max()
    is_rule = share < 1e-6 and there.min() > 1e-3 * there.max()
    claim(is_rule, f"sun's {coordinate}: forbidden harmonics {share:.0e} of the largest")

# Section 4.2, with the printed stiffness: peaks grow with torque, translation less than the torque and than rotation.
peaks = read("torque_growth").query("scene == 'oh58_4p_published_stiffness' and quantity == 'peak_growth'")
peaks = peaks.query("subject == 'sun' and number == 1").sort_values("sun_torque_nm").set_index("sun_torque_nm")
growth = [peaks.query("coordinate == @c and harmonic == @l").value for c, l in [("translation", 1), ("rotation", 2)]]
shift, turn = growth
grows = all(one.is_monotonic_increasing and one.min() > 1 and len(one) == 3 for one in growth)
claim(grows and (shift < shift.index / 565).all() and (turn > shift).all(),
      f"growth with torque: translation {shift.round(2).tolist()}, rotation {turn.round(2).tolist()}")
sys.exit(1 if failed else 0)
