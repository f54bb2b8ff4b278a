#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# NumPy 2.4.6: unwrap() puts an encoder of unsigned counts 65536 counts away where they fall by 4.
#
# unwrap() takes the difference of the counts in their own type, in which 2 - 6 is 65532 for uint16, and adds it
# to a float. So with period=4096.0, which is meant for a 12-bit encoder, counts that rise are lost at each wrap, and
# counts that fall jump with each step, without a warning. With period=4096 it raises an OverflowError,
# as half of the period is negative in uint16. Signed counts and floats are right with both.
# For us: convert counts with astype(int) before they are unwrapped.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6
timeout 60 "$folder/venv/bin/python" -W error - <<'PYTHON'
import numpy as np

for counts, right, wrong in (
    ([4090, 4094, 2, 6], [4090, 4094, 4098, 4102], [4090, 4094, -61438, -61434]),
    ([6, 2, 4094, 4090], [6, 2, -2, -6], [6, -65534, -65538, -131078]),
):
    unsigned = np.array(counts, dtype=np.uint16)
    unwrapped = np.unwrap(unsigned, period=4096.0)
    print(counts, 'unwrapped', unwrapped)
    assert unwrapped.tolist() == wrong
    for period in (4096, 4096.0):
        assert np.unwrap(unsigned.astype(int), period=period).tolist() == right
    assert np.unwrap(unsigned.astype(float), period=4096).tolist() == right
    try:
        np.unwrap(unsigned, period=4096)
    except OverflowError as error:
        print(error)
    else:
        raise AssertionError('an integer period is taken')
PYTHON
