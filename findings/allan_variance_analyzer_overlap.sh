#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# allan-variance-analyzer 1.0.4: with an overlap of 0.5, an IMU is found to have a twentieth of its noise.
#
# Samples of white noise with 0.1 m/s² and 0.1 rad/s at 100 Hz have densities of 0.1 / sqrt(100) = 0.01 m/s²/√Hz and
# 0.01 rad/s/√Hz. Expected in imu.yaml, which Kalibr reads: these, whatever the overlap of the averages is. What happens
# in AllanVarianceAnalyzer with overlap=0.5, the default of its compute_allan_variances(): the overlap is turned into
# a number of samples, which is then taken for a fraction, so that each average begins one sample after the one before.
# Their differences are those of two samples alone, and both densities are 0.0005. Nothing warns. And each analysis
# turns the speeds in the array that it is given into degrees: the same array, analysed again, has 57 times the noise.
# For us: leave the overlap at 0, the default of the class, and give each analysis a copy.
#
# Exit code 0: still so. Installs the versions into a temporary folder, without attrdict and pyaml, which are not used.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check \
    numpy==2.4.6 scipy==1.17.1 tqdm==4.67.1 loguru==0.7.3 matplotlib==3.11.2 PyYAML==6.0.4
venv/bin/pip install --quiet --disable-pip-version-check --no-deps allan-variance-analyzer==1.0.4
MPLBACKEND=Agg timeout 100 venv/bin/python - 2> progress.log <<'PYTHON' || { cat progress.log; exit 1; }
import contextlib
import io
from pathlib import Path

import numpy as np
import yaml
from allan_variance_analyzer import AllanVarianceAnalyzer

NOISE, RATE, RIGHT = 0.1, 100, 0.01
Path('sensor.yaml').write_text(f'imu_rate: {RATE}\nmeasure_rate: {RATE}\n')
record = np.random.default_rng(1).normal(0.0, NOISE, (40_000, 6))


def densities(data, overlap):
    """Return the noise densities of the accelerometer and of the gyroscope in imu.yaml."""
    with contextlib.redirect_stdout(io.StringIO()):
        AllanVarianceAnalyzer('sensor.yaml', '.', overlap=overlap, period_max=20)(data)
    found = yaml.safe_load(Path('imu.yaml').read_text())
    return found['accelerometer_noise_density'], found['gyroscope_noise_density']


apart, half = densities(record.copy(), 0), densities(record.copy(), 0.5)
used = record.copy()
densities(used, 0)
again = densities(used, 0)
print('without overlap', apart, 'with half an overlap', half, 'the same array again', again)
assert np.allclose(apart, RIGHT, rtol=0.15)
assert np.allclose(half, RIGHT / 19.4, rtol=0.05)
assert np.allclose((again[0], again[1]), (apart[0], np.degrees(apart[1])))
PYTHON
