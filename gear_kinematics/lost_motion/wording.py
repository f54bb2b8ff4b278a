"""What is said about lost motion in sentences, and how its figures are written."""

import math
from collections.abc import Iterator

from gear_kinematics.lost_motion.hysteresis import LOST_MOTION_SHARE
from gear_kinematics.lost_motion.report import HysteresisReport, LostMotionReport
from gear_kinematics.lost_motion.uncertainty import COVERAGE, Estimate
from gear_kinematics.report.document import number, printable

ARC_MINUTES = 60.0 * 180.0 / math.pi
"""In a radian: the unit of lost motion in catalogues."""
PERCENT = f'{100.0 * COVERAGE:g} %'
"""Probability with which an interval holds the value."""
_EXACT = 1e-5
"""Relative uncertainties below which a value is not written to their last digit."""


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
        f'Each ± holds the value with a probability of {PERCENT} as far as repeats and the steps '
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


def plus_minus(estimate: Estimate | None, scale: float = 1.0) -> str:
    """Write a quantity with its uncertainty, both to the uncertainty's second digit."""
    if estimate is None:
        return ''
    value, spread = rounded(estimate, scale)
    return f'{value} ± {spread}' if spread else value


def arc_minutes(estimate: Estimate | None) -> str:
    """Write an angle in arc minutes with its uncertainty."""
    return plus_minus(estimate, ARC_MINUTES)


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
