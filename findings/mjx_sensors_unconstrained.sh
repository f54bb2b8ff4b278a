#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mujoco-mjx 3.17.0: a torque of 10 N·m at a joint is 0 in each sensor of force, torque and acceleration, until the
# model has a stop.
#
# A motor with a gear of 10 and a control of 1 drives a bar. Expected: jointactuatorfrc, actuatorfrc, torque, force and
# accelerometer read in MJX what they read in MuJoCo, as they do for jointpos and jointvel: 10 N·m, 1, and so on. What
# happens: all of these are 0, without a warning, wherever a model has no constraint at all. With a range, a friction or
# an equality anywhere in the model, even one that is not reached, all are right.
# For us: give a joint a wide range if the sensors of a simulated actuator are recorded.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: \
    mujoco-mjx==3.17.0 mujoco==3.17.0 jax==0.10.2 numpy==2.4.6
JAX_PLATFORMS=cpu timeout 200 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco
import numpy as np
from mujoco import mjx

MODEL = """
<mujoco>
  <worldbody>
    <body>
      <joint name="motor" axis="0 0 1" {stop}/>
      <geom type="capsule" fromto="0 0 0 .5 0 0" size=".03" mass="1"/>
      <site name="flange"/>
    </body>
  </worldbody>
  <actuator><motor name="drive" joint="motor" gear="10"/></actuator>
  <sensor>
    <jointpos joint="motor"/>
    <jointvel joint="motor"/>
    <jointactuatorfrc joint="motor"/>
    <actuatorfrc actuator="drive"/>
    <torque site="flange"/>
    <force site="flange"/>
    <accelerometer site="flange"/>
  </sensor>
</mujoco>"""


def read(stop):
    """What MuJoCo and MJX read where the motor turns at 2 rad/s."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(stop=stop))
    data = mujoco.MjData(model)
    data.ctrl[0], data.qvel[0] = 1.0, 2.0
    simulated = mjx.forward(mjx.put_model(model), mjx.put_data(model, data))
    mujoco.mj_forward(model, data)
    print(stop or 'no stop', '\n MuJoCo', data.sensordata.round(3), '\n MJX', np.asarray(simulated.sensordata).round(3))
    return data.sensordata, np.asarray(simulated.sensordata)


expected, found = read('range="-99 99" limited="true"')
assert abs(expected[2] - 10) < 1e-9 and np.allclose(found, expected, atol=1e-3)
expected, found = read('')
assert np.allclose(found[:2], expected[:2]) and np.count_nonzero(expected[2:].round(3)) > 3
assert not found[2:].any()
PYTHON
