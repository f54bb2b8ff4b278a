"""Declares the parameters of the node to ROS, and finds faults that rclpy does not."""

import re

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from gear_kinematics.parameters import node_parameters as parameters

_QOS_DEPTH = re.compile(r'qos_overrides\..+\.depth')
_MAX_DEPTH = 2**31 - 1  # messages; the middleware counts them in 32 bits


def declare(node: Node, name: str, parameter: parameters.Parameter, default: object) -> None:
    """Declare a parameter of a node; its type is that of the default."""
    descriptor = ParameterDescriptor(
        description=parameter.description,
        additional_constraints=', '.join(parameter.choices),
        read_only=parameter.read_only,
    )
    bounds = {'from_value': parameter.minimum, 'to_value': parameter.maximum}
    if isinstance(default, int):
        descriptor.integer_range = [IntegerRange(**bounds, step=parameter.step)]
    elif isinstance(default, float):
        descriptor.floating_point_range = [FloatingPointRange(**bounds)]
    node.declare_parameter(name, default, descriptor)


def fault_of(parameter: Parameter) -> str | None:
    """Return the fault of a value of the right type and range, or None."""
    known = parameters.PARAMETERS.get(parameter.name)
    if known and (fault := known.other_fault(parameter.name, parameter.value)):
        return fault
    if _QOS_DEPTH.fullmatch(parameter.name) and not 0 <= parameter.value <= _MAX_DEPTH:
        return f'{parameter.name} must be between 0 and {_MAX_DEPTH}'
    return None
