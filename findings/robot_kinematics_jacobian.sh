#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robot-kinematics 1.1.0: in its Jacobian the last joint of an arm does not move the tip, and the tip of each URDF is at
# (0, 0, 0).
#
# An arm of 0.5 m and 0.4 m by its DH parameters, at 0.3 and 0.5 rad. Expected of Jacobian(): the derivative of
# forward_kinematics(), 0.435 and 0.287 m/rad in x. What happens: each joint turns about the frame at its own end, not
# the one before it, so that the elbow gives 0 m/rad, and the shoulder what the elbow should. Its inverse kinematics
# goes by it. pseudo_inverse() with a damping multiplies by J Jᵀ + d instead of dividing by it: 0.1 m/s in x are 0.033
# rad/s with it and 0.179 rad/s without. URDFKinematics looks for the chain from the base on as if the base were a
# child, and finds none: forward_kinematics() is at (0, 0, 0) for all angles of all URDF files, although it asks for as
# many angles as there are joints.
# For us: take the Jacobian of pinocchio for the URDF that gearkin writes.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 matplotlib==3.10.8
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps robot-kinematics==1.1.0
cd "$folder"
cat > arm.urdf <<'URDF'
<robot name="arm">
  <link name="base"/><link name="upper"/><link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="10" velocity="3"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="tip"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="10" velocity="3"/></joint>
</robot>
URDF
MPLBACKEND=Agg timeout 100 venv/bin/python - <<'PYTHON'
import numpy as np
from robot_kinematics.core.jacobian import Jacobian
from robot_kinematics.forward.dh_kinematics import DHKinematics
from robot_kinematics.forward.urdf_kinematics import URDFKinematics

angles = np.array([0.3, 0.5])
lengths = {'dh_parameters': [[0.5, 0, 0, 0], [0.4, 0, 0, 0]], 'joint_limits': [(-3, 3)] * 2}
arm = DHKinematics({'name': 'arm', 'n_joints': 2, 'joint_types': ['revolute'] * 2, **lengths})
steps = 1e-6 * np.eye(2)
right = np.array([(arm.forward_kinematics(angles + d).position - arm.forward_kinematics(angles - d).position) / 2e-6 for d in steps]).T
given = Jacobian(arm, angles)
print('derivative of x and y\n', right[:2], '\nJacobian\n', given.compute()[:2])
assert np.allclose(right[:2], [[-0.4347, -0.2869], [0.7564, 0.2787]], atol=1e-4)
assert np.allclose(given.compute()[:2], [[-0.2869, 0], [0.2787, 0]], atol=1e-4)

goal = np.array([0.1, 0, 0, 0, 0, 0])
speeds, damped = given.pseudo_inverse() @ goal, given.pseudo_inverse(damping=1e-9) @ goal
print('speeds without damping', speeds, 'with a damping of 1e-9', damped)
assert np.allclose(speeds, [-0.1793, 0.1793], atol=1e-4) and np.allclose(damped, [-0.0333, -0.0287], atol=1e-4)

model = URDFKinematics('arm.urdf')
for posture in ((0.0, 0.0), (1.0, 2.0)):
    print('URDF with', model.n_joints, 'joints at', posture, model.forward_kinematics(posture).position)
    assert not model.forward_kinematics(posture).position.any()
PYTHON
