#!/usr/bin/env python3
"""Mutants: one-line changes of the physics that the tests must notice.

    python3 checks/mutants.py [--only WORDS] [--target FOLDER]

Every mutant of checks/mutants.toml is made in a worktree of its own from HEAD and has to die: by the tests of its package
(`cargo test --release -p PACKAGE`), or else by the quick verdict. One that does not compile is an error. Takes some minutes a mutant;
--target keeps the compiled crates from one run to the next.

Exit codes: 0 all died, 1 some survived, 2 a mutant does not fit the code.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

# The folder of this file is reached by a link from the root.
ROOT = Path(__file__).resolve().parents[2]


def unfit(words: str) -> None:
    print(words, file=sys.stderr)
    sys.exit(2)


def run(folder: Path, target: str, *command: str) -> tuple[int, str]:
    environment = dict(os.environ, CARGO_TARGET_DIR=target, RUST_BACKTRACE="0")
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def killer(folder: Path, target: str, package: str) -> str | None:
    """What notices the mutant; None if nothing does."""
    code, output = run(folder, target, "cargo", "test", "--release", "-p", package, "--no-fail-fast")
    failed = [line.split()[1] for line in output.split("\n") if line.startswith("test ") and line.endswith("FAILED")]
    if failed:
        return f"{len(failed)} tests of {package}: {failed[0]}"
    if code != 0:
        unfit(f"does not compile:\n{output[-2000:]}")
    code, output = run(folder, target, "cargo", "run", "--release", "--", "validate")
    return output.strip().split("\n")[-1] if code != 0 else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--only", default="", help="mutants whose name has these words")
    parser.add_argument("--target", default=str(ROOT / "target" / "mutants"))
    arguments = parser.parse_args()
    mutants = tomllib.loads((ROOT / "checks" / "mutants.toml").read_text())["mutant"]
    survived = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "code"
        subprocess.run(["git", "worktree", "add", "-q", "--detach", str(folder)], cwd=ROOT, check=True)
        try:
            for mutant in mutants:
                if arguments.only not in mutant["name"]:
                    continue
                path = folder / mutant["file"]
                text = path.read_text()
                if text.count(mutant["old"]) != 1:
                    unfit(f"{mutant['name']}: not once in {mutant['file']}: {mutant['old']!r}")
                path.write_text(text.replace(mutant["old"], mutant["new"]))
                start = time.time()
                found = killer(folder, arguments.target, mutant["package"])
                path.write_text(text)
                survived += found is None
                print(f"{mutant['name']}: {found or 'SURVIVED'} ({time.time() - start:.0f} s)", flush=True)
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(folder)], cwd=ROOT, check=True)
    sys.exit(1 if survived else 0)


if __name__ == "__main__":
    main()
