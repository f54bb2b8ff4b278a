#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyBullet 3.2.7: calculateMassMatrix() keeps the inertia of its first call after changeDynamics().
#
# A rotor of 0.3 kg·m² gets 1.0 by changeDynamics(). The simulation obeys, so that 1 N·m accelerates it by 1 rad/s², and
# getDynamicsInfo() says 1.0; but calculateMassMatrix() and calculateInverseDynamics() go on with 0.3, if they were
# called before. Called for the first time after the change they are right.
# For us: a payload or an inertia seen through the gear has to be set before a controller asks for torques.
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
pybullet.setTimeStep(0.001)
for called_before, expected in ((True, 0.3), (False, 1.0)):
    body = pybullet.loadURDF('gear.urdf', useFixedBase=True, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    if called_before:
        assert abs(pybullet.calculateMassMatrix(body, [0.0])[0][0] - 0.3) < 1e-9
    pybullet.changeDynamics(body, 0, localInertiaDiagonal=[1, 1, 1])
    [[inertia]] = pybullet.calculateMassMatrix(body, [0.0])
    [torque] = pybullet.calculateInverseDynamics(body, [0.0], [0.0], [1.0])
    pybullet.setJointMotorControl2(body, 0, pybullet.VELOCITY_CONTROL, force=0)
    pybullet.setJointMotorControl2(body, 0, pybullet.TORQUE_CONTROL, force=1)
    pybullet.stepSimulation()
    speed = pybullet.getJointState(body, 0)[1]
    print('called before:', called_before, 'mass matrix', inertia, 'speed after 1 ms', speed)
    assert abs(speed - 0.001) < 1e-9
    assert abs(inertia - expected) < 1e-9 and abs(torque - expected) < 1e-9
PYTHON
