#!/usr/bin/env python3
"""One N = 4 OH-58 eigen analysis, ours against scipy.linalg.eigh, side by side.

Purpose: the promise that a lumped analysis costs no more than the bare eigenvalue call that people
would write in Python. Ours is the whole analysis (assembly of K and M, eigenvalues and vectors,
grouping and mode types); scipy's is `eigh(K, M)` alone, on the very matrices ours was computed from,
handed over ready made.

Method: both are timed alternately, each over a batch long against the clock's step, the order
swapped from round to round, so that a busy or throttled machine touches both; what is reported is
the ratio within each round (median, quartiles). BLAS is held to one thread unless the environment
says otherwise: at 15 to 21 degrees of freedom more threads only cost. Before any timing the two sets
of eigenvalues are compared, and a disagreement ends the run.

Noise: ratios of quartiles within 10 % of the median are usual on a quiet machine. Time: some ten
seconds after the build.

Needs numpy and scipy, and installs nothing:  pip install numpy scipy
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")  # read when numpy is imported

try:
    import numpy
    import scipy
    from scipy.linalg import eigh
except ImportError as missing:
    sys.exit(f"{missing}: this script needs numpy and scipy (pip install numpy scipy)")

ROOT = pathlib.Path(__file__).resolve().parent.parent

# |Δω²| / ω²_max: backward stable solvers differ by a few n·ε; 1e-12 leaves a hundredfold margin.
AGREEMENT = 1e-12


def build():
    """Builds the harness with the bench profile and returns its path."""
    command = ["cargo", "bench", "--no-run", "--bench", "eigen_analysis"]
    command += ["--message-format", "json-render-diagnostics"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit("cargo could not build the bench eigen_analysis")
    messages = (json.loads(line) for line in done.stdout.splitlines() if line.startswith("{"))
    for message in messages:
        if message.get("executable") and message["target"]["name"] == "eigen_analysis":
            return message["executable"]
    sys.exit("cargo built no executable for the bench eigen_analysis")


def matrices(harness):
    """K, M and the ω² that ours finds for them."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([harness, "--dump", folder], cwd=ROOT, check=True)
        read = lambda name: numpy.loadtxt(pathlib.Path(folder) / name, delimiter=",")
        return read("stiffness.csv"), read("mass.csv"), read("omega_squared.csv")


def time_ours(harness, batch):
    """Nanoseconds for one analysis, as the harness measures a batch of them."""
    command = [harness, "--batch", str(batch)]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return float(done.stdout)


def time_scipy(solve, batch):
    """Nanoseconds for one call, over a batch of them."""
    start = time.perf_counter_ns()
    for _ in range(batch):
        solve()
    return (time.perf_counter_ns() - start) / batch


def quartiles(values):
    return numpy.percentile(values, [25, 50, 75])


def main():
    parser = argparse.ArgumentParser(description="Our eigen analysis against scipy.linalg.eigh.")
    parser.add_argument("--rounds", type=int, default=40, help="rounds, at least 20 (default 40)")
    parser.add_argument("--batch", type=int, default=2000, help="solves a round (default 2000)")
    arguments = parser.parse_args()
    if arguments.rounds < 20 or arguments.batch < 1:
        parser.error("at least 20 rounds of at least one solve")

    harness = build()
    k, m, ours = matrices(harness)
    values, vectors = eigh(k, m)
    difference = numpy.max(numpy.abs(values - numpy.sort(ours))) / values[-1]
    print(f"{k.shape[0]} degrees of freedom, scipy {scipy.__version__}, numpy {numpy.__version__}")
    print(f"worst |Δω²|/ω²_max: {difference:.1e} (allowed {AGREEMENT:.0e})")
    if not difference <= AGREEMENT:
        print("the two do not solve the same problem", file=sys.stderr)
        return 1

    rivals = {
        "eigh(K, M)": lambda: eigh(k, m),
        # The least work that scipy can be talked into with eigenvectors.
        "eigh(K, M, check_finite=False, driver='gv')": lambda: eigh(
            k, m, check_finite=False, driver="gv"
        ),
    }
    runs = {"ours": lambda: time_ours(harness, arguments.batch)}
    for name, solve in rivals.items():
        runs[name] = lambda solve=solve: time_scipy(solve, arguments.batch)
    for run in runs.values():
        run()  # warm up
    times = {name: [] for name in runs}
    for number in range(arguments.rounds):
        names = list(runs) if number % 2 == 0 else list(runs)[::-1]
        for name in names:
            times[name].append(runs[name]())

    print(f"{arguments.rounds} rounds of {arguments.batch} solves; median [quartiles]")
    for name, series in times.items():
        low, median, high = quartiles(series) / 1e3
        print(f"  {name}: {median:.2f} µs [{low:.2f}, {high:.2f}]")
    for name in rivals:
        ratios = numpy.array(times[name]) / numpy.array(times["ours"])
        low, median, high = quartiles(ratios)
        print(f"ratio {name} / ours: {median:.2f} [{low:.2f}, {high:.2f}]")
    return 0


if __name__ == "__main__":
    sys.exit(main())
