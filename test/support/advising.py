# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings of braced gears at several settings as the advice sees them, and how often it holds.

The figures are read from the curve of the gear itself; between recordings they scatter.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np
from braced_gears import BracedGear

from gear_kinematics.measurement.preload.advice import Reading, advise

SETTINGS = {
    'seven, turns': ((0.0, 0.6, 1.2, 1.8, 3.0, 4.0, 5.0), True),
    'seven, numbers': ((0.0, 0.6, 1.2, 1.8, 3.0, 4.0, 5.0), False),
    'five twice, numbers': (tuple(np.repeat([0.0, 1.0, 2.0, 4.0, 5.0], 2)), False),
    'five, turns': ((0.0, 1.0, 2.0, 4.0, 5.0), True),
    'five, numbers': ((0.0, 1.0, 2.0, 4.0, 5.0), False),
    'four, turns': ((0.0, 3.0, 4.0, 5.0), True),
}
"""Settings, and whether they are turns of the ring gear."""


@cache
def figures(gear: BracedGear, setting: float) -> tuple[float, ...]:
    """Hysteresis, rad, friction, N·m, and compliance from 8 to 20 N·m of both sides, rad/(N·m)."""
    drag = gear.drag(setting)
    far, near, back, forth, there, beyond = gear.turn(
        np.array([-20.0, -8.0, -drag, drag, 8.0, 20.0]), setting
    )
    return forth - back, drag, (beyond - there) / 12.0, (near - far) / 12.0


def readings(
    gear: BracedGear, settings: Sequence[float], scatter: float, random: np.random.Generator
) -> list[Reading]:
    """Record a gear at settings, with a relative scatter of hysteresis between the recordings.

    Friction scatters by half of it, stiffness by a fifth.
    """
    shares = scatter * np.array([1.0, 0.5, -0.2, -0.2])
    found = []
    for setting in settings:
        noise = np.exp(shares * random.standard_normal(len(shares)))
        hysteresis, drag, *compliances = noise * figures(gear, setting)
        found.append(Reading(setting, hysteresis, drag, drag, tuple(compliances)))
    return found


def coverage(name: str, seeds: int, load: float, scatter: float = 0.1) -> dict[str, float]:
    """How often there is an answer, how often its intervals hold, and how wide they are.

    Args:
        name: of the settings.
        seeds: simulated sets of recordings.
        load: N·m.
        scatter: relative, of the recordings.
    """
    settings, turns = SETTINGS[name]
    gear, random = BracedGear(), np.random.default_rng(1)
    least = gear.least(load)
    more = gear.drag(least) - gear.friction
    held, added, widths = [], [], []
    for _ in range(seeds):
        found = readings(gear, settings, scatter, random)
        advice = advise(found, gear.closing if turns else None, load)
        if span := advice.least:
            held.append(span.low <= least <= span.high)
            widths.append(span.high - span.low)
        if friction := advice.added_friction:
            added.append(abs(friction.value - more) <= friction.uncertainty)
    return {
        'told': len(held) / seeds,
        'least': float(np.mean(held)),
        'added friction': float(np.mean(added)),
        'width': float(np.median(widths)),
    }
