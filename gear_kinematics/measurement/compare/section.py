# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The sections of a report on several recordings, in words, tables and panels."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from gear_kinematics.measurement.compare.changes import (
    FEWEST,
    SIGNIFICANCE,
    Change,
    changes_of,
    judged,
    trend,
)
from gear_kinematics.measurement.compare.quantities import Common, in_common
from gear_kinematics.measurement.document import Comparison
from gear_kinematics.measurement.figures import Figures
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import HYSTERESIS, SHOWN, shown
from gear_kinematics.measurement.names import Group, single
from gear_kinematics.measurement.wording import ARC_MINUTES, PERCENT
from gear_kinematics.report.document import (
    Cell,
    Figure,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    Tone,
    number,
    printable,
)

_DAY = 86400.0  # s
_PENS = (Pen.FIRST, Pen.SECOND, Pen.THIRD, Pen.FOURTH, Pen.FIFTH, Pen.SIXTH)
_TORQUES = 300
"""Of half a loop in a plot."""
_LEAST = 1e-4
"""Probability below which no number is given."""
_JUDGED = (
    f'A change of the hysteresis is called significant by chance in at most '
    f'{100.0 * SIGNIFICANCE:g} % of comparisons, and likewise one of the others; intervals '
    f'contain the ratio with a probability of {PERCENT}'
)
_BETWEEN = f'{_JUDGED}, by the scatter between recordings: the same share in all groups'
_WITHIN = (
    f'{_JUDGED}, by the scatter within recordings, which is less than that between them: record '
    'each state several times, and name the groups with --group'
)
_ORDERS = f'{_JUDGED}, if the place of a step is right; by chance: share of random orders'


def compared(
    reports: Sequence[LostMotion],
    groups: Sequence[Group] | None = None,
    positions: Sequence[str] | None = None,
) -> Comparison | None:
    """Compare groups of recordings at a common torque, or single ones, with the first.

    With positions of the output, one per recording, they are paired. Without a figure in common,
    there is nothing to compare: None.
    """
    common = in_common(reports)
    named = groups or single([report.name for report in reports])
    each = (changes_of(quantity, named, positions) for quantity in common.quantities)
    found = judged([change for own in each for change in own])
    if not found:
        return None
    repeated = any(change.repeated for change in found)
    answer = _changed(found, named, _play(reports, named))
    answer += '' if repeated else '; judged by the scatter within single recordings'
    members = [
        {'name': group.name, 'recordings': [reports[k].name for k in group.members]}
        for group in named
    ]
    data = {'groups': members, 'changes': [_data(change) for change in found]}
    texts = answer, _BETWEEN if repeated else _WITHIN
    table = _table(found, lambda c: f', {c.second}' if len(named) > 2 else '')  # noqa: PLR2004
    return _comparison('comparison', common, named, table, texts, data)


def over_time(reports: Sequence[LostMotion], times: Sequence[float], source: str) -> Comparison:
    """Find since when a gear has changed, by recordings at a common torque in order of time.

    Args:
        reports: one for each of the times.
        times: s, ascending.
        source: of the times.

    Raises:
        ValueError: if too few recordings have a figure in common.
    """
    common, named = in_common(reports), single([report.name for report in reports])
    names = [group.name for group in named]
    found = judged([best for q in common.quantities if (best := trend(q, times, names))])
    if not found:
        raise ValueError(f'a trend needs {FEWEST} recordings with the same figures')

    def since(change: Change) -> str:
        slope = (change.first, change.second) == (names[0], names[-1])
        return 'over the whole time' if slope else f'since {change.second}'

    clear = [change for change in found if change.significant]
    clear.sort(key=lambda change: (names.index(change.second), since(change)))
    since_when = '; '.join(
        f'{start}: {", ".join(f"{_arrow(change)} (p = {_chance(change)})" for change in same)}'
        for start, same in groupby(clear, since)
    )
    days = [(time - times[0]) / _DAY for time in times]
    data = {
        'recordings': [{'name': r.name, 'days': d} for r, d in zip(reports, days, strict=True)],
        'times_from': source,
        'figures': [_data(change) for change in found],
    }
    span = f'The recordings span {number(days[-1])} days, by {source}'
    texts = since_when or f'no change is shown by {len(reports)} recordings', _ORDERS, span
    table = _table(found, lambda c: f' {since(c)}')
    return _comparison('trend', common, named, table, texts, {'trend': data})


def _comparison(
    name: str,
    common: Common,
    groups: Sequence[Group],
    table: Table,
    texts: Sequence[str],
    data: Mapping[str, Any],
) -> Comparison:
    remarks = tuple(f'{printable(text)}.' for text in (*texts, *common.remarks))
    section = Section(name, (table,), remarks=remarks, figure=_figure(common, groups))
    return Comparison(section, printable(texts[0]), data)


def _table(found: Sequence[Change], about: Callable[[Change], str]) -> Table:
    """Return a row for each change, whose subject says besides the figure what it is about."""
    columns: dict[str, Callable[[Change], str | Cell]] = {
        'change': lambda c: printable(f'{c.quantity.name}{about(c)}'),
        'before': lambda c: shown(c.quantity.unit, c.before),
        'after': lambda c: shown(c.quantity.unit, c.after),
        'ratio': lambda c: number(c.after / c.before),
        'interval': lambda c: ' to '.join(map(number, c.interval)),
        'by chance': _chance,
        'judgement': lambda c: Cell(c.judgement, Tone.NOTABLE if c.significant else Tone.PLAIN),
    }
    return Table.of_items(columns, found, ('', 'judgement'))


def _chance(change: Change) -> str:
    if change.probability is None:
        return ''
    return number(change.probability, 2) if change.probability >= _LEAST else f'< {_LEAST:g}'


def _arrow(*changes: Change) -> str:
    """Say how one figure has changed, in one group or several."""
    first = changes[0]
    before = shown(first.quantity.unit, first.before).text
    after = shown(first.quantity.unit, *(change.after for change in changes)).with_unit()
    return f'{first.quantity.name} {before} → {after}'


def _changed(found: Sequence[Change], groups: Sequence[Group], play: str) -> str:
    """Say what has changed: of two groups all that is clear, of several the first figure."""
    first, second, *others = (group.name for group in groups)
    if others:
        same = [change for change in found if change.quantity == found[0].quantity]
        clear = sum(change.significant for change in same)
        return f'against {first}: {_arrow(*same)} ({clear} of {len(same)} significant)'
    parts = [
        f'{_arrow(change)} ({change.judgement})'
        for change in found
        if change.significant or change.quantity.name == HYSTERESIS
    ]
    return f'{second} against {first}: {", ".join(parts) or "no significant change"}{play}'


def _play(reports: Sequence[LostMotion], groups: Sequence[Group]) -> str:
    """Say by intervals what became of the backlash from one group to the other."""
    found = [
        [own.backlash for k in group.members if (own := reports[k].figures)] for group in groups
    ]
    if not all(found):
        return ''
    (old_low, old_high), (low, high) = (
        (
            ARC_MINUTES * min(one.low for one in own),
            ARC_MINUTES * max(math.inf if one.high is None else one.high for one in own),
        )
        for own in (found[0], found[1])
    )
    if high < old_low:
        return f'; play fell from at least {number(old_low)}′ to at most {number(high)}′'
    if low > old_high:
        return f'; play rose from at most {number(old_high)}′ to at least {number(low)}′'
    if low > 0.0:
        return f'; there is play of at least {number(low)}′'
    bound = f' (at most {number(high)}′)' if high < math.inf else ''
    return f'; whether play is left cannot be told{bound}'


def _data(change: Change) -> Mapping[str, Any]:
    low, high = change.interval or (None, None)
    return {
        'figure': change.quantity.name,
        'unit': change.quantity.unit,
        'from': {'name': change.first, 'value': change.before},
        'to': {'name': change.second, 'value': change.after},
        'ratio': change.after / change.before,
        'low': low,
        'high': high,
        'probability': change.probability,
        'significant': change.significant,
    }


# Panels


def _figure(common: Common, groups: Sequence[Group]) -> Figure:
    """Draw the loops of recordings over one another, and their main figures over the groups."""
    ticks = tuple((float(k), printable(group.name)) for k, group in enumerate(groups))
    lines = tuple(sorted(_loops(groups, common.loaded), key=lambda line: line.opacity))
    torque, angle = 'torque at the output [N·m]', 'wind-up at the output [arcmin]'
    panels = [Panel('mean loops', torque, angle, lines)] if lines else []
    places = [  # those of a group side by side
        (k + 0.5 * place / len(group.members), member)
        for k, group in enumerate(groups)
        for place, member in enumerate(group.members)
    ]
    for quantity in filter(lambda quantity: quantity.main, common.quantities):
        known = [(x, v.value, v.uncertainty) for x, m in places if (v := quantity.values[m])]
        x, y, error = np.array(known, dtype=np.float64).T
        unit, scale = SHOWN.get(quantity.unit, (quantity.unit, 1.0))
        line = Line('recordings', Pen.FIRST, x, scale * y, points=True, error=scale * error)
        panels.append(Panel(quantity.name, '', f'{quantity.name} [{unit}]', (line,), ticks=ticks))
    return Figure(tuple(panels))


def _loops(groups: Sequence[Group], chosen: Sequence[Figures | None]) -> Iterator[Line]:
    """Draw mean loops; of many groups, only the first and the last are told apart."""
    few = len(groups) <= len(_PENS)
    pens = dict(enumerate(_PENS)) if few else {0: Pen.FIRST, len(groups) - 1: Pen.SECOND}
    for k, group in enumerate(groups):
        for figures in filter(None, (chosen[member] for member in group.members)):
            ramps = figures.ramps
            torque = ramps.amplitude * np.linspace(1.0, -1.0, _TORQUES)
            fall = np.mean([loop.fall.angle_at(torque) for loop in ramps.loops], axis=0)
            rise = np.mean([loop.rise.angle_at(torque[::-1]) for loop in ramps.loops], axis=0)
            angle = np.concatenate([fall, rise]) - np.mean([fall, rise])
            around = np.concatenate([torque, torque[::-1]])
            legend = printable(group.name) if k in pens else 'between them'
            yield Line(legend, pens.get(k, Pen.FAINT), around, angle * ARC_MINUTES)
