#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-modifiers 0.0.2: a rotor of 50 g that is made 10 % heavier has 0.01 kg·m² after it, 900 times its inertia.
#
# The rotor is a cylinder of 40 mm diameter, with an inertia of 0.00001 kg·m² about its axis. Expected after mass_scale
# = 1.1: 0.000011 kg·m². What happens: each inertia below 0.01 kg·m² is set to 0.01 kg·m², without a warning. At a motor
# behind a gear of ratio 19 this rotor appears as 3.6 kg·m² at the output, where 0.004 are right.
# For us: set the inertia of the link again after the modification.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urdf-modifiers==0.0.2 urchin==0.0.30 numpy==2.4.6
cd "$folder"
timeout 120 venv/bin/python - <<'PYTHON'
import numpy as np
from urchin import URDF
from urdfModifiers.core.linkModifier import LinkModifier
from urdfModifiers.core.modification import Modification

MODEL = """
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="{mass}"/>
    <inertia ixx="1.5e-5" iyy="1.5e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><cylinder radius="{radius}" length="0.05"/></geometry></visual></link>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
</robot>"""


def inertia_after(mass, radius):
    with open('rotor.urdf', 'w') as file:
        file.write(MODEL.format(mass=mass, radius=radius))
    robot = URDF.load('rotor.urdf')
    heavier = Modification()
    heavier.add_mass(1.1, absolute=False)
    LinkModifier.from_name('rotor', robot).modify(heavier)
    inertial = robot.link_map['rotor'].inertial
    right = inertial.mass * radius**2 / 2
    print('mass', inertial.mass, 'inertia', inertial.inertia[2, 2], 'right', right)
    return inertial.mass, inertial.inertia[2, 2], right


mass, inertia, right = inertia_after(0.05, 0.02)
assert np.isclose(mass, 0.055) and np.isclose(right, 1.1e-5)
assert inertia == 0.01
_, inertia, right = inertia_after(10, 0.2)
assert np.isclose(inertia, right) and right > 0.1
PYTHON
