"""The tables of a report on lost motion, in arc minutes."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from gear_kinematics.lost_motion.dynamic.transmission import TransmissionFigures
from gear_kinematics.lost_motion.report import HysteresisReport, LostMotionReport
from gear_kinematics.lost_motion.static.hysteresis import LOST_MOTION_SHARE, Figures
from gear_kinematics.lost_motion.static.play import Candidate
from gear_kinematics.lost_motion.wording import (
    ARC_MINUTES,
    PERCENT,
    arc_minutes,
    play,
    plus_minus,
    rate_and_duration,
    rounded,
    torque,
)
from gear_kinematics.report.document import (
    Cell,
    Layout,
    Table,
    Tone,
    number,
    printable,
)
from gear_kinematics.state.uncertainty import Estimate

_FIGURES = ('figure', 'value', f'± ({PERCENT})', 'in degrees', 'repeats', 'from')
_WORDS = ('', 'from')
_QUANTITIES = (
    'hysteresis [arcmin]',
    'backlash [arcmin]',
    'lost motion [arcmin]',
    'stiffness [N·m/rad]',
    'transmission accuracy [arcmin]',
)


def head(report: LostMotionReport) -> Table:
    """Return what a recording contains and how it was read."""
    found = report.hysteresis
    rated = f'{torque(found.settings.rated_torque)} N·m ({found.rated_by})' if found else ''
    known = [rate for rate in found.rates if rate] if found else []
    return Table.of_values(
        Layout.INLINE,
        ('samples', str(report.recording.rows)),
        ('columns', printable('; '.join(report.recording.columns))),
        ('gear ratio', str(report.gear_ratio)),
        ('rated torque', rated),
        ('test', _kind(report)),
        ('rate of the torque', '; '.join(map(rate_and_duration, known))),
    )


def _kind(report: LostMotionReport) -> str:
    """Name the kind of the test as the standards divide them."""
    static = ['static (torque ramps)'] if report.hysteresis else []
    return ', '.join([*static, *(['dynamic (in motion)'] if report.transmission else [])])


def tables(report: LostMotionReport) -> Iterator[Table]:
    """Yield the tables for the available results."""
    if found := report.hysteresis:
        yield _figure_table(found)
        if len(found.figures) > 1:
            yield _amplitude_table(found)
        yield _stiffness_table(found)
        if (model := found.leaving.play_model) and model.candidates:
            yield _candidate_table(model.candidates)
    if report.transmission:
        yield _transmission_table(report.transmission, in_rows=_in_rows(report))
        yield _order_table(report.transmission)


class _Figure(NamedTuple):
    """A figure of torque ramps."""

    label: str
    unit: str
    estimate: Estimate | None
    source: str
    scale: float = 1.0

    @property
    def row(self) -> tuple[Cell, ...] | None:
        """In the table of the figures; None if it is not known, or hardly."""
        return _row(*self) if self.estimate and self.estimate.clear else None


def _figures(found: HysteresisReport) -> list[_Figure]:
    """List the figures: of friction from small ramps, others from the largest."""
    smallest, largest = found.smallest, found.largest
    small, large = map(_source, (smallest, largest))
    at = torque(LOST_MOTION_SHARE * found.settings.rated_torque)
    ranges = [(_range(s.low, s.high), s.both) for s in largest.stiffness]
    if spring := found.spring:
        ranges.append((f'of the spring {_range(spring.low, spring.high)}', spring.stiffness))
    return [
        _Figure('hysteresis at zero torque', 'arcmin', smallest.hysteresis, small, ARC_MINUTES),
        _Figure('friction (play model)', 'N·m', smallest.friction, small),
        _Figure(f'lost motion at ±{at} N·m', 'arcmin', largest.lost_motion, large, ARC_MINUTES),
        *(_Figure(f'stiffness {name}', 'N·m/rad', value, large) for name, value in ranges),
    ]


def too_uncertain(found: HysteresisReport) -> list[str]:
    """Describe the figures that are left out of their table, as their ± exceed them."""
    return [
        f'{figure.label} ({plus_minus(figure.estimate, figure.scale)} {figure.unit})'
        for figure in _figures(found)
        if figure.estimate and not figure.estimate.clear
    ]


def _figure_table(found: HysteresisReport) -> Table:
    hysteresis, *others = (figure.row for figure in _figures(found))
    rows = (hysteresis, _play_row(found.leaving), *others)
    return Table(_FIGURES, tuple(row for row in rows if row), _WORDS)


def _play_row(figures: Figures) -> tuple[Cell, ...] | None:
    model, label, source = figures.play_model, 'backlash (play model)', _source(figures)
    if not model or model.play:
        return _angle(label, figures.play, source)
    limit = number(math.degrees(model.limit)) if model.limit is not None else ''
    return (
        Cell(label, unit='arcmin'),
        Cell(play(model), unit='arcmin' if limit else ''),
        Cell(''),
        Cell(f'below {limit}' if limit else '', unit='°'),
        Cell(str(figures.loops)),
        Cell(source),
    )


def _candidate_table(candidates: Sequence[Candidate]) -> Table:
    """Return the models that were tried for the backlash, the best first."""
    return Table.of_items(
        {
            'model': lambda candidate: candidate.name,
            'error of prediction [N·m]': lambda candidate: number(candidate.error),
            'gap [arcmin]': lambda candidate: arc_minutes(candidate.gap),
            'judgement': lambda candidate: 'plausible' if candidate.plausible else 'rejected',
        },
        candidates,
        ('model', 'judgement'),
    )


def _amplitude_table(found: HysteresisReport) -> Table:
    """Compare the ramps of different amplitude."""
    return Table.of_items(
        {
            'ramps': lambda f: f'to {torque(f.amplitude)} N·m',
            'loops': lambda f: str(f.loops),
            'hysteresis [arcmin]': lambda f: arc_minutes(f.hysteresis),
            'lost motion [arcmin]': lambda f: arc_minutes(f.lost_motion),
            'backlash [arcmin]': lambda f: play(f.play_model),
            'friction [N·m]': lambda f: plus_minus(f.friction),
            'model': lambda f: f.play_model.name if f.play_model else '',
            'model residual [N·m]': lambda f: (
                number(f.play_model.residual) if f.play_model else ''
            ),
        },
        found.figures,
    )


def _stiffness_table(found: HysteresisReport) -> Table:
    """Return the stiffness for positive, negative and both signs of torque."""
    return Table.of_items(
        {
            'stiffness [N·m/rad]': lambda row: (
                f'{_range(row[1].low, row[1].high)}, ramps to {torque(row[0].amplitude)} N·m'
            ),
            'both': lambda row: plus_minus(row[1].both),
            'positive': lambda row: plus_minus(row[1].positive),
            'negative': lambda row: plus_minus(row[1].negative),
        },
        [(figures, stiffness) for figures in found.figures for stiffness in figures.stiffness],
    )


def _in_rows(report: LostMotionReport) -> bool:
    motion = report.recording.motion
    return motion is not None and motion.in_rows


def _transmission_table(found: TransmissionFigures, *, in_rows: bool) -> Table:
    """Return the figures of the transmission error."""
    delay = ('rows', 1.0) if in_rows else ('ms', 1e3)
    rows = (
        _angle('transmission accuracy forward', found.forward),
        _angle('transmission accuracy backward', found.backward),
        _angle('backward minus forward', found.reversals),
        _angle('lost motion on reversals', found.lost_motion),
        _row('delay of the output encoder', delay[0], found.delay, '', delay[1]),
    )
    travel = number(math.degrees(found.travel), 4)
    offset = (
        Cell('mean error', unit='arcmin'),
        Cell(number(found.offset * ARC_MINUTES, 5)),
        Cell(''),
        Cell(number(math.degrees(found.offset), 5), unit='°'),
        Cell(''),
        Cell(f'{found.samples} samples over {travel}° of the output'),
    )
    return Table(_FIGURES, (*(row for row in rows if row), offset), _WORDS)


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


def key(report: LostMotionReport) -> Table:
    """Return the figures of the summary, which a page shows first."""
    _, *cells = _summary_row(report)
    return Table.of_values(Layout.INLINE, *zip(_QUANTITIES, cells, strict=True))


def summary(reports: Sequence[LostMotionReport]) -> Table:
    """Return a row for each recording."""
    return Table(('recording', *_QUANTITIES), tuple(map(_summary_row, reports)))


def _summary_row(report: LostMotionReport) -> tuple[Cell, ...]:
    hysteresis = lost_motion = spring = accuracy = model = None
    if error := report.transmission:
        lost_motion, accuracy = error.lost_motion, error.forward
    if found := report.hysteresis:
        hysteresis, model = found.smallest.hysteresis, found.leaving.play_model
        lost_motion = found.largest.lost_motion
        spring = found.largest.stiffness[-1].both if found.largest.stiffness else None
    hysteresis, lost_motion, spring, accuracy = (
        e if e and e.clear else None for e in (hysteresis, lost_motion, spring, accuracy)
    )
    angles = (arc_minutes(hysteresis), play(model), arc_minutes(lost_motion))
    values = (*angles, plus_minus(spring), arc_minutes(accuracy))
    return tuple(map(Cell, (printable(report.recording.name), *values)))


def _angle(label: str, estimate: Estimate | None, source: str = '') -> tuple[Cell, ...] | None:
    return _row(label, 'arcmin', estimate, source, ARC_MINUTES)


def _row(
    label: str, unit: str, estimate: Estimate | None, source: str, scale: float = 1.0
) -> tuple[Cell, ...] | None:
    if not estimate:
        return None
    value, spread = rounded(estimate, scale)
    degrees = rounded(estimate, math.degrees(1.0))[0] if scale == ARC_MINUTES else ''
    return (
        Cell(label, unit=unit),
        Cell(value, unit=unit),
        Cell(spread, Tone.PLAIN if spread else Tone.NOTABLE, unit=unit),
        Cell(degrees, unit='°'),
        Cell(str(estimate.repeats)),
        Cell(source),
    )


def _source(figures: Figures) -> str:
    several = 's' if figures.loops > 1 else ''
    return f'{figures.loops} loop{several} to {torque(figures.amplitude)} N·m'


def _range(low: float, high: float) -> str:
    return f'{torque(low)} to {torque(high)} N·m'
