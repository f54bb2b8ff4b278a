#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kinpy 0.6.1: an arm that an MJCF turns by euler="0 0 90" is not turned, and joints lose their default axis and ref.
#
# build_serial_chain_from_mjcf() reads an arm of two links of 1 m. Expected: its tip is where MuJoCo 4.0.0 has it.
# What happens: of the five ways in which an MJCF gives the orientation of a body, only quat has an effect. With
# euler, axisangle, xyaxes and zaxis the tip is at (2, 0, 0), where (0, 2, 0) or (0, 0, -2) is right. An axis that a
# default class gives to all joints is replaced by z, so that an arm that is to move upwards moves sideways, and an
# angle of a joint with a ref is not counted from this ref. No exception or warning says so.
# For us: calculate with MuJoCo, or write each quat, type and axis out and subtract each ref. A model that MuJoCo saves
# does not help: it leaves out the type of a hinge, at which kinpy raises a KeyError.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check kinpy==0.6.1 mujoco==4.0.0 numpy==2.4.6
cat > "$folder/arm.py" <<'PYTHON'
import warnings

import kinpy
import mujoco
import numpy as np

MJCF = """
<mujoco>
  {default}
  <worldbody>
    <body name="upper" {orientation}><joint name="shoulder" type="hinge" {axis} {ref}/><geom type="sphere" size="0.1"/>
      <body name="lower" pos="1 0 0"><joint name="elbow" type="hinge" {axis}/><geom type="sphere" size="0.1"/>
        <body name="tip" pos="1 0 0"><geom type="sphere" size="0.1"/></body>
      </body>
    </body>
  </worldbody>
</mujoco>"""
warnings.simplefilter('error')


def tips(angles, orientation='', axis='axis="0 0 1"', ref='', default=''):
    text = MJCF.format(orientation=orientation, axis=axis, ref=ref, default=default)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = angles
    mujoco.mj_forward(model, data)
    chain = kinpy.build_serial_chain_from_mjcf(text, 'tip')
    given, right = chain.forward_kinematics(np.array(angles)).pos, data.body('tip').xpos
    print(orientation or default or ref or 'plain', given.round(3), 'MuJoCo', right.round(3))
    return given, right


zero = [0.0, 0.0]
for given, right in tips([0.5, 0.3]), tips([0.5, 0.3], 'quat="0.5 0.5 0.5 0.5"'):
    assert np.allclose(given, right, atol=1e-9)
for orientation in 'euler="0 0 90"', 'axisangle="0 0 1 90"', 'xyaxes="0 1 0 -1 0 0"':
    given, right = tips(zero, orientation)
    assert np.allclose(given, [2, 0, 0]) and np.allclose(right, [0, 2, 0], atol=1e-9)
given, right = tips(zero, 'zaxis="1 0 0"')
assert np.allclose(given, [2, 0, 0]) and np.allclose(right, [0, 0, -2], atol=1e-9)
given, right = tips([-0.5, 0.0], axis='', default='<default><joint axis="0 1 0"/></default>')
assert np.allclose(given, [2 * np.cos(0.5), -2 * np.sin(0.5), 0]) and np.allclose(right[1:], [0, 2 * np.sin(0.5)])
given, right = tips([0.5, 0.0], ref='ref="28.64788975654116"')  # 0.5 rad
assert np.allclose(given, [2 * np.cos(0.5), 2 * np.sin(0.5), 0]) and np.allclose(right, [2, 0, 0], atol=1e-9)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/arm.py"
