#!/usr/bin/env python3
"""One N = 4 OH-58 eigen analysis, ours against scipy.linalg.eigh, side by side.

Purpose: to check the claim that a lumped analysis takes no longer than the eigenvalue call alone in Python.
Ours is the whole analysis (assembly of K and M, eigenvalues and vectors, grouping and mode types); SciPy's
is `eigh(K, M)` alone, on the same matrices, which are assembled beforehand.

Method: both are timed alternately, each over a batch that is long compared with the clock's resolution, in
an order that is reversed from round to round, so that other load on the machine affects both; reported is
the ratio within each round (median, quartiles). BLAS uses one thread unless the environment sets another
number: at 15 to 21 degrees of freedom more threads only cost time. Before any timing the two sets of
eigenvalues are compared, and a disagreement ends the run.

Noise: ratios of quartiles within 10 % of the median are usual on a quiet machine. Time: some ten
seconds after the build.

Needs numpy and scipy, and installs nothing:  pip install numpy scipy
"""

import argparse
import sys

from beside import build, in_turns, print_times, problem, time_call, time_ours, wanted

try:
    import numpy
    import scipy
    from scipy.linalg import eigh
except ImportError as missing:
    sys.exit(f"{missing}: this script needs numpy and scipy (pip install numpy scipy)")

# |Δω²| / ω²_max: backward stable solvers differ by a few n·ε; 1e-12 leaves a hundredfold margin.
AGREEMENT = 1e-12


def main():
    parser = argparse.ArgumentParser(description="Our eigen analysis against scipy.linalg.eigh.")
    arguments = wanted(parser, 2000, "solves")

    harness = build("eigen_analysis")
    data = problem(harness)
    k, m, ours = data["stiffness"], data["mass"], data["omega_squared"]
    values, _ = eigh(k, m)
    difference = numpy.max(numpy.abs(values - numpy.sort(ours))) / values[-1]
    print(f"{k.shape[0]} degrees of freedom, scipy {scipy.__version__}, numpy {numpy.__version__}")
    print(f"worst |Δω²|/ω²_max: {difference:.1e} (allowed {AGREEMENT:.0e})")
    if not difference <= AGREEMENT:
        print("the two do not solve the same problem", file=sys.stderr)
        return 1

    rivals = {
        "eigh(K, M)": lambda: eigh(k, m),
        # SciPy's cheapest call that returns eigenvectors.
        "eigh(K, M, check_finite=False, driver='gv')": lambda: eigh(
            k, m, check_finite=False, driver="gv"
        ),
    }
    runs = {"ours": lambda: time_ours(harness, arguments.batch)}
    for name, solve in rivals.items():
        batch = lambda solve=solve: [solve() for _ in range(arguments.batch)]
        runs[name] = lambda batch=batch: time_call(batch, arguments.batch)
    times = in_turns(runs, arguments.rounds)
    print(f"{arguments.rounds} rounds of {arguments.batch} solves; median [quartiles]")
    print_times(times)
    return 0


if __name__ == "__main__":
    sys.exit(main())
