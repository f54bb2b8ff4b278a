#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# jiminy-py 1.8.13: once a turn, a delayed encoder of a continuous joint is read up to half a turn away from its angle.
#
# A continuous joint turns at 10 rad/s, and its encoder is read at 1 kHz with a delay of 2.5 ms. Expected of
# EncoderSensor: the angle that the joint had 2.5 ms ago, within one turn: 3.135 rad, -3.138 rad and -3.128 rad. What
# happens: where the angle jumps from 3.14 rad to -3.14 rad, it is interpolated as if it had moved there, and 0.003 rad
# are read instead of -3.138 rad. So it is at each of the five jumps in 3 s. delayInterpolationOrder is 1, linear, by
# default, and the interpolation does not know that the position of an unbounded joint is an angle. Without a delay,
# with delayInterpolationOrder 0, or as a revolute joint with limits far away, no reading is wrong by more than the way
# of one period.
# For us: make the joint revolute with wide limits, or set delayInterpolationOrder to 0 and take a delay that is a
# multiple of sensorsUpdatePeriod; else leave out readings that are not on a line with both of their neighbours.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check jiminy-py==1.8.13 numpy==2.2.6
cat > "$folder/encoder.py" <<'PYTHON'
import sys

import numpy as np
from jiminy_py.core import EncoderSensor, Engine, FunctionalController, Robot, SimpleMotor

SPEED, PERIOD, DELAY, SAMPLES = 10.0, 1e-3, 2.5e-3, 3000
URDF = """<robot name="gear"><link name="base"/><link name="shaft"><inertial><mass value="1"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="output" type="{}"><parent link="base"/><child link="shaft"/><axis xyz="0 0 1"/>
  <limit lower="-1000" upper="1000" effort="10" velocity="20"/></joint></robot>"""


def readings(kind, delay=DELAY, **options):
    """Return the readings of the encoder, and the angles that it should read."""
    with open(sys.argv[1], 'w') as file:
        file.write(URDF.format(kind))
    robot = Robot('gear')
    robot.initialize(sys.argv[1], has_freeflyer=False)
    motor, encoder = SimpleMotor('motor'), EncoderSensor('encoder')
    robot.attach_motor(motor)
    motor.initialize('output')
    robot.attach_sensor(encoder)
    encoder.initialize(joint_name='output')
    encoder.set_options({**encoder.get_options(), 'delay': delay, **options})
    robot.controller = FunctionalController(lambda time, position, speed, sensors, command: command.fill(0))
    engine = Engine()
    engine.add_robot(robot)
    given = engine.get_options()
    given['stepper'].update(controllerUpdatePeriod=PERIOD, sensorsUpdatePeriod=PERIOD)
    engine.set_options(given)
    engine.start(np.array([1.0, 0.0] if kind == 'continuous' else [0.0]), np.array([SPEED]))
    read = []
    for _ in range(SAMPLES):
        engine.step(PERIOD)
        read.append(encoder.data[0])
    assert abs(engine.robot_states[0].v[0] - SPEED) < 1e-6
    engine.stop()
    turned = SPEED * (np.arange(1, SAMPLES + 1) * PERIOD - delay)
    return np.array(read), turned


def wrong(name, read, turned):
    """Return which readings after the delay are off by more than the way of one period, but for whole turns."""
    error = np.abs((read - turned + np.pi) % (2 * np.pi) - np.pi)
    found = np.flatnonzero((error > SPEED * PERIOD) & (turned > 0))
    print(f'{name}: {len(found)} wrong, by up to {error[turned > 0].max():.3f} rad', flush=True)
    return found


assert len(wrong('not delayed', *readings('continuous', delay=0.0))) == 0
assert len(wrong('order 0', *readings('continuous', delayInterpolationOrder=0))) == 0
assert len(wrong('revolute', *readings('revolute'))) == 0
read, turned = readings('continuous')
places = wrong('delayed', read, turned)
for place in places:
    near = slice(place - 1, place + 2)
    print('read', read[near].round(3), 'expected', (turned[near] % (2 * np.pi)).round(3), 'or one turn less')
assert len(places) == 5 and np.all(np.abs(read[places - 1]) > 3.1) and np.all(np.abs(read[places + 1]) > 3.1)
assert np.allclose(read[places[0] - 1 : places[0] + 2], (3.135, 0.003, -3.128), atol=1e-3)
PYTHON
timeout 300 "$folder/venv/bin/python" "$folder/encoder.py" "$folder/gear.urdf"
