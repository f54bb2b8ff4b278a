# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameter file of a commissioned gear, and the report on it or on the check of one."""

from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import wrap

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.analysis import Commissioning, Value
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.measurement.wording import plus_minus, shown
from gear_kinematics.parameters.arm_file import add_actuators
from gear_kinematics.parameters.files import write_config
from gear_kinematics.parameters.new_config import arm_head, scalar, start_command
from gear_kinematics.parameters.node_parameters import default_config
from gear_kinematics.report import document as doc
from gear_kinematics.report.document import printable

_WIDTH = 100  # characters of a comment in a line
_INDENT = '    '


def actuator_file(result: Commissioning, name: str = default_config().name) -> str:
    """Return the text of the parameter file `name`; ValueError if the ratio is undetermined."""
    command = _start(result, name)
    return '\n'.join(
        [
            *_comment(f'{_found(result)} SI units: m, rad, s. Start the node with'),
            f'#     {printable(command)}',
            '/**:',
            '  ros__parameters:',
            *(f'{_INDENT}{line}' for line in _values(result)),
            '',
        ]
    )


def write_parameters(result: Commissioning, path: Path, actuator: str = '') -> str:
    """Write a gear to a new parameter file, or as an actuator to a new or existing one of an arm.

    Returns:
        The command that starts the node with the file.

    Raises:
        ValueError: if the ratio is undetermined, or the file cannot be written.
    """
    command = _start(result, path.name)
    if actuator:
        lines = [*_comment(_found(result)), *_values(result)]
        add_actuators(path, {actuator: lines}, arm_head(command))
    else:
        write_config(path, actuator_file(result, path.name))
    return command


def _start(result: Commissioning, name: str) -> str:
    """Return the command that starts the node; ValueError if the ratio is undetermined."""
    if not result.between:
        raise ValueError(str(result.answer))
    return start_command(result.request.rotor.topic, name, result.request.output.topic)


def _found(result: Commissioning) -> str:
    return f'{result.answer} From {", ".join(joint.recording.name for joint in result.joints)}.'


def _values(result: Commissioning) -> Iterator[str]:
    """Yield the lines of the parameters, each below its evidence, and further notes."""
    for found in result.values:
        if found.value is None:
            yield from _comment(f'Open: {found.name}: {found.evidence}.')
        else:
            yield from _comment(str(found.evidence))
            yield f'{found.name}: {scalar(found.value)}'
    for note in (*result.notes, *(f'{question}.' for question in result.questions)):
        yield from _comment(str(note))


def _comment(text: str) -> Iterator[str]:
    lines = wrap(printable(text), _WIDTH, break_long_words=False, break_on_hyphens=False)
    return (f'# {line}' for line in lines)


def document(result: Commissioning, target: str) -> doc.Document:
    """Return the document on a commissioning that wrote, or judged, the file `target`."""
    file, ratio, answer = result.request.file, result.ratio, result.answer
    wrong = result.changes(file) if file else {}
    if wrong:
        said = (f'{n} is {shown(old)}, not {shown(new)}' for n, (old, new) in wrong.items())
        answer = Observation.CONTRADICTED(target=target, changes='; '.join(said))
    elif result.between:
        what = Observation.AGREES if file else Observation.WRITTEN
        answer = what(answer=answer, target=target)
    columns: dict[str, Callable[[Value], str]] = {
        'parameter': lambda v: v.name,
        'value': lambda v: printable(shown(v.value)),
        'evidence': lambda v: printable(str(v.evidence)),
    }
    table = doc.Table.of_items(columns, result.values, ('', *columns))
    remarks, names = [*map(str, result.notes)], [joint.recording.name for joint in result.joints]
    for joint in result.joints:
        remarks += [f'{joint.recording.name}: {what}' for what in joint.recording.sentences]
    section = doc.Section(
        printable(', '.join(names)),
        (table,),
        None if result.between and not wrong else doc.Verdict.FAIL,
        tuple(
            doc.Sentence('finding', printable(str(each))) for each in (answer, *result.questions)
        ),
        tuple(map(printable, remarks)),
        _figure(result),
    )
    data = {
        'schema': 'gear_kinematics/commissioning',
        'version': 2,
        'answer': str(answer),
        'ratio': ratio and ratio.measured,
        'candidates': ratio.candidates if ratio else (),
        'gear_ratio': result.between and (result.request.ratio or result.between),
        'travel': result.longest.travel,
        'values': result.values,
        'contradicted': [*wrong],
        'remarks': [*remarks, *result.questions],
    }
    return doc.Document('gearkin commission', (section,), data)


def _figure(result: Commissioning) -> doc.Figure | None:
    """Draw the rotor over the output with the fitted line, and the error about it."""
    joint, ratio, label = result.longest, result.ratio, 'output angle [°]'
    if not ratio:
        return None
    output, rotor = np.degrees(joint.encoders.measured), joint.turned / TURN
    slope = float(result.between or ratio.measured.value) / 360.0  # turns per degree
    zero = np.mean(rotor - slope * output)
    ends = np.array([output.min(), output.max()])
    recorded = doc.Line.reduced('recorded', doc.Pen.THIRD, output, rotor)
    name = f'ratio {result.between or plus_minus(ratio.measured)}'
    fitted = doc.Line(name, doc.Pen.MODEL, ends, slope * ends + zero)
    error = doc.Line.reduced('error', doc.Pen.FIRST, output, output - (rotor - zero) / slope)
    left = 'measured less computed output [°]'
    return doc.Figure(
        (
            doc.Panel('rotor over output', label, 'rotor [turns]', (recorded, fitted)),
            doc.Panel('error about the line', label, left, (error,)),
        )
    )
