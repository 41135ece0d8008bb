#!/usr/bin/env bash
# Computes the results of a right and of a wrong model, and judges them; needs Python with NumPy.
#
#     examples/results/make.sh [PROGRAM]      # default: target/release/epicyclic
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../../target/release/epicyclic}")
cd "$(dirname "$0")"
unset GITHUB_STEP_SUMMARY

judge() {
    python3 lin_parker.py "$1"
    local code=0
    "$program" validate --recorded "$1" --report "$1/report" >"$1/verdict.txt" || code=$?
    [ "$code" = "$2" ] || { echo "$1: exit code $code, expected $2" >&2; exit 1; }
}

judge right 0
judge wrong 1
