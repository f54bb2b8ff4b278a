#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# stepanalyzer 0.3.1: a drive whose oscillation grows is called stable, a damped one marginally stable, and a damping of
# 0.7 is found as 0.98.
#
# By the poles of a transfer function: 1/(s² - s + 1) has them at 0.5 ± 0.87i, so that it is unstable; 2/(s + 2) is
# stable; and 0.0196/(s² + 0.196 s + 0.0196), a slow position loop, has a natural frequency of 0.14 rad/s and a damping
# of 0.196/(2 · 0.14) = 0.7. Expected: an error for the first, as the package announces for unstable systems, "Stable"
# for the second, and [0.14, 0.7] from properties(). What happens: "Stable" with an overshoot of more than 2000 %,
# "Marginally Stable", and [0.1, 0.98]: the verdict compares a gain margin with a phase margin, and the natural
# frequency is rounded to one decimal before the damping is found with it.
# For us: take the poles, for example of control.poles(), and natural frequency and damping from control.damp().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check stepanalyzer==0.3.1 control==0.10.2
cd "$folder"
MPLBACKEND=Agg venv/bin/python - <<'PYTHON'
import math

import numpy
from stepanalyzer import StepAnalyzer

time = numpy.linspace(0.0, 10.0, 5001)
growing = StepAnalyzer([1.0], [1.0, -1.0, 1.0], time)
overshoot = growing.overshoot()
print('poles', numpy.roots(growing.den), growing.getStability(), 'overshoot', overshoot, '%')
assert numpy.roots(growing.den).real.max() > 0 and growing.getStability() == 'Stable' and overshoot > 2000
damped = StepAnalyzer([2.0], [1.0, 2.0], time)
print('poles', numpy.roots(damped.den), damped.getStability())
assert numpy.roots(damped.den).max() < 0 and damped.getStability() == 'Marginally Stable'
slow = StepAnalyzer([0.0196], [1.0, 0.196, 0.0196], numpy.linspace(0.0, 100.0, 5001))
frequency = math.sqrt(0.0196)
print('expected', [round(frequency, 3), round(0.196 / 2 / frequency, 3)], 'found', slow.properties())
assert slow.properties() == [0.1, 0.98]
PYTHON
