#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# exudyn 1.13.6: the mean of a signal is twice as large in its spectrum, and a speed has half its value at both ends.
#
# ComputeFFT() gives the magnitudes of the parts of a signal. Expected of 3 + 2·cos(2π·5 Hz·t): 3 at 0 Hz and 2 at 5
# Hz, as a vibration around a mean torque is read. What happens: 6 and 2, as the part at 0 Hz is doubled like the
# others, and so is that at half of the sampling rate. FilterSensorOutput() without a filter gives the speed of a
# sensor. Expected of a shaft that turns at 3 rad/s: 3 rad/s in all rows. What happens: its first and last angles are
# repeated beyond the ends, so that its speed is 1.5 rad/s in the first and the last row, and 0 in the last one with
# centralDifferentiate=False. The acceleration is right at the ends.
# For us: halve the magnitude at 0 Hz, and leave out the first and last row of a speed, or use numpy.gradient().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check exudyn==1.13.6 numpy==2.3.5 scipy==1.17.1
cat > "$folder/signal.py" <<'PYTHON'
import numpy as np
from exudyn.signalProcessing import ComputeFFT, FilterSensorOutput

times = np.arange(1000) * 0.01
torque = 3 + 2 * np.cos(2 * np.pi * 5 * times) + 0.5 * np.cos(np.pi * np.arange(1000))
frequencies, magnitudes, _ = ComputeFFT(times, torque)
found = {float(frequencies[line]): float(magnitudes[line]) for line in (0, 50, 500)}
print('magnitudes by frequency', found)
assert all(abs(found[frequency] - value) < 1e-9 for frequency, value in ((0, 6), (5, 2), (50, 1)))
shaft = np.column_stack([times, 3 * times])
for central, first, last in (True, 1.5, 1.5), (False, 3, 0):
    speeds = FilterSensorOutput(shaft, filterWindow=0, derivative=1, centralDifferentiate=central)[:, 1]
    print('speeds', speeds[:3], speeds[-3:])
    assert np.allclose(speeds[1:-1], 3) and np.isclose(speeds[0], first) and np.isclose(speeds[-1], last)
swing = np.column_stack([times, times**2])
assert np.allclose(FilterSensorOutput(swing, filterWindow=0, derivative=2)[:, 1], 2)
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/signal.py"
