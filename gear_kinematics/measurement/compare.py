# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The section of a report that compares several recordings at a common torque."""

import math
from collections.abc import Iterator, Mapping, Sequence
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
from gear_kinematics.measurement.measured import HYSTERESIS, cell_of
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report import document as doc
from gear_kinematics.report.document import number, printable

_TORQUES = 300  # points of half a loop in a plot


def compared(
    reports: Sequence[LostMotion], groups: Sequence[Group] | None = None
) -> Comparison | None:
    """Compare groups of recordings, or single recordings, with the first one.

    Expects the recordings that `at_common_torque` returns. The result is None if they have no
    figure in common.
    """
    found, unlike = quantities(reports)
    named = groups or single([report.name for report in reports])
    changes = judged([change for quantity in found for change in changes_of(quantity, named)])
    if not changes:
        return None
    repeated, several = any(change.repeated for change in changes), len(named) > 2  # noqa: PLR2004
    answer = [_changed(changes, named)]
    remarks = []
    if not several:
        answer += _play(reports, named[1])
    if not repeated:
        answer.append(Observation.BY_SCATTER())
        remarks.append(Observation.REPEAT_RECORDINGS())
    if unlike:
        remarks.append(Observation.SMALL_RAMPS_DIFFER(names=unlike))
    section = doc.Section(
        'comparison',
        (_table(changes, several=several),),
        remarks=tuple(printable(str(remark)) for remark in remarks),
        figure=_figure(reports, named),
        leads=True,
    )
    members = [
        {'name': group.name, 'recordings': [reports[k].name for k in group.members]}
        for group in named
    ]
    data = {'groups': members, 'changes': [_data(change) for change in changes]}
    return Comparison(section, printable('; '.join(map(str, answer))), data)


def _changed(changes: Sequence[Change], groups: Sequence[Group]) -> Observed:
    """Say what has changed: all clear changes of two groups, or one figure of several groups."""
    first, second, *others = (group.name for group in groups)
    if others:
        same = [change for change in changes if change.quantity == changes[0].quantity]
        clear = sum(change.significant for change in same)
        changed = Observation.CHANGED(**_values(*same))
        return Observation.SEVERAL_COMPARED(
            first=first, changes=changed, clear=clear, count=len(same)
        )
    clearly = [
        Observation.CHANGED_SURELY(**_values(change), judgement=change.judgement)
        for change in changes
        if change.significant or change.quantity.name == HYSTERESIS
    ]
    return Observation.TWO_COMPARED(
        second=second, first=first, changes=clearly or Observation.NO_CHANGE()
    )


def _values(*changes: Change) -> dict[str, str]:
    """Format a figure before and after its changes, with one change for each later group."""
    first = changes[0]
    before = cell_of(first.quantity.unit, first.before).text
    after = cell_of(first.quantity.unit, *(change.after for change in changes)).with_unit()
    return {'figure': first.quantity.name, 'before': before, 'value': after}


def _play(reports: Sequence[LostMotion], group: Group) -> Iterator[Observed]:
    """Yield how much backlash is left in a group, by its interval in each recording."""
    found = [own.backlash for k in group.members if (own := reports[k].figures)]
    if not found:
        return
    low = min(one.low for one in found)
    high = max(math.inf if one.high is None else one.high for one in found)
    if low > 0.0:
        yield Observation.PLAY_LEFT(low=low)
    elif high < math.inf:
        yield Observation.PLAY_AT_MOST(high=high)
    else:
        yield Observation.PLAY_UNDETERMINED()


def _table(changes: Sequence[Change], *, several: bool) -> doc.Table:
    return doc.Table.of_items(
        {
            'change': lambda c: printable(
                f'{c.quantity.name}{f", {c.second}" if several else ""}'
            ),
            'before': lambda c: cell_of(c.quantity.unit, c.before),
            'after': lambda c: cell_of(c.quantity.unit, c.after),
            'ratio': lambda c: number(c.after / c.before),
            'interval': lambda c: ' to '.join(map(number, c.interval)),
            'judgement': lambda c: doc.Cell(
                c.judgement, doc.Tone.NOTABLE if c.significant else doc.Tone.PLAIN
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


def _figure(reports: Sequence[LostMotion], groups: Sequence[Group]) -> doc.Figure | None:
    """Draw the mean loops of the largest ramps of all recordings into one plot."""
    lines = []
    for k, group in enumerate(groups):
        for figures in (own for m in group.members if (own := reports[m].figures)):
            ramps = figures.ramps[-1]
            torque = ramps.amplitude * np.linspace(1.0, -1.0, _TORQUES)
            fall = np.mean([loop.fall.angle_at(torque) for loop in ramps.loops], axis=0)
            rise = np.mean([loop.rise.angle_at(torque[::-1]) for loop in ramps.loops], axis=0)
            angle = np.concatenate([fall, rise]) - np.mean([fall, rise])
            around = np.concatenate([torque, torque[::-1]])
            pen = doc.PENS[k] if k < len(doc.PENS) else doc.Pen.FAINT
            lines.append(doc.Line(printable(group.name), pen, around, angle * ARC_MINUTES))
    labels = 'torque at the output [N·m]', 'wind-up at the output [arcmin]'
    return doc.Figure((doc.Panel('mean loops', *labels, tuple(lines)),)) if lines else None
