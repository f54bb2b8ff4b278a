"""Remarks on the basis and the limits of the figures on lost motion, in sentences."""

from collections.abc import Iterator

from gear_kinematics.lost_motion.dynamic.ratio import MOST_PAIRS, MOST_TEETH, RatioEstimate
from gear_kinematics.lost_motion.model_remarks import model_remarks
from gear_kinematics.lost_motion.recorded.encoder_step import Source, Step
from gear_kinematics.lost_motion.report import HysteresisReport, LostMotionReport
from gear_kinematics.lost_motion.static.hysteresis import LOST_MOTION_SHARE
from gear_kinematics.lost_motion.tables import too_uncertain
from gear_kinematics.lost_motion.wording import ARC_MINUTES, PERCENT, torque
from gear_kinematics.report.document import number, printable


def remarks(report: LostMotionReport) -> list[str]:
    """Describe the basis and the limits of the figures, in sentences."""
    return [printable(remark) for remark in (*report.remarks, *_remarks(report))]


def _remarks(report: LostMotionReport) -> Iterator[str]:
    recording = report.recording
    if recording.error:
        yield f'{recording.error}; the figures describe the data before it'
    if fitted := report.fitted:
        yield from ratio_remarks(fitted)
    if found := report.hysteresis:
        yield (
            'Output and rotor were both measured: the wind-up is that of the gear.'
            if found.measured
            else 'Inferred, not measured: the angle is that of the motor encoder, divided by the '
            'ratio, with the output assumed to be locked. The figures include the compliance of '
            'motor, bench and clamping.'
        )
        if recording.loading:
            yield _step(recording.loading.angle_step, 'the angle at the output')
        yield from _doubts(found)
    if motion := recording.motion:
        for step, of in (
            (motion.rotor_step, 'the rotor encoder (at the output)'),
            (motion.output_step, 'the output encoder'),
        ):
            yield _step(step, of)
        yield from _delay(report)
        for cause, count in motion.unmatched.items():
            yield f'{count} output angles were not compared: {cause}.'
    yield (
        f'Each ± contains the value with a probability of {PERCENT}, given the scatter of repeats '
        'and the steps of the encoders. What repeats cannot show is not in it: errors of '
        'scale (1 % of the torque is 1 % of friction and stiffness), and the place of the teeth, '
        'which other positions of the output show.'
    )


def ratio_remarks(fitted: RatioEstimate) -> Iterator[str]:
    """Describe an estimated ratio, in sentences."""
    yield f'The gear ratio is estimated as {fitted.plus_minus}, and taken as {fitted.ratio}.'
    yield (
        f'{fitted.simplest} is the simplest fraction within twice that uncertainty; one as simple '
        f'is there by coincidence with a probability of at most {number(fitted.chance, 2)}.'
    )
    if pairs := fitted.tooth_pairs:
        shown = ', '.join(f'{ring}/{satellite}' for ring, satellite in pairs[:MOST_PAIRS])
        more = f' and {len(pairs) - MOST_PAIRS} more' if len(pairs) > MOST_PAIRS else ''
        yield (
            f'Tooth pairs (ring gear/satellite) of up to {MOST_TEETH} teeth with such a ratio: '
            f'{shown}{more}.'
        )


def _delay(report: LostMotionReport) -> Iterator[str]:
    found, motion = report.transmission, report.recording.motion
    if not (found and motion and found.reversals):
        return
    unit = 'rows' if motion.in_rows else 's'
    late, spread = found.delay, found.delay.uncertainty if found.delay else None
    if late is None:
        yield (
            'The speed varies too little to tell lost motion from a delay between the encoders: '
            '"backward minus forward" is the sum of lost motion and delay times twice the speed. '
            f'Move at several speeds, or tell the delay with --delay, in {unit}.'
        )
    elif spread and abs(late.value) > spread:
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


def _doubts(found: HysteresisReport) -> Iterator[str]:
    smallest, largest = found.smallest, found.largest
    if len(found.figures) == 1:
        yield (
            'All ramps have about the same amplitude: the figures of the play come from ramps '
            'that also load the gear.'
        )
    if smallest.loops == 1 or largest.loops == 1:
        yield 'There is no uncertainty where nothing was repeated.'
    width = smallest.hysteresis
    if width.value < -(width.uncertainty or 0.0):
        yield (
            'The hysteresis is negative, which no gear has: the torque comes later than the '
            'angle, as behind a filter or from another clock.'
        )
    if vague := too_uncertain(found):
        yield f'Too uncertain to tell, as the ± exceeds the value: {", ".join(vague)}.'
    yield from model_remarks(found)
    model, at = smallest.play_model, LOST_MOTION_SHARE * found.settings.rated_torque
    if model and model.friction.value > at and not found.measured:
        yield (
            f'The friction exceeds ±{torque(at)} N·m, at which lost motion is read: it blocks the '
            'motor there and hides play.'
        )
