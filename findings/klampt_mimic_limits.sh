#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Klampt 0.10.1.post1: the motor of a mimic may turn its output to 4 rad, beyond its stop at 3 rad, and its least
# speed is above its greatest.
#
# A motor of ±100 rad and ±10 rad/s drives an output from -1 to 3 rad by a mimic with a multiplier of -0.05 and an
# offset of 1 rad. Expected of its driver: from -40 to 40 rad, the motor's angles at both stops of the output, and ±10
# rad/s. What happens: getLimits() leaves the offset out and gives -60 to 20 rad, where setValue(-60) turns the output
# to 4 rad and setValue(20) to 0 rad; getVelocityLimits() gives [100, 10], a lower limit above the upper one. The
# angles of setValue() themselves are right, and without a mimic so are all limits. For us: compute the limits of a
# geared motor from those of its output by hand, or give the mimic no offset.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: Klampt==0.10.1.post1 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from pathlib import Path

from klampt import WorldModel

URDF = """<robot name="gear">
  <link name="stator"/>
  <link name="rotor"/>
  <link name="arm"/>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-100" upper="100" effort="1" velocity="10"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="3" effort="20" velocity="5"/>{mimic}</joint>
</robot>"""


def limits(mimic):
    """The limits of the motor, its limits of speed and the output at both limits."""
    Path('gear.urdf').write_text(URDF.format(mimic=mimic))
    world = WorldModel()
    assert world.readFile('gear.urdf')
    robot = world.robot(0)
    driver, output = robot.driver(0), robot.link('arm').getIndex()
    reached = []
    for angle in driver.getLimits():
        driver.setValue(angle)
        reached.append(robot.getConfig()[output])
    print(mimic or 'no mimic', driver.getLimits(), 'rad', driver.getVelocityLimits(), 'rad/s, output at', reached, 'rad')
    return driver.getLimits(), driver.getVelocityLimits(), reached


def close(values, expected):
    return all(abs(value - wanted) < 1e-9 for value, wanted in zip(values, expected, strict=True))


angles, speeds, _ = limits('')
assert close(angles, (-100, 100)) and close(speeds, (-10, 10))
angles, speeds, reached = limits('<mimic joint="motor" multiplier="-0.05"/>')
assert close(angles, (-60, 20)) and close(speeds, (100, 10)) and close(reached, (3, -1))
angles, speeds, reached = limits('<mimic joint="motor" multiplier="-0.05" offset="1"/>')
assert close(angles, (-60, 20)) and close(speeds, (100, 10)) and close(reached, (4, 0))
PYTHON
