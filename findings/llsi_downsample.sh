#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# llsi 0.5.0: a motor with a time constant of 0.2 s is found with 1.0 s if its record is downsampled by 5 beforehand.
#
# A record of 10 s at 1 kHz has the torque and the speed of a motor. Expected of SysIdData.downsample(5): a record of
# 10 s at 200 Hz. What happens: the step is multiplied by 5 for each series of the record. With torque and speed it is
# 25 ms instead of 5 ms, the record lasts for 50 s, and the time constant of the model is 1.0 s; with the angle as a
# third series they are 125 ms, 250 s and 4.9 s. The example in its README has two series, too. Without downsample()
# the time constant is 0.2 s. And crop(start=-1000), which keeps the last second, gives it the times from -1 s to 0 s.
# For us: set the attribute Ts after downsample(), and give crop() no negative start.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check llsi==0.5.0 numpy==2.4.6 scipy==1.17.1
cat > "$folder/downsample.py" <<'PYTHON'
import llsi
import numpy as np

COUNT, STEP, CONSTANT = 10000, 0.001, 0.2
torque = np.repeat(np.random.default_rng(0).choice([-1.0, 1.0], COUNT // 50), 50)
speed = np.zeros(COUNT)
kept = np.exp(-STEP / CONSTANT)
for k in range(1, COUNT):
    speed[k] = kept * speed[k - 1] + (1 - kept) * torque[k - 1]
angle = np.cumsum(speed) * STEP


def found(factor, **series):
    record = llsi.SysIdData(Ts=STEP, **series)
    if factor > 1:
        record.downsample(factor)
    model = llsi.sysid(record, 'speed', 'torque', 1, method='n4sid')
    constant = float(-1 / np.linalg.eigvals(model.to_ss(continuous=True).A)[0].real)
    print(f'{len(series)} series by {factor}: step {record.Ts:g} s, end {record.time()[-1]:.2f} s, constant {constant:.3f} s')
    return record.Ts, constant


for factor, series, step, constant in (
    (1, {}, 0.001, 0.2),
    (5, {}, 0.025, 0.987),
    (5, {'angle': angle}, 0.125, 4.94),
):
    given_step, given_constant = found(factor, torque=torque, speed=speed, **series)
    assert abs(given_step - step) < 1e-9 and abs(given_constant - constant) < 0.02 * constant

record = llsi.SysIdData(Ts=STEP, torque=torque, speed=speed)
record.crop(start=-1000)
print('last second from', record.time()[0], 'to', record.time()[-1])
assert np.array_equal(record['speed'], speed[-1000:]) and record.time()[0] == -1
PYTHON
timeout 120 "$folder/venv/bin/python" -W ignore "$folder/downsample.py"
