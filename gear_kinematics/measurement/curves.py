# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The panels of a report on lost motion, in arc minutes."""

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from gear_kinematics.measurement.envelope import MOST, envelope
from gear_kinematics.measurement.figures import LOST_MOTION_SHARE, Figures
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.middle_line import middle_lines
from gear_kinematics.measurement.transmission import TransmissionFigures
from gear_kinematics.measurement.wording import ARC_MINUTES, arc_minutes
from gear_kinematics.report.document import Array, Line, Panel, Pen, number

_TOGETHER = 1.1
"""Greatest ratio of orders that share a mark."""
_WAYS: tuple[tuple[int, str, Pen], ...] = (
    (0, 'turning back', Pen.FAINT),
    (1, 'forward', Pen.FIRST),
    (-1, 'backward', Pen.SECOND),
)
_HALVES = {True: ('torque rising', Pen.FIRST), False: ('torque falling', Pen.SECOND)}


def panels(report: LostMotion) -> Iterator[Panel]:
    """Yield the plots of a report."""
    if found := report.figures:
        yield from map(_ramp_panel, found.by_amplitude)
    if motion := report.transmission:
        yield _error_panel(motion)


def _ramp_panel(figures: Figures) -> Panel:
    ramps = figures.ramps
    centre = float(np.mean([loop.middle(0.0) for loop in ramps.loops]))
    lines = []
    for half in (half for loop in ramps.loops for half in reversed(loop)):
        # A ramp may continue to a larger amplitude, which has its own panel.
        inside = np.flatnonzero(np.abs(half.torque) <= 1.02 * ramps.amplitude)
        rows = inside[:: math.ceil(len(inside) / MOST)]
        name, pen = _HALVES[half.rising]
        angle = (half.angle[rows] - centre) * ARC_MINUTES
        lines.append(Line(name, pen, half.torque[rows], angle))
    for line in middle_lines(ramps):
        angle = (line.angle - centre) * ARC_MINUTES
        lines.append(Line('middle line: without friction', Pen.MODEL, line.load, angle))
    at = LOST_MOTION_SHARE * figures.settings.rated_torque
    return Panel(
        f'ramps to {number(ramps.amplitude)} N·m: hysteresis {arc_minutes(figures.hysteresis)}′',
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
            angle, error = envelope(np.degrees(motion.angle[rows]), error)
            lines.append(Line(name, pen, angle, error, points=way == 0))
    title, label = 'transmission error less its mean', 'measured less ideal [arcmin]'
    return Panel(title, 'output angle [°]', label, tuple(lines))


def spectrum_panel(
    body: str,
    spectra: Sequence[tuple[str, Pen, Array, Array]],
    orders: Iterable[tuple[float, str]],
    decades: int,
) -> Iterator[Panel]:
    """Draw spectra, if there are any, and mark orders.

    Args:
        body: in whose turn cycles are counted.
        spectra: name, pen, cycles and amplitudes, rad, of each.
        orders: cycles and name of each.
        decades: to show below the greatest amplitude.
    """
    lines = [Line(name, pen, *_peaks(x, y * ARC_MINUTES)) for name, pen, x, y in spectra]
    if lines:
        yield Panel(
            'spectrum',
            f'order: cycles in a turn of the {body}',
            'amplitude [arcmin]',
            tuple(lines),
            marks=tuple(_marks(orders)),
            scale='log',
            low=max(float(np.max(line.y)) for line in lines) / 10.0**decades,
        )


def _marks(orders: Iterable[tuple[float, str]]) -> list[tuple[float, str]]:
    """Marks of orders, each with its name; neighbouring ones share a mark."""
    groups: list[list[tuple[float, str]]] = []
    for order in sorted(orders):
        if groups and order[0] <= _TOGETHER * groups[-1][0][0]:
            groups[-1].append(order)
        else:
            groups.append([order])
    return [(group[0][0], ', '.join(name for _, name in group)) for group in groups]


def _peaks(x: Array, y: Array) -> tuple[Array, Array]:
    """Reduce points that are too dense for a logarithmic axis to their maxima."""
    starts = np.unique(np.geomspace(1, len(x), MOST).astype(np.intp) - 1)
    return x[starts], np.maximum.reduceat(y, starts)
