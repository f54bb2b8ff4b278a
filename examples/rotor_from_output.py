# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Print the rotor states that a driver has to reach for a swing of the output, and check them."""

from argparse import ArgumentParser

import numpy as np

from gear_kinematics.kinematics import Branch, Mechanism, rotor_state_for, solve

ArgumentParser(description=__doc__).parse_args()
actuator = Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=np.pi)))
direction, zero = -1, 0.25  # rotor_direction and rotor_zero of the node: rad at the output's zero
time = np.linspace(0.0, 1.0, 5)  # s
angle = np.pi / 6.0 * (1.0 - np.cos(np.pi * time))  # rad: from 0° to 60° in a second
velocity = np.pi**2 / 6.0 * np.sin(np.pi * time)  # rad/s
effort = np.full(5, 38.0)  # N·m

rotor = rotor_state_for(actuator, angle, velocity, effort)
position = zero + direction * rotor.position  # of the driver
for t, *state in zip(
    time, position, direction * rotor.velocity, direction * rotor.effort, strict=True
):
    print('{:.2f} s: {:.4f} rad, {:.4f} rad/s, {:.2f} N·m'.format(t, *state))

state = solve(actuator, rotor.angle, rotor_turns=rotor.turns)
error = np.abs(state.output_angle - angle).max()
print(f'back at the output within {error:.0e} rad')
