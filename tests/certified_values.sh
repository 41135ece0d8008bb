#!/usr/bin/env bash
# The data set as its reader uses it: Frictionless validates the package, pandas reproduces three published claims.
# Where the two cannot be had it is said so.
#
#     tests/certified_values.sh [PROGRAM]      # default: target/release/epicyclic
set -euo pipefail
root=$(realpath "$(dirname "$0")/..")
program=$(realpath "${1:-$root/target/release/epicyclic}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$program" dataset values
"$program" dataset check values
(cd values && sha256sum --quiet --check SHA256SUMS)
if ! { python3 -m venv probe && probe/bin/pip install --quiet pandas frictionless 2>probe.txt; }; then
    echo "pandas and frictionless cannot be had: nothing was judged: $(tail -n 1 probe.txt)"
    exit 0
fi
probe/bin/frictionless validate values/datapackage.json
probe/bin/python "$root/checks/certified_claims.py" values
# A claim fails where the tables do not bear it.
sed -i '/published_stiffness.peak_growth.sun.translation/s/,fe_contact,sun,translation,1,1,2260.0,,,,[0-9.]*,/,fe_contact,sun,translation,1,1,2260.0,,,,9.0,/' values/torque_growth.csv
if probe/bin/python "$root/checks/certified_claims.py" values; then
    echo "a growth of 9 at four times the torque was accepted" >&2
    exit 1
fi
echo "certified values: done in $SECONDS s"
