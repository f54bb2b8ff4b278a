#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# optisim 0.19.0: its estimator gives a joint that turns at 1 rad/s a speed of 0, and lifts a resting robot by 981 m.
#
# The state of RobotStateEstimator has angles and speeds of joints, and encoders are read 100 times a second for 10 s.
# Expected of a joint at a constant 1 rad/s, without noise: an estimate near 10 rad and 1 rad/s at the end. It is
# 9.905 rad and 0 rad/s: the prediction does not move an angle by its speed, so that no reading tells anything of a
# speed, and the angle lags by 95 ms. An accelerometer at rest, as sensor_msgs/Imu has it (REP 145), reads +9.81 m/s²
# upwards. Expected: the robot stays at 0 m. What happens: 196 m/s and 981 m after 10 s, as gravity is added to the
# reading; its own simulated IMU reads -9.81 m/s² at rest, and -7.81 m/s² where it is lifted by 2 m/s².
# For us: estimate a speed with `gearkin` or a filter of angle and speed, and compare an estimator with a robot at rest.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check optisim==0.19.0
cd "$folder"
venv/bin/python - <<'PYTHON'
import numpy
from optisim.estimation import RobotStateEstimator
from optisim.sensors import IMUSensor, SensorNoise


def estimated(upwards):
    """The state after 10 s, with an accelerometer that reads so many m/s² upwards and a joint at 1 rad/s."""
    estimator = RobotStateEstimator(1)
    for sample in range(1, 1001):
        estimator.predict(0.01, numpy.array([0.0, 0.0, upwards]), numpy.zeros(3))
        state = estimator.update_joints(numpy.array([0.01 * sample]))
    return state


state = estimated(9.81)
angle, speed = float(state.joint_positions[0]), float(state.joint_velocities[0])
print(f'joint: {angle:.3f} rad and {speed} rad/s, expected 10 rad and 1 rad/s')
assert abs(angle - 9.905) < 0.001 and speed == 0.0
print(f'robot at rest: {state.position[2]:.1f} m and {state.velocity[2]:.1f} m/s, expected 0 m and 0 m/s')
assert abs(state.position[2] - 981.0) < 0.1 and abs(state.velocity[2] - 196.2) < 0.1
imu = IMUSensor('imu', SensorNoise(), SensorNoise())
readings = [round(float(imu.read_accel([0.0, 0.0, lifted])[2]), 2) for lifted in (0.0, 2.0)]
print('its IMU reads', readings, 'm/s², expected 9.81 and 11.81 m/s²')
assert readings == [-9.81, -7.81]
PYTHON
