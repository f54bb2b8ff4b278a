#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rerun-sdk 0.41.0: a joint of a URDF whose axis has the length 2 slides twice as far, and turns by 54°, not 28.6°.
#
# Expected of compute_transform(0.5): 0.5 m along and 0.5 rad about the direction of the axis, of whatever length it is,
# as yourdfpy turns. What happens: 1 m, and a quaternion whose vector is twice as long as it should be: (0, 0, 0.495,
# 0.969), of length 1.09, which is 0.944 rad once it is normalized. There is no warning. With an axis of length 1 both
# are right. URDF asks for axes that are normalized, but its parsers take any other length as well.
# For us: write axes of length 1 into each URDF, also (0.7071068, 0, 0.7071068) rather than (1, 0, 1).
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rerun-sdk==0.41.0 yourdfpy==0.0.60 numpy==2.4.6
cat > "$folder/axis.py" <<'PYTHON'
import sys
import warnings

import numpy as np
import yourdfpy
from rerun.urdf import UrdfTree

MODEL = """<robot name="arm"><link name="base"/><link name="carriage"/><link name="shaft"/>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="{0} 0 0"/>
    <limit lower="-5" upper="5" effort="10" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="base"/><child link="shaft"/><axis xyz="0 0 {0}"/>
    <limit lower="-3" upper="3" effort="10" velocity="1"/></joint></robot>"""
warnings.simplefilter('error', UserWarning)
for length, slid, turned in ((1, 0.5, 0.5), (2, 1, 0.944)):
    with open(sys.argv[1], 'w') as file:
        file.write(MODEL.format(length))
    tree = UrdfTree.from_file_path(sys.argv[1])
    slide, turn = (tree.get_joint_by_name(name).compute_transform(0.5) for name in ('slide', 'turn'))
    position = slide.translation.as_arrow_array().to_pylist()[0]
    quaternion = turn.quaternion.as_arrow_array().to_pylist()[0]
    angle = 2 * np.arctan2(quaternion[2], quaternion[3])
    robot = yourdfpy.URDF.load(sys.argv[1])
    robot.update_cfg({'slide': 0.5, 'turn': 0.5})
    other = robot.get_transform('shaft', 'base')
    print(f'axes of length {length}: slides by {position[0]:.3f} m, turns by {angle:.3f} rad, quaternion of length '
          f'{np.linalg.norm(quaternion):.3f}; in yourdfpy {np.arctan2(other[1, 0], other[0, 0]):.3f} rad')
    assert np.isclose(position[0], slid) and np.isclose(angle, turned, atol=1e-3)
    assert np.isclose(np.arctan2(other[1, 0], other[0, 0]), 0.5)
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/axis.py" "$folder/arm.urdf"
