#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# aeroid 0.5.0: a pulse of torque of 0.5 s, given in a record of 100 Hz, does not move a resting shaft in simulation.
#
# A shaft of 0.01 kg·m² with a viscous friction of 0.02 N·m·s/rad is at rest, and gets 1 N·m from 2.0 to 2.5 s in a
# record of 20 s. Expected of simulate(): 31 rad/s at the end of the pulse, by the sum over its 50 samples. What
# happens: 0 at all times. While the shaft rests, each step of the solver is longer than the last, and the step over
# the pulse looks at the torque before and after it only. The times of the samples do not bound the steps. identify()
# simulates by the same function, so that a friction or an inertia is fitted to a shaft that never moved. No error, no
# warning.
# For us: give max_step, the interval of the samples, to simulate() and in the simulate_options of identify().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check aeroid==0.5.0 numpy==2.4.6 scipy==1.17.1
cat > "$folder/shaft.py" <<'PYTHON'
import numpy as np
from aeroid import Model

FRICTION, INERTIA = 0.02, 0.01
times = np.arange(0, 20, 0.01)
model = Model(
    states=('speed',),
    controls=('torque',),
    parameters={'friction': FRICTION, 'inertia': INERTIA},
    dynamics=lambda t, x, u, p: np.array([(u[0] - p['friction'] * x[0]) / p['inertia']]),
)
torque = np.where((times >= 2 - 1e-9) & (times < 2.5 - 1e-9), 1.0, 0.0)
speed = np.zeros_like(times)
decay = np.exp(-0.01 * FRICTION / INERTIA)
for k in range(len(times) - 1):
    speed[k + 1] = decay * speed[k] + (1 - decay) * (torque[k] + torque[k + 1]) / 2 / FRICTION
for options, expected in ({}, 0.0), ({'max_step': 0.01}, speed.max()):
    simulated = model.simulate(times, torque, [0.0], **options).states[:, 0].max()
    print(f'{options}: {simulated:.3f} of {speed.max():.3f} rad/s')
    assert abs(simulated - expected) < 0.1
PYTHON
timeout 100 "$folder/venv/bin/python" -W error "$folder/shaft.py"
