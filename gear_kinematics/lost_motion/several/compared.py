"""The section of a report that compares several recordings, in words and tables."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.several.common import (
    Basis,
    Quantity,
    basis,
    doubts,
    leaving,
    quantities,
    rate_doubts,
    without_play,
)
from gear_kinematics.lost_motion.several.comparison import (
    SIGNIFICANCE,
    Change,
    Group,
    changes,
    estimate,
    single,
    spread,
)
from gear_kinematics.lost_motion.several.overview import overview
from gear_kinematics.lost_motion.wording import PERCENT, play, plus_minus, rounded, torque
from gear_kinematics.report.document import Cell, Layout, Section, Table, Tone, number, printable
from gear_kinematics.state.uncertainty import Estimate

_SINGLE = (
    'A single recording tells the scatter within it alone. Two recordings of an unchanged gear '
    'can differ by more, as after another load or at another temperature: record each state '
    'several times and name the groups with --group.'
)


@dataclass(frozen=True, eq=False, slots=True)
class Compared:
    """A comparison of recordings as part of a document."""

    section: Section
    sentence: str
    """What has changed and what has not."""
    data: Mapping[str, Any]
    """For the JSON, without its dataclasses converted."""


def compared(
    reports: Sequence[LostMotionReport], groups: Sequence[Group] | None = None
) -> Compared | None:
    """Compare recordings at a common torque with the first of them, or groups with the first.

    Args:
        reports: as `at_common_torque` returns them.
        groups: None: each recording is one.

    Returns:
        None if no two of them have a figure in common.
    """
    common = basis(reports)
    listed = quantities(reports, common)
    names = [report.recording.name for report in reports]
    named = groups or single(names)
    found = changes(listed, named)
    if not found:
        return None
    at = f'{torque(_rated(reports))} N·m' if common else ''
    sentences = [
        _sentence(list(pair), at, _limits(reports, common, named[0], second))
        for second, pair in groupby(found, lambda change: change.second)
    ]
    head = Table.of_values(
        Layout.INLINE,
        ('compared with', printable(named[0].name)),
        ('rated torque', at),
        ('changes', str(len(found))),
        ('significant', str(sum(change.significant for change in found))),
    )
    meaning = (
        f'Each ± contains its change with a probability of {PERCENT}. Changes are called '
        f'significant so that among all {len(found)} of them there is a false one with a '
        f'probability of at most {100.0 * SIGNIFICANCE:g} % (method of Holm).'
    )
    remarks = [
        *(f'{sentence}.' for sentence in sentences),
        meaning,
        *([] if all(len(group.members) > 1 for group in named) else [_SINGLE]),
        *(doubts(reports, common) if common else []),
    ]
    section = Section(
        'comparison',
        (head, _table(found), *([_groups(listed, named)] if groups else [])),
        remarks=tuple(map(printable, remarks)),
        figure=overview(reports, common, listed, named),
    )
    sentence = sentences[0] if len(sentences) == 1 else _totals(found)
    return Compared(
        section, printable(sentence), {'comparison': _data(found, listed, named, names)}
    )


def _rated(reports: Sequence[LostMotionReport]) -> float:
    return next(r.hysteresis.settings.rated_torque for r in reports if r.hysteresis)


def _limits(
    reports: Sequence[LostMotionReport], common: Basis | None, first: Group, second: Group
) -> list[str]:
    """Say in short what cannot be judged as a difference, and by what else the groups differ."""
    if not common:
        return []
    members = [*first.members, *second.members]
    said = []
    if without_play(reports, common, members):
        before, after = (_plays(reports, common, group) for group in (first, second))
        both = f'{before} in both' if before == after else f'{before} → {after}'
        said.append(f'backlash {both}')
    if rate_doubts(reports, common, members):
        said.append('at different rates of the torque')
    return said


def _plays(reports: Sequence[LostMotionReport], common: Basis, group: Group) -> str:
    """List the backlashes of a group: values and bounds."""
    plays = leaving(reports, common)
    models = [figures.play_model for number in group.members if (figures := plays[number])]
    return ' / '.join(filter(None, (play(model, ' arcmin') for model in models))) or 'unknown'


def _sentence(pair: Sequence[Change], at: str, limits: Sequence[str]) -> str:
    """Say what has changed from one group to another, and what has not."""
    first, second = pair[0].first.name, pair[0].second.name
    judged = [change for change in pair if change.probability is not None]
    parts = [f'{told(change)}, significant' for change in judged if change.significant]
    others = [change for change in judged if not change.significant]
    if same := [told(change) for change in others if change.clear]:
        parts.append(f'not significant: {", ".join(same)}')
    if vague := [change.quantity.name for change in others if not change.clear]:
        parts.append(f'too uncertain to tell: {", ".join(vague)}')
    if unknown := [change.quantity.name for change in pair if change.probability is None]:
        parts.append(f'without repeats, and therefore not judged: {", ".join(unknown)}')
    if any(len(group.members) == 1 for group in (pair[0].first, pair[0].second)):
        parts.append('judged by the scatter within single recordings')
    parts += limits
    return f'{second} against {first}{f", at {at}" if at else ""}: {"; ".join(parts)}'


def _totals(found: Sequence[Change]) -> str:
    """Say in one line which of several groups differ from the first, and in what."""
    changed: dict[str, list[str]] = {change.second.name: [] for change in found}
    for change in found:
        if change.significant:
            changed[change.second.name].append(change.quantity.name)
    listed = [f'{name} ({", ".join(names)})' for name, names in changed.items() if names]
    return (
        f'{len(listed)} of {len(changed)} differ significantly from {found[0].first.name}'
        f'{": " if listed else ""}{", ".join(listed)}'
    )


def told(change: Change) -> str:
    """Tell a change, such as `backlash 71.2 → 4.1 arcmin (-67.1 ± 2.0)`."""
    quantity = change.quantity
    if relative := change.relative:
        if change.significant:
            way = 'rose' if relative.value > 0.0 else 'fell'
            return f'{quantity.name} {way} by {plus_minus(_magnitude(relative), 100.0)} %'
        return f'{quantity.name} ({signed(relative, 100.0)} %)'
    value, _ = rounded(change.difference, quantity.scale)
    digits = len(value.partition('.')[2])
    before, after = (
        f'{quantity.scale * estimate.value:.{digits}f}'
        for estimate in (change.before, change.after)
    )
    return (
        f'{quantity.name} {before} → {after} {quantity.unit} '
        f'({signed(change.difference, quantity.scale)})'
    )


def _magnitude(estimate: Estimate) -> Estimate:
    """Return the magnitude of a change."""
    return estimate.times(math.copysign(1.0, estimate.value))


def signed(estimate: Estimate, scale: float) -> str:
    """Format a change with its sign and uncertainty."""
    return f'{"+" if estimate.value > 0.0 else ""}{plus_minus(estimate, scale)}'


def _table(found: Sequence[Change]) -> Table:
    """Return the changes, a row each."""
    several = len({change.second.name for change in found}) > 1
    return Table.of_items(
        {
            'change': lambda c: printable(
                f'{c.second.name}: {c.quantity.name}' if several else c.quantity.name
            ),
            'before': lambda c: _value(c.quantity, c.before),
            'after': lambda c: _value(c.quantity, c.after),
            'difference': lambda c: Cell(
                signed(c.difference, c.quantity.scale), unit=c.quantity.unit
            ),
            'in percent': lambda c: Cell(
                signed(c.relative, 100.0) if c.relative else '', unit='%'
            ),
            'by chance': lambda c: '' if c.probability is None else _chance(c.probability),
            'judgement': _judgement,
        },
        found,
        ('', 'judgement'),
    )


def _judgement(change: Change) -> Cell:
    if change.significant:
        return Cell('significant', Tone.NOTABLE)
    return Cell('not judged' if change.probability is None else 'not significant')


def _chance(probability: float) -> str:
    least = 1e-4
    return f'below {least:g}' if probability < least else number(probability, 2)


def _value(quantity: Quantity, value: Estimate) -> Cell:
    return Cell(plus_minus(value, quantity.scale), unit=quantity.unit)


def _groups(listed: Sequence[Quantity], groups: Sequence[Group]) -> Table:
    """Return the means of groups, with the spread between their recordings."""

    def rows() -> Iterator[tuple[Quantity, Group, Estimate]]:
        for quantity in listed:
            for group in groups:
                if mean := estimate(quantity, group):
                    yield quantity, group, mean

    def deviation(quantity: Quantity, group: Group) -> Cell:
        value = spread(quantity, group)
        text = '' if value is None else number(quantity.scale * value)
        return Cell(text, unit=quantity.unit)

    return Table.of_items(
        {
            'group': lambda row: printable(f'{row[1].name}: {row[0].name}'),
            'mean': lambda row: _value(row[0], row[2]),
            'standard deviation between recordings': lambda row: deviation(row[0], row[1]),
            'recordings': lambda row: str(
                sum(row[0].values[number] is not None for number in row[1].members)
            ),
        },
        rows(),
    )


def _data(
    found: Sequence[Change],
    listed: Sequence[Quantity],
    groups: Sequence[Group],
    names: Sequence[str],
) -> Mapping[str, Any]:
    return {
        'significance': SIGNIFICANCE,
        'groups': [
            {
                'name': group.name,
                'recordings': [names[number] for number in group.members],
                'figures': [
                    {
                        'figure': quantity.name,
                        'mean': estimate(quantity, group),
                        'deviation': spread(quantity, group),
                    }
                    for quantity in listed
                ],
            }
            for group in groups
        ],
        'changes': [
            {
                'figure': change.quantity.name,
                'from': change.first.name,
                'to': change.second.name,
                'difference': change.difference,
                'relative': change.relative,
                'probability': change.probability,
                'significant': change.significant,
            }
            for change in found
        ],
    }
