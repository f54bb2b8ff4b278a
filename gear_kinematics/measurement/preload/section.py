# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The section of a report on recordings at several settings of the preload."""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from gear_kinematics.measurement.document import Comparison
from gear_kinematics.measurement.loops import ALIKE
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import HYSTERESIS
from gear_kinematics.measurement.names import Scale
from gear_kinematics.measurement.preload.advice import FEWEST, Advice, Reading, advise
from gear_kinematics.measurement.preload.file import Span
from gear_kinematics.measurement.wording import ARC_MINUTES, PERCENT, plus_minus
from gear_kinematics.report.document import (
    Figure,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    number,
    printable,
)


def over_preload(
    reports: Sequence[LostMotion], settings: Sequence[float], scale: Scale, load: float | None
) -> Comparison:
    """Advise a preload by recordings at several settings, which `settings_of` returns.

    Both branches must stay in mesh under the load, N·m, if one is given.

    Raises:
        ValueError: if there are too few settings with ramps of about one amplitude.
    """
    known = [report.figures for report in reports if report.figures]
    amplitude = max((figures.by_amplitude[0].ramps.amplitude for figures in known), default=0.0)
    for name in (HYSTERESIS, 'lost motion without friction'):
        found = [
            (report.name, reading)
            for report, setting in zip(reports, settings, strict=True)
            if (reading := _reading(report, setting, amplitude, name))
        ]
        readings = [reading for _, reading in found]
        if (count := len({reading.setting for reading in readings})) >= FEWEST:
            break
    else:
        fewest = f'{FEWEST} settings, not at {count}'
        raise ValueError(f'preloads: there must be ramps of about one amplitude at {fewest}')
    advice = advise(readings, scale.play, load)
    sentence = _fall(advice, name, scale)
    if load and advice.least:
        least, added = _spanned(advice.least, scale), advice.added_friction
        sentence += f'; both branches stay in mesh under {load:g} N·m from {least} on'
        sentence += f', for {plus_minus(added)} N·m more friction' if added and added.clear else ''
    elif load:
        sentence += f'; the least setting under {load:g} N·m is not known'
    table = Table.of_items(
        {
            'setting': lambda item: printable(f'{_shown(item[1].setting, scale)}, {item[0]}'),
            f'{name} [′]': lambda item: number(ARC_MINUTES * item[1].angle),
            'friction [N·m]': lambda item: number(item[1].friction),
        },
        sorted(found, key=lambda item: item[1].setting),
    )
    scatter = f'Recordings scatter about the fit by {number(100.0 * advice.scatter, 2)} %.'
    data = {
        'unit': scale.unit or None,
        'closing': scale.play,
        'load': load,
        'cause': None if advice.least else sentence,
        'figure': name,
        'readings': [{'recording': recording, **asdict(own)} for recording, own in found],
        **vars(advice),
    }
    figure = _drawing(advice, readings, name, scale)
    section = Section('preload', (table,), remarks=(f'{sentence}.', scatter), figure=figure)
    return Comparison(section, sentence, {'preload': data})


def _reading(report: LostMotion, setting: float, amplitude: float, name: str) -> Reading | None:
    """Take a figure, by its name, of the small ramps of about an amplitude, N·m, if known."""
    if not report.figures:
        return None
    small = min(report.figures.by_amplitude, key=lambda own: abs(own.ramps.amplitude - amplitude))
    alike = 1.0 / ALIKE <= small.ramps.amplitude / amplitude <= ALIKE
    angle = small.hysteresis if name == HYSTERESIS else small.frictionless
    # A torque that is later than the angle makes the hysteresis negative.
    if not (alike and small.friction and angle and angle.value > 0.0):
        return None
    friction = small.friction.value
    load = friction if name == HYSTERESIS else report.figures.settings.small_load
    # With play, one branch alone carries the load in all but the lowest range.
    ranges = [s for s in report.figures.stiffness if s.low > 0.0]
    sides = [(1.0 / s.positive.value, 1.0 / s.negative.value) for s in ranges[-1:]]
    return Reading(setting, angle.value, load, friction, *sides)


def _fall(advice: Advice, name: str, scale: Scale) -> str:
    """Say up to which setting the angle falls."""
    end, last, name = advice.end, advice.levels[-1], name.capitalize()
    if not advice.falling:
        return f'{name} does not clearly fall with the setting: record each one several times'
    if end.high >= last and end.value > advice.levels[-2]:
        shown = _shown(last, scale)
        return f'{name} still falls at the greatest setting, {shown}: record greater ones'
    start = advice.rest + advice.slope * (end.value - advice.levels[0])
    before, after = number(ARC_MINUTES * start), number(ARC_MINUTES * advice.rest)
    drop = f'{name} falls from {before} to {after}′ up to'
    value, low, high = (_shown(at, scale) for at in (end.value, end.low, end.high))
    if end.high >= last:
        beyond = f'and perhaps beyond ({PERCENT}: {low} or more)'
        return f'{drop} the setting {value}, {beyond}: repeat these, and record greater ones'
    if end.low <= advice.levels[1]:
        between = f'between {low} and {high} ({PERCENT})'
        return f'{drop} a setting {between} and no further: record settings between these'
    hint = '' if advice.least else '; ramp to more torque to learn the stiffness'
    return f'{drop} the setting {_spanned(end, scale)} and no further{hint}'


def _shown(setting: float, scale: Scale) -> str:
    return f'{number(setting / scale.size)} {scale.unit}'.rstrip()


def _spanned(span: Span, scale: Scale) -> str:
    low, high = (number(edge / scale.size) for edge in (span.low, span.high))
    return f'{_shown(span.value, scale)} ({PERCENT}: {low} to {high})'


def _drawing(advice: Advice, readings: Sequence[Reading], name: str, scale: Scale) -> Figure:
    """Draw the angle with its fit, and friction, over the settings."""
    marks = [(advice.end, 'end of the fall')] if advice.falling else []
    marks += [(advice.least, 'least setting')] if advice.least else []
    shown = tuple((at.value / scale.size, text) for at, text in marks)
    label = f'setting [{scale.unit}]' if scale.unit else 'setting'
    x = np.array([advice.levels[0], advice.end.value, advice.levels[-1]])
    fit = advice.rest + advice.slope * np.maximum(advice.end.value - x, 0.0)
    settings = np.array([reading.setting for reading in readings]) / scale.size
    angle = ARC_MINUTES * np.array([reading.angle for reading in readings])
    friction = np.array([reading.friction for reading in readings])
    lines = [Line('measured', Pen.FIRST, settings, y, points=True) for y in (angle, friction)]
    line = Line('fit', Pen.MODEL, x / scale.size, ARC_MINUTES * fit)
    upper = Panel('', label, f'{name} [′]', (lines[0], line), shown)
    return Figure((upper, Panel('', label, 'friction [N·m]', (lines[1],), shown)))
