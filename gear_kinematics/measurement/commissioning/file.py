# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameter file of a commissioned gear: values with their evidence, and what is open."""

from textwrap import wrap

from gear_kinematics.measurement.commissioning.analysis import Commissioning
from gear_kinematics.parameters.new_config import quoted, start_command
from gear_kinematics.parameters.node_parameters import default_config
from gear_kinematics.report.document import printable

_WIDTH = 100  # characters of a comment in a line
_INDENT = '    '


def actuator_file(result: Commissioning, name: str = default_config().name) -> str:
    """Return the text of a parameter file of a name.

    Raises:
        ValueError: if the ratio is open, or the positions have another unit.
    """
    if result.fault:
        raise ValueError(result.fault)
    names = ', '.join(joint.recording.name for joint in result.joints)
    command = start_command(result.request.rotor.topic, name, result.request.output.topic)
    lines = [
        *_comment(result.answer),
        *_comment(f'From {names}. Start the node with'),
        f'#     {printable(command)}',
        *_comment('SI units: m, rad, s. Parameters that are not here have their defaults.'),
        '/**:',
        '  ros__parameters:',
    ]
    for value in result.values:
        lines += [
            *_comment(value.evidence, _INDENT),
            f'{_INDENT}{value.name}: {_yaml(value.value)}',
        ]
    for text in (
        *result.notes,
        *(f'Open: {left.what}: {left.known}; {left.advice}.' for left in result.open),
    ):
        lines += _comment(text, _INDENT)
    return '\n'.join([*lines, ''])


def _comment(text: str, indent: str = '') -> list[str]:
    mark = f'{indent}# '
    return wrap(
        printable(text), _WIDTH, initial_indent=mark, subsequent_indent=mark,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip


def _yaml(value: str | float) -> str:
    if isinstance(value, str):
        return quoted(value)
    return str(value) if isinstance(value, int) else f'{value:.9f}'
