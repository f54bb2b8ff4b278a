# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameters of the bodies: of each branch, and the masses and inertias for the loads."""

import math
from collections.abc import Iterable, Mapping

from gear_kinematics.parameters.parameter import Parameter

LOADS_PARAMETERS: dict[str, Parameter] = {
    f'loads.{name}': Parameter(f'{what}; 0: none', 0.0, maximum, read_only=True)
    for name, what, maximum in (
        ('satellite_mass', 'Mass of each satellite, kg', 1e6),
        ('satellite_inertia', 'Inertia of each satellite about its axis, kg·m²', 1e6),
        ('coupling_mass', 'Mass of each Oldham coupling, kg', 1e6),
        ('coupling_inertia', 'Inertia of each Oldham coupling about its axis, kg·m²', 1e6),
        ('rotor_inertia', 'Inertia of the rotor about its axis, kg·m²', 1e6),
        ('pressure_angle', 'Working pressure angle of the teeth, rad', 1.5),
    )
}
BRANCH_PARAMETERS: Mapping[str, Parameter] = {
    'cam_phase': Parameter(
        'Angle of the cam on the rotor, rad', -2.0 * math.pi, 2.0 * math.pi, read_only=True
    ),
    'axial_position': Parameter('Position along the motor axis, m', -10.0, 10.0, read_only=True),
}


def branch_parameters(branches: Iterable[str]) -> dict[str, Parameter]:
    """Return the parameters of the named branches, by name in ROS."""
    return {
        f'{branch}.{key}': parameter
        for branch in branches
        for key, parameter in BRANCH_PARAMETERS.items()
    }
