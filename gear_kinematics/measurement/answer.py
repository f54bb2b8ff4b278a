"""The answer of a recording in one sentence, and the remarks on its basis and limits."""

import math
from collections.abc import Iterator

from gear_kinematics.measurement.encoder_step import Source, Step
from gear_kinematics.measurement.figures import GearFigures
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.middle_line import Cause
from gear_kinematics.measurement.ratio import ratio_remarks
from gear_kinematics.measurement.tables import too_uncertain
from gear_kinematics.measurement.wording import ARC_MINUTES, PERCENT, arc_minutes
from gear_kinematics.report.document import number, printable

_SMALLER = 0.7
"""Share of their amplitude to which smaller ramps are worth recording."""


def answer(report: LostMotion) -> str:
    """Say for a person who must decide what the recording shows."""
    if report.wrong_ratio:
        return report.wrong_ratio
    if report.figures:
        return _of_ramps(report.figures)
    found = report.transmission
    if found is None or not (found.forward or found.backward):
        return 'The output does not move far enough in one direction to tell its errors.'
    accuracy = arc_minutes(found.forward or found.backward)
    told = f'In one direction the output deviates by {accuracy}′ peak to peak'
    if found.lost_motion:
        return f'{told}; on reversals it loses {arc_minutes(found.lost_motion)}′.'
    if found.reversals:
        return (
            f'{told}; backward it lags by {arc_minutes(found.reversals)}′, by lost motion or by a '
            'delay between the encoders.'
        )
    return f'{told}.'


def _of_ramps(figures: GearFigures) -> str:
    width = arc_minutes(figures.smallest.hysteresis)
    backlash = figures.backlash
    told = f'At zero torque the output rests anywhere within {width}′.'
    if backlash.high is None:
        return f'{told} How much of it is play is not known; {backlash.cause.value}.'
    if value := backlash.value:
        return f'{told} Of it, {arc_minutes(value)}′ is play, the rest friction.'
    low, high = (number(end * ARC_MINUTES) for end in (backlash.low, backlash.high))
    cause = f'; {cause}' if (cause := _cause(figures)) else ''
    return f'{told} Of it, at least {low}′ and at most {high}′ is play, the rest friction{cause}.'


def _cause(figures: GearFigures) -> str:
    """Why the backlash has no value, or what to record so that it has."""
    cause, smallest = figures.backlash.cause, figures.smallest
    enough = 2.0 * smallest.friction.value if smallest.friction else math.inf
    if cause in {Cause.BENT, Cause.SOFT} and enough < _SMALLER * smallest.amplitude:
        return f'to separate them, repeat slow ramps to ±{number(enough, 2)} N·m'
    return cause.value


def remarks(report: LostMotion) -> list[str]:
    """Describe the basis and the limits of the figures, in sentences."""
    return [printable(remark) for remark in _remarks(report)]


def _remarks(report: LostMotion) -> Iterator[str]:
    recording = report.recording
    yield from report.remarks
    if report.fitted:
        yield from ratio_remarks(report.fitted)
    if found := report.figures:
        yield (
            'Output and rotor were both measured: the wind-up is that of the gear.'
            if report.measured
            else 'Inferred, not measured: the angle is that of the motor encoder, with the output '
            'taken to be locked. The figures include the compliance of motor, bench and clamping.'
        )
        if recording.locked:
            yield _step(recording.locked.angle_step, 'the angle at the output')
        if len(found.by_amplitude) == 1:
            yield 'All ramps have about one amplitude: small ones would separate play better.'
        if vague := too_uncertain(found):
            yield f'Too uncertain to tell, as the ± exceeds the value: {", ".join(vague)}.'
        if found.smallest.loops == 1 or found.largest.loops == 1:
            yield 'There is no uncertainty where nothing was repeated.'
        width = found.smallest.hysteresis
        if width.value < -(width.uncertainty or 0.0):
            yield (
                'The hysteresis is negative, which no gear has: the torque comes later than the '
                'angle, as behind a filter or from another clock.'
            )
    if both := recording.encoders:
        rotor_step = both.rotor_step_at_output(report.gear_ratio)
        yield _step(rotor_step, 'the rotor encoder (at the output)')
        yield _step(both.output_step, 'the output encoder')
        yield from _delay(report, timed=both.timed)
        for cause, count in both.unmatched.items():
            yield f'{count} output angles were not compared: {cause}.'
    yield (
        f'Each ± contains the value with a probability of {PERCENT}, given the scatter of repeats '
        'and the steps of the encoders. Errors of scale (1 % of the torque is 1 % of friction and '
        'stiffness) and other positions of the output are not in it.'
    )


def _delay(report: LostMotion, *, timed: bool) -> Iterator[str]:
    found = report.transmission
    if not (found and found.reversals):
        return
    late = found.delay
    if late is None:
        yield (
            'The speed varies too little to tell lost motion from a delay between the encoders: '
            '"backward minus forward" is the sum of lost motion and delay times twice the speed. '
            'Move at several speeds, or tell the delay with --delay, in '
            f'{"s" if timed else "rows"}.'
        )
    elif abs(late.value) > (late.uncertainty or math.inf):
        yield (
            'The stamps of the two encoders differ by a delay. It has been taken out of the '
            'transmission error.'
        )


def _step(step: Step, of: str) -> str:
    size = f'{number(step.size * ARC_MINUTES)} arcmin'
    if step.source in {Source.GIVEN, Source.FOUND}:
        return f'One step of {of} is {size}.'
    unknown = f'The step of {of} is not determinable from the readings'
    if step.source == Source.RECORDING:
        return f'{unknown}; they are recorded in steps of {size}, which the uncertainty includes.'
    return f'{unknown}, and the uncertainty does not include it.'
