# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The panels of a report on lost motion, in arc minutes."""

import math
from collections.abc import Iterator

import numpy as np

from gear_kinematics.measurement.figures import LOST_MOTION_SHARE
from gear_kinematics.measurement.loops import Ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.transmission import TransmissionFigures
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report.document import MOST_POINTS, Line, Panel, Pen, number

_WAYS: tuple[tuple[int, str, Pen], ...] = (
    (0, 'turning back', Pen.FAINT),
    (1, 'forward', Pen.FIRST),
    (-1, 'backward', Pen.SECOND),
)
_HALVES = {True: ('torque rising', Pen.FIRST), False: ('torque falling', Pen.SECOND)}


def panels(report: LostMotion) -> Iterator[Panel]:
    """Yield the plots of a report."""
    if found := report.figures:
        torque = LOST_MOTION_SHARE * found.rated_torque
        yield from (_ramp_panel(ramps, torque) for ramps in found.ramps)
    if motion := report.transmission:
        yield _error_panel(motion)


def _ramp_panel(ramps: Ramps, at: float) -> Panel:
    centre = float(np.mean([loop.middle(0.0) for loop in ramps.loops]))
    lines = []
    for half in (half for loop in ramps.loops for half in reversed(loop)):
        # A ramp may continue to a larger amplitude, which has its own panel.
        inside = np.flatnonzero(np.abs(half.torque) <= 1.02 * ramps.amplitude)
        rows = inside[:: math.ceil(len(inside) / MOST_POINTS)]
        name, pen = _HALVES[half.rising]
        angle = (half.angle[rows] - centre) * ARC_MINUTES
        lines.append(Line(name, pen, half.torque[rows], angle))
    for line in ramps.lines:
        angle = (line.angle - centre) * ARC_MINUTES
        lines.append(Line('middle line: without friction', Pen.MODEL, line.load, angle))
    return Panel(
        f'ramps to {number(ramps.amplitude)} N·m',
        f'torque at the output [N·m]; dashed: 0 and ±{100.0 * LOST_MOTION_SHARE:g} % of rated',
        'wind-up at the output [arcmin]',
        tuple(lines),
        marks=((-at, ''), (0.0, ''), (at, '')),
    )


def _error_panel(motion: TransmissionFigures) -> Panel:
    lines = []
    for way, name, pen in _WAYS:
        rows = motion.direction == way
        if rows.any():
            error = (motion.error[rows] - motion.offset) * ARC_MINUTES
            angle = np.degrees(motion.angle[rows])
            lines.append(Line.reduced(name, pen, angle, error, points=way == 0))
    title, label = 'transmission error less its mean', 'measured less ideal [arcmin]'
    return Panel(title, 'output angle [°]', label, tuple(lines))
