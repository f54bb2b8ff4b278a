#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asammdf 8.8.28: concatenate() changes the times of a file's samples, where files are not in order of time.
#
# Two files of a bench, run_2.mf4 from 12:00:00 and run_10.mf4 from 12:00:10. Sorted by name, as from a glob, run_10
# comes first. MDF.concatenate then puts the samples of run_2 behind it, 10.5 to 10.9 s after the start of run_2, which
# were taken 0.0 to 0.4 s after it. It says nothing. In order of time both keep their times; sync=True is the default.
# Expected: the right times in any order, or an error; MDF.stack keeps the times in any order.
# For us: sort files by MDF(path).header.start_time, or give each file on its own to gearkin.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asammdf==8.8.28
cd "$folder"
venv/bin/python - <<'PYTHON'
import datetime
from pathlib import Path

import numpy as np
from asammdf import MDF, Signal

times = np.arange(5) * 0.1
for name, second in (('run_2.mf4', 0), ('run_10.mf4', 10)):
    with MDF() as run:
        run.header.start_time = datetime.datetime(2026, 1, 1, 12, 0, second, tzinfo=datetime.timezone.utc)
        run.append([Signal(second + times, times, name='rotor')])
        run.save(name)
for files, right in ((['run_2.mf4', 'run_10.mf4'], True), (sorted(map(str, Path().glob('*.mf4'))), False)):
    rotor = MDF.concatenate(files).get('rotor')
    print(files, 'times', rotor.timestamps, 'values', rotor.samples)
    assert np.allclose(rotor.timestamps, rotor.samples) == right
assert files == ['run_10.mf4', 'run_2.mf4']
assert np.allclose(rotor.timestamps[5:], 10.5 + times) and np.allclose(rotor.samples[5:], times)
PYTHON
