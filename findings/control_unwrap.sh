#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-control 0.10.2: unwrap() changes the array that it is given.
#
# control.unwrap(angle) returns the unwrapped angle, and writes it over its argument as well, while numpy.unwrap makes
# a copy. So the recorded angles of a single-turn encoder are lost, a second call with another period starts from
# unwrapped ones, and an array of counts, which are whole numbers, is refused by UFuncTypeError.
# For us: use numpy.unwrap, or give it a copy.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check control==0.10.2
"$folder/venv/bin/python" - <<'PYTHON'
import control
import numpy as np

recorded = np.array([0.1, 6.2, 6.1])
expected = np.unwrap(recorded)
assert recorded[1] == 6.2
unwrapped = control.unwrap(recorded)
print('unwrapped', unwrapped, 'recorded', recorded)
assert np.allclose(unwrapped, expected)
assert np.allclose(recorded, expected)
try:
    control.unwrap(np.array([10, 4090]), period=4096)
except TypeError as error:
    print(error)
else:
    raise AssertionError('counts are unwrapped')
PYTHON
