#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# iDynTree 15.1.0: a continuous joint of a URDF with a limit of its torque may turn from 0 to 0 rad, and is saved so.
#
# A rotor is a joint of type "continuous" with <limit effort="9" velocity="600"/>, as the format of URDF allows.
# Expected: it has no limits of its position, as without this element. What happens: hasPosLimits() is true with limits
# of 0 and 0. ModelExporter writes it as type="revolute" with lower="0" upper="0", so that what keeps to the limits of a
# URDF, Pinocchio for example, holds it at 0 rad. The mimic of an output, its ratio and its offset, is lost as well, so
# that the output is a joint that nothing drives.
# For us: leave <limit> out of continuous joints before iDynTree reads them, and do not save a gear with it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check idyntree==15.1.0 pin==4.1.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import idyntree.bindings as idyntree
import pinocchio

LINK = """
<link name="{}">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link>
"""
URDF = """
<robot name="gear">
  {links}
  <joint name="motor" type="continuous">
    <parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>{limit}
  </joint>
  <joint name="joint" type="revolute">
    <parent link="stator"/><child link="output"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="9" velocity="60"/><mimic joint="motor" multiplier="0.05" offset="0.1"/>
  </joint>
</robot>
"""


def saved(limit):
    """Return whether the motor has limits, which limits Pinocchio reads after it was saved, and the URDF."""
    loader, exporter = idyntree.ModelLoader(), idyntree.ModelExporter()
    links = ''.join(map(LINK.format, ('stator', 'rotor', 'output')))
    loader.loadModelFromString(URDF.format(links=links, limit=limit), 'urdf')
    model = loader.model()
    limited = model.getJoint(model.getJointIndex('motor')).hasPosLimits()
    exporter.init(model)
    assert exporter.exportModelToFile('saved.urdf', 'urdf')
    read = pinocchio.buildModelFromUrdf('saved.urdf')
    index = read.joints[read.getJointId('motor')].idx_q
    limits = float(read.lowerPositionLimit[index]), float(read.upperPositionLimit[index])
    print(f'{limit or "no limit"}: hasPosLimits() {limited}, a {read.joints[read.getJointId("motor")].shortname()}, {limits}')
    with open('saved.urdf') as file:
        return limited, limits, file.read()


limited, limits, text = saved('<limit effort="9" velocity="600"/>')
assert limited and limits == (0, 0) and '<joint name="motor" type="revolute">' in text
assert 'mimic' not in text
limited, limits, text = saved('')
assert not limited and limits != (0, 0) and '<joint name="motor" type="continuous">' in text
PYTHON
