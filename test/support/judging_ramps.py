"""How often the figures of simulated torque ramps hold, in each scenario."""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from simulated_ramps import STEP, Ramps, Scenario, drawn, hysteresis, simulate

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.lost_motion.recorded.encoder_step import Source, Step
from gear_kinematics.lost_motion.recorded.recording import Loading, Recording
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
    """Plays that are told to be zero or negative, as values or bounds."""


def judge(scenario: Scenario, count: int, seed: int = 1) -> Judged:
    """Measure simulated recordings, each of another gear, and compare with the gears."""
    random = np.random.default_rng(seed)
    gears = drawn(scenario, count, random)
    recorded = simulate(gears, random)
    found = [_measured(recorded, k) for k in range(count)]
    models = [one.smallest.play_model for one in found]
    values = [(play, m.play) for play, m in zip(gears.play, models, strict=True) if m.play]
    limits = [
        (play, m.limit) for play, m in zip(gears.play, models, strict=True) if m.limit is not None
    ]
    told = len(values) + len(limits)
    held = sum(_holds(found, play) for play, found in values)
    held += sum(play <= limit for play, limit in limits)
    return Judged(
        hysteresis=_share((one.smallest.hysteresis for one in found), hysteresis(gears)),
        play=held / told if told else math.nan,
        friction=math.nan
        if scenario.slip
        else _share((model.friction for model in models), gears.friction),
        spring=_share(
            (one.spring.stiffness for one in found),
            [_stiffness(scenario, one) for one in found] / gears.softness,
        ),
        valued=len(values) / count,
        refused=1.0 - told / count,
        play_bias=_mean([found.value - play for play, found in values]),
        play_uncertainty=_median([found.uncertainty for _, found in values]),
        limit=_median([limit for _, limit in limits]),
        below_zero=sum(found.value <= 0.0 for _, found in values)
        + sum(limit <= 0.0 for _, limit in limits),
    )


def _measured(recorded: Ramps, gear: int) -> HysteresisReport:
    loading = Loading(
        recorded.torque[:, gear],
        recorded.angle[:, gear],
        Step(STEP, Source.GIVEN),
        measured=True,
        time=recorded.time,
    )
    recording = Recording('simulated', (), len(recorded.time), loading)
    return measure(recording, GearRatio(-19)).hysteresis


def _stiffness(scenario: Scenario, found: HysteresisReport) -> float:
    """Stiffness of the true spring over the same loads: the line through its curve."""
    load = np.linspace(found.spring.low, found.spring.high, 400)
    return 1.0 / float(np.polyfit(load, scenario.twist(load), 1)[0])


def _holds(estimate: Estimate, value: float) -> bool:
    return abs(estimate.value - value) <= estimate.uncertainty


def _share(found: Iterable[Estimate], true: Sequence[float]) -> float:
    """Share of the estimates that hold."""
    return float(np.mean(list(map(_holds, found, true))))


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values)) if values else math.nan


def _median(values: Sequence[float]) -> float:
    return float(np.median(values)) if values else math.nan
