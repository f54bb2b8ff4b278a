#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# hebi-py 2.16.1: a trajectory goes through other waypoints if their array is a slice of another one, or read-only.
#
# A rotor and an output are to pass (0, 0), (1, 5) and (2, 7) rad at 0, 1 and 2 s. Expected of create_trajectory(): the
# trajectory passes them, whatever the memory of the NumPy array with these numbers looks like. What happens: it does so
# for an array of its own. As every second column of a longer array, positions[:, ::2], the same numbers are passed as
# (0, 9), (1, 9) and (2, 0) rad; from a read-only array, as (0, 1), (2, 0) and (5, 7) rad. Of waypoints that are
# given as rows and transposed, the positions are right, but the velocities of a separate array are mixed up: 9.4 rad/s
# for 0.3 rad/s. Of the transposed ones, estimate_segment_times() gives 3.5 s and 5.5 s instead of 5.5 s and 2.5 s.
# There is no error. The addresses of the arrays are handed to its library without their strides; one flag, that of the
# positions, decides for all of them whether they lie in rows or in columns. And `n_fabian`, a keyword in the signature
# of estimate_segment_times(), has no effect; fabian_constant, in its docstring, has one.
# For us: give numpy.array(…, dtype=float, order='C') of each array, a copy of its own, and check the waypoints by
# get_state().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check hebi-py==2.16.1 numpy==1.26.4
cat > "$folder/waypoints.py" <<'PYTHON'
import numpy as np
from hebi.trajectory import TimeEstimationMethod, create_trajectory, estimate_segment_times

TIMES = np.array([0.0, 1.0, 2.0])
WAYPOINTS = np.array([[0.0, 0.0], [1.0, 5.0], [2.0, 7.0]])  # a row for each
SPEEDS = np.array([[0.1, np.nan, 0.2], [0.3, np.nan, 0.4]])  # a row for each joint


def passed(name, positions, speeds=None):
    """Return the positions at the times of the waypoints, and the speeds at the first and the last one."""
    assert np.array_equal(positions, WAYPOINTS.T)
    states = [create_trajectory(TIMES, positions, speeds).get_state(time) for time in TIMES]
    found = [state[0].round(3).tolist() for state in states], [states[end][1].round(3).tolist() for end in (0, -1)]
    print(name, 'positions', found[0], 'speeds', found[1])
    return found


right = [[0, 0], [1, 5], [2, 7]]
own = np.array(WAYPOINTS.T, order='C')
assert passed('own', own, SPEEDS) == (right, [[0.1, 0.3], [0.2, 0.4]])
assert passed('transposed', WAYPOINTS.T) == (right, [[0, 0], [0, 0]])
assert passed('transposed', WAYPOINTS.T, SPEEDS) == (right, [[0.1, 9.355], [2.02, 0.4]])
longer = np.array([[0.0, 9.0, 1.0, 9.0, 2.0], [0.0, 9.0, 5.0, 9.0, 7.0]])
assert passed('every second', longer[:, ::2])[0] == [[0, 9], [1, 9], [2, 0]]
read_only = own.copy()
read_only.flags.writeable = False
assert passed('read-only', read_only)[0] == [[0, 1], [2, 0], [5, 7]]

method = TimeEstimationMethod.VelocityRamp
times = [estimate_segment_times(method, given, [1, 1], [2, 2]).tolist() for given in (own, WAYPOINTS.T)]
print('segments', times)
assert times == [[5.5, 2.5], [3.5, 5.5]]
method = TimeEstimationMethod.NFabian
by_default, by_signature, by_other = (
    estimate_segment_times(method, own, [1, 1], [2, 2], **given).round(3).tolist()
    for given in ({}, {'n_fabian': 3.0}, {'fabian_constant': 3.0})
)
print('by default', by_default, 'n_fabian=3', by_signature, 'fabian_constant=3', by_other)
assert by_signature == by_default == [10.001, 4.238] and by_other == [10.001, 4.11]
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/waypoints.py" 2>&1
