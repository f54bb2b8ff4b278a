#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# better-actuator-models 1.0.2: a servo that holds an arm has 14 % more friction in simulation, and swings up to 11 mrad
# elsewhere, if a free body, as the base of a walking robot, comes before it in the model.
#
# The friction of its models depends on the load of the gear, which MujocoController computes from the constraint forces
# less the servo's own friction. An arm on a Dynamixel MX-106 (model m3) or XL-330 swings alone, with a free ball behind
# it in the MJCF, or with the same ball before it; the ball touches nothing. Expected: the same friction and angles in
# all three. What happens: they are the same alone and with the ball behind, but with the ball before the arm the
# friction is counted as a load: 0.189 instead of 0.166 N·m in the end, and the XL-330 is up to 11 mrad elsewhere. The
# number of the joint is sought among the numbers of the degrees of freedom, which differ behind a free or ball joint.
# For us: compare the friction of one joint with that of a model without the free body.
#
# Exit code 0: still so. Installs the versions into a temporary folder, also for a Python below 3.12, which it names as
# the least but does not need here.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6 colorama==0.4.6
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps --ignore-requires-python \
  better-actuator-models==1.0.2
cat > "$folder/arm.py" <<'PYTHON'
import math

import mujoco
import numpy as np
from bam.model import load_model
from bam.mujoco import MujocoController

ARM = """<body pos="0 0 2"><joint name="arm" axis="0 1 0"/>
  <inertial pos="0 0 -0.1" mass="0.3" diaginertia="1e-3 1e-3 1e-3"/></body>"""
BALL = """<body pos="3 0 1"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body>"""
MJCF = """<mujoco><option timestep="0.001"/><worldbody>{}</worldbody>
  <actuator><motor name="arm" joint="arm"/></actuator></mujoco>"""


def swung(bodies, servo):
    """The angles of the arm in rad and its friction in N·m, for 2 s in steps of 1 ms."""
    model = mujoco.MjModel.from_xml_string(MJCF.format(bodies))
    data = mujoco.MjData(model)
    controller = MujocoController(load_model(motor_name=servo, model='m3'), 'arm', model, data)
    data.joint('arm').qpos = 0.3
    mujoco.mj_forward(model, data)
    record = []
    for k in range(2000):
        controller.set_q_target('arm', 0.3 + 0.8 * math.sin(2 * math.pi * k / 1000))
        controller.update()
        mujoco.mj_step(model, data)
        record.append((data.joint('arm').qpos[0], model.joint('arm').frictionloss[0]))
    return np.transpose(record)


for servo, difference, frictions in ('mx106', 0.0009, (0.166, 0.189)), ('xl330', 0.0112, (0.0202, 0.0232)):
    alone, behind, before = (swung(bodies, servo) for bodies in (ARM, ARM + BALL, BALL + ARM))
    greatest = np.abs(before[0] - alone[0]).max()
    print(f'{servo}: friction alone {alone[1, -1]:.4f}, ball behind {behind[1, -1]:.4f}, ball before'
          f' {before[1, -1]:.4f} N·m; angles differ by up to {1000 * greatest:.2f} mrad')
    assert np.allclose(alone, behind, atol=1e-12)
    assert np.allclose((alone[1, -1], before[1, -1]), frictions, rtol=0.02)
    assert abs(greatest - difference) < 0.2 * difference
PYTHON
timeout 150 "$folder/venv/bin/python" "$folder/arm.py"
