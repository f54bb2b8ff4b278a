#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# stonesoup 1.9.1: half way between two readings of a shaft at 178° and -178°, it is interpolated at 0°.
#
# A state may have an angle, of the type Bearing, whose differences and means go over ±180° as they should.
# Expected of interpolate_state_mutable_sequence() for a shaft that turns at 4°/s, with readings of type Bearing at 178°
# and, 1 s later, at -178°: an angle of 180° after 0.5 s. What happens: the angles are interpolated as plain numbers, so
# that the shaft is at 0° then, and at 89° after 0.25 s, as if it turned back by 356°. The results are no longer of the
# type Bearing. The mean of the same two states, weighted equally, is at 180°, and their difference is 4°.
# For us: unwrap the angles of a record before it is interpolated, as numpy.unwrap() does, and wrap them afterwards.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check stonesoup==1.9.1 numpy==2.4.6 scipy==1.17.1
cat > "$folder/bearing.py" <<'PYTHON'
import datetime

import numpy as np
from stonesoup.functions.interpolate import interpolate_state_mutable_sequence
from stonesoup.types.angle import Bearing
from stonesoup.types.array import StateVector, StateVectors
from stonesoup.types.state import ParticleState, State, StateMutableSequence

start = datetime.datetime(2026, 1, 1)
readings = [StateVector([Bearing(np.deg2rad(angle))]) for angle in (178, -178)]
states = [State(reading, start + datetime.timedelta(seconds=i)) for i, reading in enumerate(readings)]
shaft = StateMutableSequence(states)

difference = np.rad2deg(float(readings[1][0] - readings[0][0]))
mean = np.rad2deg(float(ParticleState(StateVectors(readings), weight=np.array([0.5, 0.5])).mean[0]))
print(f'difference {difference:.6g}°, mean {mean:.6g}°')
assert np.isclose(difference, 4) and np.isclose(abs(mean), 180)

for seconds, expected in (0, 178), (0.25, 89), (0.5, 0), (0.75, -89), (1, -178):
    found = interpolate_state_mutable_sequence(shaft, start + datetime.timedelta(seconds=seconds)).state_vector[0]
    print(f'after {seconds} s: {np.rad2deg(float(found)):.6g}°, {type(found).__name__}')
    assert np.isclose(np.rad2deg(float(found)), expected, atol=1e-6)
    assert isinstance(found, Bearing) == (seconds in (0, 1))
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/bearing.py"
