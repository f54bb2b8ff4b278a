#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: of several bodies in the world of an MJCF, only the first is read.
#
# In an MJCF a rotor and an output stand side by side in the worldbody, as independent bodies do. MuJoCo 4.0.0 reads two
# joints. Pinocchio's buildModelFromMJCF reads the joint and the mass of the first body alone, without an error
# or a warning: which one depends on the order in the file. Within one body that is fixed to the world both are read.
# For us: put all bodies into one fixed body, such as the stator, and compare the names of the joints.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0
cd "$folder"
cat > bodies.py <<'PYTHON'
import mujoco
import pinocchio

BODY = """
<body name="{0}">
  <joint name="{0}" type="hinge" axis="0 0 1"/><inertial pos="0 0 0" mass="{1}" diaginertia="1 1 1"/>
</body>
"""
ROTOR, OUTPUT = BODY.format('rotor', 1), BODY.format('output', 2)


def joints(bodies):
    with open('gear.xml', 'w') as file:
        file.write(f'<mujoco><worldbody>{bodies}</worldbody></mujoco>')
    model = mujoco.MjModel.from_xml_path('gear.xml')
    read = pinocchio.buildModelFromMJCF('gear.xml')
    mass = sum(inertia.mass for inertia in read.inertias)
    print('MuJoCo', model.njnt, 'joints, Pinocchio', list(read.names)[1:], 'and', mass, 'kg')
    assert model.njnt == 2
    return list(read.names)[1:], mass


assert joints(ROTOR + OUTPUT) == (['rotor'], 1)
assert joints(OUTPUT + ROTOR) == (['output'], 2)
assert sorted(joints(f'<body name="stator">{ROTOR}{OUTPUT}</body>')[0]) == ['output', 'rotor']
PYTHON
timeout 90 venv/bin/python bodies.py
