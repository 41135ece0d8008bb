"""Shared by the scripts that time this project and another program in turns."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(variable, "1")  # read when numpy is imported

try:
    import numpy
except ImportError as missing:
    sys.exit(f"{missing}: this script needs numpy (pip install numpy)")

ROOT = pathlib.Path(__file__).resolve().parent.parent


def build(bench):
    """Builds a harness with the bench profile and returns its path."""
    command = ["cargo", "bench", "--no-run", "--bench", bench]
    command += ["--message-format", "json-render-diagnostics"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"cargo could not build the bench {bench}")
    messages = (json.loads(line) for line in done.stdout.splitlines() if line.startswith("{"))
    for message in messages:
        if message.get("executable") and message["target"]["name"] == bench:
            return message["executable"]
    sys.exit(f"cargo built no executable for the bench {bench}")


def problem(harness):
    """The problem of the harness and its solution: the CSV files of its dump, by name."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([harness, "--dump", folder], cwd=ROOT, check=True)
        files = pathlib.Path(folder).glob("*.csv")
        return {file.stem: numpy.loadtxt(file, delimiter=",", ndmin=1) for file in files}


def time_ours(harness, batch):
    """Nanoseconds per solution, measured by the harness over a batch."""
    command = [harness, "--batch", str(batch)]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return float(done.stdout)


def time_call(run, count):
    """Nanoseconds per solution of a call that computes `count` solutions."""
    start = time.perf_counter_ns()
    run()
    return (time.perf_counter_ns() - start) / count


def in_turns(runs, rounds):
    """Times of runs (a dict of functions that return nanoseconds), in an order that is reversed from round to
    round; the first run, this project, is the one that the others are compared with."""
    for run in runs.values():
        run()  # warm up
    times = {name: [] for name in runs}
    for number in range(rounds):
        names = list(runs) if number % 2 == 0 else list(runs)[::-1]
        for name in names:
            times[name].append(runs[name]())
    return times


def print_times(times):
    """Medians and quartiles, then the ratios within each round."""
    for name, series in times.items():
        low, median, high = numpy.percentile(series, [25, 50, 75]) / 1e3
        print(f"  {name}: {median:.3f} µs [{low:.3f}, {high:.3f}]")
    ours, *rivals = times
    for name in rivals:
        ratios = numpy.array(times[name]) / numpy.array(times[ours])
        low, median, high = numpy.percentile(ratios, [25, 50, 75])
        print(f"ratio {name} / {ours}: {median:.2f} [{low:.2f}, {high:.2f}]")


def wanted(parser, batch, what):
    """Rounds and batch from the command line."""
    parser.add_argument("--rounds", type=int, default=40, help="rounds, at least 20 (default 40)")
    parser.add_argument("--batch", type=int, default=batch, help=f"{what} a round (default {batch})")
    arguments = parser.parse_args()
    if arguments.rounds < 20 or arguments.batch < 1:
        parser.error(f"at least 20 rounds of at least one of the {what}")
    return arguments
