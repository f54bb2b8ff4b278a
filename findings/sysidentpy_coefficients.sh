#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sysidentpy 0.9.0: a simulated joint that should end at 0.5 rad/s grows beyond 1e20 if its terms and coefficients are
# given in another order.
#
# SimulateNARMAX.simulate() takes a model's terms and their coefficients. Expected: each coefficient belongs to the
# term at its place. What happens: the terms are sorted, first the outputs, then the inputs, each by age, and the
# coefficients are not. So "0.1 times the torque, 1.5 times the speed, less 0.7 times the speed before" is simulated as
# 0.1 times the speed, plus 1.5 times the speed before, less 0.7 times the torque. Neither an error nor a warning.
# FROLS gives its own terms in the order of their weight, so that a model that it has found, handed on with its
# coefficients, is wrong, too.
# For us: sort the terms and their coefficients together before simulate().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sysidentpy==0.9.0 numpy==2.3.5 scipy==1.17.1
cat > "$folder/coefficients.py" <<'PYTHON'
import numpy as np
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS
from sysidentpy.parameter_estimation import LeastSquares
from sysidentpy.simulation import SimulateNARMAX

torque = np.ones((200, 1))
speed = np.zeros((200, 1))
for k in range(2, 200):
    speed[k] = 1.5 * speed[k - 1] - 0.7 * speed[k - 2] + 0.1 * torque[k - 1]


def simulated(terms, coefficients):
    simulator = SimulateNARMAX(basis_function=Polynomial(degree=1), estimate_parameter=False)
    result = simulator.simulate(
        X_test=torque, y_test=speed, model_code=np.array(terms)[:, None], theta=np.array(coefficients)[:, None]
    )
    print(terms, coefficients, 'last speeds', result[-2:, 0])
    return result


assert abs(speed[-1] - 0.5) < 1e-9
assert abs(simulated([1001, 1002, 2001], [1.5, -0.7, 0.1]) - speed).max() < 1e-9
swapped = simulated([2001, 1001, 1002], [0.1, 1.5, -0.7])
meant = np.zeros((200, 1))
for k in range(2, 200):
    meant[k] = 0.1 * meant[k - 1] + 1.5 * meant[k - 2] - 0.7 * torque[k - 1]
assert abs(swapped - meant).max() < 1e-9 * abs(meant).max() and abs(swapped).max() > 1e20

# A model that FROLS has found in the same record, after its standstill, with a torque that varies.
varied = np.random.default_rng(0).uniform(0, 2, (200, 1))
turned = np.full((200, 1), 0.5)
for k in range(2, 200):
    turned[k] = 1.5 * turned[k - 1] - 0.7 * turned[k - 2] + 0.1 * varied[k - 1]
model = FROLS(order_selection=False, n_terms=3, ylag=2, xlag=2, basis_function=Polynomial(degree=1), estimator=LeastSquares())
model.fit(X=varied, y=turned)
terms, coefficients = model.final_model[:, 0].tolist(), model.theta[:, 0].round(6).tolist()
handed = simulated(terms, coefficients)
assert terms != sorted(terms) and abs(handed - speed).max() > 0.1
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/coefficients.py"
