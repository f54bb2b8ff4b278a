#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: a joint that is made the mimic of another one loses the inertia of its rotor, its damping, its
# friction and its stops, so that a mechanism of 0.61 kg·m² has 0.21 kg·m².
#
# An output turns by 0.5 of an input, and both have a link of 0.168 kg·m², an armature of 1.6 and 0 kg·m², a damping of
# 0.4 and 0 N·m·s/rad, and stops at ±0.3 and ±2 rad. Expected of the input, once transformJointIntoMimic() has made the
# output its mimic: its own values and 0.5² of the inertia and the damping of the output, so 0.61 kg·m² and 0.1
# N·m·s/rad, and stops at ±0.6 rad. What happens: 0.21 kg·m², which has the links but no armature, no damping, no
# friction, and stops at ±2 rad, at which the output is at ±1 rad, beyond its stops. In the model without the mimic all
# of them are there. A mimic of a URDF, which cannot have an armature, loses its damping, friction and stops as well.
# For us: add multiplier² times the armature and the damping of each mimic to the joint that it follows.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 numpy==2.4.6
cat > "$folder/gear.py" <<'PYTHON'
import numpy as np
import pinocchio as pin

LINK = """<link name="{}"><inertial><mass value="1"/>
  <inertia ixx="0.168" iyy="0.168" izz="0.168" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{0}" type="revolute"><parent link="stator"/><child link="{0} link"/><axis xyz="0 0 1"/>
  <limit lower="-{1}" upper="{1}" effort="10" velocity="3"/><dynamics damping="{2}" friction="{3}"/>{4}</joint>"""
MIMIC = '<mimic joint="input" multiplier="0.5"/>'


def urdf(mimic):
    links = LINK.format('input link') + LINK.format('output link')
    joints = JOINT.format('input', 2, 0, 0, '') + JOINT.format('output', 0.3, 0.4, 0.5, mimic)
    return f'<robot name="gear"><link name="stator"/>{links}{joints}</robot>'


free = pin.buildModelFromXML(urdf(''))
free.armature[:] = 0, 1.6
follow = np.array([1, 0.5])
inertia = follow @ pin.crba(free, free.createData(), np.zeros(2)) @ follow
damping = follow**2 @ free.damping
print('both joints: inertia', inertia, 'kg·m², damping', damping, 'N·m·s/rad, stops', free.upperPositionLimit, 'rad')
assert np.allclose((inertia, damping), (0.61, 0.1)) and np.allclose(free.upperPositionLimit, (2, 0.3))
assert np.allclose(free.friction, (0, 0.5))
transformed = pin.transformJointIntoMimic(free, free.getJointId('input'), free.getJointId('output'), 0.5, 0.0)
for name, model in ('transformed', transformed), ('from the URDF', pin.buildModelFromXML(urdf(MIMIC), mimic=True)):
    found = pin.crba(model, model.createData(), np.zeros(model.nq))[0, 0]
    stops = model.upperPositionLimit
    print(f'{name}: inertia {found}, armature {model.armature}, damping {model.damping}, stops {stops}')
    assert model.nv == 1 and np.isclose(found, 0.21) and model.armature[0] == 0 and model.damping[0] == 0
    assert model.friction[0] == 0 and stops[0] == 2
    pose = model.createData()
    pin.forwardKinematics(model, pose, np.array([2.0]))
    output = pin.rpy.matrixToRpy(pose.oMi[model.getJointId('output')].rotation)[2]
    assert np.isclose(output, 1.0)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/gear.py"
