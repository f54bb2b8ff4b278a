#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robot-format-converter 1.0.0: of a URDF, each turned origin of a joint is lost, so that a hanging arm lies.
#
# The readme lists reading and writing of URDF and of its schema as implemented, "preserving robot structure and
# properties". A shoulder 0.3 m above the ground is turned by rpy="0 1.5708 0", so that the tip 0.4 m along its x hangs
# at (0, 0, -0.1). Expected in the converted URDF: the same. What happens: rpy="0 0 0" and the tip at (0.4, 0, 0.3); in
# the schema, the orientation is [0, 0, 0, 1]. The mimic of a joint is lost as well. Nothing is logged or raised, and
# validate passes.
# For us: convert nothing with it, and compare the pose of the tip before and after any other conversion.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robot-format-converter==1.0.0
cd "$folder"
cat > arm.urdf <<'URDF'
<robot name="arm"><link name="base"/><link name="upper"/><link name="tip"/><link name="finger"/>
  <joint name="shoulder" type="continuous">
    <origin xyz="0 0 0.3" rpy="0 1.57079632679 0"/><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="end" type="fixed"><origin xyz="0.4 0 0"/><parent link="upper"/><child link="tip"/></joint>
  <joint name="grip" type="continuous">
    <parent link="tip"/><child link="finger"/><axis xyz="0 0 1"/><mimic joint="shoulder" multiplier="0.05"/>
  </joint>
</robot>
URDF
venv/bin/python - <<'PYTHON'
import math
import pathlib
import xml.etree.ElementTree as ElementTree

import yaml
from robot_format_converter import FormatConverter

converter = FormatConverter()
converter.convert('arm.urdf', 'converted.urdf')
converter.to_schema('arm.urdf', 'arm.yaml')


def tip(path):
    """The position of the tip in m where the shoulder stands at 0, by the pitch and the positions of the URDF."""
    shoulder, end = (ElementTree.parse(path).find(f"joint[@name='{name}']/origin") for name in ('shoulder', 'end'))
    roll, pitch, yaw = (float(part) for part in shoulder.get('rpy').split())
    assert roll == yaw == 0
    x, y, z = (float(part) for part in shoulder.get('xyz').split())
    length = float(end.get('xyz').split()[0])
    return round(x + length * math.cos(pitch), 3), y, round(z - length * math.sin(pitch), 3)


print('tip before', tip('arm.urdf'), 'after', tip('converted.urdf'))
assert tip('arm.urdf') == (0.0, 0.0, -0.1) and tip('converted.urdf') == (0.4, 0.0, 0.3)
orientation = yaml.safe_load(pathlib.Path('arm.yaml').read_text())['joints'][0]['pose']['orientation']
print('orientation in the schema', orientation)
assert orientation == [0.0, 0.0, 0.0, 1.0]
assert 'mimic' not in pathlib.Path('converted.urdf').read_text()
PYTHON
venv/bin/robot-convert info converted.urdf > info
