#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ikpy 4.2.1: a joint whose axis is not of length 1 in the URDF stretches the robot instead of turning it.
#
# A tool stands 1 m from a joint that turns by 1 rad about the axis (0, 0, 2). ikpy puts it 1.77 m away from the joint:
# its matrix is not a rotation. With an axis of four digits, (0.7071, 0.7071, 0), the tool is 7 µm too near.
# kinpy 0.6.1 and yourdfpy 0.0.60 bring the axis to length 1 and keep the distance.
# For us: give axes in full precision, or divide them by their length before the URDF is given to ikpy.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ikpy==4.2.1 kinpy==0.6.1 yourdfpy==0.0.60
cd "$folder"
cat > arm.py <<'PYTHON'
import kinpy
import numpy as np
import yourdfpy
from ikpy.chain import Chain

URDF = """
<robot name="arm">
  <link name="stator"/><link name="output"/><link name="tool"/>
  <joint name="joint" type="continuous">
    <parent link="stator"/><child link="output"/><axis xyz="{}"/>
  </joint>
  <joint name="mount" type="fixed">
    <parent link="output"/><child link="tool"/><origin xyz="{}"/>
  </joint>
</robot>
"""
for axis, offset in (('0 0 2', '1 0 0'), ('0.7071 0.7071 0', '0 0 1'), ('0 0 1', '1 0 0')):
    urdf = URDF.format(axis, offset)
    with open('arm.urdf', 'w') as file:
        file.write(urdf)
    chain = Chain.from_urdf_file('arm.urdf', base_elements=['stator'], active_links_mask=[False, True, False])
    poses = {'ikpy': chain.forward_kinematics([0, 1.0, 0])}
    serial = kinpy.build_serial_chain_from_urdf(urdf, 'tool')
    poses['kinpy'] = serial.forward_kinematics([1.0]).matrix()
    model = yourdfpy.URDF.load('arm.urdf')
    model.update_cfg([1.0])
    poses['yourdfpy'] = model.get_transform('tool', 'stator')
    for name, pose in poses.items():
        error = np.abs(pose[:3, :3] @ pose[:3, :3].T - np.eye(3)).max()
        distance = np.linalg.norm(pose[:3, 3])
        print(axis, name, 'distance', distance, 'rotation wrong by', error)
        expected = {'0 0 2': 1.767546, '0.7071 0.7071 0': 0.999993}.get(axis, 1) if name == 'ikpy' else 1
        assert abs(distance - expected) < 1e-6
        assert (error > 1e-5) == (expected != 1)
PYTHON
timeout 90 venv/bin/python arm.py
