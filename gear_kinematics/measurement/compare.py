# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The section of a report that compares several recordings at one torque."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from gear_kinematics.measurement.changes import (
    Change,
    Group,
    changes_of,
    judged,
    quantities,
    single,
)
from gear_kinematics.measurement.document import Comparison
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import HYSTERESIS, shown
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report.document import (
    PENS,
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

_TORQUES = 300
"""Points of half a loop in a plot."""
_WITHIN = 'Record each state several times, and compare with --group: recordings differ by more'


def compared(
    reports: Sequence[LostMotion], groups: Sequence[Group] | None = None
) -> Comparison | None:
    """Compare groups of recordings, or single ones, with the first.

    The recordings are those that `at_common_torque` returns. Without a figure in common, there is
    nothing to compare: None.
    """
    found, unlike = quantities(reports)
    named = groups or single([report.name for report in reports])
    changes = judged([change for quantity in found for change in changes_of(quantity, named)])
    if not changes:
        return None
    repeated, several = any(change.repeated for change in changes), len(named) > 2  # noqa: PLR2004
    sentence = _changed(changes, named)
    sentence += '' if several else _play(reports, named[1])
    sentence += '' if repeated else '; judged by the scatter within single recordings'
    remarks = [] if repeated else [f'{_WITHIN}.']
    if unlike:
        others = f'the smallest ramps of {", ".join(unlike)} are smaller than those of the others'
        remarks.append(f'Hysteresis and friction: not compared where {others}.')
    section = Section(
        'comparison',
        (_table(changes, several=several),),
        remarks=tuple(map(printable, remarks)),
        figure=_figure(reports, named),
        leads=True,
    )
    members = [
        {'name': group.name, 'recordings': [reports[k].name for k in group.members]}
        for group in named
    ]
    data = {'groups': members, 'changes': [_data(change) for change in changes]}
    return Comparison(section, printable(sentence), data)


def _changed(changes: Sequence[Change], groups: Sequence[Group]) -> str:
    """Say what has changed: of two groups all that is clear, of several the first figure."""
    first, second, *others = (group.name for group in groups)
    if others:
        same = [change for change in changes if change.quantity == changes[0].quantity]
        clear = sum(change.significant for change in same)
        return f'against {first}: {_arrow(*same)} ({clear} of {len(same)} significant)'
    parts = [
        f'{_arrow(change)} ({change.judgement})'
        for change in changes
        if change.significant or change.quantity.name == HYSTERESIS
    ]
    return f'{second} against {first}: {", ".join(parts) or "no significant change"}'


def _arrow(*changes: Change) -> str:
    """Say how one figure has changed, in one group or several."""
    first = changes[0]
    before = shown(first.quantity.unit, first.before).text
    after = shown(first.quantity.unit, *(change.after for change in changes)).with_unit()
    return f'{first.quantity.name} {before} → {after}'


def _play(reports: Sequence[LostMotion], group: Group) -> str:
    """Say by intervals what is left of the backlash in a group."""
    found = [own.backlash for k in group.members if (own := reports[k].figures)]
    if not found:
        return ''
    low = ARC_MINUTES * min(one.low for one in found)
    high = ARC_MINUTES * max(math.inf if one.high is None else one.high for one in found)
    if low > 0.0:
        return f'; there is play of at least {number(low)}′'
    bound = f' (at most {number(high)}′)' if high < math.inf else ''
    return f'; whether play is left is undetermined{bound}'


def _table(changes: Sequence[Change], *, several: bool) -> Table:
    return Table.of_items(
        {
            'change': lambda c: printable(
                f'{c.quantity.name}{f", {c.second}" if several else ""}'
            ),
            'before': lambda c: shown(c.quantity.unit, c.before),
            'after': lambda c: shown(c.quantity.unit, c.after),
            'ratio': lambda c: number(c.after / c.before),
            'interval': lambda c: ' to '.join(map(number, c.interval)),
            'judgement': lambda c: Cell(
                c.judgement, Tone.NOTABLE if c.significant else Tone.PLAIN
            ),
        },
        changes,
        ('', 'judgement'),
    )


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


def _figure(reports: Sequence[LostMotion], groups: Sequence[Group]) -> Figure | None:
    """Draw the mean loops of the largest ramps of recordings over one another."""
    lines = []
    for k, group in enumerate(groups):
        for figures in (own for m in group.members if (own := reports[m].figures)):
            ramps = figures.ramps[-1]
            torque = ramps.amplitude * np.linspace(1.0, -1.0, _TORQUES)
            fall = np.mean([loop.fall.angle_at(torque) for loop in ramps.loops], axis=0)
            rise = np.mean([loop.rise.angle_at(torque[::-1]) for loop in ramps.loops], axis=0)
            angle = np.concatenate([fall, rise]) - np.mean([fall, rise])
            around = np.concatenate([torque, torque[::-1]])
            pen = PENS[k] if k < len(PENS) else Pen.FAINT
            lines.append(Line(printable(group.name), pen, around, angle * ARC_MINUTES))
    labels = 'torque at the output [N·m]', 'wind-up at the output [arcmin]'
    return Figure((Panel('mean loops', *labels, tuple(lines)),)) if lines else None
