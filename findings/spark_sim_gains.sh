#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robotpy-rev 2026.0.4: in a simulated SPARK MAX, I acts at a thousandth of what REV documents, and D at 750 times.
#
# Expected of a SparkMaxSim: the output of the controller that REV prints on its page on closed-loop control: it runs
# each ms and adds I times the error to its integral, so that an I of 0.001 gives full output 1 s after an error of 1
# turn. What happens: it adds I times the error times the step in seconds, however long the step is, which gives 0.001
# after 1 s. D is divided by the step in seconds instead: at 1 turn/s a D of 1 gives -0.75 after 1 s, and -0.001 by that
# page. P is right. So gains that were tuned in simulation let a real joint swing, and those of a real joint leave it
# away from its goal.
# For us: tune I and D on the motor, not in simulation.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotpy-rev==2026.0.4 wpilib==2026.2.2
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import itertools
import os
import sys

import rev
import wpilib
from wpilib.simulation import DriverStationSim
from wpimath.system.plant import DCMotor

DriverStationSim.setEnabled(True)
DriverStationSim.setDsAttached(True)
DriverStationSim.notifyNewData()
wpilib.DriverStation.refreshData()
identifiers = itertools.count(1)


def output(step, goal, rpm=0.0, **gains):
    """The output of a SPARK MAX after 1 s with a goal in turns, where its motor turns with a given speed."""
    motor = rev.SparkMax(next(identifiers), rev.SparkLowLevel.MotorType.kBrushless)
    config = rev.SparkMaxConfig()
    for name, gain in gains.items():
        getattr(config.closedLoop, name)(gain)
    motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kNoPersistParameters)
    simulated = rev.SparkMaxSim(motor, DCMotor.NEO(1))
    motor.getClosedLoopController().setReference(goal, rev.SparkMax.ControlType.kPosition)
    for _ in range(round(1.0 / step)):
        simulated.iterate(rpm, 12.0, step)
    return motor.getAppliedOutput()


integrals = [output(step, 1.0, I=0.001) for step in (0.02, 0.001)]
proportional, derivative = output(0.02, 1.0, P=0.1), output(0.02, 0.0, rpm=60.0, D=1.0)
print('P of 0.1, error of 1 turn:', proportional)
print('I of 0.001, error of 1 turn, after 1 s:', integrals, 'with steps of 20 and 1 ms')
print('D of 1 at 1 turn/s, after 1 s:', derivative)
slow = all(abs(integral - 0.001) < 1e-6 for integral in integrals)
correct = slow and abs(proportional - 0.1) < 1e-6 and -1.1 < derivative < -0.5
sys.stdout.flush()
os._exit(0 if correct else 1)
PYTHON
