#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# xurdfpy 0.6.6 (the xacro of the Rust crate xurdf): a joint at ${-a**2} is above its parent instead of below it.
#
# Expressions in a xacro file are those of Python, by the documentation of xacro. Expected for a = 0.5, as xacro 2.1.1
# and Python have it: -a**2 is -0.25, -90 % 360 is 270, and int(-2.7) is -2. What happens: 0.25, -90 and -3, without an
# error, in parse_xacro_string() and in the command xurdf-xacro: the minus binds more tightly than the power, the rest
# has the sign of the dividend, and int() rounds down. Without a negative number all three are right.
# For us: expand a .xacro with xacro itself before another parser reads it, or write -(a**2).
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check xurdfpy==0.6.6 xacro==2.1.1
cd "$folder"
cat > arm.xacro <<'XACRO'
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="a" value="0.5"/>
  <link name="base"/><link name="upper"/>
  <joint name="shoulder" type="fixed">
    <origin xyz="${-90 % 360} ${int(-2.7)} ${-a**2}"/><parent link="base"/><child link="upper"/>
  </joint>
  <link name="lower"/>
  <joint name="elbow" type="fixed">
    <origin xyz="${90 % 360} ${int(2.7)} ${a**2}"/><parent link="upper"/><child link="lower"/>
  </joint>
</robot>
XACRO
venv/bin/python - <<'PYTHON'
import xml.etree.ElementTree as ElementTree

import xacro
import xurdfpy

with open('arm.xacro') as file:
    found = xurdfpy.parse_urdf_string(xurdfpy.parse_xacro_string(file.read()))
expanded = ElementTree.fromstring(xacro.process_file('arm.xacro').toxml())
origins = {}
for joint in found.joints:
    right = [float(part) for part in expanded.find(f"joint[@name='{joint.name}']/origin").get('xyz').split()]
    origins[joint.name] = right, [float(part) for part in joint.origin.xyz]
    print(f'{joint.name}: xacro {right}, xurdfpy {origins[joint.name][1]}')
assert origins['shoulder'] == ([270.0, -2.0, -0.25], [-90.0, -3.0, 0.25])
assert origins['elbow'] == ([90.0, 2.0, 0.25], [90.0, 2.0, 0.25])
PYTHON
venv/bin/xurdf-xacro arm.xacro | grep -F 'xyz="-90 -3 0.25"'
