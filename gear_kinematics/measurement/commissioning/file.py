# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameter file of a commissioned gear: values with their evidence, and what is open."""

from collections.abc import Iterator
from textwrap import wrap

from gear_kinematics.measurement.commissioning.analysis import Commissioning
from gear_kinematics.parameters.new_config import quoted, start_command
from gear_kinematics.parameters.node_parameters import default_config
from gear_kinematics.report.document import printable

_WIDTH = 100  # characters of a comment in a line
_INDENT = '    '


def actuator_file(result: Commissioning, name: str = default_config().name) -> str:
    """Return the text of a parameter file of a name; ValueError if the ratio is open."""
    if not result.between:
        raise ValueError(result.answer)
    names = ', '.join(joint.recording.name for joint in result.joints)
    command = start_command(result.request.rotor.topic, name, result.request.output.topic)
    lines = [
        *_comment(f'{result.answer} From {names}. SI units: m, rad, s. Start the node with'),
        f'#     {printable(command)}',
        '/**:',
        '  ros__parameters:',
    ]
    for found in result.values:
        if found.value is None:
            lines += _comment(f'Open: {found.name}: {found.evidence}.', _INDENT)
        else:
            lines += _comment(found.evidence, _INDENT)
            lines.append(f'{_INDENT}{found.name}: {_yaml(found.value)}')
    for note in result.notes:
        lines += _comment(note, _INDENT)
    return '\n'.join([*lines, ''])


def _comment(text: str, indent: str = '') -> Iterator[str]:
    lines = wrap(printable(text), _WIDTH, break_long_words=False, break_on_hyphens=False)
    return (f'{indent}# {line}' for line in lines)


def _yaml(value: str | float) -> str:
    text = f'{value:.9f}' if isinstance(value, float) else str(value)
    return quoted(text) if isinstance(value, str) else text
