#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# aeroid 0.5.0: if the first guess of a shaft's friction is 0, its friction is found as a quarter and its inertia as
# five times their values, and a pulse of torque that it gets at rest does not move it in simulation.
#
# A shaft of 0.01 kg·m² with a viscous friction of 0.02 N·m·s/rad gets three pulses of torque, and its speed is read
# with a noise of 0.01 rad/s. Expected of identify(): these values, for any first guess near them. What happens: they
# are found from a guess of 0.03 and 0.02, but from 0 and 0.02 the friction is 0.005 N·m·s/rad, with a standard error
# below 1e-6, and the inertia 0.05 kg·m², as a success, with a warning for some noise and without one for other: each
# parameter is scaled by its guess, 0 by 1e-8, and the step of its derivative then has no effect. Expected of
# simulate() of this shaft, at rest at first: 31 rad/s after a pulse of 1 N·m from 2.0 to 2.5 s in a record of 100 Hz.
# What happens: 0 at all times, as the solver steps over it.
# For us: begin with the order of magnitude of each parameter, and give max_step, the interval of the samples.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check aeroid==0.5.0 numpy==2.4.6 scipy==1.17.1
cat > "$folder/shaft.py" <<'PYTHON'
import numpy as np
from aeroid import FlightData, Model, identify

FRICTION, INERTIA = 0.02, 0.01
times = np.arange(0, 20, 0.01)
model = Model(
    states=('speed',),
    controls=('torque',),
    parameters={'friction': FRICTION, 'inertia': INERTIA},
    dynamics=lambda t, x, u, p: np.array([(u[0] - p['friction'] * x[0]) / p['inertia']]),
)


def pulses(begins, width):
    """A torque of 1 N·m from each time on, for `width` seconds, and the speed of the shaft that results."""
    torque = np.zeros_like(times)
    for begin in begins:
        torque[(times >= begin - 1e-9) & (times < begin + width - 1e-9)] = 1.0
    speed = np.zeros_like(times)
    decay = np.exp(-0.01 * FRICTION / INERTIA)
    for k in range(len(times) - 1):
        speed[k + 1] = decay * speed[k] + (1 - decay) * (torque[k] + torque[k + 1]) / 2 / FRICTION
    return torque, speed


torque, speed = pulses((2.0,), 0.5)
for options, expected in ({}, 0.0), ({'max_step': 0.01}, speed.max()):
    simulated = model.simulate(times, torque, [0.0], **options).states[:, 0].max()
    print(f'pulse at 2 s, {options}: {simulated:.3f} of {speed.max():.3f} rad/s')
    assert abs(simulated - expected) < 0.1

torque, speed = pulses((0.0, 6.0, 12.0), 0.1)
measured = speed + 0.01 * np.random.default_rng(0).standard_normal(len(speed))
measured[0] = 0
record = FlightData(time=times, channels={'speed': measured, 'torque': torque})
for guess, right in (0.03, True), (0.0, False):
    found = identify(model, record, ['friction', 'inertia'], initial_guess={'friction': guess, 'inertia': 0.02})
    print(f'friction begun with {guess}: {found.parameters}, standard errors {found.stderr}, {found.message}')
    assert found.success and found.stderr['friction'] < 1e-5
    assert right == (abs(found.parameters['friction'] - FRICTION) < 1e-4)
    assert right == (abs(found.parameters['inertia'] - INERTIA) < 1e-4)
    assert right or (found.parameters['friction'] < 0.01 and found.parameters['inertia'] > 0.03)
PYTHON
timeout 250 "$folder/venv/bin/python" "$folder/shaft.py"
