#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Drake 1.51.1: the non-conservative power of an arm that loses 1.2 W to the damping of its joint is 0.
#
# The documentation says that this power is negative "if the non-conservative forces are dissipative", and that PE + KE
# less its integral "should be conserved by any physically-correct model". Expected of CalcNonConservativePower() of a
# MultibodyPlant, for a joint at 2 rad/s with a damping of 0.3 N·m·s/rad: -1.2 W, and -1.2 + 2 W with a motor that gives
# 1 N·m. What happens: 0 in both cases, although both act in the dynamics: the acceleration is 0.08 rad/s², 0.4 N·m
# divided by 5 kg·m². So a check of the energy says that a right model is wrong.
# For us: compute these powers from the torques and the velocity of the joint.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check drake==1.51.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

URDF = """
<robot name="arm">
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="5" iyy="5" izz="5" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="joint" type="continuous">
    <parent link="world"/><child link="arm"/><axis xyz="0 0 1"/><dynamics damping="0.3"/>
  </joint>
  <transmission>
    <type>transmission_interface/SimpleTransmission</type><joint name="joint"/><actuator name="motor"/>
  </transmission>
</robot>
"""
plant = MultibodyPlant(0.0)
Parser(plant).AddModelsFromString(URDF, 'urdf')
plant.Finalize()
context = plant.CreateDefaultContext()
plant.SetVelocities(context, [2.0])
for torque in 0.0, 1.0:
    plant.get_actuation_input_port().FixValue(context, [torque])
    acceleration = plant.get_generalized_acceleration_output_port().Eval(context)[0]
    lost, stored = plant.CalcNonConservativePower(context), plant.CalcConservativePower(context)
    print(f'motor {torque} N·m: {acceleration} rad/s², non-conservative {lost} W, conservative {stored} W')
    assert abs(acceleration - (torque - 0.6) / 5) < 1e-9
    assert lost == 0 and stored == 0
PYTHON
