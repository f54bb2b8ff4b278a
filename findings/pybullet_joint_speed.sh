#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyBullet 3.2.7: a joint turns at no more than 100 rad/s, and the friction of a joint is not simulated.
#
# The URDF gives the joint of a rotor a velocity limit of 600 rad/s and a friction of 0.5 N·m; getJointInfo shows both.
# Set to 500 rad/s by resetJointState, the rotor has 100 rad/s after a step. Set to 10 rad/s, it has 10 rad/s a second
# later, without any torque, where the friction should have taken 1.7 rad/s; damping of links is off.
# For us: a motor of 6000 rpm turns at 955 rpm without a word: set changeDynamics(body, joint, maxJointVelocity=1000).
#
# Exit code 0: still so. Installs the packages into a temporary folder; needs Python 3.9 to 3.12 for a wheel.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pybullet==3.2.7 numpy==2.4.6
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="0.3" iyy="0.3" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit effort="9" velocity="600"/><dynamics damping="0" friction="0.5"/></joint>
</robot>
URDF
venv/bin/python - <<'PYTHON'
import pybullet

pybullet.connect(pybullet.DIRECT)
body = pybullet.loadURDF('gear.urdf', useFixedBase=True, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
for link in (-1, 0):
    pybullet.changeDynamics(body, link, linearDamping=0, angularDamping=0)
pybullet.setJointMotorControl2(body, 0, pybullet.VELOCITY_CONTROL, force=0)


def speed_after(steps, speed):
    pybullet.resetJointState(body, 0, 0, speed)
    for _ in range(steps):
        pybullet.stepSimulation()
    return pybullet.getJointState(body, 0)[1]


info = pybullet.getJointInfo(body, 0)
fast, slow = speed_after(1, 500), speed_after(240, 10)
print('friction', info[7], 'limit', info[11], 'speed of 500:', fast, 'speed of 10 after 1 s:', slow)
assert (info[7], info[11]) == (0.5, 600)
assert fast == 100 and abs(slow - 10) < 1e-9
pybullet.changeDynamics(body, 0, maxJointVelocity=1000)
assert speed_after(1, 500) == 500
PYTHON
