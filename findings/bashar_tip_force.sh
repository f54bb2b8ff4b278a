#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bashar 2.0.0: a force of 1 N at the tip of an arm of 1 m needs 0.5 N·m by inverse_dynamics(), 1 N·m by
# forward_dynamics().
#
# A bar of 1 kg and 1 m turns in a level plane; its centre of mass is at 0.5 m. Expected: a force of 1 N across its tip
# needs a torque of 1 N·m, and forward_dynamics() of what inverse_dynamics() gives returns the acceleration. What
# happens: both take an Ftip, but one at the centre of mass of the last link, the other at the tip. The torque is 0.5
# N·m; with it the bar does not stand still, but is accelerated by -1.48 rad/s². With the centre of mass at the tip the
# two agree.
# For us: add the transposed jacobian_body() times the force to the torques of a free tip.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bashar==2.0.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from pathlib import Path

import numpy as np
from bashar.api import BasharSystem, compile_profile

URDF = """<robot name="bar">
  <link name="base"/>
  <link name="bar">
    <inertial>
      <origin xyz="{centre} 0 0"/>
      <mass value="1"/>
      <inertia ixx="0.0875" iyy="0.0875" izz="0.0875" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <link name="tip"/>
  <joint name="motor" type="continuous">
    <parent link="base"/>
    <child link="bar"/>
    <axis xyz="0 0 1"/>
  </joint>
  <joint name="end" type="fixed">
    <parent link="bar"/>
    <child link="tip"/>
    <origin xyz="1 0 0"/>
  </joint>
</robot>"""
still, across = np.zeros(1), np.array([0, 0, 0, 0, 1.0, 0])
for centre, expected in ((0.5, 0.5), (1.0, 1.0)):
    Path('bar.urdf').write_text(URDF.format(centre=centre))
    assert compile_profile('bar.urdf', 'bar', '.')
    bar = BasharSystem('bar.json')
    kinematics, dynamics = bar.kinematics, bar.dynamics
    pose = kinematics.forward_kinematics_space(still)
    right = (kinematics.jacobian_body(kinematics.jacobian_space(still), pose).T @ across)[0]
    torque = dynamics.inverse_dynamics(still, still, still, across)[0]
    acceleration = dynamics.forward_dynamics(still, still, np.array([torque]), across)[0]
    inertia = dynamics.mass_matrix(still)[0, 0]
    print('centre', centre, 'm, tip', pose[:3, 3], 'torque', torque, 'N·m, by the Jacobian', right, 'N·m')
    print('acceleration with this torque', acceleration, 'rad/s², inertia', inertia, 'kg·m²')
    assert np.allclose(pose[:3, 3], [1, 0, 0]) and abs(right - 1.0) < 1e-9
    assert abs(torque - expected) < 1e-9
    assert abs(acceleration - (expected - 1.0) / inertia) < 1e-9
PYTHON
