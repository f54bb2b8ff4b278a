#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cyberwave-robot-format 0.1.8: an MJCF's limits of ±90° become ±90 rad, and a body turned by euler is not turned.
#
# Angles of an MJCF are degrees unless <compiler angle="radian"/> says otherwise; the documentation of the package says
# that its schema uses radians. An arm whose upper body is turned by euler="0 0 90" has a hinge from -90° to 90°.
# Expected, as MuJoCo 3.11.0 reads it: ±1.571 rad, and the tip at (0, 0.3, 0). What happens: the limits are ±90, in the
# schema, in the URDF, which has radians, and in the MJCF, which the package writes with angle="radian"; and the tip is
# at (0.3, 0, 0). Neither validate() nor a warning says so. The limits and the tip are right where the MJCF has radians
# and a quat.
# For us: let MuJoCo load the model and save it (MjSpec.to_xml(), in radians and quaternions), and convert that.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check cyberwave-robot-format==0.1.8 mujoco==3.11.0
cd "$folder"
cat > degrees.xml <<'MJCF'
<mujoco><worldbody><body name="base"><body name="upper" euler="0 0 90">
  <inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/><joint name="shoulder" axis="0 1 0" range="-90 90"/>
  <body name="tip" pos="0.3 0 0"><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/></body>
</body></body></worldbody></mujoco>
MJCF
sed -e 's|<mujoco>|<mujoco><compiler angle="radian"/>|' -e 's|euler="0 0 90"|quat="0.70710678 0 0 0.70710678"|' \
    -e 's|range="-90 90"|range="-1.5707963 1.5707963"|' degrees.xml > radians.xml
venv/bin/python - <<'PYTHON'
import xml.etree.ElementTree as ElementTree

import mujoco
from cyberwave_robot_format.mjcf import MJCFExporter, MJCFParser
from cyberwave_robot_format.urdf import URDFExporter


def compiled(path):
    """The upper limit of the hinge in rad, and the position of the tip in m, as MuJoCo has them."""
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return round(float(model.jnt_range[0, 1]), 3), data.body('tip').xpos.round(3).tolist()


found = {}
for name in ('degrees', 'radians'):
    schema = MJCFParser().parse(f'{name}.xml')
    assert schema.validate() == []
    URDFExporter().export(schema, f'{name}.urdf')
    MJCFExporter().export(schema, f'{name}_again.xml')
    limit = ElementTree.parse(f'{name}.urdf').find("joint[@name='shoulder']/limit").get('upper')
    found[name] = compiled(f'{name}.xml'), compiled(f'{name}_again.xml'), round(float(limit), 3)
    print(f'{name}: MuJoCo {found[name][0]}, converted MJCF {found[name][1]}, upper limit of the URDF {limit}')
right = 1.571, [0.0, 0.3, 0.0]
assert found['radians'] == (right, right, 1.571)
assert found['degrees'] == (right, (90.0, [0.3, 0.0, 0.0]), 90.0)
PYTHON
