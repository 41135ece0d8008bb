#!/usr/bin/env bash
# Computes the results of a right and of a wrong model, and judges them. PYTHON names a Python with NumPy.
#
#     PYTHON=venv/bin/python examples/results/make.sh [PROGRAM]      # default: target/release/epicyclic
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../../target/release/epicyclic}")
python=$(command -v "${PYTHON:-python3}")
[[ $python = /* ]] || python=$PWD/$python
cd "$(dirname "$0")"
unset GITHUB_STEP_SUMMARY

judge() {
    local folder=$1 expected=$2 code=0
    shift 2
    "$python" lumped_model.py "$folder" "$@"
    "$program" validate --recorded "$folder" --report "$folder/report" >"$folder/verdict.txt" || code=$?
    [ "$code" = "$expected" ] || { echo "$folder: exit code $code, expected $expected" >&2; exit 1; }
}

judge right 0
judge wrong 1 --mistake ring_angle_sign
