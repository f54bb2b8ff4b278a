"""How often the figures of simulated torque ramps hold, in each scenario."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from simulated_ramps import STEP, Scenario, simulate, truth

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.lost_motion.encoder_step import Source, Step
from gear_kinematics.lost_motion.recording import Loading, Recording
from gear_kinematics.lost_motion.report import HysteresisReport, measure
from gear_kinematics.state.uncertainty import Estimate


class Judged(NamedTuple):
    """Shares of recordings in which a figure is held by its interval, and what is told."""

    hysteresis: float
    play: float
    """Of those with a value or an upper bound."""
    friction: float
    """NaN where a gear has no one friction."""
    spring: float
    valued: float
    """Share of recordings whose play has a value."""
    refused: float
    """Share of those whose play is not separable from the spring."""
    play_bias: float
    """rad, mean error of the values; NaN without any."""
    play_uncertainty: float
    """rad, median ± of the values; NaN without any."""
    limit: float
    """rad, median upper bound; NaN without any."""
    below_zero: int
    """Plays that are told to be negative, as values or bounds."""


def judge(scenario: Scenario, seeds: int, seed: int = 1) -> Judged:
    """Measure simulated recordings, and compare with the gear."""
    gear = truth(scenario)
    recorded = simulate(scenario, seeds, np.random.default_rng(seed))
    found = [
        _measured(recorded.time, recorded.torque[:, k], recorded.angle[:, k]) for k in range(seeds)
    ]
    models = [one.smallest.play_model for one in found]
    values = [model.play for model in models if model.play]
    limits = [model.limit for model in models if model.limit is not None]
    held = sum(_holds(value, gear.play) for value in values)
    held += sum(gear.play <= limit for limit in limits)
    told = len(values) + len(limits)
    return Judged(
        hysteresis=_share(_holds(one.smallest.hysteresis, gear.hysteresis) for one in found),
        play=held / told if told else math.nan,
        friction=math.nan
        if scenario.slip
        else _share(_holds(model.friction, gear.friction) for model in models),
        spring=_share(_holds(one.spring.stiffness, _stiffness(scenario, one)) for one in found),
        valued=len(values) / seeds,
        refused=1.0 - told / seeds,
        play_bias=_mean([value.value - gear.play for value in values]),
        play_uncertainty=_median([value.uncertainty for value in values]),
        limit=_median(limits),
        below_zero=sum(value.value <= 0.0 for value in values) + sum(x <= 0.0 for x in limits),
    )


def _measured(time: np.ndarray, torque: np.ndarray, angle: np.ndarray) -> HysteresisReport:
    loading = Loading(torque, angle, Step(STEP, Source.GIVEN), measured=True, time=time)
    recording = Recording('simulated', (), len(time), loading)
    return measure(recording, GearRatio(-19)).hysteresis


def _stiffness(scenario: Scenario, found: HysteresisReport) -> float:
    """Stiffness of the true spring over the same loads: the line through its curve."""
    load = np.linspace(found.spring.low, found.spring.high, 400)
    return 1.0 / float(np.polyfit(load, scenario.spring(load), 1)[0])


def _holds(estimate: Estimate, value: float) -> bool:
    return abs(estimate.value - value) <= estimate.uncertainty


def _share(held: Sequence[bool]) -> float:
    return float(np.mean(list(held)))


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values)) if values else math.nan


def _median(values: Sequence[float]) -> float:
    return float(np.median(values)) if values else math.nan
