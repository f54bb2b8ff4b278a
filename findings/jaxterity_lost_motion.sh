#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# jaxterity 1.2.0: of a joint without any lost motion it finds 4.6 mrad, which is its encoder's noise, with an interval
# that excludes 0.
#
# reversal_lost_motion() of a sweep up and back, 4000 samples of an encoder of 4096 counts a turn with a noise of 3
# counts. It is documented to be "the median signed gap" of the two directions. Expected without any lost motion: about
# 0 counts. What happens: 3 counts, as the gaps lose their signs before their median is taken, with an interval that
# excludes 0. A lost motion of 2 counts is 3 counts as well. One of 10 counts is right, and so is 0 at a noise of 0.3
# counts.
# For us: measure lost motion by gearkin lost-motion, or take the difference of the mean positions of both directions.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check jaxterity==1.2.0 jax==0.9.2 jaxonomy==3.4.1 \
    numpy==2.4.6 mujoco==3.10.0
cd "$folder"
timeout 120 venv/bin/python - 2> log <<'PYTHON' || { cat log; exit 1; }
import numpy as np
from jaxterity.checkup.backlash import reversal_lost_motion

COUNTS_PER_RAD = 4096 / (2 * np.pi)
CALIBRATION = {'calibrations': [{'servo_id': 1, 'ticks_per_rad': COUNTS_PER_RAD}]}
SAMPLES = 2000  # of each direction


def measured(noise, lost):
    up = np.linspace(1000, 3000, SAMPLES)
    goals = np.concatenate([up, up[::-1]])
    directions = np.repeat([-1, 1], SAMPLES)
    positions = np.round(goals + directions * lost / 2 + np.random.default_rng(1).normal(0, noise, 2 * SAMPLES))
    record = {
        'schema': 'lekiwi-backlash-capture-v1', 't': (np.arange(2 * SAMPLES) * 0.01).tolist(), 'servo_ids': [1],
        'servo_id': [1] * (2 * SAMPLES), 'phase': ['forward'] * SAMPLES + ['reverse'] * SAMPLES,
        'goal_ticks': np.round(goals).tolist(), 'pos_ticks': positions.tolist(), 'joints': {'1': 'elbow'},
    }
    (result,) = reversal_lost_motion(record, calibration=CALIBRATION)
    low, high = np.array(result.ci95_rad) * COUNTS_PER_RAD
    signed = np.mean(positions[:SAMPLES] - positions[SAMPLES:][::-1])
    print(f'noise {noise}, lost motion {lost} counts: {result.lost_motion_ticks} between {low:.1f} and {high:.1f}; '
          f'{result.lost_motion_rad * 1e3:.2f} mrad; mean of the signed gaps {abs(signed):.2f} counts')
    assert abs(abs(signed) - lost) < 0.3
    return result.lost_motion_ticks, low


assert measured(0.3, 0)[0] == 0 and measured(3, 10)[0] == 10
count, low = measured(3, 0)
assert count == 3 and low > 2
assert measured(3, 2)[0] == 3
PYTHON
