# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameters of a simulated actuator beside those of the node, and their file."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from gear_kinematics.parameters import ConfigError, NodeParameters
from gear_kinematics.parameters.files import given_parameters
from gear_kinematics.parameters.parameter import Parameter
from gear_kinematics.share import share_directory

NODE = 'gear_simulator'
"""The default name of the node that simulates an actuator."""

PARAMETERS: Mapping[str, Parameter] = {
    'play': Parameter(
        'Angle between the flanks of each branch, before a preload closes it, rad at the output',
        *(0.0, 1.0),
        read_only=True,
    ),
    'friction': Parameter(
        'Friction of the output against the stator, N·m', 0.0, 1e6, read_only=True
    ),
    'rotor_damping': Parameter(
        'Torque of the rotor against its speed, N·m·s/rad', 0.0, 1e6, read_only=True
    ),
    'output_inertia': Parameter(
        'Inertia of the output shaft and of what it moves, kg·m²', 1e-9, 1e9, read_only=True
    ),
}
"""Those that only a simulated actuator has, by their names in ROS."""


def default_config() -> Path:
    """The installed config/simulated_actuator.yaml."""
    return share_directory() / 'config' / 'simulated_actuator.yaml'


@cache
def _default_values() -> Mapping[str, Any]:
    return given_parameters(default_config(), NODE)


def default_value(name: str) -> Any:
    """The default of one of `PARAMETERS`, from config/simulated_actuator.yaml."""
    return _default_values()[name]


def load(path: Path, node: str = NODE) -> tuple[NodeParameters, dict[str, Any]]:
    """Read a parameter file as the simulating node would.

    Returns:
        The parameters that all nodes share, and the values of `PARAMETERS`.

    Raises:
        ConfigError: as `NodeParameters.load`.
    """
    parameters = NodeParameters.load(path, node, PARAMETERS)
    given = given_parameters(path, node)
    values = {name: given.get(name, default_value(name)) for name in PARAMETERS}
    faults = (PARAMETERS[name].fault(name, value) for name, value in values.items())
    if found := [fault for fault in faults if fault]:
        raise ConfigError(f'{path}: {"; ".join(found)}')
    return parameters, values
