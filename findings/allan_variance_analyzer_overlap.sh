#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# allan-variance-analyzer 1.0.4: with its default overlap, a gyroscope's noise of 10 mrad/s in 1 s is found as 1 mrad/s,
# and one of 3.2 mrad/s in 10 s as 0.1 mrad/s.
#
# The Allan deviation of white noise falls with the square root of the time: samples with 0.1 rad/s at 100 Hz have
# 0.1 / sqrt(100) = 10 mrad/s in 1 s, from the differences of averages that follow each other. What happens in
# compute_allan_variances(), whose overlap is 0.5 by default: the overlap is turned into a number of samples, but
# compute_bin_averages() takes it as a fraction, so that each average begins one sample after the one before, and the
# differences are those of two samples alone, divided by their number. So the deviation falls with the time itself, and
# the noise density at 1 s is a tenth of the right one. Nothing warns. The class AllanVarianceAnalyzer has an overlap of
# 0 by default, with which the averages follow each other and the deviations are right.
# For us: give overlap=0 wherever the library takes an overlap.
#
# Exit code 0: still so. Installs the version into a temporary folder, and loads its statistics without its plots.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 tqdm==4.67.1
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps allan-variance-analyzer==1.0.4
cd "$folder"/venv/lib/python3*/site-packages/allan_variance_analyzer
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import importlib.util

import numpy as np

spec = importlib.util.spec_from_file_location('allan_variance_analyzer.statistics', 'statistics.py')
statistics = importlib.util.module_from_spec(spec)
spec.loader.exec_module(statistics)

RATE, NOISE = 100, 0.1
data = np.random.default_rng(1).normal(0.0, NOISE, (200_000, 6))
times = np.array([0.1, 1.0, 10.0])
right = NOISE / np.sqrt(times * RATE)


def deviations(**options):
    """Return the deviation at each time, averaged over the six axes."""
    return np.sqrt(statistics.compute_allan_variances(data, times, RATE, **options).mean(axis=1))


found, apart = deviations(), deviations(overlap=0)
for time, default, separate, expected in zip(times, found, apart, right):
    print(f'{time} s: {1e3 * default:.2f} mrad/s, without overlap {1e3 * separate:.2f}; {1e3 * expected:.2f} is right')
assert np.allclose(apart, right, rtol=0.1)
assert np.allclose(found, NOISE / (times * RATE), rtol=0.1)
PYTHON
