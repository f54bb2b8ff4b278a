# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Settings of the rotor's input that follow from the parameters."""

from dataclasses import replace

from gear_kinematics.parameters import PARAMETERS, NodeParameters
from gear_kinematics.wire.cdr import SECOND

_ENCODERS = tuple(
    name
    for name in PARAMETERS
    if name.startswith(('rotor_', 'output_encoder_')) and name != 'rotor_effort_factor'
)
"""The parameters that turns from an absolute encoder at the output rest on."""


def encoders_differ(one: NodeParameters, other: NodeParameters) -> bool:
    """Whether turns that an encoder at the output found are those of other encoders."""
    return any(getattr(one, name) != getattr(other, name) for name in _ENCODERS)


def only_zero_differs(one: NodeParameters, other: NodeParameters) -> bool:
    """Whether the same motion is counted from another zero, as after homing."""
    return replace(one, rotor_zero=other.rotor_zero) == other


def longest_silence(parameters: NodeParameters) -> float:
    """ns; diagnostics, too, call the driver silent after so long."""
    return parameters.input_timeout * SECOND if parameters.absolute else 0.0


def limits(parameters: NodeParameters) -> tuple[float, float, float]:
    """The arguments of `Plausibility`."""
    bounds = parameters.max_rotor_speed, parameters.max_rotor_acceleration
    return *bounds, parameters.rotor_period


def torque_factor(parameters: NodeParameters) -> float:
    """N·m of the rotor, in its direction, per unit of the effort in the messages."""
    return parameters.rotor_direction * parameters.rotor_effort_factor
