#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# hampel 1.0.2: a jump in the first or last half window of a recording is not an outlier, and one count of a still
# encoder is.
#
# Expected: of three equal jumps of an angle, one in the middle and one each next to the ends, all are found, as the
# window is cut short at the ends, or none that cannot be judged is called sound. What happens: samples in the first and
# last half window are never judged and come back as they are, so that the newest sample of a running recording never
# is. All values come back in 32 bits: of counts beyond 2^24 each second one is another one. Where more than half of a
# window is equal, as at an encoder that stands, the deviation is 0 and a step of one count is an outlier, however large
# n_sigma is.
# For us: repeat the end samples half a window before and after; compare with the resolution too.
#
# Exit code 0: still so. Needs a C compiler; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check hampel==1.0.2 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from hampel import hampel

angle = np.random.default_rng(0).normal(0, 0.1, 30)
angle[[1, 15, 28]] += 50
for window in (5, 7):
    result = hampel(angle, window_size=window)
    print('window', window, 'outliers', list(result.outlier_indices), 'kept', result.filtered_data[[1, 28]])
    assert list(result.outlier_indices) == [15]
    assert result.filtered_data[1] > 49 and result.filtered_data[28] > 49
padded = hampel(np.pad(angle, 3, mode='edge'), window_size=7)
print('padded', [index - 3 for index in padded.outlier_indices])
assert [index - 3 for index in padded.outlier_indices] == [1, 15, 28]
counts = np.full(40, 1000.0)
counts[20] = 1001
found = [list(hampel(counts, window_size=5, n_sigma=float(sigma)).outlier_indices) for sigma in (3, 1000)]
turning = 2.0**24 + np.arange(20)
changed = hampel(turning, window_size=5).filtered_data - turning
print('outliers of one count', found, 'changes of counts beyond 2^24', changed[:6])
assert np.count_nonzero(changed) == 10
assert found == [[20], [20]]
PYTHON
