#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sorotraj 1.3.2: a trajectory that is asked for 3.5 s and 0.5 s at once gives the two angles in the opposite order.
#
# A joint goes from 0 to 1 rad in a prefix of 1 s, to 3 rad in 2 s, and back to 0 in a suffix of 1 s. Expected of the
# function of get_traj_function() for the times [3.5, 0.5]: [1.5, 0.5] rad. What happens: [0.5, 1.5], since the values
# of prefix, main part and suffix are put one behind the other, in whatever order the times were. Times of samples that
# came late, or of several joints in one array, get each other's angles; in ascending order all is right. Without a
# suffix the trajectory is to hold its last angle, and does so in an array with earlier times, but for a single time 1
# µs behind the end it raises a TypeError, which ends a loop that asks by the clock.
# For us: ask for one time at a time, and for at most the final time.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    sorotraj==1.3.2 numpy==2.4.6 scipy==1.17.1 matplotlib==3.10.8 pyyaml==6.0.4
cd "$folder"
MPLBACKEND=Agg timeout 100 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
import sorotraj

parts = {'prefix': [[0, 0.0], [1, 1.0]], 'setpoints': [[0, 1.0], [2, 3.0]], 'suffix': [[0, 3.0], [1, 0.0]]}
angle, end = sorotraj.Interpolator(parts).get_traj_function(num_reps=1)
single = [float(angle(time)) for time in (3.5, 0.5)]
both, ordered = (np.ravel(angle(times)).tolist() for times in ([3.5, 0.5], [0.5, 3.5]))
print('3.5 s and 0.5 s one by one', single, 'together', both, 'in ascending order', ordered)
assert end == 4 and np.allclose(single, [1.5, 0.5]) and np.allclose(both, [0.5, 1.5]) and np.allclose(ordered, [0.5, 1.5])

del parts['suffix']
angle, end = sorotraj.Interpolator(parts).get_traj_function(num_reps=1)
print('without a suffix: at the end', float(angle(end)), 'in an array', np.ravel(angle([0.5, end + 1])))
assert float(angle(end)) == 3 and np.allclose(np.ravel(angle([0.5, end + 1])), [0.5, 3])
try:
    angle(end + 1e-6)
except TypeError as error:
    print('1 µs behind the end:', error)
else:
    raise SystemExit(1)
PYTHON
