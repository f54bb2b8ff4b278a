#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ROSS 2.3.0: the unbalance of a pinion that its wheel drives at 30 turns a second shakes it 10 times a second, not 30.
#
# A wheel of 60 teeth turns at 10 turns a second and drives a pinion of 20, which by check_speed() of the MultiRotor
# turns at -30. Expected of unbalance_force_over_time() for an unbalance of 1 g·m at the pinion: a force of 35.5 N that
# turns backwards 30 times a second. What happens: it has 35.5 N, by the speed of the pinion, but its angle is that of
# the wheel, so that it turns forwards, 10 times a second. The run_time_response() to it has one peak, at 10 Hz, where a
# sensor at the gearbox finds 30 Hz, so that an order analysis blames the wheel. Nothing warns. On the wheel itself, and
# on a single rotor, both are right.
# For us: build the force on a driven shaft yourself, with the angle -ratio * speed * t.
#
# Exit code 0: still so. Installs the versions into a temporary folder, without the libraries for its seals and its
# magnetic bearings, of which there are none here.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 plotly==5.24.1 \
    pint==0.25.3 pandas==3.0.1 toml==0.10.2 methodtools==0.4.7 numba==0.66.0 prettytable==3.18.0
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps ross-rotordynamics==2.3.0
cd "$folder"
touch ccp.py
echo 'class TransferFunction: s = 1' > control.py
timeout 200 venv/bin/python - <<'PYTHON'
import sys

sys.path.insert(0, '.')
import numpy as np
import ross

STEP, TURNS = 1 / 1000, 10


def rotor(teeth):
    """Return a shaft of 0.8 m between two bearings with a gear of module 4 mm in its middle."""
    steel = ross.materials.steel
    shaft = [ross.ShaftElement(L=0.2, idl=0, odl=0.05, material=steel) for _ in range(4)]
    gear = ross.GearElement(n=2, m=5, Id=0.02, Ip=0.04, n_teeth=teeth, pitch_diameter=teeth * 0.004)
    bearings = [ross.BearingElement(n=end, kxx=1e8, kyy=1e8, cxx=1e4, cyy=1e4) for end in (0, 4)]
    return ross.Rotor(shaft, [gear], bearings)


gearbox = ross.MultiRotor(rotor(60), rotor(20), coupled_nodes=(2, 2), gear_mesh_stiffness=1e8)
times = np.arange(0, 1, STEP)
speed = 2 * np.pi * TURNS
found = {}
for name, node in (('wheel', 2), ('pinion', gearbox.driven_nodes[2])):
    shaft = gearbox.check_speed(node, speed) / (2 * np.pi)
    force = gearbox.unbalance_force_over_time([node], [1e-3], [0.0], speed, times)
    x, y = force[node * gearbox.number_dof : node * gearbox.number_dof + 2]
    turns = np.unwrap(np.arctan2(y, x))[-1] / (2 * np.pi) / times[-1]
    shaken = gearbox.run_time_response(speed, force.T, times).yout[:, node * gearbox.number_dof]
    spectrum = np.abs(np.fft.rfft(shaken - shaken.mean()))
    peak = np.fft.rfftfreq(len(times), STEP)[spectrum.argmax()]
    found[name] = [round(float(value), 1) for value in (shaft, x.max(), turns, peak)]
    print('{}: {} turns/s, a force of {} N at {} turns/s, shaken at {} Hz'.format(name, *found[name]))
assert found == {'wheel': [10, 3.9, 10, 10], 'pinion': [-30, 35.5, 10, 10]}, found
PYTHON
