"""The tables of a report on lost motion, in arc minutes."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.figures import LOST_MOTION_SHARE, Figures, GearFigures, Stiffness
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.middle_line import Backlash
from gear_kinematics.measurement.transmission import TransmissionFigures
from gear_kinematics.measurement.wording import (
    ARC_MINUTES,
    PERCENT,
    arc_minutes,
    plus_minus,
    rounded,
)
from gear_kinematics.report.document import Cell, Layout, Table, Tone, counted, number, printable

_SCALES = {'arcmin': ARC_MINUTES, 'ms': 1e3}
"""From SI to the units that are not."""


def head(report: LostMotion) -> Table:
    """Return what a recording contains and how it was read."""
    found = report.figures
    rates = [figures.rate for figures in found.by_amplitude] if found else []
    motion = report.transmission
    kinds = {'static (torque ramps)': found, 'dynamic (in motion)': motion}
    return Table.of_values(
        Layout.INLINE,
        ('samples', str(report.recording.rows)),
        ('columns', printable('; '.join(report.recording.columns))),
        ('gear ratio', str(report.gear_ratio)),
        ('rated torque', f'{number(found.settings.rated_torque)} N·m' if found else ''),
        ('test', ', '.join(kind for kind, known in kinds.items() if known)),
        ('travel', f'{number(math.degrees(motion.travel), 4)}°' if motion else ''),
        ('rate of the torque', '; '.join(f'{number(rate)} N·m/s' for rate in rates if rate)),
    )


def tables(report: LostMotion) -> Iterator[Table]:
    """Yield the tables for the available results."""
    if found := report.figures:
        yield _table(figure for figure in _figures(found) if figure.clear)
        if len(found.by_amplitude) > 1:
            yield _amplitude_table(found)
        yield _stiffness_table(found)
    if motion := report.transmission:
        both = report.recording.encoders
        timed = bool(both and both.timed)
        yield _table(figure for figure in _errors(motion, timed=timed) if figure.value)
        yield _order_table(motion)


class _Figure(NamedTuple):
    """A row of a table of figures."""

    label: str
    unit: str
    value: Estimate | Backlash | None
    """SI."""
    source: str = ''

    @property
    def clear(self) -> bool:
        """Whether the value is known, and its uncertainty does not exceed it."""
        return self.value.clear if isinstance(self.value, Estimate) else self.value is not None

    @property
    def scale(self) -> float:
        """The factor with which the value is shown."""
        return _SCALES.get(self.unit, 1.0)


def _table(figures: Iterable[_Figure]) -> Table:
    columns = ('figure', 'value', f'± ({PERCENT})', 'repeats', 'from')
    return Table(columns, tuple(map(_row, figures)), ('', 'from'))


def _row(figure: _Figure) -> tuple[Cell, ...]:
    label, unit, value, source = figure
    if isinstance(value, Backlash):
        if value.value is None:
            interval = Cell(shown(value, figure.scale), unit='' if value.high is None else unit)
            return Cell(label, unit=unit), interval, Cell(''), Cell(''), Cell(source)
        value = value.value
    texts = (*rounded(value, figure.scale), str(value.repeats)) if value else ('', '', '')
    text, spread, repeats = texts
    uncertainty = Cell(spread, Tone.PLAIN if spread else Tone.NOTABLE, unit)
    return Cell(label, unit=unit), Cell(text, unit=unit), uncertainty, Cell(repeats), Cell(source)


def _figures(found: GearFigures) -> list[_Figure]:
    """List the figures: of friction from small ramps, others from the largest."""
    small, large = map(_source, (found.smallest, found.largest))
    at = number(LOST_MOTION_SHARE * found.settings.rated_torque)
    load, whole = number(found.settings.small_load), found.largest.overall
    return [
        _Figure('hysteresis at zero torque', 'arcmin', found.hysteresis, small),
        _Figure('backlash', 'arcmin', found.backlash, 'all ramps'),
        _Figure(f'lost motion at ±{at} N·m', 'arcmin', found.lost_motion, large),
        _Figure(
            f'lost motion without friction at ±{load} N·m', 'arcmin', found.frictionless, small
        ),
        _Figure('friction', 'N·m', found.friction, small),
        *(_Figure(f'stiffness {_range(s)}', 'N·m/rad', s.both, large) for s in found.stiffness),
        _Figure('stiffness of whole loops', 'N·m/rad', whole.both if whole else None, large),
    ]


def _source(figures: Figures) -> str:
    return f'{counted(figures.loops, "loop")} to {number(figures.amplitude)} N·m'


def _range(stiffness: Stiffness) -> str:
    return f'{number(stiffness.low)} to {number(stiffness.high)} N·m'


def too_uncertain(found: GearFigures) -> list[str]:
    """Describe the figures that are left out of their table, as their ± exceed them."""
    return [
        f'{figure.label} ({shown(figure.value, figure.scale)} {figure.unit})'
        for figure in _figures(found)
        if figure.value and not figure.clear
    ]


def shown(value: Estimate | Backlash | None, scale: float) -> str:
    """Format a figure; a backlash without a value, as the interval that contains it."""
    if not isinstance(value, Backlash):
        return plus_minus(value, scale)
    if value.high is None:
        return 'unknown'
    if value.value:
        return plus_minus(value.value, scale)
    return f'{number(value.low * scale)} to {number(value.high * scale)}'


def _amplitude_table(found: GearFigures) -> Table:
    """Compare the ramps of different amplitude."""
    return Table.of_items(
        {
            'ramps': lambda f: f'to {number(f.amplitude)} N·m',
            'loops': lambda f: str(f.loops),
            'hysteresis [arcmin]': lambda f: arc_minutes(f.hysteresis),
            'lost motion [arcmin]': lambda f: arc_minutes(f.lost_motion),
            'without friction [arcmin]': lambda f: arc_minutes(f.frictionless),
            'backlash [arcmin]': lambda f: shown(f.backlash, ARC_MINUTES) or 'unknown',
            'friction [N·m]': lambda f: plus_minus(f.friction),
        },
        found.by_amplitude,
    )


def _stiffness_table(found: GearFigures) -> Table:
    """Return the stiffness for positive, negative and both signs of torque."""
    return Table.of_items(
        {
            'stiffness [N·m/rad]': lambda row: (
                f'{_range(row[1])}, ramps to {number(row[0].amplitude)} N·m'
            ),
            'both': lambda row: plus_minus(row[1].both),
            'positive': lambda row: plus_minus(row[1].positive),
            'negative': lambda row: plus_minus(row[1].negative),
        },
        [(figures, s) for figures in found.by_amplitude for s in figures.stiffness],
    )


def _errors(found: TransmissionFigures, *, timed: bool) -> list[_Figure]:
    """List the figures of the transmission error."""
    return [
        _Figure('transmission accuracy forward', 'arcmin', found.forward),
        _Figure('transmission accuracy backward', 'arcmin', found.backward),
        _Figure('backward minus forward', 'arcmin', found.reversals),
        _Figure('lost motion on reversals', 'arcmin', found.lost_motion),
        _Figure('delay of the output encoder', 'ms' if timed else 'rows', found.delay),
    ]


def _order_table(found: TransmissionFigures) -> Table:
    """Return the amplitudes of the marked orders."""
    return Table.of_items(
        {
            'order': lambda order: order.name,
            'cycles per output turn': lambda order: str(order.cycles),
            'forward [arcmin]': lambda order: arc_minutes(order.forward),
            'backward [arcmin]': lambda order: arc_minutes(order.backward),
        },
        [order for order in found.orders if order.forward or order.backward],
    )


def key(report: LostMotion) -> Table:
    """Return the figures of the summary, which a page shows first."""
    return Table.of_values(Layout.INLINE, *_main_figures(report).items())


def summary(reports: Sequence[LostMotion]) -> Table:
    """Return a row for each recording, of at least one."""
    rows = [(printable(report.name), *_main_figures(report).values()) for report in reports]
    columns = ('recording', *_main_figures(reports[0]))
    return Table(columns, tuple(tuple(map(Cell, row)) for row in rows))


def _main_figures(report: LostMotion) -> dict[str, str]:
    found, motion = report.figures, report.transmission
    moving = found or motion
    return {
        'hysteresis [arcmin]': arc_minutes(found.hysteresis) if found else '',
        'backlash [arcmin]': shown(found.backlash, ARC_MINUTES) if found else '',
        'lost motion [arcmin]': arc_minutes(moving.lost_motion) if moving else '',
        'stiffness [N·m/rad]': (
            plus_minus(found.stiffness[-1].both) if found and found.stiffness else ''
        ),
        'transmission accuracy [arcmin]': arc_minutes(motion.forward) if motion else '',
    }
