# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Print the output angle and the pose of each body at one rotor angle."""

from argparse import ArgumentParser
from math import degrees, pi

from gear_kinematics.kinematics import Branch, Mechanism, solve

ArgumentParser(description=__doc__).parse_args()
actuator = Mechanism(
    ring_teeth=80,
    satellite_teeth=76,
    eccentricity=0.0011,  # m
    branches=(Branch('a'), Branch('b', cam_phase=pi, axial_position=-0.04)),
)
at = solve(actuator, rotor_angle=2.5)  # rad
print(f'output: {degrees(at.output_angle):.4f}°, by the ratio {actuator.gear_ratio}')
for branch, satellite, oldham in zip(
    actuator.branches, at.satellite_centre, at.oldham_centre, strict=True
):
    print(f'satellite {branch.name}: at {1e3 * satellite} mm')
    print(f'Oldham coupling {branch.name}: at {1e3 * oldham} mm')
