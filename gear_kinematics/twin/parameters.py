# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The additional parameters of a simulated actuator, and their file."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gear_kinematics import parameters
from gear_kinematics.parameters import ConfigError
from gear_kinematics.parameters.files import default_values, given_parameters
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
    'model': Parameter(
        'What computes the motion; auto: mujoco if it is installed',
        choices=('auto', 'mujoco', 'fast'),
        kind=str,
        read_only=True,
    ),
    'rate': Parameter('Rate of rotor_state and output_encoder, Hz', 1.0, 5000.0, read_only=True),
    'max_rotor_torque': Parameter(
        'Greatest torque of the motor, N·m; max_rotor_speed bounds what is commanded, too',
        *(0.0, 1e6),
        read_only=True,
    ),
    'rotor_counts': Parameter(
        'Steps per turn of the encoder of the rotor; 0: exact', 0, 2**31, kind=int, read_only=True
    ),
    'output_counts': Parameter(
        "Steps per turn of the output's encoder; 0: exact", 0, 2**31, kind=int, read_only=True
    ),
    'dropout': Parameter('Share of the messages that are not sent', 0.0, 1.0, read_only=True),
    'wear': Parameter('What ~/wear takes off the flanks, rad at the output', 0.0, 1.0),
}
"""Parameters that only a simulated actuator has, by their names in ROS."""


def default_config() -> Path:
    """The installed config/simulated_actuator.yaml."""
    return share_directory() / 'config' / 'simulated_actuator.yaml'


def default_value(name: str) -> Any:
    """Default from config/simulated_actuator.yaml, or else that of gear_state_publisher."""
    values = default_values(default_config(), NODE)
    return values[name] if name in values else parameters.default_value(name)


def own_values(path: Path, node: str) -> dict[str, Any]:
    """Read the values of `PARAMETERS` for a node; raises ConfigError if a value is invalid."""
    given = given_parameters(path, node)
    values = {name: given.get(name, default_value(name)) for name in PARAMETERS}
    faults = (PARAMETERS[name].fault(name, value) for name, value in values.items())
    if found := [fault for fault in faults if fault]:
        raise ConfigError(f'{path}: {"; ".join(found)}')
    return values
