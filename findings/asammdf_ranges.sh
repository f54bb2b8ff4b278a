#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asammdf 8.8.28: a table of ranges is applied only at the upper end of each range, where the raw values are whole
# numbers.
#
# A channel stores the gear that is engaged in one byte; its conversion says a ratio of 10 for 0 to 2, 20 for 3 to 5,
# and 0 otherwise. ASAM MDF 4 has both ends belong to a range of whole numbers. Expected: 10, 10, 10, 20, 20, 20, 0.
# What happens: 0, 0, 10, 0, 0, 20, 20, without a warning: even 6, which is in no range. mdfreader 4.3 reads the same
# file as expected, and asammdf too where the raw values are floats.
# For us: read the channel with raw=True and apply the table yourself, or save such a channel as floats.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asammdf==8.8.28 mdfreader==4.3
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import mdfreader
import numpy as np
from asammdf import MDF, Signal

TABLE = {
    'lower_0': 0, 'upper_0': 2, 'phys_0': 10.0,
    'lower_1': 3, 'upper_1': 5, 'phys_1': 20.0,
    'default': 0.0,
}  # fmt: skip
RIGHT = [10, 10, 10, 20, 20, 20, 0]


def read(kind):
    raw, name = np.arange(7, dtype=kind), f'{kind}.mf4'
    with MDF(version='4.10') as file:
        file.append([Signal(raw, raw / 10.0, name='ratio', conversion=TABLE)])
        file.save(name)
    with MDF(name) as file:
        ratio = file.get('ratio').samples.tolist()
    other = mdfreader.Mdf(name).get_channel_data('ratio').tolist()
    print(kind, 'asammdf', ratio, 'mdfreader', other)
    return ratio, other


for kind in ('uint8', 'int16', 'int32'):
    assert read(kind) == ([0, 0, 10, 0, 0, 20, 20], RIGHT)
assert read('float64')[0] == [10, 10, 0, 20, 20, 0, 0]  # the upper end is not in a range of floats
PYTHON
