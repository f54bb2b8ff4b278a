#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Drake 1.51.1, MuJoCo 4.0.0: a gear ratio multiplies only the rotor's inertia in one, only the torque in the other.
#
# An arm of 1 kg·m² is driven through a ratio of 19 by a motor of 0.01 kg·m² that gives 2 N·m, and would accelerate by
# 19·2 / (1 + 19²·0.01) = 8.24 rad/s². Drake's drake:gear_ratio multiplies the rotor's inertia by 19², but neither the
# torque nor its limit: 0.434 rad/s². MuJoCo's gear multiplies the torque and its limit, but not the armature, which
# is an inertia at the joint: 37.6 rad/s².
# For us: torque and limit times the ratio go to Drake, and the rotor's inertia times its square goes to MuJoCo.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check drake==1.51.1 mujoco==4.0.0
cat > "$folder/drive.py" <<'PYTHON'
import mujoco
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import JointActuatorIndex

URDF = """
<robot name="gear" xmlns:drake="drake">
  <link name="stator"/>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="fixed" type="fixed"><parent link="world"/><child link="stator"/></joint>
  <joint name="joint" type="continuous">
    <parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/><limit effort="2" velocity="100"/>
  </joint>
  <transmission>
    <type>transmission_interface/SimpleTransmission</type><joint name="joint"/>
    <actuator name="motor"><drake:gear_ratio value="19"/><drake:rotor_inertia value="0.01"/></actuator>
  </transmission>
</robot>
"""
MJCF = """
<mujoco>
  <worldbody>
    <body>
      <joint name="joint" axis="0 0 1" armature="0.01"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    </body>
  </worldbody>
  <actuator><motor joint="joint" gear="19" forcerange="-2 2"/></actuator>
</mujoco>
"""
plant = MultibodyPlant(0.0)
Parser(plant).AddModelsFromString(URDF, 'urdf')
plant.Finalize()
assert plant.get_joint_actuator(JointActuatorIndex(0)).default_gear_ratio() == 19
context = plant.CreateDefaultContext()
model = mujoco.MjModel.from_xml_string(MJCF)
data = mujoco.MjData(model)
for torque in 2.0, 100.0:
    plant.get_actuation_input_port().FixValue(context, [torque])
    drake = plant.get_generalized_acceleration_output_port().Eval(context)[0]
    data.ctrl[0] = torque
    mujoco.mj_forward(model, data)
    print('command', torque, 'N·m: Drake', drake, 'MuJoCo', data.qacc[0], 'rad/s²')
    assert abs(drake - 2 / (1 + 19**2 * 0.01)) < 1e-6
    assert abs(data.qacc[0] - 19 * 2 / (1 + 0.01)) < 1e-6
PYTHON
timeout 90 "$folder/venv/bin/python" "$folder/drive.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }
