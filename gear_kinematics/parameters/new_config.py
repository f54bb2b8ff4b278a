# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A parameter file for a driver: the default one, with the driver's joint."""

import math
import re
import shlex
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import yaml

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.parameters.node_parameters import NODE, default_config
from gear_kinematics.share import PACKAGE
from gear_kinematics.wire.topics import OUTPUT_ENCODER, ROTOR_STATE


def new_config(
    topic: str,
    joint: str,
    name: str,
    ratio: GearRatio,
    teeth: tuple[int, int] | None = None,
    encoder: Mapping[str, str | float] = MappingProxyType({}),
) -> str:
    """Return the text of a named parameter file for a joint, or its index, on a driver's topic.

    Without the `teeth` of ring and satellite, only the ratio of the gear is known. `encoder` has
    the known parameters of the rotor's encoder, by name.
    """
    values = _gear(joint, ratio, teeth, encoder)
    # Leave out the head, which describes the default file itself.
    body = re.sub(r'\A(#.*\n)+', '', default_config().read_text('utf-8'))
    line = rf'(?m)^( +({"|".join(values)}): ).*'
    body = re.sub(line, lambda match: match[1] + values[match[2]], body)
    return (
        f'# For the joint {_one_line(joint)} on {_one_line(topic)}, with the gear ratio {ratio}.\n'
        '# Start the node with\n'
        f'#     {start_command(topic, name)}\n'
        f'# Check {"the mechanism, " if teeth else ""}rotor_direction, rotor_encoder and '
        'max_rotor_speed. SI units: m, rad, s.\n' + body
    )


def new_actuator(
    topic: str,
    joint: str,
    ratio: GearRatio,
    teeth: tuple[int, int] | None = None,
    encoder: Mapping[str, str | float] = MappingProxyType({}),
) -> list[str]:
    """Return the lines of an actuator in the parameter file of an arm; see `new_config`."""
    place = f'# The joint {_one_line(joint)} on {_one_line(topic)}, with the gear ratio {ratio}.'
    values = _gear(joint, ratio, teeth, encoder)
    return [place, *(f'{name}: {value}' for name, value in values.items())]


def arm_head(command: str) -> list[str]:
    """Return the head of a new parameter file of an arm, with the command that starts the node."""
    return [
        '# An arm: all its actuators in one node. Start it with',
        f'#     {command}',
        '# Each parameter can stand below an actuator, or beside `actuators` for all of them.',
        '# Check rotor_direction and rotor_encoder; set max_rotor_speed to what the motors reach.',
        '# An output has the name of its actuator, unless an output_joint is given.',
        '# SI units: m, rad, s.',
    ]


def _gear(
    joint: str, ratio: GearRatio, teeth: tuple[int, int] | None, encoder: Mapping[str, str | float]
) -> dict[str, str]:
    """Return the parameters that are known of a gear, as scalars of YAML."""
    values = {'rotor_joint': scalar(joint), 'gear_ratio': scalar(str(ratio))}
    if teeth:
        values |= zip(('ring_teeth', 'satellite_teeth'), map(str, teeth), strict=True)
        values['gear_ratio'] = "''"
    return values | {name: scalar(value) for name, value in encoder.items()}


def scalar(value: str | float) -> str:
    """Write a value for YAML: a float to nine decimals, a text in quotes, single if possible."""
    if isinstance(value, str):
        return str(yaml.safe_dump(value, default_style="'", width=math.inf)).strip()
    return str(value) if isinstance(value, int) else f'{value:.9f}'


def start_command(topic: str, name: str, encoder: str = '') -> str:
    """Return the command that starts the node with a parameter file and the topics of drivers.

    A missing encoder has an empty topic. In a workspace of ROS, the node is not on the PATH; in a
    virtual environment, it is only while that is active.
    """
    program = ['ros2', 'run', PACKAGE, NODE]
    if shutil.which(NODE):
        program = [NODE]
    elif (beside := Path(sys.executable).with_name(NODE)).exists():
        program = [str(beside)]
    arguments = ['--ros-args', '--params-file', name]
    for own, theirs in ((ROTOR_STATE, topic), (OUTPUT_ENCODER, encoder)):
        if theirs:
            arguments += ['-r', f'{own}:={theirs}']
    return shlex.join([*program, *arguments])


def _one_line(text: str) -> str:
    return ''.join(char if char.isprintable() else '�' for char in text)
