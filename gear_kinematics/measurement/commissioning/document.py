# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The reports on the commissioning of a gear, and on the check of a parameter file."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

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
            'value': lambda value: printable(str(value.value)),
            'evidence': lambda value: printable(value.evidence),
        },
        result.values,
        ('', 'value', 'evidence'),
    )
    verdict = Verdict.FAIL if result.fault else Verdict.PASS
    return _document('gearkin commission', result, answer, verdict, values)


def check_document(result: Commissioning, file: str, judgements: Sequence[Judgement]) -> Document:
    """Return the document on the check of a parameter file."""
    wrong = [each for each in judgements if each.holds is False]
    left = ', '.join(each.name for each in judgements if each.holds is None)
    answer = '; '.join(f'{each.name} is {each.written}, but {each.found}' for each in wrong)
    answer = (
        f'{file} is contradicted: {answer}.' if wrong else f'{file} agrees with the recording.'
    )
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
    found = {'judgements': plain(tuple(judgements))}
    return _document('gearkin commission --check', result, answer, verdict, table, **found)


def _document(
    title: str,
    result: Commissioning,
    answer: str,
    verdict: Verdict,
    table: Table,
    **data: Any,
) -> Document:
    left = Table.of_items(
        {
            'open': lambda each: each.what,
            'known': lambda each: each.known,
            'what to do': lambda each: each.advice,
        },
        result.open,
        ('', 'known', 'what to do'),
    )
    remarks = list(result.notes)
    for joint in result.joints:
        remarks += [f'{joint.recording.name}: {sentence}' for sentence in joint.sentences]
    section = Section(
        ', '.join(printable(joint.recording.name) for joint in result.joints),
        (table, left),
        verdict,
        (Finding('finding', printable(answer)),),
        tuple(map(printable, remarks)),
        Figure(tuple(_panels(result))),
    )
    ratio = result.ratio
    data |= {
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
        'recordings': [joint.recording.name for joint in result.joints],
    }
    head = {'schema': 'gear_kinematics/commissioning', 'version': 1}
    return Document(title, (section,), head | data, verdict)


def _panels(result: Commissioning) -> list[Panel]:
    """Draw the rotor over the output with the fitted line, and what is left over it."""
    joint, turns, degrees = result.longest, 1.0 / math.tau, 180.0 / math.pi
    output = joint.encoders.measured * degrees
    lines = [Line('recorded', Pen.THIRD, *envelope(output, joint.turned * turns))]
    label = 'output angle [°]'
    if result.ratio is None:
        return [Panel('rotor over output', label, 'rotor [turns]', tuple(lines))]
    slope = float(result.between or result.ratio.measured.value)
    zeros = joint.turned - slope * joint.encoders.measured
    ends = np.array([output.min(), output.max()])
    fitted = slope * ends / 360.0 + np.mean(zeros) * turns
    ratio = str(result.between or result.ratio.plus_minus)
    lines.append(Line(f'ratio {ratio}', Pen.MODEL, ends, fitted))
    left = (np.mean(zeros) - zeros) / slope * degrees
    way = np.gradient(joint.turned) * slope
    return [
        Panel('rotor over output', label, 'rotor [turns]', tuple(lines)),
        Panel(
            'error about the line',
            label,
            'measured less computed output [°]',
            tuple(
                Line(name, pen, *envelope(output[rows], left[rows]))
                for name, pen, rows in (
                    ('forward', Pen.FIRST, way >= 0.0),
                    ('backward', Pen.SECOND, way < 0.0),
                )
                if rows.any()
            ),
        ),
    ]
