# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameter file of a commissioned gear: values with their evidence, and what is open."""

from gear_kinematics.measurement.commissioning.analysis import Commissioning
from gear_kinematics.parameters.new_config import quoted, start_command
from gear_kinematics.parameters.node_parameters import default_config
from gear_kinematics.report.document import printable


def actuator_file(result: Commissioning, name: str = default_config().name) -> str:
    """Return the text of a parameter file of a name.

    Raises:
        ValueError: if the ratio is open, or the positions have another unit.
    """
    if result.fault:
        raise ValueError(result.fault)
    rotor, output = result.request.rotor.topic, result.request.output.topic
    heads = [
        result.answer,
        f'From {", ".join(joint.recording.name for joint in result.joints)}. Start the node with',
        f'    {start_command(rotor, name, output)}',
        'SI units: m, rad, s. Parameters that are not here have their defaults.',
    ]
    lines = [f'# {printable(text)}' for text in heads]
    lines += ['/**:', '  ros__parameters:']
    for value in result.values:
        lines.append(f'    # {printable(value.evidence)}')
        lines.append(f'    {value.name}: {_yaml(value.value)}')
    lines += [f'    # {printable(note)}' for note in result.notes]
    lines += [
        f'    # Open: {printable(f"{left.what}: {left.known}; {left.advice}")}.'
        for left in result.open
    ]
    return '\n'.join([*lines, ''])


def _yaml(value: str | float) -> str:
    if isinstance(value, str):
        return quoted(value)
    return str(value) if isinstance(value, int) else f'{value:.9f}'
