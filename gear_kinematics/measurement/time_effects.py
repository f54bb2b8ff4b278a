"""What time does to torque ramps: each effect is told by one test, and not taken out."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy import stats

from gear_kinematics.correction.uncertainty import Component, Estimate, resolution
from gear_kinematics.measurement.loops import Ramps
from gear_kinematics.measurement.wording import arc_minutes
from gear_kinematics.report.document import number

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
        ramps: from small to large amplitude.
        friction: N·m, of the smallest, as creep adds to that of large ones.
        angle_step: rad, between readings of the encoder; 0 if unknown.
    """
    yield from _drift(ramps)
    if friction:
        yield from _goes_on(ramps[-1], friction.value, angle_step)


def _drift(ramps: Sequence[Ramps]) -> Iterator[str]:
    """A zero that moves evenly: the middles of loops at no torque, over time."""
    group = max(ramps, key=lambda ramps: len(ramps.loops))
    if not group.rate or len(group.loops) < _FEWEST:
        return
    times = [
        float(np.mean([half.at(0.0, half.time) for half in loop if half.time is not None]))
        for loop in group.loops
    ]
    line = stats.linregress(times, [loop.middle(0.0) for loop in group.loops])
    if line.pvalue < _CHANCE:
        span = times[-1] - times[0]
        moved = Estimate(line.slope * span, line.stderr * span, len(times) - 2, len(times))
        yield f'The zero drifts by {arc_minutes(moved)} arcmin in {number(span)} s, evenly.'


def _goes_on(ramps: Ramps, friction: float, angle_step: float) -> Iterator[str]:
    """How far the angle goes on after a reversal of the torque, while friction holds the gear."""
    halves = ramps.halves
    least = min(abs(half.start - half.end) for half in halves)
    if not ramps.rate or len(halves) < _FEWEST or least < 4.0 * friction:
        return
    further = []
    for half in halves:
        way = 1.0 if half.rising else -1.0
        held = half.angle_at(half.start + way * 2.0 * friction * _STILL)
        further.append(-way * float(np.mean(held) - half.angle_at(half.start)))
    found = Estimate.of_mean(further, Component(resolution(angle_step)))
    if found.value > (found.uncertainty or 0.0):
        yield (
            f'After the torque has turned back, the angle goes on by {arc_minutes(found)} '
            'arcmin while friction holds the gear: it creeps, or the encoder is late. This is '
            'part of the hysteresis.'
        )
