#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# npTDMS 1.13.0: as_dataframe() puts samples of different times into one row.
#
# A TDMS file has a rotor sampled every 1 ms from 0 s and an output sampled every 2 ms from 0.5 s, as the
# properties wf_increment and wf_start_offset say. Row 1 of the table holds the rotor at 0.001 s beside the
# output at 0.502 s: the columns are put together by the number of the sample, and the shorter one is
# filled with NaN at its end. No argument aligns them but time_index=True, which is off unless given.
# For us: take the times of each channel from time_track(), and interpolate one channel at the other's.
#
# Exit code 0: still so. Installs npTDMS and pandas into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check npTDMS==1.13.0 pandas==3.1.1
cat > "$folder/table.py" <<'PYTHON'
import sys

import numpy as np
from nptdms import ChannelObject, TdmsFile, TdmsWriter

fast = {'wf_increment': 0.001, 'wf_start_offset': 0.0}
slow = {'wf_increment': 0.002, 'wf_start_offset': 0.5}
with TdmsWriter(sys.argv[1]) as writer:
    rotor = ChannelObject('bench', 'rotor', np.arange(6) * 1.0, properties=fast)
    output = ChannelObject('bench', 'output', np.arange(4) * 10.0, properties=slow)
    writer.write_segment([rotor, output])
recorded = TdmsFile.read(sys.argv[1])
table = recorded.as_dataframe()
print(table)
rotor, output = (recorded['bench'][name] for name in ('rotor', 'output'))
assert rotor.time_track()[1] == 0.001
assert output.time_track()[1] == 0.502
row = table.iloc[1].to_numpy()
assert row.tolist() == [1.0, 10.0]
assert np.isnan(table.iloc[5, 1])
aligned = recorded.as_dataframe(time_index=True)
assert len(aligned) == 10
PYTHON
"$folder/venv/bin/python" "$folder/table.py" "$folder/bench.tdms"
