#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mujoco-mjx 3.17.0: an MJCF's armature of a tendon has next to no effect, and the delay of a motor none, without an
# exception.
#
# "MJX will raise an exception if asked to copy an mjModel that references unsupported features", as it does for a
# sensor of a stop. Expected: an exception, or the motion that MuJoCo 3.17.0 computes with the same model. What happens
# where an arm falls for 0.5 s: with an armature of 1 kg·m² on the tendon that couples it with a rotor it turns by 2.589
# rad (by 2.594 without it) instead of by 0.28 rad; with a motor whose delay is 0.1 s by 3.50 rad, as without it,
# instead of by 3.27 rad. The same armature at the joint is right.
# For us: simulate such a model in MuJoCo, or give the inertia as armature of the joints.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: \
    mujoco-mjx==3.17.0 mujoco==3.17.0 jax==0.10.2 numpy==2.4.6
JAX_PLATFORMS=cpu timeout 300 "$folder/venv/bin/python" - <<'PYTHON'
import jax
import mujoco
import numpy as np
from mujoco import mjx

MODEL = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <body>
      <joint name="arm" axis="0 1 0" {joint}/>
      <geom type="capsule" fromto="0 0 0 .5 0 0" size=".03" mass="1"/>
    </body>
    <body pos="0 1 0">
      <joint name="rotor" axis="0 1 0"/>
      <geom type="cylinder" size=".05 .02" mass="1" euler="90 0 0"/>
    </body>
  </worldbody>
  {rest}
</mujoco>"""
TENDON = '<tendon><fixed {}><joint joint="arm" coef="1"/><joint joint="rotor" coef="-2"/></fixed></tendon>'
MOTOR = '<actuator><motor joint="arm" {}/></actuator>'


def turned(joint='', rest=''):
    """The angle in rad by which the arm falls within 0.5 s, in MuJoCo and in MJX."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(joint=joint, rest=rest))
    data = mujoco.MjData(model)
    data.ctrl[:] = 1.0
    there, start = mjx.put_model(model), mjx.put_data(model, data)
    fall = jax.jit(lambda state: jax.lax.fori_loop(0, 500, lambda _, now: mjx.step(there, now), state))
    for _ in range(500):
        mujoco.mj_step(model, data)
    angles = float(data.qpos[0]), float(fall(start).qpos[0])
    print(joint, rest, 'MuJoCo', angles[0], 'rad, MJX', angles[1], 'rad')
    return angles


expected, found = turned('armature="1"')
assert abs(found - expected) < 1e-3
for part, setting, wanted in ((TENDON, 'armature="1"', 0.28), (MOTOR, 'delay="0.1" nsample="200"', 3.27)):
    expected, found = turned(rest=part.format(setting))
    same, without = turned(rest=part.format(''))
    assert abs(same - without) < 1e-3 and abs(found - without) < 0.01
    assert abs(expected - wanted) < 0.01 and abs(found - expected) > 0.1
PYTHON
