#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# filterpy 2.0.0: of a joint at 100 rad that each of two models knows to 1 mrad, MMAEFilterBank says ±71 rad.
#
# A bank of two equal Kalman filters of angle and speed reads an encoder with a noise of 1 mrad. As both have the same
# estimate, the bank has to have that estimate and its covariance, as IMMEstimator has. What happens: the estimate is
# right, but P grows with the angle: ±0.07 rad at 0 rad, ±0.6 rad at 1 rad and ±71 rad at 100 rad, instead of ±1 mrad.
# The spread of the models is taken about one number of the state, the angle for the first model and the speed for the
# second, instead of about the whole state. Of three models the third is left out of P, since the state has two numbers.
# So a gate by P lets each reading pass. Nothing warns.
# For us: compute the covariance from the filters and p of the bank, or take IMMEstimator.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check filterpy==2.0.0 numpy==2.4.6 scipy==1.17.1
timeout 100 "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import numpy as np
from filterpy.common import Q_discrete_white_noise
from filterpy.kalman import IMMEstimator, KalmanFilter, MMAEFilterBank

STEP, NOISE = 0.01, 0.001


def model(angle, uncertainty=0.01):
    joint = KalmanFilter(2, 1)
    joint.x = np.array([[angle], [0.0]])
    joint.F, joint.H = np.array([[1, STEP], [0, 1]]), np.array([[1.0, 0]])
    joint.P, joint.Q = np.eye(2) * uncertainty**2, Q_discrete_white_noise(2, STEP, 20.0**2)
    joint.R = np.array([[NOISE**2]])
    return joint


def bank_of(models):
    share = [1 / len(models)] * len(models)
    return MMAEFilterBank(models, share, 2, H=models[0].H)


def uncertainties(angle):
    """Return what one model, the bank and an IMMEstimator of two such models say after 200 readings, for the angle."""
    one, bank = model(angle), bank_of([model(angle), model(angle)])
    mixed = IMMEstimator([model(angle), model(angle)], (0.5, 0.5), np.array([[0.97, 0.03], [0.03, 0.97]]))
    random = np.random.default_rng(0)
    for reading in angle + random.normal(0, NOISE, 200):
        for joint in (one, bank, mixed):
            joint.predict()
            joint.update(np.array([[reading]]))
    assert np.allclose(bank.x, one.x) and np.allclose(mixed.x, one.x) and np.allclose(mixed.P, one.P)
    found = [float(np.sqrt(joint.P[0, 0])) for joint in (one, bank, mixed)]
    print('at', angle, 'rad: one model, bank and IMM say ±', found, 'rad')
    return found


for angle, bank in ((0.0, 0.066), (1.0, 0.64), (100.0, 70.6)):
    assert np.allclose(uncertainties(angle), (0.00092, bank, 0.00092), rtol=0.05)

three = []
for uncertainty in (0.01, 10.0):  # of the third model
    bank = bank_of([model(0.0), model(0.0), model(0.0, uncertainty)])
    bank.p = np.array([0.0, 0.0, 1.0])
    bank.predict()
    bank.update(np.array([[0.0]]))
    three.append(bank.P[0, 0])
print('P of the angle with all of the probability at the third model', three, 'its own', bank.filters[2].P[0, 0])
assert three == [0, 0] and bank.filters[2].P[0, 0] > 0
PYTHON
