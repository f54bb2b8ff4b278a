"""Recordings of braced gears at several settings as the advice sees them, and how often it holds.

What is read from a recording scatters about the gear's own figures: play, friction and stiffness
change from recording to recording, and repeats scatter within it.
"""

import math
from collections import Counter
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from braced_gears import BracedGear

from gear_kinematics.lost_motion.preload.advice import advise
from gear_kinematics.lost_motion.preload.model import Reading
from gear_kinematics.state.uncertainty import Estimate

LOADS = (8.0, 20.0)  # N·m
REPEATS = 5


class Scatter(NamedTuple):
    """Standard deviations."""

    between: float = 3e-4  # rad, of the play between recordings
    within: float = 1e-4  # rad, of its mean over the repeats
    friction: float = 0.03  # N·m
    stiffness: float = 0.02  # relative


SETTINGS = {
    'seven, turns': ((0.0, 0.6, 1.2, 1.8, 3.0, 4.0, 5.0), True, Scatter()),
    'seven, numbers': ((0.0, 0.6, 1.2, 1.8, 3.0, 4.0, 5.0), False, Scatter()),
    'five twice, numbers': ((0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0), False, Scatter()),
    'five, turns': ((0.0, 1.0, 2.0, 3.0, 4.0), True, Scatter()),
    'one just at the end, turns': ((0.0, 1.0, 2.0, 2.4, 3.0, 4.0), True, Scatter()),
    'three, turns': ((0.0, 1.0, 3.0), True, Scatter()),
    'hardly any between, turns': ((0.0, 1.0, 2.0, 3.0, 4.0), True, Scatter(1e-5, 2e-4)),
}
"""Settings, whether they are turns of the ring gear, and the scatter."""


@cache
def slopes(gear: BracedGear, setting: float) -> tuple[float, float]:
    """Stiffness over the range of load, of either sign, N·m/rad."""
    return gear.stiffness(setting, *LOADS)


def readings(
    gear: BracedGear,
    settings: Sequence[float],
    scatter: Scatter,
    random: np.random.Generator,
) -> list[Reading]:
    """Record a gear.

    Args:
        gear: the true one.
        settings: one per recording.
        scatter: of the recordings.
        random: source.
    """
    found = []
    for number, setting in enumerate(settings):
        play = max(-gear.squeeze(setting) + scatter.between * random.standard_normal(), 0.0)
        noise = scatter.within * math.sqrt(REPEATS) * random.standard_normal(REPEATS)
        seen = Estimate.of_mean((play + noise).tolist())
        clear = seen.value > seen.uncertainty
        drag = gear.drag(setting) + scatter.friction * random.standard_normal()
        springs = [
            Estimate(side * (1.0 + scatter.stiffness * random.standard_normal()), None, 0.0, 1)
            for side in slopes(gear, setting)
        ]
        found.append(
            Reading(
                f'recording {number}',
                setting,
                seen if clear else None,
                None if clear else max(seen.value, 0.0) + seen.uncertainty,
                Estimate(drag, None, 0.0, 1),
                *springs,
            )
        )
    return found


def coverage(name: str, seeds: int, load: float) -> dict[str, float]:
    """How often intervals contain the true value, and predictions a new recording.

    Args:
        name: of the settings.
        seeds: simulated sets of recordings.
        load: N·m.
    """
    settings, turns, scatter = SETTINGS[name]
    gear = BracedGear()
    random = np.random.default_rng(1)
    least, counts, held = gear.least(load), Counter(), Counter()
    price = gear.drag(least) - gear.drag(gear.end)

    def judge(what: str, estimate: Estimate | None, value: float) -> None:
        if estimate and estimate.uncertainty is not None:
            counts[what] += 1
            held[what] += abs(estimate.value - value) <= estimate.uncertainty

    for _ in range(seeds):
        seen = readings(gear, settings, scatter, random)
        advice = advise(seen, gear.closing if turns else None, LOADS)
        counts['bounds'] += 1
        low, high = advice.play.greatest_with, advice.play.least_without
        held['bounds'] += (low or -1.0) <= gear.end <= (math.inf if high is None else high)
        if span := advice.least(load):
            counts['least'] += 1
            held['least'] += span.low <= least <= span.high
            judge('price', advice.price(load), price)
        at = random.choice(settings) + 0.3
        [new] = readings(gear, [at], scatter, random)
        judge('friction', advice.predicted_friction(at), new.friction.value)
        both = 2.0 / (1.0 / new.positive.value + 1.0 / new.negative.value)
        judge('stiffness', advice.predicted_stiffness(at), both)
        if predicted := advice.predicted_play(at):
            counts['play'] += 1
            held['play'] += (
                abs(predicted.value - new.play.value) <= predicted.uncertainty
                if new.play
                else predicted.value - predicted.uncertainty <= new.limit
            )
    shares = {what: held[what] / counts[what] for what in counts}
    return {**shares, 'told': counts['least'] / seeds}
