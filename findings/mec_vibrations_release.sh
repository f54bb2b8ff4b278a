#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mec-vibrations-calcs 0.1.2: an arm let go at -1 rad begins at 1 rad, and above its resonance it moves with its torque.
#
# get_natural_response() is the free vibration from an initial deflection. What happens if this is negative and the
# damping is below the critical one: the phase is an arc tangent of one quotient, so that the answer has the wrong
# sign. At a damping ratio of 1 and 2 the sign is right, but from 1 rad at a ratio of 2 and 10 rad/s, the arm is at
# 0.007 rad after 0.5 s where 0.282 rad are right. get_permanent_response_HE() of a torque at twice the resonance has
# the wrong sign as well: it is in phase with the torque, where the arm moves against it.
# For us: a stiffness and a damping that are fitted by these functions are wrong; use scipy.signal.lsim().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mec-vibrations-calcs==0.1.2 numpy==2.4.6 scipy==1.17.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from mec_vibrations_calcs.one_dof_calc import get_natural_response, get_permanent_response_HE
from scipy.integrate import solve_ivp

FREQUENCY = 10.0
TIMES = np.array([0.0, 0.1, 0.5])


def integrated(ratio, start, times=TIMES, torque=0.0, forced=20.0):
    def derivative(time, state):
        acceleration = torque * np.cos(forced * time) - 2 * ratio * FREQUENCY * state[1] - FREQUENCY**2 * state[0]
        return [state[1], acceleration]

    return solve_ivp(derivative, [0, times[-1]], [start, 0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]


for ratio, start in (0.0, 1), (0.0, -1), (0.1, 1), (0.1, -1), (1, -1), (2, 1):
    given, right = get_natural_response(FREQUENCY, ratio, start, 0.0, TIMES), integrated(ratio, start)
    print('ratio', ratio, 'from', start, 'rad:', given, 'right', right)
    if ratio < 1 and start < 0:
        assert np.allclose(given, -right, atol=1e-6)
    elif ratio == 2:
        assert abs(given[2] - 0.00726) < 1e-5 and abs(right[2] - 0.28217) < 1e-5
    else:
        assert np.allclose(given, right, atol=1e-6)

times = np.concatenate([[0], 20 + np.linspace(0, 0.3, 20)])  # the free vibration has ended by then
given = get_permanent_response_HE(FREQUENCY, FREQUENCY**2, 1.0, 0.1, 20.0, times)[1:]
right = integrated(0.1, 0, times, torque=1.0)[1:]
print('at twice the resonance', given[:3], 'right', right[:3])
assert np.allclose(given, -right, atol=1e-6) and abs(right).max() > 1e-3
PYTHON
