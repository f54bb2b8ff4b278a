#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyuff 2.5.8: the times of an encoder are stretched by the jitter of their first step, or kept to six digits.
#
# A universal file (data set 58) has its times as a start and a step, or one by one. Expected: an error where the times
# do not fit, as here, where the first of 1000 steps of 1 ms is 2 % too long. What happens: the step is that of the
# first two samples, and the second that was recorded is read as 1.02 s. One by one they are right at first, but the
# format gives them six digits: after 100 s, a thousand samples at 10 kHz have 101 different times, after 1000 s 11.
# Nothing warns of either.
# For us: begin the times at 0 and give them one by one up to 10 s; keep longer recordings in another format.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyuff==2.5.8 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
import pyuff

EVEN, UNEVEN, TIME_RESPONSE = 1, 0, 1


def read(times, spacing):
    """Return the times of a file with a shaft at 5 rad/s."""
    channel = pyuff.prepare_58(
        func_type=TIME_RESPONSE, rsp_node=1, rsp_dir=1, ref_node=1, ref_dir=1, id1='shaft',
        data=5 * times, x=times, abscissa_spacing=spacing, orddenom_spec_data_type=0,
    )  # fmt: skip
    pyuff.UFF('shaft.uff').write_sets(channel, 'overwrite')
    return pyuff.UFF('shaft.uff').read_sets()['x']


jitter = np.arange(1001) * 1e-3
jitter[1] += 2e-5
ends = [float(read(jitter, spacing)[-1]) for spacing in (EVEN, UNEVEN)]
print('end of 1 s: even', ends[0], 'uneven', ends[1])
assert np.allclose(ends, [1.02, 1.0])
for begin, expected in ((0, 1000), (100, 101), (1000, 11)):
    different = len(set(read(begin + np.arange(1000) * 1e-4, UNEVEN)))
    print('from', begin, 's on', different, 'different times of 1000')
    assert different == expected
PYTHON
