"""Remarks on the models of torque ramps, in sentences."""

import math
from collections.abc import Iterator

from gear_kinematics.lost_motion.report import HysteresisReport
from gear_kinematics.lost_motion.several.comparison import SIGNIFICANCE, holm
from gear_kinematics.lost_motion.static.lag import OF_GEAR
from gear_kinematics.lost_motion.static.play import Cause, PlayModel
from gear_kinematics.lost_motion.static.soft_middle import SOFTEST
from gear_kinematics.lost_motion.wording import ARC_MINUTES, PERCENT, plus_minus, torque
from gear_kinematics.report.document import number

_MOSTLY = 0.7
"""Share of a standard uncertainty from which on one part of it exceeds all others together."""
_WELL_KNOWN = 0.01
"""Relative ± of a stiffness up to which nobody needs to know it better."""
_ALL = 0.995
"""Share of a lag that counts as all of it."""
_LARGER = 3.0
"""Amplitude of ramps that load the spring well, as a multiple of the friction."""
_TOO_LARGE = 2.5
"""Multiple of that from which on ramps bend the spring more than need be."""
_SMALLER = 0.1
"""Amplitude of ramps that bend it far less, as a share of those recorded."""


def model_remarks(found: HysteresisReport) -> Iterator[str]:
    """Describe what the models tell, and what was taken out of the recording."""
    yield from _effects(found)
    model = found.smallest.play_model
    if not model:
        yield 'There is no play model, as the ramps have no middle line.'
        return
    if found.smallest.within:
        yield (
            f'The ramps to {torque(found.smallest.amplitude)} N·m stay within the backlash: the '
            f'gear yields to them at {number(model.stiffness)} N·m/rad, less than a fifth of the '
            f'stiffness of its spring. Those to {torque(found.leaving.amplitude)} N·m leave it.'
        )
    if beyond := found.leaving.play_model:
        yield from _backlash(beyond, found.smallest.amplitude)
    yield from _unseen_lag(found, model)
    yield from _unknown_creep(found)
    if model.growth:
        yield f'The friction grows by {plus_minus(model.growth, 100.0)} % of the load.'
    if model.missing:
        yield (
            'The friction builds up slowly after a reversal: near the peaks, '
            f'{plus_minus(model.missing)} N·m of it are missing. This has been taken out of the '
            'middle line.'
        )


def _effects(found: HysteresisReport) -> Iterator[str]:
    lag = found.effects.lag
    if lag and lag.value < 0.0:
        yield (
            f'The torque comes {plus_minus(lag.times(-1.0), 1e3)} ms later than the angle, as '
            'behind a filter. The ± of hysteresis and friction contain that; slower ramps reduce '
            'it.'
        )
    elif lag:
        late = (
            f'The angle reverses {plus_minus(lag, 1e3)} ms later than the torque: its encoder is '
            'late, or inertia moves the gear on.'
        )
        removed = found.effects.removed
        share = removed.value / lag.value if removed else 0.0
        if share > _ALL:
            yield f'{late} This has been taken out as a lag of the encoder.'
        else:
            yield (
                f'{late} Of this, {100.0 * share:.0f} % have been taken out; the ± of hysteresis '
                'and friction contain both.'
            )
    for drift, figures in zip(found.effects.drifts, found.figures, strict=True):
        if drift:
            yield (
                f'During the ramps to {torque(figures.amplitude)} N·m, the zero of the angle '
                f'drifted by {number(60.0 * drift.rate * ARC_MINUTES)} arcmin per minute'
                f'{"" if drift.steady else " in the mean, but not evenly"}. This has been taken '
                'out.'
            )
    if (creep := found.creep) and found.spring:
        stiffness = 100.0 * found.spring.stiffness.value
        likely = sorted([(creep.constant, creep.compliance.value), *creep.others])
        ends = [
            f'{number(stiffness * compliance, 2)} % within about {number(constant, 2)} s'
            for constant, compliance in (likely[0], likely[-1])
        ]
        late = f'between {" and ".join(ends)}' if creep.others else ends[0]
        yield (
            f'The gear creeps. The share of its twist that comes late is {late}. Backlash, '
            'friction and the stiffness of the spring are without creep; hysteresis, lost motion '
            'and the other stiffnesses contain it.'
        )


def _unseen_lag(found: HysteresisReport, model: PlayModel) -> Iterator[str]:
    """Say where a lag of the encoder would change the friction most, and does not show."""
    rate, late = found.rates[0], found.effects.late
    if found.effects.lag or not rate:
        return
    if late is None:
        unseen = 'No reversal shows whether the encoder is late.'
    elif late > OF_GEAR and late * rate.rate > _MOSTLY * (model.friction.standard or math.inf):
        unseen = (
            'Most of the ± of the friction comes from a possible lag of the encoder: the '
            f'reversals do not exclude one of about {1e3 * late:.0f} ms.'
        )
    else:
        return
    yield (
        f'{unseen} Each millisecond would add {number(1e-3 * rate.rate, 2)} N·m to the friction, '
        'and twice the twist by this torque to the hysteresis. Reversals with a corner, and finer '
        'steps of the encoder, show a lag.'
    )


def _unknown_creep(found: HysteresisReport) -> Iterator[str]:
    """Say where the stiffness of the spring would be known better without creep."""
    if not (spring := found.spring) or spring.stiffness.standard is None:
        return
    uncertain = (spring.stiffness.uncertainty or 0.0) > _WELL_KNOWN * spring.stiffness.value
    if uncertain and spring.by_creep > _MOSTLY * spring.stiffness.standard:
        yield (
            'Most of the ± of the stiffness of the spring comes from creep, which the recording '
            f'{"shows, but not how fast it is" if found.creep else "does not exclude"}. Pauses of '
            'some seconds at the peaks of the torque show it.'
        )


def _backlash(model: PlayModel, least: float) -> Iterator[str]:
    yield (
        f'The simplest plausible model is: {model.name}, {number(model.stiffness, 4)} N·m/rad. On '
        f'the middle line of the hysteresis curve it leaves {number(model.residual)} N·m (root '
        'mean square).'
    )
    yield from _play(model, least)
    if model.more:
        yield (
            f'The friction within the backlash exceeds that beyond it by {plus_minus(model.more)} '
            'N·m, as where a gear moves faster. The ± of backlash and friction contain that. '
            'Slower ramps have less of it.'
        )
    yield from _tests(model)


def _play(model: PlayModel, least: float) -> Iterator[str]:
    soft = (
        f'Over the backlash the gear yields at {number(model.softness, 2)} of its stiffness beyond'
        if model.softness
        else ''
    )
    match model.cause:
        case Cause.NONE if soft:
            yield f'{soft}; below {SOFTEST:g} this counts as backlash.'
        case Cause.ZERO:
            yield (
                f'The backlash is an upper bound ({PERCENT}): zero is within the interval of a '
                'model that describes the ramps as well.'
            )
        case Cause.SOFT:
            yield (
                f'The backlash is an upper bound ({PERCENT}): in the middle the gear yields at '
                f'{number(model.softness or 0.0, 2)} of its stiffness beyond, which may be '
                'backlash or a soft spring, such as an elastic bracing. Ramps at other positions '
                'of the output, or an encoder at the output, tell them apart.'
            )
        case Cause.MODELS:
            yield (
                'The backlash is not separable from the spring, because the interval of a model '
                'that describes the ramps equally well reaches the hysteresis. '
                f'{_apart(model, least)} tell the models apart.'
            )
        case Cause.FLANKS:
            yield (
                'The backlash is not separable from the spring, because these ramps hardly load '
                f'the spring beyond it: of their torque, {torque(model.friction.value)} N·m are '
                f'friction. Record ramps to {torque(_LARGER * model.friction.value)} N·m or more.'
            )
        case Cause.SINGLE:
            yield 'No backlash shows. Without repeats there is no upper bound.'


def _apart(model: PlayModel, least: float) -> str:
    """Say which ramps tell models apart, where the smallest recorded are those to least, N·m."""
    enough = max(_LARGER * model.friction.value, _SMALLER * least)
    if _TOO_LARGE * enough < least:
        return f'Ramps to about {torque(enough)} N·m, in which the spring is less bent,'
    return 'More repeats, and slower ramps,'


def _tests(model: PlayModel) -> Iterator[str]:
    together = holm([test.probability for test in model.tests])
    found = [
        f'{test.name} ({number(test.statistic, 2)} where chance has {number(test.expected, 2)})'
        for test, probability in zip(model.tests, together, strict=True)
        if probability < SIGNIFICANCE
    ]
    if found:
        yield (
            f'What the model leaves is not chance alone: {", ".join(found)}. What is the same in '
            'all loops is in the ± of the backlash.'
        )
