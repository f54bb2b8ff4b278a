#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyBullet 3.2.7: the wheel requires no numpy, but without it the import fails.
#
# `pip install pybullet` succeeds in an empty environment, and `pip check` finds nothing missing. `import pybullet`
# raises "numpy._core.multiarray failed to import": the wheel was built with numpy, and states no dependency.
# For us: install numpy beside it, to load the URDF.
#
# Exit code 0: still so. Installs the version into a temporary folder; needs Python 3.9 to 3.12 for its wheel.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
pip="$folder/venv/bin/pip --disable-pip-version-check"
$pip install --quiet --only-binary=:all: pybullet==3.2.7
$pip check
if "$folder/venv/bin/python" -c 'import pybullet' 2> "$folder/error"; then exit 1; fi
grep 'ImportError: numpy' "$folder/error"
$pip install --quiet numpy==2.4.6
"$folder/venv/bin/python" -c 'import pybullet'
