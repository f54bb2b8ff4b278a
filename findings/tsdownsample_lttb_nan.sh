#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tsdownsample 0.1.5.1: one NaN hides the jump of an output near it from LTTB, which is documented to leave NaN out.
#
# An output that stands still but for one sample of 5 mrad, 1000 samples, of which another one, number 410, is NaN.
# Expected of LTTBDownsampler with 20 points, which the documentation lists under "Omit NaNs": the 5 mrad, as without
# the NaN. What happens: the NaN is one of the 20 points, and of the parts before and after its own, only the first
# sample is taken, because no area is greater than NaN. A jump at 164 of the 165 other samples from 334 to 499 is not
# shown. MinMaxLTTBDownsampler, M4Downsampler and MinMaxDownsampler show each.
# For us: use MinMaxLTTBDownsampler, as plotly-resampler does, or take the NaN out first.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tsdownsample==0.1.5.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import tsdownsample

FAULT = 410


def hidden(downsampler, fault):
    samples = []
    for jump in range(1000):
        angles = np.zeros(1000)
        angles[jump] = 5e-3
        if fault:
            angles[FAULT] = np.nan
        shown = angles[downsampler.downsample(angles, n_out=20)]
        if jump != FAULT and np.nanmax(shown) == 0:
            samples.append(jump)
        assert np.isnan(shown).any() == (fault and isinstance(downsampler, tsdownsample.LTTBDownsampler))
    return samples


for name in ('MinMaxLTTBDownsampler', 'M4Downsampler', 'MinMaxDownsampler', 'LTTBDownsampler'):
    downsampler = getattr(tsdownsample, name)()
    sound, faulty = hidden(downsampler, False), hidden(downsampler, True)
    print(name, 'hides', len(sound), 'of 999 jumps, with a NaN', len(faulty), faulty[:1], faulty[-1:])
    assert not sound
    if name == 'LTTBDownsampler':
        assert (len(faulty), faulty[0], faulty[-1]) == (164, 334, 499)
    else:
        assert not faulty
PYTHON
