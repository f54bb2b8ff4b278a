#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MultibodyPy 0.0.5: of a sliding friction of 100 N, one of its models makes 300 N, and another one 0.1 N.
#
# A contact with a normal force of 1000 N and a coefficient of friction of 0.1 slides at 0.2 m/s, and `vd`, at which
# sliding begins, is 0.1 m/s. Expected by Coulomb's law of each model, as its other three have it: 0.1 · 1000 N = 100 N,
# and 0 N at rest. What happens: SigmoidFriction makes 300 N, and 200 N at rest, as it adds the coefficient where it
# should subtract it. BilinearFriction, with 0.1 for rest and sliding, makes 0.1 N for any normal force, as it forgets
# to multiply by it beyond `vs`; below, it is right.
# For us: take HyperbolicTangensFriction or StribeckFriction, and compare a friction with coefficient times load.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check MultibodyPy==0.0.5
cd "$folder"
venv/bin/python - <<'PYTHON'
import numpy
from MultibodyPy.forces import (BilinearFriction, HyperbolicTangensFriction, SigmoidFriction, SimpleFriction,
                                StribeckFriction)

normal, coefficient = 1000.0, 0.1
sliding, still = numpy.array([0.2, 0.0, 0.0]), numpy.zeros(3)
models = {
    'simple': SimpleFriction(coefficient, 0.1),
    'tanh': HyperbolicTangensFriction(coefficient, 0.1),
    'Stribeck': StribeckFriction(coefficient, 0.01, coefficient, 0.1),
    'sigmoid': SigmoidFriction(coefficient, 0.1),
    'bilinear': BilinearFriction(coefficient, 0.1, coefficient, 0.01),
}
found = {}
for name, model in models.items():
    found[name] = [float(model.get_friction_force(normal, speed)) for speed in (still, sliding)]
    print(f'{name}: {found[name][0]:.2f} N at rest, {found[name][1]:.2f} N at 0.2 m/s; expected 0 N and 100 N')
for name in ('simple', 'tanh', 'Stribeck'):
    assert found[name][0] == 0.0 and abs(found[name][1] - 100.0) < 0.1
assert found['sigmoid'][0] == 200.0 and abs(found['sigmoid'][1] - 300.0) < 0.1
assert found['bilinear'][0] == 0.0 and abs(found['bilinear'][1] - 0.1) < 1e-9
assert float(models['bilinear'].get_friction_force(10 * normal, sliding)) == found['bilinear'][1]
PYTHON
