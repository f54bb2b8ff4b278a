"""Recordings of braced gears at several settings as the advice sees them, and how often it holds.

The figures are read from the curve of the gear itself; between recordings they scatter.
"""

import math
from collections import Counter
from collections.abc import Sequence
from functools import cache

import numpy as np
from braced_gears import BracedGear

from gear_kinematics.measurement.preload.advice import Reading, advise

LOADS = (8.0, 20.0)  # N·m, range of the stiffness
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
    """Hysteresis, rad, friction, N·m, and stiffness, N·m/rad."""
    drag = gear.drag(setting)
    hysteresis = np.ptp(gear.turn(np.array([-drag, drag]), setting))
    return hysteresis, drag, *gear.stiffness(setting, *LOADS)


def readings(
    gear: BracedGear, settings: Sequence[float], scatter: float, random: np.random.Generator
) -> list[Reading]:
    """Record a gear at settings, with a relative scatter of hysteresis between the recordings.

    Friction scatters by half of it, stiffness by a fifth.
    """
    shares = scatter * np.array([1.0, 0.5, 0.2, 0.2])
    found = []
    for setting in settings:
        noise = np.exp(shares * random.standard_normal(len(shares)))
        hysteresis, drag, push, pull = noise * figures(gear, setting)
        compliances = (1.0 / push, 1.0 / pull)
        found.append(Reading(setting, hysteresis, drag, drag, compliances))
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
    least, counts = gear.least(load), Counter()
    price, widths = gear.drag(least) - gear.friction, []
    for _ in range(seeds):
        found = readings(gear, settings, scatter, random)
        advice = advise(found, gear.closing if turns else None, load)
        if span := advice.least:
            cost = advice.price
            counts['told'] += 1
            counts['least'] += span.low <= least <= span.high
            widths.append(span.high - span.low)
            counts['priced'] += cost is not None
            counts['price'] += bool(cost and abs(cost.value - price) <= cost.uncertainty)
    return {
        'told': counts['told'] / seeds,
        'least': counts['least'] / max(counts['told'], 1),
        'price': counts['price'] / counts['priced'] if counts['priced'] else math.nan,
        'width': float(np.median(widths)),
    }
