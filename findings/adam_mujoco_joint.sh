#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adam-robotics 0.5.0: of a MuJoCo model, it loses the armature of a motor, the pos and ref of a joint, and the first
# joint of an arm on the ground.
#
# An arm on a floating base has a shoulder and an elbow. Expected of from_mujoco_model(): the tip and the mass matrix
# that MuJoCo 4.0.0 computes of the same model, as documented. They agree for the plain arm: the tip is at 0.7762 m, and
# the shoulder has 0.1994 kg·m². What happens with armature="0.5", the reflected inertia of a rotor: the shoulder has
# 0.1994 kg·m² instead of 0.6994. With the shoulder's pos="0 0 0.1": the tip is at 0.7762 m instead of 0.7466 m, as the
# joint is moved, and the arm with it. With the elbow's ref="0.2": the tip is 60 mm away from its place. If the arm
# stands on the ground, without the base, the model has the elbow alone. No warning in any of the cases.
# For us: add the armatures to the mass matrix, and load a URDF of the arm.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    adam-robotics==0.5.0 mujoco==4.0.0 casadi==3.8.2 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 120 venv/bin/python - > log <<'PYTHON' || { cat log; exit 1; }
import mujoco
import numpy as np
from adam.numpy import KinDynComputations

ANGLES = [0.3, -0.5]
BASE = '<body name="base"><freejoint/><inertial pos="0 0 0" mass="10" diaginertia="1 1 1"/>'


def model(base=BASE, shoulder='', elbow=''):
    end = '</body>' if base else ''
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco><compiler angle="radian"/><worldbody>{base}
          <body name="upper" pos="0.1 0 0"><joint name="shoulder" axis="0 1 0" {shoulder}/>
            <inertial pos="0.2 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
            <body name="fore" pos="0.4 0 0"><joint name="elbow" axis="0 1 0" {elbow}/>
              <inertial pos="0.15 0 0" mass="0.5" diaginertia="0.005 0.005 0.005"/>
              <body name="tip" pos="0.3 0 0">
                <inertial pos="0 0 0" mass="0.001" diaginertia="1e-6 1e-6 1e-6"/></body></body></body>{end}
        </worldbody></mujoco>""")


def compared(**options):
    """The tip's position and the shoulder's inertia by adam, and the same by MuJoCo."""
    mujoco_model = model(**options)
    data = mujoco.MjData(mujoco_model)
    data.qpos[7:] = ANGLES
    mujoco.mj_forward(mujoco_model, data)
    full = np.zeros((mujoco_model.nv, mujoco_model.nv))
    mujoco.mj_fullM(mujoco_model, data, full)
    adam = KinDynComputations.from_mujoco_model(mujoco_model)
    tip = np.asarray(adam.forward_kinematics('tip', np.eye(4), np.array(ANGLES)))[:3, 3]
    inertia = np.asarray(adam.mass_matrix(np.eye(4), np.array(ANGLES)))[6, 6]
    right = data.body('tip').xpos, full[6, 6]
    print('>', options, 'adam', tip.round(4), inertia.round(4), 'MuJoCo', right[0].round(4), right[1].round(4))
    return tip, inertia, *right


tip, inertia, right_tip, right_inertia = compared()
assert np.allclose(tip, right_tip) and np.isclose(inertia, right_inertia)
_, geared, _, right_geared = compared(shoulder='armature="0.5"')
assert np.isclose(geared, inertia) and np.isclose(right_geared, inertia + 0.5)
moved, _, right_moved, _ = compared(shoulder='pos="0 0 0.1"')
assert np.isclose(moved[0], tip[0]) and np.isclose(right_moved[0], 0.7466, atol=1e-4)
turned, _, right_turned, _ = compared(elbow='ref="0.2"')
assert np.allclose(turned, tip) and np.linalg.norm(right_turned - tip) > 0.05
names = KinDynComputations.from_mujoco_model(model(base='')).rbdalgos.model.actuated_joints
print('>', 'joints of the arm on the ground:', names)
assert names == ['elbow']
PYTHON
grep '^>' log
