"""One result from recordings at several positions of the output, with the spread between them."""

from collections.abc import Sequence
from dataclasses import dataclass

from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.several.common import Quantity, basis, doubts, quantities
from gear_kinematics.lost_motion.several.compared import Compared
from gear_kinematics.lost_motion.several.comparison import Group, estimate
from gear_kinematics.lost_motion.several.overview import overview
from gear_kinematics.lost_motion.wording import PERCENT, plus_minus
from gear_kinematics.report.document import Cell, Layout, Section, Table, number, printable
from gear_kinematics.state.uncertainty import Estimate

DEFAULT_PATTERN = r'pos(?:ition)?[_ -]?(\d+)'
"""Such as position_1 or pos2."""
_MEANING = (
    f'Each ± contains the mean over all positions of the output with a probability of {PERCENT}, '
    'if these positions are a random sample of them. Positions that were not measured may lie '
    'outside of the least and the greatest value.'
)


@dataclass(frozen=True, slots=True)
class OverPositions:
    """A figure of one gear at several positions of its output, SI."""

    quantity: Quantity
    gear: Group
    mean: Estimate
    """Its uncertainty is that of the mean over all positions, of which these are a sample."""
    least: float
    least_at: str
    """Name of the position."""
    greatest: float
    greatest_at: str
    single: float | None
    """Root mean square of the ± of single positions; None if one is unknown."""
    positions: int

    @property
    def spread(self) -> float:
        """Greatest less least value."""
        return self.greatest - self.least


def over_positions(
    reports: Sequence[LostMotionReport], gears: Sequence[Group], positions: Sequence[str]
) -> Compared:
    """Combine the recordings of each gear.

    Args:
        reports: as `at_common_torque` returns them.
        gears: of the reports.
        positions: names of the positions, one per report.

    Raises:
        ValueError: if they have no figure in common.
    """
    common = basis(reports)
    listed = quantities(reports, common)
    found = [
        combined
        for gear in gears
        for quantity in listed
        if (combined := _combined(quantity, gear, positions))
    ]
    if not found:
        raise ValueError('--positions: the recordings have no figure in common')
    several = len(gears) > 1
    sentence = '' if several else _sentence(found)
    head = Table.of_values(
        Layout.INLINE,
        ('positions', ', '.join(map(printable, dict.fromkeys(positions)))),
        ('recordings', str(len(reports))),
    )
    remarks = (
        *([f'{sentence}.'] if sentence else []),
        _MEANING,
        *(doubts(reports, common) if common else []),
    )
    names = [
        Group(f'{gear.name}: {positions[member]}' if several else positions[member], (member,))
        for gear in gears
        for member in gear.members
    ]
    section = Section(
        'positions',
        (head, _table(found, several=several)),
        remarks=tuple(map(printable, remarks)),
        figure=overview(reports, common, listed, names),
    )
    return Compared(section, printable(sentence), {'positions': _data(found, reports)})


def _combined(quantity: Quantity, gear: Group, positions: Sequence[str]) -> OverPositions | None:
    by_position: dict[str, list[int]] = {}
    for member in gear.members:
        by_position.setdefault(positions[member], []).append(member)
    known = [
        (value, position)
        for position, members in by_position.items()
        if (value := estimate(quantity, Group(position, tuple(members))))
    ]
    if len(known) < 2:  # noqa: PLR2004, no spread
        return None
    (least, least_at), (greatest, greatest_at) = (
        way(known, key=lambda pair: pair[0].value) for way in (min, max)
    )
    own = [value.uncertainty for value, _ in known]
    squares = [u * u for u in own if u is not None]
    return OverPositions(
        quantity,
        gear,
        Estimate.of_mean([value.value for value, _ in known]),
        least.value,
        least_at,
        greatest.value,
        greatest_at,
        (sum(squares) / len(squares)) ** 0.5 if len(squares) == len(own) else None,
        len(known),
    )


def _sentence(found: Sequence[OverPositions]) -> str:
    count = max(combined.positions for combined in found)
    parts, vague = [], []
    for c in found:
        if not c.mean.clear:
            vague.append(c.quantity.name)
            continue
        mean = plus_minus(c.mean, c.quantity.scale)
        between = f'{_scaled(c, c.least)} to {_scaled(c, c.greatest)}'
        parts.append(f'{c.quantity.name} {mean} {c.quantity.unit} ({between})')
    if vague:
        parts.append(f'too uncertain to tell: {", ".join(vague)}')
    return f'over {count} positions: {"; ".join(parts)}'


def _scaled(combined: OverPositions, value: float) -> str:
    return number(combined.quantity.scale * value)


def _table(found: Sequence[OverPositions], *, several: bool) -> Table:
    def cell(combined: OverPositions, value: float | None) -> Cell:
        text = '' if value is None else _scaled(combined, value)
        return Cell(text, unit=combined.quantity.unit)

    return Table.of_items(
        {
            'over positions': lambda c: printable(
                f'{c.gear.name}: {c.quantity.name}' if several else c.quantity.name
            ),
            'mean': lambda c: Cell(plus_minus(c.mean, c.quantity.scale), unit=c.quantity.unit),
            'least': lambda c: cell(c, c.least),
            'at': lambda c: printable(c.least_at),
            'greatest': lambda c: cell(c, c.greatest),
            'at position': lambda c: printable(c.greatest_at),
            'spread': lambda c: cell(c, c.spread),
            '± of one position': lambda c: cell(c, c.single),
            'positions': lambda c: str(c.positions),
        },
        found,
        ('', 'at', 'at position'),
    )


def _data(
    found: Sequence[OverPositions], reports: Sequence[LostMotionReport]
) -> list[dict[str, object]]:
    return [
        {
            'gear': combined.gear.name,
            'recordings': [reports[member].recording.name for member in combined.gear.members],
            'figure': combined.quantity.name,
            'mean': combined.mean,
            'least': {'value': combined.least, 'position': combined.least_at},
            'greatest': {'value': combined.greatest, 'position': combined.greatest_at},
            'spread': combined.spread,
            'single': combined.single,
            'positions': combined.positions,
        }
        for combined in found
    ]
