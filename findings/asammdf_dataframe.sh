#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asammdf 8.8.28: to_dataframe() interpolates a single-turn encoder through its wraps, and shows values for times before
# a channel began.
#
# A file holds the angle of a rotor every 0.1 s, which wraps at 2π, and the angle of an output in between. The table has
# a row for each time of either, and interpolation is documented to be on. What happens: between 5.4 and 0.9168 rad it
# shows 3.1584 rad, where the rotor was at 0.0168. The output has its first value, 1.0, also at 0.0 s, before it was
# measured. Counts, which are whole numbers, repeat the last one. With use_interpolation=False the table has only what
# was measured, and NaN elsewhere.
# For us: read each channel with its own times, MDF.get(name), and unwrap it before anything else.
#
# Exit code 0: still so. Installs asammdf into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asammdf==8.8.28
cat > "$folder/table.py" <<'PYTHON'
import math
import sys

import numpy as np
from asammdf import MDF, Signal

rotor_times, output_times = np.arange(10) * 0.1, np.arange(10) * 0.1 + 0.05
rotor = np.mod(18.0 * rotor_times, 2.0 * math.pi)
with MDF() as written:
    counts = np.arange(10, dtype='u2') * 100
    written.append([Signal(rotor, rotor_times, name='rotor', unit='rad')])
    written.append([Signal(counts, rotor_times, name='counts')])
    written.append([Signal(1.0 + rotor_times, output_times, name='output', unit='rad')])
    written.save(sys.argv[1])
with MDF(sys.argv[1]) as recorded:
    table = recorded.to_dataframe()
    bare = recorded.to_dataframe(use_interpolation=False)
print(table.head(8))
wrapped = table['rotor'].iloc[7]
assert abs(wrapped - 0.5 * (rotor[3] + rotor[4])) < 1e-9
assert abs(wrapped - math.fmod(18.0 * 0.35, 2.0 * math.pi)) > 3.0
assert table['output'].iloc[0] == 1.0
assert table['counts'].iloc[1] == 0
assert np.isnan(bare['rotor'].iloc[7])
assert np.isnan(bare['output'].iloc[0])
PYTHON
"$folder/venv/bin/python" "$folder/table.py" "$folder/encoders.mf4"
