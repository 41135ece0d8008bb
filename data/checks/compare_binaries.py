#!/usr/bin/env python3
"""The gate: do two builds of `epicyclic` give the same numbers, to the last bit?

    python3 checks/compare_binaries.py BEFORE AFTER [--cases FOLDER] [--threads 1,2]
                                       [--only GLOB] [--out FILE.csv|FILE.md]

Keep the binary from before a change that should alter no result, and run this with the one after it. Every shipped
scene, and with --cases every scene of another folder that BEFORE accepts, goes through the verbs; `scene check` gets
the refused ones too. Compared are all leaves of the JSON (numbers as they are printed), exit codes and messages,
without paths, versions and timings. BEFORE runs on the first number of threads, AFTER on every one, so that its
results are also compared between threads. --only takes a pattern for `command scene`: 'sweep*', '* oh58_4p', validate.

How to read the table: a row is one kind of difference in one job. `runs` says which two were compared: before and
after, or AFTER on two numbers of threads. `path` leads to the leaf: `[]` is any entry of a list, `[rotation]` any of
that coordinate, `[fe.hertz.1]` the one of that id; `count` leaves differ so. Before and after are of the leaf with the
largest relative difference. `of largest` is the largest absolute difference over the largest magnitude at that path:
1e-16 is rounding there, even if an amplitude that should vanish has changed by all of itself. A row `exit code` is a
job that ends differently (2 is refused); a row `not compared` one that ran out of CPU time in both.

Exit codes: 0 all equal, 1 differences, 2 bad arguments.
"""

import argparse
import csv
import fnmatch
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from collections import Counter, namedtuple
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"
# The maps that take seconds; contact-loss and linear-kinematics take minutes.
MAPS = """bouncing-bar hammering transients parametric truncated-stiffness contact-cells explicit-step integrators lag
    locking mode-types resolution spacing""".split()
# Sweeps: keys of [dynamics], keys of [fe_contact], arguments, spread of the speeds about that of the operating point.
# Tables of mesh forces cost as much as they have steps; modes of bodies as much as these have elements, at every speed
# anew. 60 and 120 steps are whole numbers for up to six planets.
SWEEPS = {
    "quasi_static": ('fidelity = "quasi_static"', "", (), 0.3),
    "mesh_law": ('fidelity = "mesh_law"\nsteps_per_cycle = 60', "", (), 0.3),
    "lumped": ('fidelity = "quasi_static"\nsteps_per_cycle = 60', "", ("--model", "lumped"), 0.3),
    "modal_2": ('fidelity = "modal"\nmodes = 2\nsteps_per_cycle = 120', "flank_elements = 6", (), 0.0),
}
FIDELITY_KEYS = "fidelity modes quantity mode_type mode_number response tolerance_percent".split()
LIMIT_S = 60  # CPU time of a job; of validate ten times as much
UNCOMPARED_KEYS = {"version", "seconds", "solve_seconds"}
NAMES = ("id", "name", "coordinate")  # what an entry of a list may be called by
# A command line without the binary; what a run of it gave; a kind of difference in it.
Job = namedtuple("Job", "command scene arguments limit_s", defaults=[LIMIT_S])
Outcome = namedtuple("Outcome", "ending output messages", defaults=["", ""])
Row = namedtuple(
    "Row", "runs command scene path what count before after largest_relative of_largest", defaults=["", ""])


def jobs_without_scene():
    """The verbs that need no scene, the most expensive first."""
    jobs = [Job("validate", "", ("validate",), 10 * LIMIT_S), Job("stability guards", "", ("stability", "--guards"))]
    jobs += [Job(f"stability {name}", "", ("stability", name)) for name in MAPS]
    return jobs + [Job("stability list", "", ("stability",)), Job("validate controls", "", ("validate", "--controls"))]


def jobs_of_scene(path, name, copies):
    """Every verb on one scene, sweeps on copies of it with other keys."""
    text = path.read_text(encoding="utf-8")
    keys = tomllib.loads(text)
    operation = keys.get("operation", {})
    rpm = float(operation.get("speed_rpm", 1000))
    force_n = 200 * keys.get("geometry", {}).get("face_width_mm", 10.0)
    force = ("--normal-force-n", f"{force_n:.9g}") if keys["kind"] == "gear_pair" else ()
    torque = () if "torque_nm" in operation else ("--sun-torque-nm", "500")
    work = [
        ("modes", path, ()),
        ("modes turning", path, ("--carrier-speeds-rpm", f"0,{rpm / 4:.9g}")),
        ("rules", path, ()),
        ("static", path, ("--positions", "12", *force)),
        ("impulse", copies / "quasi_static" / path.name, torque),
        ("branches", path, ("--speeds-rpm", f"{0.98 * rpm:.9g}:{rpm:.9g}", "--max-points", "4")),
    ]
    for sweep, (dynamics, fe_contact, given, spread) in SWEEPS.items():
        copy = copies / sweep / path.name
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(with_keys(with_keys(text, "dynamics", dynamics), "fe_contact", fe_contact), encoding="utf-8")
        speeds = f"{(1 - spread) * rpm:.9g}:{(1 + spread) * rpm:.9g}:{0.3 * rpm:.9g}"
        work.append((f"sweep {sweep}", copy, ("--speeds-rpm", speeds, *given)))
    return [Job(command, name, (command.split()[0], str(file), *rest)) for command, file, rest in work]


def with_keys(scene, table, lines):
    """The scene with these lines in a table, in place of its own for the same keys and for its choice of fidelity."""
    if not lines:
        return scene
    replaced = set(FIDELITY_KEYS) | {line.split(" = ")[0] for line in lines.splitlines()}
    head, header, rest = re.split(rf"(?m)^(\[{table}\].*|\Z)", scene.rstrip() + "\n", maxsplit=1)
    own, *others = re.split(r"(?m)^(?=\[)", rest, maxsplit=1)
    kept = [line for line in own.splitlines() if line.split("=")[0].strip() not in replaced]
    return "\n".join([head, header or f"[{table}]", lines, *kept, *others]) + "\n"


def all_jobs(before, cases, scratch):
    """`scene check` of every scene, all other verbs on those that the binary `before` accepts."""
    jobs = jobs_without_scene()
    for folder in [SCENES] + ([cases] if cases else []):
        for path in sorted(folder.glob("*.toml")):
            name = path.stem if folder == SCENES else f"{folder.name}/{path.stem}"
            jobs.append(Job("scene check", name, ("scene", "check", str(path))))
            if run(before, 1, jobs[-1], scratch).ending == "exit 0":
                jobs += jobs_of_scene(path, name, scratch / folder.name)
    return jobs


def run(binary, threads, job, scratch):
    """One run. Its limit is one of CPU time, which does not depend on what else the machine does."""
    line = ["sh", "-c", f'ulimit -S -t {job.limit_s}; exec "$@"', "sh", binary, *job.arguments, "--format", "json"]
    environment = os.environ | {"RAYON_NUM_THREADS": str(threads)}
    try:
        done = subprocess.run(line, cwd=scratch, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                              timeout=20 * job.limit_s, encoding="utf-8", errors="backslashreplace")
    except subprocess.TimeoutExpired:
        return Outcome(f"over {20 * job.limit_s} s")
    if done.returncode == -signal.SIGXCPU:
        return Outcome(f"over {job.limit_s} s of CPU time")
    return Outcome(f"exit {done.returncode}", done.stdout, normalised(done.stderr, scratch))


def normalised(messages, scratch):
    """Messages without paths, versions, thread and line of a panic, and the seconds of validate's suites."""
    messages = messages.replace(f"{scratch}/", "").replace(f"{SCENES.parent}/", "")
    for varying in (r"\b\d+\.\d+\.\d+\b", r"(?<=') \(\d+\)(?= panicked)", r"(?<=\.rs):\d+:\d+", r"(?m), \d+\.\d s$"):
        messages = re.sub(varying, "", messages)
    return messages


class Number(str):
    """The literal of a JSON number, to the last digit."""


def leaves(outcome):
    """Every leaf of a run by its path: its collapsed path, and its text as JSON has it."""
    found = {"exit code": ("exit code", outcome.ending)}
    found |= {f"stderr[{n}]": ("stderr[]", line) for n, line in enumerate(outcome.messages.splitlines())}
    try:
        collect(json.loads(outcome.output, parse_float=Number, parse_int=Number), "", "", found)
    except json.JSONDecodeError:
        found |= {f"stdout[{n}]": ("stdout[]", line) for n, line in enumerate(outcome.output.splitlines())}
    return found


def collect(value, path, collapsed, found):
    """Adds the leaves below a value of a JSON document."""
    if isinstance(value, dict) and value:
        for key in value.keys() - UNCOMPARED_KEYS:
            collect(value[key], f"{path}.{key}", f"{collapsed}.{key}", found)
    elif isinstance(value, list) and value:
        tables = (entry if isinstance(entry, dict) else {} for entry in value)
        names = [next((table[key] for key in NAMES if type(table.get(key)) is str), "") for table in tables]
        are_names_unique = "" not in names and len(set(names)) == len(names)
        for index, (entry, name) in enumerate(zip(value, names, strict=True)):
            collect(entry, f"{path}[{name if are_names_unique else index}]", f"{collapsed}[{name}]", found)
    else:
        text = str(value) if isinstance(value, Number) else json.dumps(value, ensure_ascii=False)
        found[path.removeprefix(".")] = (collapsed.removeprefix("."), text)


def differences(runs, job, before, after):
    """Rows of the table for two runs of a job, none if they are equal."""
    if before.ending == after.ending and before.ending.startswith("over"):
        return [Row(runs, job.command, job.scene, "", "not compared", "1", before.ending, after.ending)]
    if before == after:
        return []
    if before.ending != after.ending and not (before.output and after.output):  # only one computed anything
        before, after = before._replace(output=""), after._replace(output="")
    old, new = leaves(before), leaves(after)
    groups, scales = {}, {}
    for path in old | new:
        collapsed = (old.get(path) or new[path])[0]
        x, y = (side[path][1] if path in side else None for side in (old, new))
        scales[collapsed] = max(scales.get(collapsed, 0.0), abs(number(x) or 0.0), abs(number(y) or 0.0))
        if x != y:
            what = "added" if x is None else "removed" if y is None else "changed"
            groups.setdefault((collapsed, what), []).append((x or "", y or ""))
    rows = []
    for (path, what), pairs in groups.items():
        x, y = max(pairs, key=lambda pair: relative(*pair) or 0.0)
        size = ()
        if relative(x, y) is not None:
            step = max(abs(number(p) - number(q)) for p, q in pairs if relative(p, q) is not None)
            size = f"{relative(x, y):.1e}", f"{step / (scales[path] or 1.0):.1e}"
        rows.append(Row(runs, job.command, job.scene, path, what, str(len(pairs)), x, y, *size))
    return rows


def number(text):
    """The value of a literal, None where it is no number."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return None


def relative(before, after):
    """Relative difference of two numbers, 1 from or to zero; None where one is no number."""
    x, y = number(before), number(after)
    return None if x is None or y is None else abs(x - y) / (max(abs(x), abs(y)) or 1.0)


def judge(job, given, scratch):
    """All runs of a job, compared; and how BEFORE ended."""
    reference = run(given.before, given.threads[0], job, scratch)
    first, *others = (run(given.after, threads, job, scratch) for threads in given.threads)
    rows = differences("before/after", job, reference, first)
    for threads, other in zip(given.threads[1:], others, strict=True):
        rows += differences(f"threads {given.threads[0]}/{threads}", job, first, other)
    return rows, reference.ending


def judge_all(jobs, given, scratch):
    """Rows of all jobs and how BEFORE ended each, as many jobs at a time as the machine has cores."""
    rows, endings, start = [], {}, time.monotonic()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        waiting = {pool.submit(judge, job, given, scratch): job for job in jobs}
        for done, future in enumerate(as_completed(waiting), start=1):
            found, endings[waiting[future]] = future.result()
            rows += found
            if done % 25 == 0 or found:
                seconds = time.monotonic() - start
                print(f"{done} of {len(jobs)} jobs, {len(rows)} rows, {seconds:.0f} s", file=sys.stderr)
    return sorted(rows), endings


def show(rows):
    """Prints the table with long values cut and columns aligned."""
    lines = [[name.replace("_", " ") for name in Row._fields]]
    lines += [[value if len(value) <= 60 else value[:59] + "…" for value in line] for line in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for line in lines:
        print("  ".join(map(str.ljust, line, widths)).rstrip())


def save(rows, path):
    """Writes the table with whole values, as CSV or Markdown."""
    with path.open("w", encoding="utf-8", newline="") as out:
        if path.suffix == ".csv":
            csv.writer(out).writerows([Row._fields, *rows])
        else:
            for line in [Row._fields, ["---"] * len(Row._fields), *rows]:
                out.write("| " + " | ".join(value.replace("|", "\\|") for value in line) + " |\n")


def summarise(rows, endings, seconds):
    """Prints what was compared; says whether anything differs."""
    print("Jobs by command, and how BEFORE ended them (1 a check failed, 2 refused):")
    for command in sorted({job.command for job in endings}):
        ends = Counter(ending for job, ending in endings.items() if job.command == command)
        print(f"  {command:<30}" + ", ".join(f"{count} × {ending}" for ending, count in sorted(ends.items())))
    different = {line[1:3] for line in rows if line.what != "not compared"}
    uncompared = {line[1:3] for line in rows} - different
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{len(endings)} jobs: {len(endings) - len(different) - len(uncompared)} equal, {len(different)} different, "
          f"{len(uncompared)} not compared; {seconds:.0f} s, {used.ru_utime + used.ru_stime:.0f} s of CPU time")
    return bool(different)


def arguments():
    """The command line; what is wrong with it ends the program with exit code 2."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("before", "after", "--cases", "--out"):
        parser.add_argument(name, type=lambda path: Path(path).resolve())
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--only", default="*")
    given = parser.parse_args()
    for binary in (given.before, given.after):
        if not (binary.is_file() and os.access(binary, os.X_OK)):
            parser.error(f"{binary} is no program")
    if not re.fullmatch(r"[1-9]\d*(,[1-9]\d*)*", given.threads):
        parser.error(f"--threads {given.threads}: whole numbers with commas between, as 1,2")
    given.threads = given.threads.split(",")
    if given.cases and not any(given.cases.glob("*.toml")):
        parser.error(f"--cases {given.cases}: no scene (*.toml) is there")
    if given.out and (given.out.suffix not in (".csv", ".md") or not given.out.parent.is_dir()):
        parser.error(f"--out {given.out}: a file .csv or .md in a folder that is there")
    return given


def main():
    given, start = arguments(), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        jobs = all_jobs(given.before, given.cases, scratch)
        jobs = [job for job in jobs if fnmatch.fnmatchcase(f"{job.command} {job.scene}".strip(), given.only)]
        if not jobs:
            print(f"--only {given.only}: no `command scene` is like that", file=sys.stderr)
            return 2
        rows, endings = judge_all(jobs, given, scratch)
    if given.out:
        save(rows, given.out)
    if rows:
        show(rows)
    return int(summarise(rows, endings, time.monotonic() - start))


if __name__ == "__main__":
    sys.exit(main())
