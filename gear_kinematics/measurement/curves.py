"""The panels of a report on lost motion, in arc minutes."""

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from gear_kinematics.measurement.figures import LOST_MOTION_SHARE, Figures
from gear_kinematics.measurement.loops import HalfLoop, Ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.middle_line import middle_lines
from gear_kinematics.measurement.transmission import TransmissionFigures
from gear_kinematics.measurement.wording import ARC_MINUTES, arc_minutes
from gear_kinematics.report.document import Array, Line, Panel, Pen, number

_MOST = 2000  # points of a line
_TOGETHER = 1.1
"""Greatest ratio of orders that share a mark."""
_WAYS: tuple[tuple[int, str, Pen], ...] = (
    (0, 'turning back', Pen.FAINT),
    (1, 'forward', Pen.FIRST),
    (-1, 'backward', Pen.SECOND),
)


def panels(report: LostMotion) -> Iterator[Panel]:
    """Yield the plots of a report."""
    if found := report.figures:
        for ramps, figures in zip(report.ramps, found.by_amplitude, strict=True):
            yield _ramp_panel(ramps, figures, found.settings.rated_torque)
    if report.transmission:
        yield from _transmission(report.transmission)


def _ramp_panel(ramps: Ramps, figures: Figures, rated_torque: float) -> Panel:
    centre = float(np.mean([loop.middle(0.0) for loop in ramps.loops]))
    lines = [_half_loop(half, centre, ramps) for loop in ramps.loops for half in reversed(loop)]
    for line in middle_lines(ramps):
        angle = (line.angle - centre) * ARC_MINUTES
        lines.append(Line('middle line: without friction', Pen.MODEL, line.load, angle))
    at = LOST_MOTION_SHARE * rated_torque
    return Panel(
        f'ramps to {number(ramps.amplitude)} N·m: hysteresis {arc_minutes(figures.hysteresis)}′',
        f'torque at the output [N·m]; dashed: 0 and ±{100.0 * LOST_MOTION_SHARE:g} % of rated',
        'wind-up at the output [arcmin]',
        tuple(lines),
        marks=((-at, ''), (0.0, ''), (at, '')),
    )


def _half_loop(half: HalfLoop, centre: float, ramps: Ramps) -> Line:
    # A ramp may continue to a larger amplitude, which has its own panel.
    inside = np.abs(half.torque) <= 1.02 * ramps.amplitude
    every = math.ceil(np.count_nonzero(inside) / _MOST)
    load, angle = (values[inside][::every] for values in (half.torque, half.angle))
    angle = (angle - centre) * ARC_MINUTES
    if half.rising:
        return Line('torque rising', Pen.FIRST, load, angle)
    return Line('torque falling', Pen.SECOND, load, angle)


def _transmission(found: TransmissionFigures) -> Iterator[Panel]:
    lines = []
    for way, name, pen in _WAYS:
        rows = found.direction == way
        if rows.any():
            error = (found.error[rows] - found.offset) * ARC_MINUTES
            angle, error = envelope(np.degrees(found.angle[rows]), error)
            lines.append(Line(name, pen, angle, error, points=way == 0))
    yield Panel(
        'transmission error less its mean',
        'output angle [°]',
        'measured less ideal [arcmin]',
        tuple(lines),
    )
    spectra = [
        (name, pen, spectrum.orders[1:], spectrum.amplitude[1:])
        for spectrum, (_, name, pen) in zip(found.spectra, _WAYS[1:], strict=True)
        if spectrum
    ]
    highest = max((cycles[-1] for _, _, cycles, _ in spectra), default=0.0)
    orders = [(float(o.cycles), o.name) for o in found.orders if float(o.cycles) <= highest]
    yield from spectrum_panel('output', spectra, orders, decades=4)


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


def envelope(x: Array, y: Array) -> tuple[Array, Array]:
    """Reduce points that are too dense for a plot to their minima and maxima."""
    order = np.argsort(x, kind='stable')
    x, y = x[order], y[order]
    if len(x) <= _MOST:
        return x, y
    starts = np.linspace(0, len(x), _MOST // 2, endpoint=False, dtype=np.intp)
    bounds = np.stack([np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)], axis=1)
    return np.repeat(x[starts], 2), bounds.ravel()


def _peaks(x: Array, y: Array) -> tuple[Array, Array]:
    """Reduce points that are too dense for a logarithmic axis to their maxima."""
    starts = np.unique(np.geomspace(1, len(x), _MOST).astype(np.intp) - 1)
    return x[starts], np.maximum.reduceat(y, starts)
