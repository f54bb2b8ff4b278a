"""The panels of a report on lost motion, in arc minutes."""

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.static.hysteresis import LOST_MOTION_SHARE, Figures
from gear_kinematics.lost_motion.static.ramps import HalfLoop, Ramps
from gear_kinematics.lost_motion.wording import ARC_MINUTES, arc_minutes, torque
from gear_kinematics.report.document import Array, Line, Panel, Pen

_MOST = 2000  # points of a line
_TOGETHER = 1.1
"""Greatest ratio of orders that share a mark."""
_DECADES = 4
"""Decades of a spectrum below its greatest amplitude."""


def panels(report: LostMotionReport) -> list[Panel]:
    """Return the plots of a report."""
    return [*_hysteresis(report), *_transmission(report)]


def _hysteresis(report: LostMotionReport) -> Iterator[Panel]:
    if found := report.hysteresis:
        for ramps, figures in zip(found.ramps, found.figures, strict=True):
            yield _ramp_panel(ramps, figures, found.settings.rated_torque)


def _ramp_panel(ramps: Ramps, figures: Figures, rated_torque: float) -> Panel:
    centre = float(np.mean([loop.middle(0.0) for loop in ramps.loops]))
    lines = []
    for loop in ramps.loops:
        lines.append(_half_loop('torque rising', Pen.FIRST, loop.rise, centre, ramps))
        lines.append(_half_loop('torque falling', Pen.SECOND, loop.fall, centre, ramps))
    if model := figures.play_model:
        load, angle = model.loop(ramps.amplitude)
        lines.append(Line(f'model: {model.name}', Pen.MODEL, load, (angle - centre) * ARC_MINUTES))
    at = LOST_MOTION_SHARE * rated_torque
    width = arc_minutes(figures.hysteresis)
    return Panel(
        f'ramps to {torque(ramps.amplitude)} N·m: hysteresis {width} arcmin',
        f'torque at the output [N·m]; dashed: 0 and ±{100.0 * LOST_MOTION_SHARE:g} % of rated',
        'wind-up at the output [arcmin]',
        tuple(lines),
        marks=((-at, ''), (0.0, ''), (at, '')),
    )


def _half_loop(name: str, pen: Pen, half: HalfLoop, centre: float, ramps: Ramps) -> Line:
    # A ramp may continue to a larger amplitude, which has its own panel.
    inside = np.abs(half.torque) <= 1.02 * ramps.amplitude
    load, angle = (_thinned(values[inside]) for values in (half.torque, half.angle))
    return Line(name, pen, load, (angle - centre) * ARC_MINUTES)


def _transmission(report: LostMotionReport) -> Iterator[Panel]:
    found, motion = report.transmission, report.recording.motion
    if not (found and motion):
        return
    ways: tuple[tuple[int, str, Pen], ...] = (
        (0, 'turning back', Pen.FAINT),
        (1, 'forward', Pen.FIRST),
        (-1, 'backward', Pen.SECOND),
    )
    lines = []
    for way, name, pen in ways:
        rows = motion.direction == way
        if rows.any():
            error = (motion.error[rows] - found.offset) * ARC_MINUTES
            angle, error = envelope(np.degrees(motion.angle[rows]), error)
            lines.append(Line(name, pen, angle, error, points=way == 0))
    yield Panel(
        'transmission error less its mean',
        'output angle [°]',
        'measured less ideal [arcmin]',
        tuple(lines),
    )
    spectra = [
        Line(name, pen, *peaks(spectrum.orders[1:], spectrum.amplitude[1:] * ARC_MINUTES))
        for spectrum, (_, name, pen) in zip(found.spectra, ways[1:], strict=True)
        if spectrum
    ]
    if spectra:
        highest = max(float(line.x[-1]) for line in spectra)
        yield Panel(
            'spectrum',
            'order: cycles in a turn of the output',
            'amplitude [arcmin]',
            tuple(spectra),
            marks=tuple(marks(((float(o.cycles), o.name) for o in found.orders), highest)),
            scale='log',
            low=max(float(np.max(line.y)) for line in spectra) / 10.0**_DECADES,
        )


def marks(
    orders: Iterable[tuple[float, str]], highest: float = math.inf
) -> Iterator[tuple[float, str]]:
    """Yield marks for orders, each with its name; neighbouring ones share a mark.

    Args:
        orders: on the x axis of a spectrum.
        highest: the highest order to mark.
    """
    near: list[tuple[float, str]] = []
    for order in sorted(order for order in orders if order[0] <= highest):
        if near and order[0] > _TOGETHER * near[0][0]:
            yield _mark(near)
            near = []
        near.append(order)
    if near:
        yield _mark(near)


def _mark(orders: Sequence[tuple[float, str]]) -> tuple[float, str]:
    return orders[0][0], ', '.join(name for _, name in orders)


def envelope(x: Array, y: Array) -> tuple[Array, Array]:
    """Reduce points that are too dense for a plot to their minima and maxima."""
    order = np.argsort(x, kind='stable')
    x, y = x[order], y[order]
    if len(x) <= _MOST:
        return x, y
    starts = np.linspace(0, len(x), _MOST // 2, endpoint=False, dtype=np.intp)
    bounds = np.stack([np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)], axis=1)
    return np.repeat(x[starts], 2), bounds.ravel()


def peaks(x: Array, y: Array) -> tuple[Array, Array]:
    """Reduce points that are too dense for a logarithmic axis to their maxima."""
    starts = np.unique(np.geomspace(1, len(x), _MOST).astype(np.intp) - 1)
    return x[starts], np.maximum.reduceat(y, starts)


def _thinned(values: Array) -> Array:
    return values[:: math.ceil(len(values) / _MOST)]
