#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# truerig 0.1.1: the friction and the greatest torque of a joint are lost in MJCF, and the report of losses is silent.
#
# truerig converts a URDF and reports what the conversion loses. A joint has a friction of 0.2 N·m and an effort of 2
# N·m. The MJCF has neither frictionloss nor actuatorfrcrange; the report names assumed contacts, but not these. MuJoCo
# 4.0.0 itself keeps both when it reads the same URDF.
# For us: let MuJoCo read the URDF, or compare the models' dof_frictionloss and jnt_actfrcrange.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check truerig==0.1.1 mujoco==4.0.0
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="joint" type="revolute">
    <parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="2" velocity="3"/><dynamics damping="0.7" friction="0.2"/>
  </joint>
</robot>
URDF
timeout 60 venv/bin/truerig convert gear.urdf gear.xml > report
cat report
if grep -iE 'frictionloss|joint friction|effort|torque' report; then exit 1; fi
timeout 60 venv/bin/python - <<'PYTHON'
import mujoco

read, converted = (mujoco.MjModel.from_xml_path(path) for path in ('gear.urdf', 'gear.xml'))
for model, friction, effort in ((read, 0.2, 2.0), (converted, 0.0, 0.0)):
    print('friction', model.dof_frictionloss, 'effort', model.jnt_actfrcrange, 'damping', model.dof_damping)
    assert model.dof_frictionloss[0] == friction and model.jnt_actfrcrange[0, 1] == effort
    assert model.dof_damping[0] == 0.7
PYTHON
