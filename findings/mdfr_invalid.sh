#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mdfr 0.7.3: a reading that an .mf4 marks as invalid is an angle like any other, and joining puts numbers in rad under
# the unit deg.
#
# An encoder gives 0 while it has a fault, and marks these samples as invalid. Expected: no value, as mf4-rs 3.7.0 gives
# nan of the same file, or a mask. What happens: get_channel_data(), get_polars_series() and the exported CSV have 0,
# and nothing tells them from readings. concat_mdf() of a recording in deg and one in rad, begun ten seconds later,
# appends the numbers in rad to those in deg, under the unit deg, and lets them follow one sample after the last. It
# compares names alone, and returns no word.
# For us: gearkin leaves invalid samples out of an .mf4; give it the recordings one by one.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mdfr==0.7.3 mf4-rs==3.7.0 asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1
cd "$folder"
timeout 200 venv/bin/python - 2> /dev/null <<'PYTHON'
from datetime import datetime, timedelta, timezone
from pathlib import Path

import mdfr
import mf4_rs
import numpy as np
from asammdf import MDF, Signal

START = datetime(2026, 11, 28, 12, tzinfo=timezone.utc)
times = np.arange(5) / 100


def record(name, angles, unit, begun=START, **options):
    recording = MDF(version='4.10')
    recording.start_time = begun
    recording.append([Signal(np.array(angles), times, name='angle', unit=unit, **options)])
    recording.save(name, overwrite=True)
    loaded = mdfr.Mdfr(name)
    loaded.load_all_channels_data_in_memory()
    return loaded


faulty = record('faulty.mf4', [90.0, 91.0, 0.0, 93.0, 94.0], 'deg', invalidation_bits=np.array([0, 0, 1, 0, 0], bool))
angles = faulty.get_channel_data('angle').tolist()
faulty.export_to_csv('faulty')
[exported] = Path('.').glob('faulty*.csv')
other = mf4_rs.Mdf('faulty.mf4').values('angle')
print('mdfr', angles, 'CSV', exported.read_text().split(), 'mf4-rs', other)
assert angles == [90.0, 91.0, 0.0, 93.0, 94.0] and '0.02,0.0' in exported.read_text()
assert np.isnan(other[2]) and np.isfinite(other[[0, 1, 3, 4]]).all()

first = record('first.mf4', [90.0, 91.0, 92.0, 93.0, 94.0], 'deg')
first.concat_mdf(record('second.mf4', [1.60, 1.62, 1.64, 1.66, 1.68], 'rad', START + timedelta(seconds=10)))
[master] = first.get_channel_names_set() - {'angle'}
joined = first.get_channel_data('angle').tolist(), first.get_channel_unit('angle'), first.get_channel_data(master).tolist()
print('joined', *joined)
assert joined[0] == [90.0, 91.0, 92.0, 93.0, 94.0, 1.60, 1.62, 1.64, 1.66, 1.68] and joined[1] == 'deg'
assert np.allclose(joined[2], np.arange(10) / 100)
PYTHON
