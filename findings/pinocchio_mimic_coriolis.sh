#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: of an arm whose wrist is geared to its shoulder, computeCoriolisMatrix() gives 2.63 N·m instead of
# 1.97 N·m.
#
# Three links turn about parallel axes without gravity; the wrist mimics the shoulder with -1, as in a palletizer, and
# the model is read with mimic=True. At 1 rad/s of the shoulder and -1 rad/s of the elbow, expected of C(q, v) v: 1.97
# and 2.93 N·m, as rnea() of the same model without acceleration gives, and as three free joints give that are coupled
# by hand. What happens: 2.63 and 2.63 N·m. The derivative of the matrix of masses less 2 C is not skew-symmetric
# either, on which controllers rely. Algorithms such as aba() and computeRNEADerivatives() refuse a model with a mimic
# by an error; this one does not. rnea(), crba() and the Jacobian of the hand are right.
# For us: take rnea() without acceleration, less that without speed, or couple free joints by a matrix of the ratios.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pinocchio

LINK = """<link name="{}"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
  <inertia ixx="0.01" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/><origin xyz="{} 0 0"/>
  <axis xyz="0 0 1"/><limit effort="100" velocity="10" lower="-9" upper="9"/>{}</joint>"""
LINKS = ''.join(LINK.format(name) for name in ('upper', 'fore', 'hand'))
SHOULDER, ELBOW = JOINT.format('j1', 'base', 'upper', 0, ''), JOINT.format('j2', 'upper', 'fore', 1, '')
Q, V = np.array([0.3, 0.8]), np.array([1.0, -1.0])


def arm(mimic):
    wrist = JOINT.format('j3', 'fore', 'hand', 1, mimic)
    text = f'<robot name="arm"><link name="base"/>{LINKS}{SHOULDER}{ELBOW}{wrist}</robot>'
    model = pinocchio.buildModelFromXML(text, mimic=True)
    model.gravity.setZero()
    return model, model.createData()


def masses(position):
    return np.array(pinocchio.crba(*geared, position))


geared, free = arm('<mimic joint="j1" multiplier="-1"/>'), arm('')
ratios = np.array([[1, 0], [0, 1], [-1, 0]])
matrix = pinocchio.computeCoriolisMatrix(*geared, Q, V)
torque = pinocchio.rnea(*geared, Q, V, np.zeros(2))
coupled = ratios.T @ pinocchio.computeCoriolisMatrix(*free, ratios @ Q, ratios @ V) @ ratios @ V
print('C v', matrix @ V, 'rnea', torque, 'free joints', coupled, 'N·m')
assert np.allclose(torque, coupled) and np.allclose(coupled, (1.96816, 2.92701), atol=1e-5)
assert np.allclose(matrix @ V, (2.63149, 2.63149), atol=1e-5)
passive = (masses(Q + 1e-6 * V) - masses(Q - 1e-6 * V)) / 2e-6 - 2 * matrix
print('derivative of the masses less 2 C', passive.tolist())
assert np.abs(passive + passive.T).max() > 0.1
assert np.allclose(masses(Q), ratios.T @ pinocchio.crba(*free, ratios @ Q) @ ratios)
hand = pinocchio.computeJointJacobian(*free, ratios @ Q, 3) @ ratios
assert np.allclose(pinocchio.computeJointJacobian(*geared, Q, 3), hand)
for refusing in pinocchio.aba, pinocchio.computeRNEADerivatives:
    try:
        refusing(*geared, Q, V, np.zeros(2))
    except RuntimeError as error:
        print(refusing.__name__, error)
    else:
        raise AssertionError('a model with a mimic is not refused')
PYTHON
