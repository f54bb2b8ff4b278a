#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bayesfilter 0.2.0: a shaft at 2 rad/s whose readings come at irregular times is estimated up to 0.15 rad behind its
# angle.
#
# Its README says to use run() for readings at irregular times. run() estimates on a grid of its own, here of 10 Hz.
# Expected: readings without noise at known times give the angle on the grid. What happens: each reading is taken as the
# angle at the next time of the grid, so that the estimate is behind by up to a step, and its variance says that it is
# right to 0.1 mrad. With readings on the grid it is right. Besides, the first estimate is predicted by a step although
# no time has passed: an initial speed of 2 rad/s, known to 1 rad/s, becomes 0.0002 rad/s by a first reading that agrees
# with the initial angle.
# For us: call predict() and update() with the time between two readings, or run() at a rate far above that of the
# readings.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bayesfilter==0.2.0 numpy==2.4.6
cat > "$folder/irregular.py" <<'PYTHON'
import numpy as np
from bayesfilter.distributions import Gaussian
from bayesfilter.filtering import BayesianFilter
from bayesfilter.model import StateTransitionModel
from bayesfilter.observation import Observation

SPEED = 2.0
POSITION = np.array([[1.0, 0.0]])


def transition(step):
    return np.array([[1.0, step], [0.0, 1.0]])


def new_filter(angle):
    model = StateTransitionModel(lambda state, step: transition(step) @ state, np.diag([1e-10, 1e-8]),
                                 lambda state, step: transition(step))
    return BayesianFilter(model, Gaussian(np.array([angle, SPEED]), np.diag([1e-6, 1.0])))


def reading(time):
    return Observation(np.array([SPEED * time]), np.array([[1e-8]]), lambda state: POSITION @ state, lambda state: POSITION)


def behind(times, rate):
    states, grid = new_filter(SPEED * times[0]).run([reading(time) for time in times], list(times), rate, use_jacobian=True)
    means = np.array([state.mean() for state in states])
    error = means[20:, 0] - SPEED * np.array(grid)[20:]
    deviation = np.sqrt(states[-1].covariance()[0, 0])
    print(f'{rate} Hz: error from {error.min():.4f} to {error.max():.4f} rad, deviation by the filter {deviation:.5f}')
    print('first estimate', means[0])
    return error, deviation, means[0]


regular = np.arange(101) / 10
irregular = np.sort(np.random.default_rng(1).uniform(0, 10, 200))
error, _, first = behind(regular, 10.0)
assert abs(error).max() < 1e-4
assert abs(first[0]) < 1e-5 and abs(first[1]) < 0.001
error, deviation, _ = behind(irregular, 10.0)
assert error.min() < -0.14 and error.max() < 0 and deviation < 1.1e-4

# The same filter, with the time between two readings, is right.
one = new_filter(SPEED * irregular[0])
state = one.state
for before, now in zip(irregular, irregular[1:]):
    state = one.update(reading(now), one.predict(state, now - before), use_jacobian=True)
    assert abs(state.mean()[0] - SPEED * now) < 1e-4
print('reading by reading', state.mean() - [SPEED * irregular[-1], SPEED])
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/irregular.py"
