#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# opendsp 0.1.0: a band-stop makes -170 rad of a shaft at 100 rad, and a shaft that turns back begins at 0 rad/s.
#
# Its butter() is documented as a replacement for that of scipy.signal. Expected of a band-stop of order 2 from 5 to
# 10 Hz at 100 Hz, which is to remove the resonance of an arm: a gain of 1 outside of the band. What happens: -1.7, for
# other bands and orders from 0.86 to 3.98, with either sign. Low-pass, high-pass and band-pass are those of scipy.
# Expected of savitzky_golay() of a shaft that turns at -1 rad/s: -1 rad/s everywhere. What happens: it begins and ends
# at 0, and is wrong for half a window there; at +1 rad/s it is right. resample_hz() from 100 to 200 Hz puts the last
# sample at the end of the new record, so that all times are stretched, by 0.25 % for 2 s.
# For us: use scipy.signal.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check opendsp==0.1.0 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
import opendsp
import scipy.signal

still = np.full(2000, 100.0)
for order, band, gain in ((1, [0.3, 0.6], 0.8556), (2, [0.1, 0.2], -1.6989), (4, [0.3, 0.6], 3.9805)):
    ours, theirs = (module.butter(order, band, 'bandstop') for module in (opendsp, scipy.signal))
    values = opendsp.lfilter(*ours, still)[-1], scipy.signal.lfilter(*theirs, still)[-1]
    print('order', order, 'band', band, 'a shaft at 100 rad is at', values[0], 'rad, by scipy at', values[1], 'rad')
    assert abs(values[0] - 100 * gain) < 0.01 and abs(values[1] - 100) < 0.001
for kind, band in (('low', 0.1), ('high', 0.1), ('band', [0.1, 0.2])):
    assert np.allclose(opendsp.butter(3, band, kind), scipy.signal.butter(3, band, kind))

times = np.arange(200) / 100
forward, back = (opendsp.savitzky_golay(speed * times, 9, 2, deriv=1, rate=100.0) for speed in (1, -1))
print('speeds at the start, turning forward', forward[:5], 'and back', back[:5])
assert np.allclose(forward, 1.0)
assert abs(back[0]) < 1e-9 and abs(back[-1]) < 1e-9 and np.allclose(back[4:-4], -1.0)

resampled = opendsp.resample_hz(times, 100, 200)
print('samples', resampled.size, 'speed of 1 rad/s', (resampled[1] - resampled[0]) * 200)
assert resampled.size == 400 and abs((resampled[1] - resampled[0]) * 200 - 0.9975) < 1e-4
PYTHON
