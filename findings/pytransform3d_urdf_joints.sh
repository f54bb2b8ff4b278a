#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pytransform3d 3.17.0: the output of a gear, a mimic of a URDF, stands still; a slide without `lower` has no stop at 0.
#
# Expected of UrdfTransformManager for a motor at 2 rad whose output mimics it by -0.05, with an offset of 0.3 rad: the
# output at 0.2 rad, as in yourdfpy. What happens: it stays at 0 rad, without a warning, and takes any other angle by
# set_joint(). A slide with <limit upper="0.1" effort="10" velocity="1"/> goes from 0 to 0.1 m, as the format gives
# `lower` the default 0. What happens: its limits are -inf and 0.1 m, and it goes to -0.5 m. With lower="0" it stays at
# 0 m. It is documented that angles beyond the limits are clipped, not that a mimic or this default is left out.
# For us: set each mimic after its motor, and write both limits into a URDF.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pytransform3d==3.17.0 \
  lxml==6.1.3 yourdfpy==0.0.60 numpy==2.4.6
cat > "$folder/joints.py" <<'PYTHON'
import io
import warnings

import numpy as np
import yourdfpy
from pytransform3d.urdf import UrdfTransformManager

MODEL = """<robot name="gear"><link name="stator"/><link name="rotor"/><link name="shaft"/><link name="carriage"/>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/><mimic joint="motor" multiplier="-0.05" offset="0.3"/></joint>
  <joint name="slide" type="prismatic"><parent link="stator"/><child link="carriage"/><axis xyz="1 0 0"/>
    <limit {} upper="0.1" effort="10" velocity="1"/></joint></robot>"""


def turned(pose):
    return np.arctan2(pose[1, 0], pose[0, 0])


warnings.simplefilter('error', UserWarning)
robot = yourdfpy.URDF.load(io.StringIO(MODEL.format('lower="0"')))
robot.update_cfg({'motor': 2.0, 'slide': 0.0})
right = turned(robot.get_transform('shaft', 'stator'))
for lower, slid in (('', -0.5), ('lower="0"', 0)):
    manager = UrdfTransformManager()
    manager.load_urdf(MODEL.format(lower))
    manager.set_joint('motor', 2.0)
    manager.set_joint('slide', -0.5)
    output, rotor = (turned(manager.get_transform(link, 'stator')) for link in ('shaft', 'rotor'))
    slide, limits = manager.get_transform('carriage', 'stator')[0, 3], manager.get_joint_limits('slide')
    print(f'motor {rotor:.2f} rad: output {output:.2f} rad, in yourdfpy {right:.2f} rad; slide with '
          f'{lower or "no lower"}, sent to -0.5 m: {slide:.2f} m, limits {limits}')
    assert np.allclose((rotor, output, right), (2, 0, 0.2)) and np.isclose(slide, slid)
    assert limits == ((0, 0.1) if lower else (-np.inf, 0.1))
    manager.set_joint('motor', 20.0)
    manager.set_joint('output', 0.7)
    assert np.isclose(turned(manager.get_transform('shaft', 'stator')), 0.7)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/joints.py"
