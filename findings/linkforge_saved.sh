#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# linkforge-core 1.5.4: of a URDF that is read and saved, the gear and the limits of its ros2_control part are lost.
#
# A joint's command interface is limited to ±0.5 rad, its state begins at 0.2 rad, and a transmission inside of the
# <ros2_control> has a mechanical reduction of 19. Expected: they are there after a way through URDFParser and
# URDFGenerator, which the package calls lossless. What happens: the transmission, the limits and the initial value are
# gone without a warning, so that a drive that should turn 19 times as far as the joint turns only as far as the joint.
# Numbers are rounded to six decimals, but for those near 0, and a ratio as well: a mimic of -1/19 becomes -0.052632,
# and after 1000 turns of the rotor its output is off by 2.6 mrad. But for the rounding, masses, inertias, limits,
# damping, friction and a <transmission> outside of <ros2_control> are kept.
# For us: keep the <ros2_control> part in a file of its own, and compare the URDF that was written with the one before.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check linkforge-core==1.5.4
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math
from xml.etree import ElementTree

from linkforge.core.generators.urdf_generator import URDFGenerator
from linkforge.core.parsers.urdf_parser import URDFParser

URDF = '''
<robot name="gear">
  <link name="base"/><link name="rotor"/><link name="output"/>
  <joint name="motor" type="continuous"><parent link="base"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="out" type="continuous"><parent link="base"/><child link="output"/><axis xyz="0 0 1"/>
    <mimic joint="motor" multiplier="-0.05263157894736842"/></joint>
  <ros2_control name="drive" type="system">
    <hardware><plugin>drive/System</plugin></hardware>
    <joint name="motor">
      <command_interface name="position"><param name="min">-0.5</param><param name="max">0.5</param></command_interface>
      <state_interface name="position"><param name="initial_value">0.2</param></state_interface>
      <param name="node">1</param>
    </joint>
    <transmission name="gear"><plugin>transmission_interface/SimpleTransmission</plugin>
      <actuator name="drive" role="actuator1"/>
      <joint name="motor" role="joint1"><mechanical_reduction>19.0</mechanical_reduction></joint></transmission>
  </ros2_control>
</robot>'''
before = ElementTree.fromstring(URDF)
after = ElementTree.fromstring(URDFGenerator().generate(URDFParser().parse_string(URDF)))
part = './ros2_control'
assert after.find(part + '/joint/param[@name="node"]').text == '1'
for path in '/transmission', '/joint/command_interface/param', '/joint/state_interface/param':
    counts = len(before.findall(part + path)), len(after.findall(part + path))
    print(path, 'before and after', counts)
    assert counts[0] and not counts[1]
ratios = [float(root.find('.//mimic').get('multiplier')) for root in (before, after)]
error = 1000 * math.tau * (ratios[1] - ratios[0])
print('ratios', ratios, 'error after 1000 turns in rad', error)
assert abs(error + 2.65e-3) < 1e-4
PYTHON
