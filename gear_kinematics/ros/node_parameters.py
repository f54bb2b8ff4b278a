# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Declares the parameters of the node to ROS, and finds faults that rclpy does not."""

import re
from collections.abc import Mapping

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from gear_kinematics.parameters import PARAMETERS, default_value
from gear_kinematics.parameters.parameter import Parameter as Declaration

_QOS_DEPTH = re.compile(r'qos_overrides\..+\.depth')
_MAX_DEPTH = 2**31 - 1  # messages; the middleware counts them in 32 bits


def declare(node: Node, parameters: Mapping[str, Declaration]) -> None:
    """Declare parameters of a node, by name, with their default values."""
    for name, parameter in parameters.items():
        descriptor = ParameterDescriptor(
            description=parameter.description,
            additional_constraints=', '.join(parameter.choices),
            read_only=parameter.read_only,
        )
        bounds = {'from_value': parameter.minimum, 'to_value': parameter.maximum}
        if parameter.kind is int:
            descriptor.integer_range = [IntegerRange(**bounds, step=parameter.step)]
        elif parameter.kind is float:
            descriptor.floating_point_range = [FloatingPointRange(**bounds)]
        node.declare_parameter(name, default_value(name), descriptor)


def fault_of(parameter: Parameter) -> str | None:
    """Return the fault of a value of the right type and range, or None."""
    known = PARAMETERS.get(parameter.name)
    if known and (fault := known.other_fault(parameter.name, parameter.value)):
        return fault
    if _QOS_DEPTH.fullmatch(parameter.name) and not 0 <= parameter.value <= _MAX_DEPTH:
        return f'{parameter.name} must be between 0 and {_MAX_DEPTH}'
    return None
