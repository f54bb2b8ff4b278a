#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# forwardkinematics 1.2.3: a tool 0.2 m in front of a flange is put 0.2 m along x of the base, however the arm turns.
#
# An arm of 1 m has turned by 90° at its shoulder, and link_transformation is a tool 0.2 m further along x of its last
# link. Expected of numpy() and of casadi(), for a number and for a symbol: the tool is at (0, 1.2), as Pinocchio 4.1.0
# gives it. What happens: numpy() gives (0.2, 1), as it multiplies the tool from the left; casadi() is right. With
# parent_link='upper' it is the other way round: numpy() gives the last link in the upper arm, (1, 0), and casadi()
# ignores the parent and gives it in the base, (0, 1). So a controller that is made by casadi() differs from its check
# by numpy(). Nothing warns.
# For us: give neither; multiply the pose of the link by the tool, and the inverse of the parent's pose by it, yourself.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check forwardkinematics==1.2.3 casadi==3.8.2 numpy==1.26.4
python3 -m venv pinocchio
pinocchio/bin/pip install --quiet --disable-pip-version-check pin==4.1.0 numpy==2.4.6
cat > arm.urdf <<'URDF'
<robot name="arm">
  <link name="base"/><link name="upper"/><link name="lower"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0" rpy="0 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0" rpy="0 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>
URDF
timeout 60 pinocchio/bin/python - <<'PYTHON'
import numpy as np
import pinocchio

model = pinocchio.buildModelFromUrdf('arm.urdf')
data = model.createData()
pinocchio.framesForwardKinematics(model, data, np.array([np.pi / 2, 0]))
tool = data.oMf[model.getFrameId('lower')].act(np.array([0.2, 0, 0]))
print('Pinocchio: tool at', tool)
assert np.allclose(tool, (0, 1.2, 0))
PYTHON
timeout 60 venv/bin/python -W ignore - <<'PYTHON'
import casadi
import numpy as np
from forwardkinematics.urdfFks.generic_urdf_fk import GenericURDFFk

angles, tool = np.array([np.pi / 2, 0]), np.eye(4)
tool[0, 3] = 0.2
with open('arm.urdf') as file:
    arm = GenericURDFFk(file.read(), 'base', ['lower'])


def places(**choice):
    """Return the place of the last link by numpy() and by casadi(), in the plane of the arm in m."""
    symbol = casadi.SX.sym('q', 2)
    pose = casadi.Function('pose', [symbol], [arm.casadi(symbol, 'lower', **choice)])(angles)
    both = np.array(arm.numpy(angles, 'lower', **choice))[:2, 3], np.array(pose)[:2, 3]
    print(*choice, 'numpy()', both[0], 'casadi()', both[1])
    return both


assert np.allclose(places(), ((0, 1), (0, 1)))
assert np.allclose(places(link_transformation=tool), ((0.2, 1), (0, 1.2)))
assert np.allclose(places(parent_link='upper'), ((1, 0), (0, 1)))
PYTHON
