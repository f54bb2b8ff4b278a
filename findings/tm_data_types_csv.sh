#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tm_data_types 0.5.0: a shaft that stands at 0 rad before it makes 100 turns is read from a .csv at 4.8 mrad.
#
# Tektronix's package writes and reads waveforms of its oscilloscopes as .wfm, .csv and .mat. Expected of angles that
# are written to a .csv with nine digits: the same angles when it is read. What happens: they are put into 16 bits
# between the least and the greatest of them, so that after 100 turns a step is 9.6 mrad: 0 is read as 4.8 mrad, a
# transmission error of 1 mrad disappears, and the end of the turns is 4.8 mrad too low. Where one sample is a spike,
# the steps of all others grow with it. A .mat comes back like that, too, a .wfm as it was written.
# Nothing in the README announces it. For us: read the .csv with NumPy, from its eleventh line on.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tm_data_types==0.5.0 numpy==1.26.4
cd "$folder"
timeout 120 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
from tm_data_types import AnalogWaveform, read_file, write_file

# A second at rest, and 100 turns within ten seconds with a transmission error of 1 mrad, at 1 kHz.
turned = 2 * np.pi * 100 * np.clip(0.1 * (0.001 * np.arange(11_001) - 1), 0, 1)
angles = (turned + 0.001 * np.sin(turned)).astype(np.float32)
waveform = AnalogWaveform()
waveform.y_axis_values, waveform.y_axis_spacing, waveform.y_axis_offset = angles, 1.0, 0.0
waveform.x_axis_spacing, waveform.trigger_index = 0.001, 0.0

errors = {}
for kind in ('wfm', 'mat', 'csv'):
    write_file(f'shaft.{kind}', waveform)
    errors[kind] = 1000 * (read_file(f'shaft.{kind}').normalized_vertical_values - angles)
    rest, end, most = errors[kind][0], errors[kind][-1], np.abs(errors[kind]).max()
    print(f'.{kind}: {rest:.2f} mrad at rest, {end:.2f} mrad at the end, {most:.2f} mrad at most off')
assert np.abs(errors['wfm']).max() == 0
for kind in ('mat', 'csv'):
    assert np.isclose(errors[kind][0], 4.79, atol=0.02) and np.isclose(errors[kind][-1], -4.79, atol=0.1)

written = np.loadtxt('shaft.csv', delimiter=',', skiprows=10)[:, 1]
print(f'By NumPy the .csv is at most {1000 * np.abs(written - angles).max():.4f} mrad off')
assert np.abs(written - angles).max() < 1e-5
PYTHON
