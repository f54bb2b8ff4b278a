"""The section of a report that says since when a gear has changed."""

from collections.abc import Mapping, Sequence
from typing import Any

from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.several.common import basis, doubts, quantities
from gear_kinematics.lost_motion.several.compared import Compared, signed
from gear_kinematics.lost_motion.several.comparison import SIGNIFICANCE, single
from gear_kinematics.lost_motion.several.overview import overview
from gear_kinematics.lost_motion.several.trend import FEWEST, Slope, Step, Trend, trends
from gear_kinematics.lost_motion.wording import PERCENT
from gear_kinematics.report.document import Cell, Layout, Section, Table, Tone, number, printable

_DAY = 86400.0  # s


def over_time(
    reports: Sequence[LostMotionReport], times: Sequence[float], source: str
) -> Compared:
    """Find the changes of recordings over time.

    Args:
        reports: as `at_common_torque` returns them, in order of time.
        times: of the recordings, s, ascending.
        source: of the times.

    Raises:
        ValueError: if too few recordings have a figure in common.
    """
    common = basis(reports)
    listed = quantities(reports, common)
    days = [(time - times[0]) / _DAY for time in times]
    found = trends(listed, days)
    if not found:
        raise ValueError(
            f'--trend needs {FEWEST} recordings with the same figures and their uncertainty'
        )
    names = [report.recording.name for report in reports]
    sentence = _sentence(found, names)
    head = Table.of_values(
        Layout.INLINE,
        ('recordings', str(len(reports))),
        ('from', printable(names[0])),
        ('to', printable(names[-1])),
        ('days', number(days[-1])),
        ('in order of', source),
    )
    meaning = (
        f'Each ± contains its change with a probability of {PERCENT}. If the gear has not '
        f'changed, a change is told with a probability of at most {100.0 * SIGNIFICANCE:g} %, '
        'however much its recordings scatter.'
    )
    remarks = (
        f'{sentence}.',
        meaning,
        *(doubts(reports, common) if common else ()),
    )
    section = Section(
        'trend',
        (head, _table(found, names)),
        remarks=tuple(map(printable, remarks)),
        figure=overview(reports, common, listed, single(names), found),
    )
    data = {'trend': _data(found, names, days, source)}
    return Compared(section, printable(sentence), data)


def _sentence(found: Sequence[Trend], names: Sequence[str]) -> str:
    """Say since when which figures have changed, and which have not."""
    since: dict[int, list[str]] = {}
    for trend in found:
        for step in trend.steps:
            since.setdefault(step.since, []).append(_told(trend, step))
    parts = [f'since {names[k]}: {", ".join(told)}' for k, told in sorted(since.items())]
    if rising := [_told(trend, trend.slope) for trend in found if trend.slope]:
        parts.append(f'over the whole time: {", ".join(rising)}')
    if same := [trend.quantity.name for trend in found if not trend.changed]:
        parts.append(f'no change shown by {", ".join(same)}')
    return '; '.join(parts)


def _told(trend: Trend, change: Step | Slope) -> str:
    quantity = trend.quantity
    return f'{quantity.name} {signed(change.change, quantity.scale)} {quantity.unit}'


def _table(found: Sequence[Trend], names: Sequence[str]) -> Table:
    """Return a row for each step or slope, and for each figure without one."""
    rows: list[tuple[Trend, Step | Slope | None]] = []
    for trend in found:
        rows += [(trend, step) for step in trend.steps]
        if trend.slope or not trend.steps:
            rows.append((trend, trend.slope))
    return Table.of_items(
        {
            'figure': lambda row: row[0].quantity.name,
            'change': lambda row: (
                Cell(signed(row[1].change, row[0].quantity.scale), unit=row[0].quantity.unit)
                if row[1]
                else Cell('none found')
            ),
            'since': lambda row: _since(row[1], names),
            'by chance': lambda row: number(row[0].probability, 2),
            'recordings': lambda row: str(len(row[0].numbers)),
        },
        rows,
        ('', 'since'),
    )


def _since(change: Step | Slope | None, names: Sequence[str]) -> Cell:
    match change:
        case Step():
            earliest, latest = names[change.earliest], names[change.latest]
            between = '' if earliest == latest else f' ({earliest} to {latest})'
            return Cell(printable(f'{names[change.since]}{between}'), Tone.NOTABLE)
        case Slope():
            return Cell('always: in proportion to time', Tone.NOTABLE)
    return Cell('')


def _data(
    found: Sequence[Trend], names: Sequence[str], days: Sequence[float], source: str
) -> Mapping[str, Any]:
    return {
        'recordings': [{'name': name, 'days': day} for name, day in zip(names, days, strict=True)],
        'times_from': source,
        'significance': SIGNIFICANCE,
        'figures': [
            {
                'figure': trend.quantity.name,
                'probability': trend.probability,
                'steps': [
                    {
                        'since': names[step.since],
                        'earliest': names[step.earliest],
                        'latest': names[step.latest],
                        'change': step.change,
                    }
                    for step in trend.steps
                ],
                'slope': trend.slope,
            }
            for trend in found
        ],
    }
