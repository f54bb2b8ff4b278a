#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyBullet 3.2.7: a URDF that was changed is not read again, even after resetSimulation().
#
# loadURDF keeps the contents of files by their path. A URDF is written with a mass of 1 kg and loaded, written with 2
# kg and loaded again: the mass is 1 kg, also after resetSimulation(). After a new connection it is 2 kg.
# For us: where `gearkin urdf` writes a file again beside a running program, it needs
# setPhysicsEngineParameter(enableFileCaching=0) before the first loadURDF.
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


def load(mass):
    with open('gear.urdf') as file:
        text = file.read()
    with open('changed.urdf', 'w') as file:
        file.write(text.replace('mass value="1"', f'mass value="{mass}"'))
    return pybullet.getDynamicsInfo(pybullet.loadURDF('changed.urdf'), 0)[0]


pybullet.connect(pybullet.DIRECT)
masses = [load(1), load(2)]
pybullet.resetSimulation()
masses.append(load(2))
pybullet.disconnect()
pybullet.connect(pybullet.DIRECT)
masses.append(load(2))
pybullet.setPhysicsEngineParameter(enableFileCaching=0)
masses.append(load(3))
print('masses', masses)
assert masses == [1.0, 1.0, 1.0, 2.0, 3.0]
PYTHON
