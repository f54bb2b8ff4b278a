"""What time does to torque ramps: each effect is told by one test, and not taken out."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy import stats

from gear_kinematics.measurement.loops import Loop, Ramps
from gear_kinematics.measurement.wording import ARC_MINUTES, plus_minus
from gear_kinematics.report.document import number
from gear_kinematics.state.uncertainty import Component, Estimate, resolution

_FEWEST = 4
"""Loops, or reversals, in which an effect can be told from scatter."""
_CHANCE = 0.01
"""Probability below which a drift is no coincidence."""
_STILL = np.linspace(0.3, 0.9, 30)
"""Shares of twice the friction by which the torque has gone back: the gear certainly stands still,
and what a late encoder still had to show has come."""


def time_remarks(
    ramps: Sequence[Ramps], friction: Estimate | None, angle_step: float
) -> Iterator[str]:
    """Say what changes with time, with its size, if it is significant.

    Args:
        ramps: by amplitude, from small to large.
        friction: N·m, of the smallest, as creep adds to that of large ones.
        angle_step: rad, between readings of the encoder; 0 if unknown.
    """
    if drift := _drift(ramps):
        yield drift
    if friction and (late := _goes_on(ramps[-1], friction.value, angle_step)):
        yield late


def _drift(ramps: Sequence[Ramps]) -> str:
    """A zero that moves evenly: the middles of loops at no torque, over time."""
    group = max(ramps, key=lambda ramps: len(ramps.loops))
    points = [(_time(loop), loop.middle(0.0)) for loop in group.loops]
    times = [time for time, _ in points if time is not None]
    if len(times) < max(_FEWEST, len(points)):
        return ''
    line = stats.linregress(times, [middle for _, middle in points])
    if not line.pvalue < _CHANCE:
        return ''
    span = times[-1] - times[0]
    moved = Estimate(line.slope * span, line.stderr * span, len(times) - 2, len(times))
    return (
        f'The zero drifts by {plus_minus(moved, ARC_MINUTES)} arcmin in {number(span)} s, evenly.'
    )


def _time(loop: Loop) -> float | None:
    if loop.fall.time is None or loop.rise.time is None:
        return None
    return 0.5 * float(loop.fall.time_at(0.0) + loop.rise.time_at(0.0))


def _goes_on(ramps: Ramps, friction: float, angle_step: float) -> str:
    """How far the angle goes on after a reversal of the torque, while friction holds the gear."""
    further = []
    for loop in ramps.loops:
        for half in (loop.fall, loop.rise):
            if half.time is None or 4.0 * friction > abs(half.start - half.end):
                return ''
            way = 1.0 if half.rising else -1.0
            held = half.angle_at(half.start + way * 2.0 * friction * _STILL)
            further.append(-way * float(np.mean(held) - half.angle_at(half.start)))
    if len(further) < _FEWEST:
        return ''
    found = Estimate.of_mean(further, Component(resolution(angle_step)))
    if found.value <= (found.uncertainty or 0.0):
        return ''
    return (
        f'After the torque has turned back, the angle goes on by {plus_minus(found, ARC_MINUTES)} '
        'arcmin while friction holds the gear: it creeps, or the encoder is late. This is part of '
        'the hysteresis.'
    )
