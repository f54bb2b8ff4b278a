# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges doubted readings in a row: do they agree with each other, and with a motion before?"""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from gear_kinematics.state.reach import FLOOR, STALEST, Reading, RotorLimits

AGREEING = 3
"""Doubted readings in a row that are believed."""
_LONGEST_REPEAT = 1.0  # s, for which a driver repeats a reading while the rotor turns on
_REPEATED = 0.05  # of the way meanwhile: what it may differ by from that at a steady speed
_STEADY = 0.25  # of the speed: what it may change by meanwhile


class Agreement(NamedTuple):
    """A motion on which readings agree."""

    speed: float
    """rad/s."""
    step: float
    """The last step, rad."""
    span: int
    """The time that it took, ns."""
    stale: float
    """By how much a reading may be older than its stamp, s."""
    within: bool
    """Whether all steps keep to the limit of the speed."""


def agreement(
    readings: Sequence[tuple[int, float]], limits: RotorLimits, finest: float, period: float
) -> Agreement | None:
    """Find the motion on which readings agree: stamps, ns, and positions, rad; None if on none.

    Args:
        readings: in the order of their reception.
        limits: those of the rotor.
        finest: rad, the resolution of the encoder.
        period: rad after which the readings repeat; 0: never.
    """
    times, positions = zip(*readings, strict=True)
    spans = [(b - a) * 1e-9 for a, b in pairwise(times)]
    steps = [b - a for a, b in pairwise(positions)]
    if period:
        steps = [math.remainder(step, period) for step in steps]
    stale, noise, total = min(STALEST, max(spans)), max(FLOOR, 2.0 * finest), sum(spans)
    if total < 0.0:
        return None
    speed = sum(steps) / total if total else 0.0
    slack = noise + limits.acceleration * total * total + abs(speed) * stale
    pairs = [*zip(steps, spans, strict=True)]
    within = all(abs(step) <= limits.speed * (span + stale) + noise for step, span in pairs)
    uneven = max(abs(step - speed * span) for step, span in pairs)
    if uneven > slack or not (within or total):
        return None
    return Agreement(speed, steps[-1], times[-1] - times[-2], stale, within)


def goes_on(
    motion: Reading,
    stamp: int,
    position: float,
    speed: float,
    limits: RotorLimits,
    finest: float,
    *,
    stood: bool,
) -> bool:
    """Whether a reading, ns and rad, with a speed, rad/s, continues an earlier motion.

    The readings between were wrong, or a driver repeated one while the rotor turned on.

    Args:
        motion: the last reading of that motion.
        stamp: of the reading.
        position: of the reading.
        speed: at the reading.
        limits: those of the rotor.
        finest: rad, the resolution of the encoder.
        stood: whether the readings between have one position.
    """
    before, since, step, span = motion
    time = (stamp - since) * 1e-9
    if not (step and span) or (time > _LONGEST_REPEAT and stood):
        return False
    former = step / (span * 1e-9)
    change = _STEADY * abs(former) + (0.0 if stood else limits.acceleration * time)
    way, stale = 0.5 * (former + speed) * time, min(STALEST, 1.25e-9 * span)
    uncertain = max(FLOOR, 2.0 * finest) + max(abs(former), abs(speed)) * stale
    uncertain += _REPEATED * abs(way) + 0.25 * change * time
    return abs(speed - former) <= change and abs(position - before - way) <= uncertain
