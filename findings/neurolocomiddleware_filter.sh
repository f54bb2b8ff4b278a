#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# NeuroLocoMiddleware 0.0.1: a low-pass with a time constant of 0.5 s gets 0.42 s in substeps, and its usual
# coefficients are an error.
#
# discretize_N_tustin(dt, N=5) is to take N steps of dt / N by Tustin's rule. Expected: the time constant of the other
# rules. What happens: it takes N + 1 of them, so that the filter of a torque is 20 % too fast at N = 5, and twice as
# fast at N = 1. Its end value is right, as is the time constant after discretize_tustin() and
# discretize_substep_euler(). from_poly_fraction([1], [1, 0.5]), the usual low-pass, is an UnboundLocalError, although
# its documentation allows shorter numerators; the same with a zero for s, from_poly_fraction([1, 0], [1, 0.5]), is
# right.
# For us: use scipy.signal, or give as many coefficients in both, and discretize_tustin().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps NeuroLocoMiddleware==0.0.1 numpy==2.4.6
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import io
import math

from NeuroLocoMiddleware.LinearFilter import from_poly_fraction

TIME_CONSTANT, STEP = 0.5, 0.001


def measured(rule, *substeps):
    """The time until a step has reached 1 - 1/e, and where it ends."""
    low_pass = from_poly_fraction([1.0, 0.0], [1.0, TIME_CONSTANT], dt=STEP)
    with contextlib.redirect_stdout(io.StringIO()):
        getattr(low_pass, rule)(STEP, *substeps)
    answer = [float(low_pass.next(1.0)[0, 0]) for _ in range(10000)]
    return STEP * next(n for n, value in enumerate(answer, 1) if value >= 1 - 1 / math.e), answer[-1]


for rule, substeps, expected in (
    ('discretize_tustin', (), TIME_CONSTANT),
    ('discretize_substep_euler', (5,), TIME_CONSTANT),
    ('discretize_N_tustin', (5,), TIME_CONSTANT * 5 / 6),
    ('discretize_N_tustin', (1,), TIME_CONSTANT / 2),
):
    constant, end = measured(rule, *substeps)
    print(f'{rule}{substeps}: time constant {constant:.3f} s, end {end:.3f}')
    assert abs(constant - expected) < 0.003 and abs(end - 1) < 1e-3
try:
    from_poly_fraction([1.0], [1.0, TIME_CONSTANT])
except UnboundLocalError as error:
    print(error)
else:
    raise SystemExit(1)
PYTHON
