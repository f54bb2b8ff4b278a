#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robot-ik 0.4.0: gravity loads the vertical first joint of its six-joint robot with 29.4 N·m, which is the torque of
# the second.
#
# Expected of gravity_torque(): the derivative of the potential energy, so 0 at a joint that turns about the vertical.
# What happens: with the robot that the package brings, the joints have -29.4, 5.0, 0.3, 14.1 ... N·m, where the energy
# of the positions of its own forward kinematics gives 0, -29.4, -1.8, 0.3 ...: the axis of each joint is taken from the
# link after it. Centres of mass are not moved to their link either: one arm of 0.5 m needs 0 N·m with 2 kg at its tip,
# and -9.81 N·m with them at its joint.
# For us: compute torques with a library that is checked against energy, such as Pinocchio or MuJoCo.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robot-ik==0.4.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from robot_ik.dynamics.solver import DynamicsSolver, LinkInertia, RobotDynamicsModel, six_dof_articulated_dyn

results = {}
for com in (0.0, -0.5):
    link = LinkInertia(2.0, np.array([com, 0, 0]), np.zeros((3, 3)))
    down = np.array([0, -9.81, 0])
    arm = DynamicsSolver(RobotDynamicsModel(np.array([0.5]), np.zeros(1), np.zeros(1), [link], down, np.zeros(1)))
    level = np.zeros(1)
    results[com] = float(arm.gravity_torque(level)[0]), float(arm.inertia_matrix(level)[0, 0])
    print('com', com, 'm: torque', results[com][0], 'N·m, inertia', results[com][1], 'kg·m²')
assert results[0.0] == (0, 0)
assert np.allclose(results[-0.5], (-9.81, 0.5))

six = DynamicsSolver(six_dof_articulated_dyn())


def energy(angles):
    frames = six.forward_kinematics_all(angles)[1:]
    places = [frame[:3, :3] @ link.com + frame[:3, 3] for frame, link in zip(frames, six.model.links)]
    return -sum(link.mass * six.model.gravity @ place for link, place in zip(six.model.links, places))


angles, small = np.array([0.3, -0.4, 0.5, 0.2, 0.6, 0.1]), 1e-6
right = np.array([(energy(angles + step) - energy(angles - step)) / (2 * small) for step in small * np.eye(6)])
torque = six.gravity_torque(angles)
print('six joints', torque, 'derivative of the energy', right)
assert np.allclose(right[:3], [0, -29.3791, -1.8205], atol=1e-3)
assert np.allclose(torque[:4], [-29.3791, 4.9562, 0.2863, 14.0940], atol=1e-3)
PYTHON
