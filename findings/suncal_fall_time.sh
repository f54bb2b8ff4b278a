#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# suncal 1.7.1: a torque that rises first has a fall time of NaN instead of 3.2 s, and of -3300 s if it is noisy.
#
# A torque rises from 0 to 3 N·m within 1 s, holds for 2 s and falls within 4 s, read each 0.1 s. The features of a
# waveform are its rise time, fall time and crossings of a threshold, with uncertainties; a clip for each is optional.
# Expected: from 90 % to 10 % it falls in 3.2 s, and it falls through 1.5 N·m at 6 s. What happens: the fall is searched
# from the first reading on, which is already below, and the reading before that one is taken to be the last one. So the
# fall time is NaN, and with a noise of 0.02 N·m it is -3300 s; the fall through 1.5 N·m is at inf or 1986 s.
# Rise time, width and maximum are right. And the interval of a minimum is given from its upper to its lower end.
# For us: give the fall a clip that begins at the maximum, with which it is right, and sort the interval of a minimum.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check suncal==1.7.1 numpy==2.4.6 scipy==1.17.1
cat > "$folder/fall.py" <<'PYTHON'
import numpy as np
from suncal.curvefit.curvefit_model import CurveFit, WaveCalc
from suncal.curvefit.uncertarray import Array

times = np.linspace(0, 10, 101)
torque = np.interp(times, [0, 1, 2, 4, 8, 10], [0, 0, 3, 3, 0, 0])


def features(torque, uncertainty):
    fit = CurveFit(Array(times, torque, uy=np.full(len(times), uncertainty)), 'line')
    fit.wavecalcs = {
        'rise': WaveCalc('rise'),
        'fall': WaveCalc('fall'),
        'clipped fall': WaveCalc('fall', clip=(3, 10)),
        'falls through 1.5': WaveCalc('thresh_fall', thresh=1.5),
        'width': WaveCalc('fwhm'),
        'maximum': WaveCalc('max'),
        'minimum': WaveCalc('min'),
    }
    with np.errstate(all='ignore'):
        found = {name: feature.uncert for name, feature in fit.calculate_wave().features.items()}
    for name, feature in found.items():
        print(name, f'{feature.nominal:.4g}, 95 % from {feature.low:.4g} to {feature.high:.4g}')
    return found


def fails(feature, right):
    return not abs(feature.nominal - right) < 100


exact = features(torque, 0.001)
noisy = features(torque + np.random.default_rng(0).normal(0, 0.02, len(times)), 0.02)
for found in exact, noisy:
    assert abs(found['rise'].nominal - 0.8) < 0.05 and abs(found['width'].nominal - 4.5) < 0.05
    assert abs(found['clipped fall'].nominal - 3.2) < 0.2
    assert fails(found['fall'], 3.2) and fails(found['falls through 1.5'], 6)
    assert found['minimum'].low > found['minimum'].high and found['maximum'].low < found['maximum'].high
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/fall.py"
