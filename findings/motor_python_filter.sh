#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# motor-python 0.0.11: the low-pass of a joint at 1 rad gives 0 as its position, or 1.37 rad, and its backward Euler
# diverges.
#
# SecondOrderLowPassFilter.run() is to give the filtered signal and its derivative. Expected for a joint that goes to 1
# rad: 1 rad, then 0 rad/s. What happens: run() gives them the other way round, so that the position peaks at 7.3 "rad"
# and ends at 0; step() is right. With initial_condition 1, a joint that stands at 1 rad is filtered as up to 1.37 rad,
# as the state of the derivative begins at 1 too, which is 20 rad/s here. Backward Euler, said to be more stable, and
# the trapezoidal rule take the slope of the old state: at 5 Hz they diverge, where the methods of these names are
# stable at any rate. The integral of PIDController is cut off where it is used, not where it is kept: after 60 s at a
# stop, with a gain of 1, the output pushes on for 53 s with an error of the same size in the other direction.
# For us: swap what run() gives, begin at 0 and subtract the first position, sample fast, and reset() the PID after a
# stop.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check motor-python==0.0.11 numpy==2.4.6
cd "$folder"
timeout 100 "$folder/venv/bin/python" - <<'PYTHON' 2> log || { cat log; exit 1; }
import math

from motor_python.definitions import LowPassFilterConfig, PIDConfig, SolverType
from motor_python.pid_controller import PIDController
from motor_python.second_order_low_pass_filter import SecondOrderLowPassFilter

STEPS = 400


def low_pass(**settings):
    return SecondOrderLowPassFilter(LowPassFilterConfig(cut_off_frequency_rad_per_sec=20.0, damping_ratio=1.0, **settings))


signal, derivative = low_pass().run([1.0] * STEPS)
stepped = low_pass()
position, velocity = [stepped.step(1.0, 0.01) for _ in range(STEPS)][-1]
print(f'run(): signal up to {max(signal):.2f}, at last {signal[-1]:.3f}, derivative at last {derivative[-1]:.3f}; step(): {position:.3f}, {velocity:.3f}')
assert abs(signal[-1]) < 1e-6 and abs(max(signal) - 20 / math.e) < 0.05 and abs(derivative[-1] - 1) < 1e-6
assert abs(position - 1) < 1e-6 and abs(velocity) < 1e-6

standing = low_pass(initial_condition=1.0)
positions = [standing.step(1.0, 0.001)[0] for _ in range(STEPS)]
print(f'a joint that stands at 1 rad: {positions[0]:.3f} to {max(positions):.3f} rad')
assert abs(max(positions) - 1 - 1 / math.e) < 1e-3

for solver in (SolverType.BACKWARD_EULER, SolverType.TRAPEZOIDAL):
    ends = {}
    for rate in (100, 5):
        solved = low_pass(solver_type=solver)
        ends[rate] = [solved.step(1.0, 1 / rate)[0] for _ in range(STEPS)][-1]
    print(f'{solver}: at 100 Hz {ends[100]:.3f} rad, at 5 Hz {ends[5]:.3g} rad')
    assert abs(ends[100] - 1) < 1e-6 and abs(ends[5]) > 1e9

pid = PIDController(PIDConfig(0.0, 1.0, 0.0, (-7, 7)), LowPassFilterConfig())
reached = math.radians(60)
time = 0.0
while time < 60:
    pid.compute_output(time, reached, 0.0)
    time += 0.01
stopped = time
while pid.compute_output(time, -reached, 0.0) >= 7:
    time += 0.01
print(f'the output pushes against the stop for {time - stopped:.1f} s after the error has changed its sign')
assert abs(time - stopped - (60 - 7 / reached)) < 0.1
PYTHON
