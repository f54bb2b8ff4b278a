# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Print the travel of the gear's slides during a turn of the rotor, computed in one batch."""

from argparse import ArgumentParser

import numpy as np

from gear_kinematics.kinematics import Branch, Mechanism, solve

ArgumentParser(description=__doc__).parse_args()
actuator = Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=np.pi)))
angle = np.linspace(0.0, 2.0 * np.pi, 10_001)  # rad
at = solve(actuator, rotor_angle=angle, rotor_velocity=314.0)  # rad/s, for all angles
for number, branch in enumerate(actuator.branches):
    travel = np.ptp(at.satellite_slide[:, number])
    fastest = np.abs(at.satellite_slide_velocity[:, number]).max()
    print(f'slide of satellite {branch.name}: {1e3 * travel:.2f} mm, up to {fastest:.3f} m/s')
