#!/usr/bin/env python3
"""Lines of Rust by folder: code without blanks, comments and what only tests compile, and beside it what is no product.

    python3 checks/count.py [COMMIT ...] [--depth N]

Counts files under version control, of the working tree without a commit. A line is code if it is neither blank nor a comment
and stands outside every item with `#[cfg(test)]`. `tests` are files in folders of that name, files called tests.rs or
*_tests.rs, and what `#[cfg(test)]` guards; `examples` and `benches` are files in those folders, of which code is counted too.
`all lines` are those of the product with comments and blanks. With two commits the table has the difference.
"""

import argparse
import re
import subprocess
from collections import defaultdict

COLUMNS = ["code", "all lines", "tests", "examples", "benches"]


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], capture_output=True, text=True, check=True).stdout


def files(commit: str | None) -> list[tuple[str, str]]:
    if commit is None:
        names = git("ls-files", "*.rs").split()
        return [(name, open(name, encoding="utf-8").read()) for name in names]
    names = [n for n in git("ls-tree", "-r", "--name-only", commit).split("\n") if n.endswith(".rs")]
    return [(name, git("show", f"{commit}:{name}")) for name in names]


def kind(name: str) -> str:
    folders, base = name.split("/")[:-1], name.split("/")[-1]
    if "tests" in folders or base == "tests.rs" or base.endswith("_tests.rs"):
        return "tests"
    return next((own for own in ("examples", "benches") if own in folders), "code")


def blanked(text: str) -> str:
    """Strings, character literals and comments without their content, so that braces can be counted; lines stay lines."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\.[^\']*|[^\'\\])\'', re.S
    )

    def blank(found: re.Match) -> str:
        own = found.group(0)
        lines = "\n" * own.count("\n")
        return lines if own.startswith("/") else '""' + lines

    return pattern.sub(blank, text)


def split(text: str) -> tuple[int, int]:
    """Lines of code outside and inside items that only tests compile."""
    lines = blanked(text).split("\n")
    outside = inside = 0
    depth, until, is_pending = 0, None, False
    for line in lines:
        line = line.strip()
        is_guard = line.startswith("#[cfg(test)]") or line.startswith("#![cfg(test)]")
        if until is None and is_guard:
            is_pending = True
        in_tests = is_pending or until is not None
        if line:
            inside, outside = inside + in_tests, outside + (not in_tests)
        before = depth
        depth += line.count("{") - line.count("}")
        if is_pending and not is_guard and line and not line.startswith("#"):
            if depth > before:
                is_pending, until = False, before
            elif line.endswith(";") or line.endswith("}"):
                is_pending = False
        if until is not None and depth <= until:
            until = None
    return outside, inside


def count(commit: str | None, depth: int) -> dict[str, dict[str, int]]:
    table: dict[str, dict[str, int]] = defaultdict(lambda: dict.fromkeys(COLUMNS, 0))
    for name, text in files(commit):
        parts = [part for part in name.split("/")[:-1] if part != "src"]
        folder = "/".join(parts[:depth]) or "src"
        own = kind(name)
        outside, inside = split(text)
        for row in (table[folder], table["all"]):
            if own == "code":
                row["code"] += outside
                row["tests"] += inside
                row["all lines"] += text.count("\n")
            else:
                row[own] += outside + inside
    return table


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("commits", nargs="*")
    parser.add_argument("--depth", type=int, default=1, help="folders that a row is deep")
    arguments = parser.parse_args()
    tables = [count(commit, arguments.depth) for commit in arguments.commits or [None]]
    folders = sorted({name for table in tables for name in table if name != "all"}) + ["all"]
    width = max(map(len, folders))
    print(" " * width, *(f"{column:>20}" for column in COLUMNS))
    for folder in folders:
        cells = []
        for column in COLUMNS:
            values = [table[folder][column] if folder in table else 0 for table in tables]
            own = str(values[-1])
            cells.append(own if len(values) == 1 else f"{own} ({values[-1] - values[0]:+})")
        print(f"{folder:<{width}}", *(f"{cell:>20}" for cell in cells))


if __name__ == "__main__":
    main()
