#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gym-electric-motor 3.0.3: a shaft that is to stand still turns at 100 rad/s if another load did so before.
#
# ConstantSpeedLoad(omega_fixed=0) blocks the shaft of a simulated motor, as for a test of its current. Expected: 0
# rad/s. What happens: 0 rad/s, but 100 rad/s once a ConstantSpeedLoad(omega_fixed=100) has been made in the same
# program, for another motor: the first speed is kept in a dictionary that all loads share. So is the random first speed
# of a PolynomialStaticLoad with random_init: each later load without it begins at the same speed instead of 0. And a
# load of 0.1 kg·m² that is used for three motors one after the other has the inertia of three rotors at the third, as
# the rotor's is added to it each time: 0.175 instead of 0.125 kg·m².
# For us: give each load its own load_initializer={'states': {'omega': ...}, 'interval': None, 'random_init': None,
# 'random_params': (None, None)}, and make a load for each motor.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gym-electric-motor==3.0.3 numpy==2.4.6
MPLBACKEND=Agg timeout 100 "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import gym_electric_motor as gem
from gym_electric_motor.physical_systems.mechanical_loads import ConstantSpeedLoad, PolynomialStaticLoad


def started(load):
    """Return the first speed of a permanently excited DC motor with the load, in rad/s, and its inertia in kg·m²."""
    environment = gem.make('Cont-CC-PermExDc-v0', load=load)
    (state, _), _ = environment.reset()
    system = environment.unwrapped.physical_system
    index = system.state_positions['omega']
    return float(state[index] * system.limits[index]), float(load.j_total)


def show(what, value):
    print(what, value)
    return value


assert show('blocked shaft', started(ConstantSpeedLoad(omega_fixed=0))[0]) == 0
assert show('shaft at 100 rad/s', started(ConstantSpeedLoad(omega_fixed=100))[0]) == 100
assert show('blocked shaft after it', started(ConstantSpeedLoad(omega_fixed=0))[0]) == 100

assert show('load from standstill', started(PolynomialStaticLoad())[0]) == 0
random = show('load with a random first speed', started(PolynomialStaticLoad(load_initializer={'random_init': 'uniform'}))[0])
assert random != 0
assert show('load from standstill after it', started(PolynomialStaticLoad())[0]) == random

load = PolynomialStaticLoad(load_parameter={'a': 0, 'b': 0, 'c': 0, 'j_load': 0.1})
inertias = show('inertia with three motors', [started(load)[1] for _ in range(3)])
assert all(abs(inertia - right) < 1e-9 for inertia, right in zip(inertias, (0.125, 0.15, 0.175), strict=True))
PYTHON
