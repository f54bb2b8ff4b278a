#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# roboticstoolbox-python 1.5.0: the friction of a joint in a URDF becomes its viscous damping.
#
# <dynamics damping="0.1" friction="0.02"/> means 0.1 N·m·s/rad and 0.02 N·m. The joint of the Robot has B = 0.02, its
# viscous friction, and Tc = [0, 0], its Coulomb friction; the damping is dropped. At 10 rad/s that is 0.2 N·m in place
# of 1.02. A URDF with damping alone has no losses at all. Pinocchio 4.1.0 reads 0.1 and 0.02.
# For us: set link.B and link.Tc by hand where torques are computed from a URDF.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check roboticstoolbox-python==1.5.0
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="9" velocity="600"/><dynamics damping="0.1" friction="0.02"/></joint>
</robot>
URDF
venv/bin/python - "$folder/gear.urdf" <<'PYTHON'
import sys

import numpy as np
import roboticstoolbox

[joint] = [link for link in roboticstoolbox.Robot.URDF(sys.argv[1]).links if link.isjoint]
print('viscous', joint.B, 'Coulomb', joint.Tc)
assert joint.B == 0.02 and np.all(joint.Tc == 0)
PYTHON
python3 -m venv "$folder/pinocchio"
"$folder/pinocchio/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0
"$folder/pinocchio/bin/python" - <<'PYTHON'
import pinocchio

model = pinocchio.buildModelFromUrdf('gear.urdf')
print('Pinocchio', model.damping, model.upperDryFrictionLimit)
assert (model.damping[0], model.upperDryFrictionLimit[0]) == (0.1, 0.02)
PYTHON
