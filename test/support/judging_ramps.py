# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How often the figures of simulated torque ramps hold, in each scenario."""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from simulated_ramps import STEP, Scenario, drawn, hysteresis, simulate

from gear_kinematics.measurement.figures import GearFigures, gear_figures
from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.statistics.uncertainty import Estimate


class Judged(NamedTuple):
    """Shares of recordings in which a figure is held by its interval, and how wide that is."""

    hysteresis: float
    friction: float
    """NaN where a gear has no one friction, or where time adds to the width of the loop."""
    backlash: float
    width: float
    """rad, median of the interval of the backlash."""
    widest: float
    """rad, of 95 of 100 intervals."""
    above_zero: float
    """Share of recordings that are told to have backlash."""


def judge(scenario: Scenario, count: int, seed: int = 1, *, alike: bool = False) -> Judged:
    """Measure simulated recordings and compare with the gears, which all differ unless alike."""
    random = np.random.default_rng(seed)
    gears = drawn(scenario, count, random, spread=0.0 if alike else 1.0)
    recorded = simulate(gears, random)
    found = [measured(recorded.torque[:, k], recorded.angle[:, k]) for k in range(count)]
    backlash = [figures.backlash for figures in found]
    widths = [(math.inf if one.high is None else one.high) - one.low for one in backlash]
    held = [
        one.low <= play and (one.high is None or play <= one.high)
        for one, play in zip(backlash, gears.play * np.ones(count), strict=True)
    ]
    return Judged(
        hysteresis=_share((one.hysteresis for one in found), hysteresis(gears)),
        friction=math.nan
        if scenario.slip or scenario.creeps or np.any(scenario.lag) or scenario.inertia
        else _share((one.friction for one in found), gears.friction),
        backlash=float(np.mean(held)),
        width=float(np.median(widths)),
        widest=float(np.quantile(widths, 0.95)),
        above_zero=float(np.mean([one.low > 0.0 for one in backlash])),
    )


def measured(torque: np.ndarray, angle: np.ndarray) -> GearFigures:
    return gear_figures(find_ramps(torque, angle), STEP)


def _share(found: Iterable[Estimate], true: Sequence[float]) -> float:
    """Share of the estimates that hold."""
    pairs = zip(found, true, strict=True)
    return float(np.mean([abs(one.value - value) <= one.uncertainty for one, value in pairs]))
