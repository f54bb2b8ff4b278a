# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The additional parameters of a simulated actuator, and their file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from gear_kinematics import parameters
from gear_kinematics.parameters.files import default_values
from gear_kinematics.parameters.parameter import Parameter, declared_in, parameter
from gear_kinematics.share import share_directory

NODE = 'gear_simulator'  # the default name of the node that simulates an actuator


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinParameters:
    """The parameters that only a simulated actuator has, under their names in ROS."""

    play: float = parameter(
        'Angle between the flanks of each branch, before a preload closes it, rad at the output',
        *(0.0, 1.0),
        read_only=True,
    )
    friction: float = parameter(
        'Friction of the output against the stator, N·m', 0.0, 1e6, read_only=True
    )
    rotor_damping: float = parameter(
        'Torque of the rotor against its speed, N·m·s/rad', 0.0, 1e6, read_only=True
    )
    output_inertia: float = parameter(
        'Inertia of the output shaft and of what it moves, kg·m²', 1e-9, 1e9, read_only=True
    )
    model: str = parameter(
        'What computes the motion; auto: mujoco if it is installed',
        choices=('auto', 'mujoco', 'fast'),
        read_only=True,
    )
    rate: float = parameter(
        'Rate of rotor_state and output_encoder, Hz', 1.0, 5000.0, read_only=True
    )
    max_rotor_torque: float = parameter(
        'Greatest torque of the motor, N·m; max_rotor_speed bounds what is commanded, too',
        *(0.0, 1e6),
        read_only=True,
    )
    rotor_counts: int = parameter(
        'Steps per turn of the encoder of the rotor; 0: exact', 0, 2**31, read_only=True
    )
    output_counts: int = parameter(
        "Steps per turn of the output's encoder; 0: exact", 0, 2**31, read_only=True
    )
    dropout: float = parameter('Share of the messages that are not sent', 0.0, 1.0, read_only=True)
    wear: float = parameter('What ~/wear takes off the flanks, rad at the output', 0.0, 1.0)

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Self:
        """Create them from valid values by names in ROS; others have their defaults."""
        return cls(**{name: values.get(name, default_value(name)) for name in PARAMETERS})


PARAMETERS: Mapping[str, Parameter] = declared_in(TwinParameters)  # the parameters by name


def default_config() -> Path:
    """The installed config/simulated_actuator.yaml."""
    return share_directory() / 'config' / 'simulated_actuator.yaml'


def default_value(name: str) -> Any:
    """Default from config/simulated_actuator.yaml, or else that of gear_state_publisher."""
    values = default_values(default_config(), NODE)
    return values[name] if name in values else parameters.default_value(name)
