#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gearpy 1.3.1: a gear whose load drives it gives out more power than it takes in.
#
# A motor turns a reduction of 10 with an efficiency of 0.8. A load of 5 N·m against the motion needs 0.625 N·m at the
# motor, which is right: 5 / (10·0.8). The same load in the direction of the motion, such as a weight that sinks, gives
# the motor -0.625 N·m as well, where friction leaves 5·0.8 / 10 = 0.4 N·m. So the lossy gear makes a quarter more power
# than the load gives, and the speed of a sinking weight and the torque of a brake come out too high.
# For us: gearpy answers for loads against the motion; take no torque of braking or back-driving from it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gearpy==1.3.1
timeout 90 "$folder/venv/bin/python" - <<'PYTHON'
from gearpy.mechanical_objects import DCMotor, SpurGear
from gearpy.powertrain import Powertrain
from gearpy.solver import Solver
from gearpy.units import AngularPosition, AngularSpeed, InertiaMoment, TimeInterval, Torque
from gearpy.utils import add_fixed_joint, add_gear_mating


def steady_state(load):
    motor = DCMotor(
        name='motor',
        no_load_speed=AngularSpeed(1000, 'rad/s'),
        maximum_torque=Torque(1, 'Nm'),
        inertia_moment=InertiaMoment(1e-4, 'kgm^2'),
    )
    inertia = InertiaMoment(1e-12, 'kgm^2')
    pinion = SpurGear(name='pinion', n_teeth=10, inertia_moment=inertia)
    wheel = SpurGear(name='wheel', n_teeth=100, inertia_moment=inertia)
    add_fixed_joint(master=motor, slave=pinion)
    add_gear_mating(master=pinion, slave=wheel, efficiency=0.8)
    wheel.external_torque = lambda time, angular_position, angular_speed: Torque(load, 'Nm')
    wheel.angular_position = AngularPosition(0, 'rad')
    wheel.angular_speed = AngularSpeed(0, 'rad/s')
    solver = Solver(powertrain=Powertrain(motor=motor))
    solver.run(time_discretization=TimeInterval(0.001, 'sec'), simulation_time=TimeInterval(3, 'sec'))
    speed, torque = (motor.time_variables[name][-1].value for name in ('angular speed', 'driving torque'))
    return torque, torque * speed, load * wheel.time_variables['angular speed'][-1].value


for load, expected in ((5, 0.625), (-5, -0.625)):
    torque, motor_power, load_power = steady_state(load)
    print('load', load, 'N·m, motor', torque, 'N·m: powers', motor_power, 'W and', load_power, 'W')
    assert abs(torque - expected) < 1e-6
    assert abs(motor_power / load_power - 1.25) < 1e-6
PYTHON
