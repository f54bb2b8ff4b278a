#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nemo-bldc 1.1.0: a shaft that is to swing to and fro at 0.2 rad/s gets a feedforward of 2 rad/s, and is 1.8 rad ahead.
#
# A SignalTriangle of 0.1 Hz and an amplitude of 1 rad goes up by 1 rad within 5 s. Expected of its derivative(), which
# simulate() adds as the feedforward of the speed where it controls a position: 0.2 rad/s. What happens: 2 rad/s, as at
# each frequency: the derivative is that of a triangle of 1 Hz. In the simulation the shaft runs ahead of its goal until
# a position loop of 1/s takes the 1.8 rad/s away, by 1.8 rad, which is more than the whole swing. A sine is followed to
# 5 mrad.
# For us: take a sine to choose gains with it, and compare a feedforward with the differences of the goal.
#
# Exit code 0: still so. Installs the versions into a temporary folder, without PyGObject, which only the window needs.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps nemo-bldc==1.1.0 numpy==2.2.6
cd "$folder"
venv/bin/python - <<'PYTHON'
import numpy
from nemo_bldc.physics.motor import Motor
from nemo_bldc.simulation.pi_controller import PIController
from nemo_bldc.simulation.signal import SignalSinus, SignalTriangle
from nemo_bldc.simulation.simulate import ControlType, simulate

for frequency in (0.1, 1.0, 5.0):
    triangle = SignalTriangle(frequency=frequency, amplitude=1.0)
    time, step = 0.1 / frequency, 1e-6
    slope = (triangle.value(time + step) - triangle.value(time - step)) / (2 * step)
    print(f'{frequency} Hz: slope {slope:.3f} rad/s, derivative() {triangle.derivative(time):.3f} rad/s')
    assert abs(slope - 2 * frequency) < 1e-6 and triangle.derivative(time) == 2.0

motor = Motor(n=14, R=0.1, L=1e-4, ke=0.01, iq_max=30.0, iq_nominal=10.0, U=24.0, reduction_ratio=9.0)


def greatest_error(signal):
    """The greatest difference in rad between the goal and the shaft in the second half of 5 s."""
    result = simulate(motor, ControlType.POSITION, signal, 5.0, 0.01, 0.01, PIController(0.2, 100.0, 100.0),
                      PIController(5.0, 0.0, 0.0), PIController(1.0, 0.0, 0.0), control_loop_frequency=10000.0)
    return float(numpy.abs(result.theta - result.pos_target)[len(result.time) // 2:].max())


sine = greatest_error(SignalSinus(frequency=0.1, amplitude=0.5))
triangle = greatest_error(SignalTriangle(frequency=0.1, amplitude=1.0))
print(f'greatest error: sine {sine:.3f} rad, triangle {triangle:.3f} rad')
assert sine < 0.05 and abs(triangle - 1.8) < 0.05
PYTHON
