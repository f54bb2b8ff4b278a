#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: a delay of 100 ms of an encoder or a motor becomes 50 ms if the time step is halved, without a warning.
#
# A sensor has delay="0.1" nsample="50", which is enough for 100 ms at a time step of 2 ms. Expected at 1 ms: the same
# delay, or an error, as there is one for a delay without nsample. What happens: the oldest of the 50 samples is used,
# so that the encoder lags by 50 ms; with nsample="10" it lags by 10 ms. The command of a motor is delayed too little in
# the same way. The delay in the model is still 0.1.
# For us: give nsample as the delay divided by the least time step, rounded up, and measure the delay of the simulation.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco

MODEL = """
<mujoco>
  <option timestep="{step}"/>
  <worldbody>
    <body><joint name="joint" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
  </worldbody>
  <actuator><motor joint="joint" {motor}/></actuator>
  <sensor><jointpos joint="joint" {encoder}/></sensor>
</mujoco>
"""


def encoder_lag(step, delay):
    """Return by how many seconds the reading of a joint at 1 rad/s lags, after 1 s."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(step=step, motor='', encoder=delay))
    data = mujoco.MjData(model)
    data.qvel[0] = 1
    while data.time < 1:
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    print(f'{step} s, {delay}: the encoder lags by {data.qpos[0] - data.sensordata[0]:.4f} s, sensor_delay {model.sensor_delay}')
    return data.qpos[0] - data.sensordata[0]


def motor_lag(step, delay):
    """Return the time from the command of a torque to the first motion of the joint."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(step=step, motor=delay, encoder=''))
    data = mujoco.MjData(model)
    data.ctrl[0] = 1
    while data.qvel[0] == 0:
        mujoco.mj_step(model, data)
    print(f'{step} s, {delay}: the motor lags by {data.time - step:.4f} s')
    return data.time - step


FEW, ENOUGH = 'delay="0.1" nsample="50"', 'delay="0.1" nsample="100"'
for lag in encoder_lag, motor_lag:
    assert abs(lag(0.002, FEW) - 0.1) < 1e-6 and abs(lag(0.001, ENOUGH) - 0.1) < 1e-6
    assert abs(lag(0.001, FEW) - 0.05) < 1e-6
    assert abs(lag(0.001, 'delay="0.1" nsample="10"') - 0.01) < 1e-6
try:
    encoder_lag(0.001, 'delay="0.1"')
except ValueError as error:
    print('without nsample:', error)
else:
    raise AssertionError('a delay without nsample is accepted')
PYTHON
