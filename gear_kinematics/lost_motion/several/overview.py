"""The panels that show several recordings together."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import cycle
from os.path import commonprefix

import numpy as np

from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.several.common import (
    LOST_MOTION,
    Basis,
    Quantity,
    backlash,
    leaving,
)
from gear_kinematics.lost_motion.several.comparison import Group, estimate
from gear_kinematics.lost_motion.several.trend import Trend
from gear_kinematics.lost_motion.static.ramps import Array, Ramps
from gear_kinematics.lost_motion.wording import ARC_MINUTES, PERCENT, torque
from gear_kinematics.report.document import Figure, Line, Panel, Pen, printable
from gear_kinematics.state.uncertainty import Estimate

_PENS = (Pen.FIRST, Pen.SECOND, Pen.THIRD, Pen.FOURTH, Pen.FIFTH, Pen.SIXTH)
_WORD_END = re.compile(r'[\W_]')
_LEVELS = 300
"""Torques of half a loop."""
_COLUMNS = 3
"""Panels side by side."""
_ASIDE = 0.12
"""By how much the recordings of a group are moved aside from its mean and from each other."""


def overview(
    reports: Sequence[LostMotionReport],
    common: Basis | None,
    quantities: Sequence[Quantity],
    groups: Sequence[Group],
    trends: Sequence[Trend] = (),
) -> Figure:
    """Draw the loops over one another, and each figure over recordings or groups.

    Args:
        reports: at a common torque.
        common: the ramps on which they are compared.
        quantities: of the reports.
        groups: of the reports, each of one recording if there are no others.
        trends: of the quantities, if the recordings are in order of time.
    """
    panels = []
    if common:
        small, loaded = torque(common.least), torque(common.reach)
        panels.append(_loops(reports, common.small, f'about {small}', groups))
        if common.small != common.loaded:
            panels.append(_loops(reports, common.loaded, f'at least {loaded}', groups))
    found = {trend.quantity.name: trend for trend in trends}
    shown = _shown(quantities, ramps=bool(common))
    further: dict[str, tuple[Line, ...]] = {}
    if common and (bounds := _bounds(reports, common, groups)):
        gaps = backlash(reports, common)
        further[gaps.name] = bounds
        if gaps not in shown:  # less than two have a value
            shown.insert(1, gaps)
    panels += [_over_groups(q, groups, found.get(q.name), further.get(q.name, ())) for q in shown]
    return Figure(tuple(panels), columns=_COLUMNS)


def _shown(quantities: Sequence[Quantity], *, ramps: bool) -> list[Quantity]:
    """Leave out what friction disturbs most: all stiffness but the highest, and lost motion."""
    stiffness = [q for q in quantities if q.unit == 'N·m/rad']
    return [
        q for q in quantities if q not in stiffness[:-1] and not (ramps and q.name == LOST_MOTION)
    ]


def _loops(
    reports: Sequence[LostMotionReport],
    places: Sequence[int | None],
    amplitude: str,
    groups: Sequence[Group],
) -> Panel:
    lines = []
    for group, (name, pen) in zip(groups, _legend(groups), strict=True):
        for number in group.members:
            found, place = reports[number].hysteresis, places[number]
            if found and place is not None:
                load, angle = _mean_loop(found.ramps[place])
                lines.append(Line(name, pen, load, angle * ARC_MINUTES))
    # What is faint is behind.
    lines.sort(key=lambda line: line.pen != Pen.FAINT)
    return Panel(
        f'mean loops, ramps to {amplitude} N·m',
        'torque at the output [N·m]',
        'wind-up at the output [arcmin]',
        tuple(lines),
    )


def _legend(groups: Sequence[Group]) -> list[tuple[str, Pen]]:
    """Name and pen of each group; of many, only the first and the last are told apart."""
    names = _short(groups)
    if len(groups) <= len(_PENS):
        return list(zip(names, cycle(_PENS), strict=False))
    between = [('between them', Pen.FAINT)] * (len(groups) - 2)
    return [(names[0], Pen.FIRST), *between, (names[-1], Pen.SECOND)]


def _mean_loop(ramps: Ramps) -> tuple[Array, Array]:
    """Torques and mean angles of the loops of one amplitude, N·m and rad, from peak to peak."""
    load = ramps.amplitude * np.linspace(1.0, -1.0, _LEVELS)
    centre = float(np.mean([loop.middle(0.0) for loop in ramps.loops]))
    fall = np.mean([loop.fall.angle_at(load) for loop in ramps.loops], axis=0)
    rise = np.mean([loop.rise.angle_at(load[::-1]) for loop in ramps.loops], axis=0)
    return np.concatenate([load, load[::-1]]), np.concatenate([fall, rise]) - centre


def _bounds(
    reports: Sequence[LostMotionReport], common: Basis, groups: Sequence[Group]
) -> tuple[Line, ...]:
    """Draw upper bounds of the backlash, from zero up."""
    found = leaving(reports, common)
    models = [(x, f.play_model) for x, number in _places(groups) if (f := found[number])]
    bounds = [(x, model.limit) for x, model in models if model and model.limit is not None]
    if not bounds:
        return ()
    x, limits = np.array(bounds).T
    y = np.stack([0.0 * limits, limits, np.full_like(limits, np.nan)], axis=1)
    return (
        Line(f'upper bounds ({PERCENT})', Pen.SECOND, np.repeat(x, 3), y.ravel() * ARC_MINUTES),
    )


def _over_groups(
    quantity: Quantity, groups: Sequence[Group], trend: Trend | None, further: tuple[Line, ...]
) -> Panel:
    unit = f'{quantity.name} [{quantity.unit}]'
    return Panel(
        f'{quantity.name} (lines: {further[0].name})' if further else quantity.name,
        '',
        unit,
        (*_points(quantity, groups, trend), *further),
        marks=tuple((step.since - 0.5, '') for step in trend.steps) if trend else (),
        ticks=tuple((float(k), name) for k, name in enumerate(_short(groups))),
    )


def _points(quantity: Quantity, groups: Sequence[Group], trend: Trend | None) -> Iterator[Line]:
    means = [(float(k), estimate(quantity, group)) for k, group in enumerate(groups)]
    if several := _several(groups):
        own = [(x, quantity.values[number]) for x, number in _places(groups)]
        yield replace(_line('recordings', Pen.FAINT, quantity, own), error=None)
    if any(value for _, value in means):
        yield _line('means of groups' if several else 'recordings', Pen.FIRST, quantity, means)
    if trend and trend.changed:
        x = np.array(trend.numbers, dtype=np.float64)
        yield Line('fit', Pen.MODEL, *_parts(x, trend))


def _several(groups: Sequence[Group]) -> bool:
    return any(len(group.members) > 1 for group in groups)


def _places(groups: Sequence[Group]) -> list[tuple[float, int]]:
    """Return the places of all recordings, with their numbers: beside the means, if there are."""
    aside = _ASIDE if _several(groups) else 0.0
    return [
        (k + aside * (1.0 + place / len(group.members)), number)
        for k, group in enumerate(groups)
        for place, number in enumerate(group.members)
    ]


def _parts(x: Array, trend: Trend) -> tuple[Array, Array]:
    """The fit, with a gap at each step."""
    edges = [trend.numbers.index(step.since) for step in trend.steps]
    fitted = trend.fitted * trend.quantity.scale
    return np.insert(x, edges, np.nan), np.insert(fitted, edges, np.nan)


def _line(
    name: str,
    pen: Pen,
    quantity: Quantity,
    places: Sequence[tuple[float, Estimate | None]],
) -> Line:
    known = [(place, value) for place, value in places if value]
    spread = [np.nan if v.uncertainty is None else v.uncertainty for _, v in known]
    return Line(
        name,
        pen,
        np.array([place for place, _ in known]),
        np.array([value.value for _, value in known]) * quantity.scale,
        points=True,
        error=np.array(spread) * quantity.scale,
    )


def _short(groups: Sequence[Group]) -> list[str]:
    """Names without what the names of all files have in common at their ends."""
    names = [group.name for group in groups]
    if len(names) == 1:
        return [printable(names[0])]
    end = commonprefix([name[::-1] for name in names])[::-1]  # noqa: RUF071, of characters
    # Words are not cut.
    end = end[match.start() :] if (match := _WORD_END.search(end)) else ''
    return [printable(name.removesuffix(end)) for name in names]
