"""What every rendering says about lost motion, and in which order: tables and sentences."""

import math
from collections.abc import Iterator, Sequence

from gear_kinematics.lost_motion.hysteresis import LOST_MOTION_SHARE, Figures
from gear_kinematics.lost_motion.report import HysteresisReport, LostMotionReport
from gear_kinematics.lost_motion.uncertainty import COVERAGE, Estimate
from gear_kinematics.report.wording import Cell, Table, Tone, number, printable

ARC_MINUTES = 60.0 * 180.0 / math.pi
"""In a radian: the unit of lost motion in catalogues."""
_EXACT = 1e-5
"""Relative uncertainties below which a value is not written to their last digit."""
_PERCENT = f'{100.0 * COVERAGE:g} %'
_PLUS_MINUS = f'± ({_PERCENT})'


def name(report: LostMotionReport) -> str:
    """Name the recording."""
    return printable(report.recording.name)


def head(report: LostMotionReport) -> Table:
    """Say what the report is about."""
    found = report.hysteresis
    rated = f'{torque(found.settings.rated_torque)} N·m ({found.rated_by})' if found else ''
    return Table(
        ('', 'samples', 'columns', 'rated torque'),
        (
            (
                Cell(''),
                Cell(str(report.recording.rows)),
                Cell(printable('; '.join(report.recording.columns))),
                Cell(rated),
            ),
        ),
    )


def tables(report: LostMotionReport) -> Iterator[Table]:
    """Give all tables that have something in them."""
    if found := report.hysteresis:
        yield figure_table(found)
        if len(found.figures) > 1:
            yield amplitude_table(found)
        yield stiffness_table(found)
    if report.transmission:
        yield transmission_table(report)
        yield order_table(report)


def figure_table(found: HysteresisReport) -> Table:
    """Give the figures: those of the play from the smallest ramps, the others from the largest."""
    smallest, largest = found.smallest, found.largest
    small, large = (f'{_loops(f)} to {torque(f.amplitude)} N·m' for f in (smallest, largest))
    at = torque(LOST_MOTION_SHARE * found.settings.rated_torque)
    rows = [
        _angle('hysteresis at zero torque', smallest.hysteresis, small),
        _angle('backlash (play model)', smallest.play, small),
        _row('friction (play model)', 'N·m', smallest.friction, small),
        _angle(f'lost motion at ±{at} N·m', largest.lost_motion, large),
        *(
            _row(f'stiffness {_range(s.low, s.high)}', 'N·m/rad', s.both, large)
            for s in largest.stiffness
        ),
    ]
    return Table(
        ('figure', 'value', _PLUS_MINUS, 'in degrees', 'repeats', 'from'),
        tuple(row for row in rows if row),
        prose=('from',),
    )


def amplitude_table(found: HysteresisReport) -> Table:
    """Compare the ramps of different amplitude."""
    return Table(
        (
            'ramps',
            'loops',
            'hysteresis [arcmin]',
            'lost motion [arcmin]',
            'backlash [arcmin]',
            'friction [N·m]',
            'model residual [arcmin]',
        ),
        tuple(_amplitude_row(figures) for figures in found.figures),
    )


def _amplitude_row(figures: Figures) -> tuple[Cell, ...]:
    model = figures.play_model
    return (
        Cell(f'to {torque(figures.amplitude)} N·m'),
        Cell(str(figures.loops)),
        Cell(plus_minus(figures.hysteresis, ARC_MINUTES)),
        Cell(plus_minus(figures.lost_motion, ARC_MINUTES)),
        Cell(plus_minus(figures.play, ARC_MINUTES)),
        Cell(plus_minus(figures.friction)),
        Cell(number(model.residual * ARC_MINUTES) if model else ''),
    )


def stiffness_table(found: HysteresisReport) -> Table:
    """Give the stiffness under torque of either sign."""
    return Table(
        ('stiffness [N·m/rad]', 'both', 'positive', 'negative'),
        tuple(
            (
                Cell(f'{_range(s.low, s.high)}, ramps to {torque(figures.amplitude)} N·m'),
                *(Cell(plus_minus(estimate)) for estimate in (s.both, s.positive, s.negative)),
            )
            for figures in found.figures
            for s in figures.stiffness
        ),
    )


def transmission_table(report: LostMotionReport) -> Table:
    """Give the figures of the transmission error."""
    found = report.transmission
    if not found:
        return Table(('transmission',), ())
    rows = (
        _angle('transmission accuracy forward', found.forward),
        _angle('transmission accuracy backward', found.backward),
        _angle('lost motion on reversals', found.lost_motion),
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
    return Table(
        ('figure', 'value', _PLUS_MINUS, 'in degrees', 'repeats', 'from'),
        (*(row for row in rows if row), offset),
        prose=('from',),
    )


def order_table(report: LostMotionReport) -> Table:
    """Give the amplitudes of the marked orders."""
    orders = report.transmission.orders if report.transmission else ()
    return Table(
        ('order', 'cycles per output turn', 'forward [arcmin]', 'backward [arcmin]'),
        tuple(
            (
                Cell(order.name),
                Cell(str(order.cycles)),
                Cell(plus_minus(order.forward, ARC_MINUTES)),
                Cell(plus_minus(order.backward, ARC_MINUTES)),
            )
            for order in orders
            if order.forward or order.backward
        ),
    )


def summary_table(reports: Sequence[LostMotionReport]) -> Table:
    """Give a line for each recording."""
    return Table(
        (
            'recording',
            'hysteresis [arcmin]',
            'backlash [arcmin]',
            'lost motion [arcmin]',
            'stiffness [N·m/rad]',
            'transmission accuracy [arcmin]',
        ),
        tuple(_summary(report) for report in reports),
    )


def _summary(report: LostMotionReport) -> tuple[Cell, ...]:
    hysteresis = play = lost_motion = spring = accuracy = None
    if error := report.transmission:
        lost_motion, accuracy = error.lost_motion, error.forward
    if found := report.hysteresis:
        hysteresis, play = found.smallest.hysteresis, found.smallest.play
        lost_motion = found.largest.lost_motion
        spring = found.largest.stiffness[-1].both if found.largest.stiffness else None
    return (
        Cell(name(report)),
        Cell(plus_minus(hysteresis, ARC_MINUTES)),
        Cell(plus_minus(play, ARC_MINUTES)),
        Cell(plus_minus(lost_motion, ARC_MINUTES)),
        Cell(plus_minus(spring)),
        Cell(plus_minus(accuracy, ARC_MINUTES)),
    )


# Sentences


def remarks(report: LostMotionReport) -> list[str]:
    """Say what the figures rest on, and what they leave out."""
    return [printable(remark) for remark in (*report.remarks, *_remarks(report))]


def _remarks(report: LostMotionReport) -> Iterator[str]:
    recording = report.recording
    if recording.error:
        yield f'{recording.error}; the figures are of what comes before'
    if found := report.hysteresis:
        yield (
            'Output and rotor were both measured: the wind-up is that of the gear.'
            if found.measured
            else 'Inferred, not measured: the angle is that of the encoder on the motor, through '
            'the ratio, and the output is taken to be locked. What gives way in motor, bench and '
            'clamping is part of the figures.'
        )
        yield _step(found.settings.angle_step, 'a reading of the angle at the output')
        yield from _doubts(found)
    if motion := recording.motion:
        for step, of in (
            (motion.rotor_step, "the rotor's encoder, through the ratio, at the output"),
            (motion.output_step, "the output's encoder"),
        ):
            yield _step(step, of)
        for cause, count in motion.unmatched.items():
            yield f'{count} output angles were not compared: {cause}.'
    yield (
        f'Each ± holds the value with a probability of {_PERCENT} as far as repeats and the steps '
        'of the encoders tell; scale errors of torque and angle are not in it.'
    )


def _step(step: float, of: str) -> str:
    if not step:
        return f'Steps of {of} do not show in the data: they are not in the uncertainty.'
    return f'One step of {of} is {number(step * ARC_MINUTES)} arcmin.'


def _doubts(found: HysteresisReport) -> Iterator[str]:
    smallest, largest = found.smallest, found.largest
    if len(found.figures) == 1:
        yield (
            'All ramps have about the same amplitude: figures of the play come from those that '
            'also load the gear.'
        )
    if smallest.loops == 1 or largest.loops == 1:
        yield 'Where nothing was repeated there is no uncertainty.'
    model = smallest.play_model
    if not model:
        yield (
            'No range of stiffness is clear of zero torque: without the spring there is no play '
            'model.'
        )
        return
    yield (
        f'The play model takes {number(model.stiffness, 4)} N·m/rad for its spring and leaves '
        f'{number(model.residual * ARC_MINUTES)} arcmin (root mean square) of the curve: what '
        'sticks and slips is no part of it.'
    )
    if model.friction.value > (low := largest.stiffness[-1].low):
        yield (
            f'The friction is more than the {torque(low)} N·m from which on the spring is '
            'measured: part of the play is in the spring. Larger ramps are needed.'
        )
    at = LOST_MOTION_SHARE * found.settings.rated_torque
    if model.friction.value > at and not found.measured:
        yield (
            f'The friction is more than the ±{torque(at)} N·m at which lost motion is read: it '
            'holds the motor back there, and hides play.'
        )


# Cells


def plus_minus(estimate: Estimate | None, scale: float = 1.0) -> str:
    """Write a quantity with its uncertainty, both to the uncertainty's second digit."""
    if estimate is None:
        return ''
    value, spread = rounded(estimate, scale)
    return f'{value} ± {spread}' if spread else value


def rounded(estimate: Estimate, scale: float) -> tuple[str, str]:
    """Write a value and its uncertainty, which is empty where it is not known."""
    value, spread = estimate.value * scale, estimate.uncertainty
    if not spread:
        return number(value, 4), '' if spread is None else '0'
    spread *= scale
    if spread < abs(value) * _EXACT:
        return number(value, 6), number(spread, 2)
    decimals = max(0, 1 - math.floor(math.log10(spread)))
    # What rounds to zero has no sign.
    return f'{round(value, decimals) + 0.0:.{decimals}f}', f'{spread:.{decimals}f}'


def torque(value: float) -> str:
    """Write a torque."""
    return number(value)


def _angle(label: str, estimate: Estimate | None, source: str = '') -> tuple[Cell, ...] | None:
    return _row(label, 'arcmin', estimate, source, ARC_MINUTES)


def _row(
    label: str, unit: str, estimate: Estimate | None, source: str, scale: float = 1.0
) -> tuple[Cell, ...] | None:
    if not estimate:
        return None
    value, spread = rounded(estimate, scale)
    degrees = rounded(estimate, math.degrees(1.0))[0] if scale != 1.0 else ''
    return (
        Cell(label, unit=unit),
        Cell(value, unit=unit),
        Cell(spread, Tone.PLAIN if spread else Tone.NOTABLE, unit=unit),
        Cell(degrees, unit='°'),
        Cell(str(estimate.repeats)),
        Cell(source),
    )


def _loops(figures: Figures) -> str:
    return f'{figures.loops} loop{"s" if figures.loops > 1 else ""}'


def _range(low: float, high: float) -> str:
    return f'{torque(low)} to {torque(high)} N·m'
