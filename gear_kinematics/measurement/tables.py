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

_FIGURES = ('figure', 'value', f'± ({PERCENT})', 'in degrees', 'repeats', 'from')
_WORDS = ('', 'from')
_DEGREES = math.degrees(1.0)


def head(report: LostMotion) -> Table:
    """Return what a recording contains and how it was read."""
    found = report.figures
    rates = [figures.rate for figures in found.by_amplitude] if found else []
    kinds = {'static (torque ramps)': found, 'dynamic (in motion)': report.transmission}
    return Table.of_values(
        Layout.INLINE,
        ('samples', str(report.recording.rows)),
        ('columns', printable('; '.join(report.recording.columns))),
        ('gear ratio', str(report.gear_ratio)),
        ('rated torque', f'{number(found.settings.rated_torque)} N·m' if found else ''),
        ('test', ', '.join(kind for kind, known in kinds.items() if known)),
        ('rate of the torque', '; '.join(f'{number(rate)} N·m/s' for rate in rates if rate)),
    )


def tables(report: LostMotion) -> Iterator[Table]:
    """Yield the tables for the available results."""
    if found := report.figures:
        yield _figure_table(found)
        if len(found.by_amplitude) > 1:
            yield _amplitude_table(found)
        yield _stiffness_table(found)
    if report.transmission:
        yield _transmission_table(report.transmission, report)
        yield _order_table(report.transmission)


class _Figure(NamedTuple):
    """A row of a table of figures."""

    label: str
    unit: str
    estimate: Estimate | None
    source: str = ''
    scale: float = 1.0


def _angle(label: str, estimate: Estimate | None, source: str = '') -> _Figure:
    return _Figure(label, 'arcmin', estimate, source, ARC_MINUTES)


def _rows(figures: Iterable[_Figure]) -> Iterator[tuple[Cell, ...]]:
    """Yield rows of the known figures."""
    for label, unit, estimate, source, scale in figures:
        if estimate:
            value, spread = rounded(estimate, scale)
            yield (
                Cell(label, unit=unit),
                Cell(value, unit=unit),
                Cell(spread, Tone.PLAIN if spread else Tone.NOTABLE, unit=unit),
                Cell(rounded(estimate, _DEGREES)[0] if unit == 'arcmin' else '', unit='°'),
                Cell(str(estimate.repeats)),
                Cell(source),
            )


def _figures(found: GearFigures) -> list[_Figure]:
    """List the figures: of friction from small ramps, others from the largest."""
    smallest, largest = found.smallest, found.largest
    small, large = map(_source, (smallest, largest))
    at = number(LOST_MOTION_SHARE * found.settings.rated_torque)
    load = number(found.settings.small_load)
    stiffness = {_range(s): s.both for s in largest.stiffness}
    if largest.overall:
        stiffness['of whole loops'] = largest.overall.both
    return [
        _angle('hysteresis at zero torque', smallest.hysteresis, small),
        _angle(f'lost motion at ±{at} N·m', largest.lost_motion, large),
        _angle(f'lost motion without friction at ±{load} N·m', found.frictionless, small),
        _Figure('friction', 'N·m', smallest.friction, small),
        *(_Figure(f'stiffness {of}', 'N·m/rad', s, large) for of, s in stiffness.items()),
    ]


def _source(figures: Figures) -> str:
    return f'{counted(figures.loops, "loop")} to {number(figures.amplitude)} N·m'


def _range(stiffness: Stiffness) -> str:
    return f'{number(stiffness.low)} to {number(stiffness.high)} N·m'


def too_uncertain(found: GearFigures) -> list[str]:
    """Describe the figures that are left out of their table, as their ± exceed them."""
    return [
        f'{figure.label} ({plus_minus(figure.estimate, figure.scale)} {figure.unit})'
        for figure in _figures(found)
        if figure.estimate and not figure.estimate.clear
    ]


def _figure_table(found: GearFigures) -> Table:
    rows = list(_rows(f for f in _figures(found) if f.estimate and f.estimate.clear))
    rows.insert(1, _backlash_row(found.backlash))
    return Table(_FIGURES, tuple(rows), _WORDS)


def _backlash_row(backlash: Backlash) -> tuple[Cell, ...]:
    if backlash.value:
        return next(_rows([_angle('backlash', backlash.value, 'all ramps')]))
    minutes, degrees = (
        Cell(interval(backlash, scale), unit='' if backlash.high is None else unit)
        for scale, unit in ((ARC_MINUTES, 'arcmin'), (_DEGREES, '°'))
    )
    cells = (minutes, Cell(''), degrees, Cell(''), Cell('all ramps'))
    return (Cell('backlash', unit='arcmin'), *cells)


def interval(backlash: Backlash | None, scale: float = ARC_MINUTES) -> str:
    """Format a backlash: a value, or the interval that contains it."""
    if backlash is None or backlash.high is None:
        return 'unknown'
    if backlash.value:
        return plus_minus(backlash.value, scale)
    return f'{number(backlash.low * scale)} to {number(backlash.high * scale)}'


def _amplitude_table(found: GearFigures) -> Table:
    """Compare the ramps of different amplitude."""
    return Table.of_items(
        {
            'ramps': lambda f: f'to {number(f.amplitude)} N·m',
            'loops': lambda f: str(f.loops),
            'hysteresis [arcmin]': lambda f: arc_minutes(f.hysteresis),
            'lost motion [arcmin]': lambda f: arc_minutes(f.lost_motion),
            'without friction [arcmin]': lambda f: arc_minutes(f.frictionless),
            'backlash [arcmin]': lambda f: interval(f.backlash),
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


def _transmission_table(found: TransmissionFigures, report: LostMotion) -> Table:
    """Return the figures of the transmission error."""
    both = report.recording.encoders
    unit, scale = ('ms', 1e3) if both and both.timed else ('rows', 1.0)
    rows = _rows(
        (
            _angle('transmission accuracy forward', found.forward),
            _angle('transmission accuracy backward', found.backward),
            _angle('backward minus forward', found.reversals),
            _angle('lost motion on reversals', found.lost_motion),
            _Figure('delay of the output encoder', unit, found.delay, '', scale),
        )
    )
    travel = number(math.degrees(found.travel), 4)
    offset = (
        Cell('mean error', unit='arcmin'),
        Cell(number(found.offset * ARC_MINUTES, 5), unit='arcmin'),
        Cell(''),
        Cell(number(math.degrees(found.offset), 5), unit='°'),
        Cell(''),
        Cell(f'{found.samples} samples over {travel}° of the output'),
    )
    return Table(_FIGURES, (*rows, offset), _WORDS)


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
    return Table.of_values(Layout.INLINE, *_quantities(report).items())


def summary(reports: Sequence[LostMotion]) -> Table:
    """Return a row for each recording, of at least one."""
    rows = [(printable(report.name), *_quantities(report).values()) for report in reports]
    columns = ('recording', *_quantities(reports[0]))
    return Table(columns, tuple(tuple(map(Cell, row)) for row in rows))


def _quantities(report: LostMotion) -> dict[str, str]:
    hysteresis = lost_motion = stiffness = accuracy = None
    backlash = ''
    if error := report.transmission:
        lost_motion, accuracy = error.lost_motion, error.forward
    if found := report.figures:
        hysteresis, lost_motion = found.smallest.hysteresis, found.largest.lost_motion
        stiffness = found.largest.stiffness[-1].both if found.largest.stiffness else None
        backlash = interval(found.backlash)
    return {
        'hysteresis [arcmin]': arc_minutes(hysteresis),
        'backlash [arcmin]': backlash,
        'lost motion [arcmin]': arc_minutes(lost_motion),
        'stiffness [N·m/rad]': plus_minus(stiffness),
        'transmission accuracy [arcmin]': arc_minutes(accuracy),
    }
