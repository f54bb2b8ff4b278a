#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyros-robotics 2.1.0: a joint that must accelerate 10 kg·m² at 100 rad/s² gets the motors of one without any inertia.
#
# size_actuator() takes `j_load`, "reflected at the joint", and `alpha_max`, "required at the joint", and its module
# announces an acceleration check of J_motor + J_load / N². Expected: for 2 N·m at 30 rpm and an acceleration that needs
# 1000 N·m more, none of its motors and gears is left, as with 1002 N·m. What happens: the same 137 of them pass
# in the same order, with the same margins; neither number is used, and no motor of the catalogue has an inertia.
# For us: add the torque of the acceleration, with the rotor's inertia times the square of the ratio, to tau_peak.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyros-robotics==2.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math

from pyros.robotics.motors import SizingRequirement, size_actuator


def passing(torque, **demanded):
    report = size_actuator(SizingRequirement(torque, 1.0, 30 * 2 * math.pi / 60, **demanded))
    return [(one.motor.id, one.ratio, one.peak_margin, one.fitness) for one in report.best(1000)]


without, with_inertia = passing(2.0), passing(2.0, j_load=10.0, alpha_max=100.0)
print('pass without an inertia:', len(without), 'with 10 kg·m² at 100 rad/s²:', len(with_inertia), without[0])
assert len(without) == 137 and without == with_inertia
print('pass with these 1000 N·m in tau_peak:', len(passing(1002.0)))
assert not passing(1002.0)
PYTHON
