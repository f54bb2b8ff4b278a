# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The reports on the commissioning of a gear, and on the check of a parameter file."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.analysis import Commissioning
from gear_kinematics.measurement.commissioning.check import Judgement
from gear_kinematics.measurement.envelope import envelope
from gear_kinematics.measurement.wording import plain
from gear_kinematics.report.document import (
    Document,
    Figure,
    Finding,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    Verdict,
    printable,
)

_STATES = {True: 'holds', False: 'contradicted', None: 'open'}


def document(result: Commissioning, target: str) -> Document:
    """Return the document on a commissioning, whose file is the target."""
    answer = result.answer
    if not result.fault:
        answer = f'{answer.removesuffix(".")}: written to {target}.'
    values = Table.of_items(
        {
            'parameter': lambda value: value.name,
            'value': lambda value: _shown(value.value),
            'evidence': lambda value: printable(value.evidence),
        },
        result.values,
        ('', 'value', 'evidence'),
    )
    left = Table.of_items(
        {
            'open': lambda each: each.what,
            'known': lambda each: each.known,
            'what to do': lambda each: each.advice,
        },
        result.open,
        ('', 'known', 'what to do'),
    )
    return _document('gearkin commission', result, answer, (values, left))


def check_document(result: Commissioning, file: str, judgements: Sequence[Judgement]) -> Document:
    """Return the document on the check of a parameter file."""
    wrong = [each for each in judgements if each.holds is False]
    left = ', '.join(each.name for each in judgements if each.holds is None)
    answer = f'{file} agrees with the recording.'
    if wrong:
        what = '; '.join(f'{each.name} is {each.written}, but {each.found}' for each in wrong)
        answer = f'{file} is contradicted: {what}.'
    answer += f' Left open: {left}.' if left else ''
    table = Table.of_items(
        {
            'parameter': lambda each: each.name,
            'file': lambda each: printable(each.written),
            'recording': lambda each: printable(each.found),
            'state': lambda each: _STATES[each.holds],
        },
        judgements,
        ('', 'file', 'recording', 'state'),
    )
    verdict = Verdict.FAIL if wrong else Verdict.PASS
    made = _document('gearkin commission --check', result, answer, (table,), verdict)
    return replace(made, data={**made.data, 'judgements': plain(tuple(judgements))})


def _document(
    title: str,
    result: Commissioning,
    answer: str,
    tables: tuple[Table, ...],
    verdict: Verdict | None = None,
) -> Document:
    recordings = [joint.recording for joint in result.joints]
    remarks = list(result.notes)
    for recording in recordings:
        remarks += [f'{recording.name}: {sentence}' for sentence in recording.sentences]
    names = [recording.name for recording in recordings]
    section = Section(
        printable(', '.join(names)),
        tables,
        None,  # the finding says it, and why
        (Finding('finding', printable(answer)),),
        tuple(map(printable, remarks)),
        Figure(tuple(_panels(result))),
    )
    ratio = result.ratio
    data = {
        'schema': 'gear_kinematics/commissioning',
        'version': 1,
        'answer': answer,
        'ratio': plain(ratio.measured) if ratio else None,
        'gear_ratio': plain(result.request.ratio or result.between) if result.between else None,
        'candidates': plain(ratio.candidates) if ratio else [],
        'tooth_pairs': plain(ratio.tooth_pairs) if ratio else [],
        'travel': result.travel,
        'values': plain(result.values),
        'open': plain(result.open),
        'delay': plain(result.delay),
        'remarks': remarks,
        'recordings': names,
    }
    return Document(title, (section,), data, verdict)


def _shown(value: str | float) -> str:
    return f'{value:.6f}' if isinstance(value, float) else printable(str(value))


def _panels(result: Commissioning) -> Iterator[Panel]:
    """Draw the rotor over the output with the fitted line, and what is left over it."""
    joint, ratio, label = result.longest, result.ratio, 'output angle [°]'
    output, rotor = np.degrees(joint.encoders.measured), joint.turned / TURN
    lines = [Line('recorded', Pen.THIRD, *envelope(output, rotor))]
    if ratio:
        slope = float(result.between or ratio.measured.value) / 360.0  # turns per degree
        zero = np.mean(rotor - slope * output)
        ends = np.array([output.min(), output.max()])
        name = f'ratio {result.between or ratio.plus_minus}'
        lines.append(Line(name, Pen.MODEL, ends, slope * ends + zero))
    yield Panel('rotor over output', label, 'rotor [turns]', tuple(lines))
    if ratio:
        error, forward = output - (rotor - zero) / slope, np.gradient(rotor) * slope >= 0.0
        ways = ('forward', Pen.FIRST, forward), ('backward', Pen.SECOND, ~forward)
        errors = (
            Line(name, pen, *envelope(output[rows], error[rows]))
            for name, pen, rows in ways
            if rows.any()
        )
        title = 'measured less computed output [°]'
        yield Panel('error about the line', label, title, tuple(errors))
