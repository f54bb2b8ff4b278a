#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sysidentpy 0.9.0: of a record that begins at standstill at 0 rad, the model of a joint is found without its torque.
#
# A joint's speed is 1.5 times the one before, less 0.7 times the second one before, plus 0.1 times the torque before;
# the record has no noise. FROLS adds the term that explains most of what is left, and gives the share that each
# explains; they add up to 1 at most. What happens: where the first value of a chosen term is exactly 0, as in each
# record that begins at standstill, its Householder transform is void, as it is built with the sign of that value. The
# next terms are then chosen as if the first had explained nothing: the shares add up to 1.4, two terms of the speed
# are chosen and the torque is not, so that the simulated joint does not move. With 3 terms the torque of two steps
# before is chosen, with -0.001. The same record without its first two values, or raised by 1e-6, gives the right
# model. There is no warning.
# For us: cut the standstill off the beginning of a record.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sysidentpy==0.9.0 numpy==2.3.5 scipy==1.17.1
cat > "$folder/standstill.py" <<'PYTHON'
import numpy as np
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS
from sysidentpy.parameter_estimation import LeastSquares

NAMES = {0: 'constant', 1001: 'speed 1 before', 1002: 'speed 2 before', 2001: 'torque 1 before', 2002: 'torque 2 before'}


def record(count):
    torque = np.random.default_rng(0).uniform(-1, 1, count)
    speed = np.zeros(count)
    for k in range(2, count):
        speed[k] = 1.5 * speed[k - 1] - 0.7 * speed[k - 2] + 0.1 * torque[k - 1]
    return torque[:, None], speed[:, None]


def found(torque, speed, **options):
    model = FROLS(ylag=2, xlag=2, basis_function=Polynomial(degree=1), estimator=LeastSquares(), **options)
    model.fit(X=torque, y=speed)
    terms = {NAMES[int(code)]: round(float(factor), 4) for code, factor in zip(model.final_model[:, 0], model.theta[:, 0])}
    error = abs(model.predict(X=torque, y=speed) - speed).max() / abs(speed).max()
    print(options, terms, f'shares {np.sum(model.err):.3f}, greatest error {error:.1%}')
    return terms, np.sum(model.err), error


torque, speed = record(1000)
right = {'speed 1 before': 1.5, 'speed 2 before': -0.7, 'torque 1 before': 0.1}
by_count, by_criterion = {'order_selection': False, 'n_terms': 3}, {'order_selection': True, 'n_info_values': 5}
for moved in (torque[2:], speed[2:]), (torque, speed + 1e-6):
    terms, shares, error = found(*moved, **by_count)
    assert terms.keys() == right.keys() and shares < 1.0001 and error < 1e-3
terms, shares, error = found(torque, speed, **by_criterion)
assert terms.keys() == {'speed 1 before', 'speed 2 before'} and shares > 1.4 and error > 0.9
terms, shares, error = found(torque, speed, **by_count)
assert 'torque 1 before' not in terms and abs(terms['torque 2 before']) < 0.01 and error > 0.3
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/standstill.py"
