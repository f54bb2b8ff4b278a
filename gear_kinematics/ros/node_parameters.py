# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Declares the parameters of a node to ROS, and finds faults that rclpy does not."""

import re
from array import array
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from gear_kinematics.parameters import PARAMETERS, NodeParameters, default_value
from gear_kinematics.parameters.arm import COMMON, actuators_of, faults_in, full_name
from gear_kinematics.parameters.body_parameters import branch_parameters
from gear_kinematics.parameters.parameter import Parameter as Declaration
from gear_kinematics.ros.workarounds.private import given_parameters

_QOS_DEPTH = re.compile(r'qos_overrides\..+\.depth')
_MAX_DEPTH = 2**31 - 1  # messages; the middleware counts them in 32 bits


def declared_actuators(
    node: Node,
    others: Mapping[str, Declaration] = MappingProxyType({}),
    default: Callable[[str], Any] = default_value,
    shared: Mapping[str, Declaration] = PARAMETERS,
) -> dict[str, NodeParameters]:
    """Declare the parameters of all actuators of a node, and return their values by actuator.

    The `shared` ones, of gear_state_publisher, and the `others` are declared for each actuator of
    an arm, except `COMMON` ones. `default` gives a default value by name.

    Raises:
        ParameterException: if a value of `others` is refused.
        ValueError: if an unknown parameter was given, or a value or a name is refused; the text
            lists them all.
    """
    # rclpy ignores undeclared parameters, and has no public access to them.
    given = {name: _plain(each.value) for name, each in given_parameters(node).items()}
    if faults := faults_in(given, others):
        raise ValueError('; '.join(faults))
    if not given.get('actuators'):
        branches = given.get('branches', default('branches'))
        known = {**shared, **branch_parameters(branches)}
        given = {name: default(name) for name in known} | given
    actuators = actuators_of(given)
    values: dict[str, Any] = {}
    for name, parameters in actuators.items():
        own = parameters.values()
        known = {**shared, **branch_parameters(own['branches']), **others}
        for key in others:
            own[key] = given.get(full_name(name, key), given.get(key, default(key)))
        common = {key: key for key in COMMON if key not in values}
        named = common | {full_name(name, key): key for key in known if key not in COMMON}
        values |= {full: own[key] for full, key in named.items()}
        _declare(node, {full: known[key] for full, key in named.items()}, values.__getitem__)
    return actuators


def _plain(value: Any) -> Any:
    """Return a value as parameter files have it."""
    return [*(value or ())] if value is None or isinstance(value, (list, tuple, array)) else value


def _declare(
    node: Node, parameters: Mapping[str, Declaration], default: Callable[[str], Any]
) -> None:
    for name, parameter in parameters.items():
        descriptor = ParameterDescriptor(
            description=parameter.description,
            additional_constraints=', '.join(parameter.choices),
            read_only=parameter.read_only,
            dynamic_typing=default(name) == [],  # an empty list has no type in ROS
        )
        bounds = {'from_value': parameter.minimum, 'to_value': parameter.maximum}
        if parameter.kind is int:
            descriptor.integer_range = [IntegerRange(**bounds, step=parameter.step)]
        elif parameter.kind is float:
            descriptor.floating_point_range = [FloatingPointRange(**bounds)]
        node.declare_parameter(name, default(name), descriptor)


def fault_of(parameter: Parameter, known: Mapping[str, Declaration] = PARAMETERS) -> str | None:
    """Return the fault of a value, or None."""
    if declaration := known.get(parameter.name):
        return declaration.fault(parameter.name, _plain(parameter.value))
    if _QOS_DEPTH.fullmatch(parameter.name) and not 0 <= parameter.value <= _MAX_DEPTH:
        return f'{parameter.name} must be between 0 and {_MAX_DEPTH}'
    return None
