#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asammdf 8.8.28: cut() adds two samples that were never measured, with a position that the shaft never had.
#
# Expected: the samples between the two times. What happens: by its default include_ends=True a sample is added at
# exactly each of the two times, a float interpolated. In a recording of a single-turn encoder that wraps from 350° to
# 10°, the piece begins at 180°. Counts, as integers, are held at their last value instead. Pieces that
# are joined again have more samples than the recording, at uneven times.
# For us: such samples look like a jump of the encoder; cut with include_ends=False.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asammdf==8.8.28 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import asammdf
import numpy as np

times = np.arange(6) * 0.1
angle = np.array([310.0, 330.0, 350.0, 10.0, 30.0, 50.0])
recording = asammdf.MDF()
recording.append([
    asammdf.Signal(angle, times, name='angle', unit='deg'),
    asammdf.Signal(angle.astype('uint16'), times, name='counts'),
])
cut = recording.cut(start=0.25, stop=0.45)
print('times', cut.get('angle').timestamps, 'angle', cut.get('angle').samples, 'counts', cut.get('counts').samples)
assert np.allclose(cut.get('angle').timestamps, [0.25, 0.3, 0.4, 0.45])
assert np.allclose(cut.get('angle').samples, [180, 10, 30, 40])
assert list(cut.get('counts').samples) == [350, 10, 30, 30]
inner = recording.cut(start=0.25, stop=0.45, include_ends=False)
assert list(inner.get('angle').samples) == [10, 30]
PYTHON
