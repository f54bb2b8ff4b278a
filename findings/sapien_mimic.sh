#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# SAPIEN 3.0.3: the gear ratio of a mimic between two joints on one link is inverted, 1/20 becomes 20.
#
# Rotor and output are on the stator, and the output is the mimic of the motor by -0.05. Expected: 1 N·m at the rotor
# turns it 20 times as far as the output. What happens: in a second the rotor turns by 0.07 rad and the output by -1.45
# rad, in its simulation on a CPU, without a warning: the rotor is -0.05 times the output. With an offset of 0.03 rad it
# is the rotor that goes there, not the output. A joint without dynamics in the URDF has a friction of 0.05: 0.01 N·m do
# not turn the rotor.
# For us: take the mimic out of the URDF for SAPIEN, and set the position of the output yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sapien==3.0.3 setuptools==80.9.0
cd "$folder"
cat > gear.py <<'PYTHON'
import sapien
from sapien import physx

URDF = '''
<robot name="gear">
  <link name="stator"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="shaft"><inertial><mass value="1"/><inertia ixx="4" iyy="4" izz="4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-100" upper="100" effort="10" velocity="600"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <limit lower="-10" upper="10" effort="10" velocity="600"/>
    <mimic joint="motor" multiplier="{}" offset="{}"/></joint>
</robot>'''


def turned(multiplier, offset, torque):
    scene = sapien.Scene([physx.PhysxCpuSystem()])
    scene.physx_system.config.gravity = [0, 0, 0]
    scene.set_timestep(0.001)
    loader = scene.create_urdf_loader()
    loader.fix_root_link = True
    with open('gear.urdf', 'w') as file:
        file.write(URDF.format(multiplier, offset))
    robot = loader.load('gear.urdf')
    assert [joint.name for joint in robot.active_joints] == ['motor', 'output']
    assert all(abs(joint.friction - 0.05) < 1e-6 for joint in robot.active_joints)
    for _ in range(1000):
        robot.set_qf([torque, 0.0])
        scene.step()
    rotor, output = map(float, robot.qpos)
    print('multiplier', multiplier, 'offset', offset, torque, 'N·m: rotor', rotor, 'output', output)
    return rotor, output


rotor, output = turned(-0.05, 0, 1)
assert 0.05 < rotor < 0.1 and abs(rotor / output / -0.05 - 1) < 0.01
rotor, output = turned(-0.05, 0.03, 0)
assert abs(rotor - (0.03 - 0.05 * output)) < 1e-3 and abs(rotor - 0.03) < 1e-3
assert turned(-0.05, 0, 0.01) == (0, 0)
PYTHON
timeout 120 venv/bin/python gear.py 2> log || { cat log; exit 1; }
if grep -i mimic log; then exit 1; fi
