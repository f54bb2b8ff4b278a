"""Models of the ramps of a recording: the spring, its play and friction, and what time does."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.lost_motion.creep import Creep, Loads, creep_of, without_creep
from gear_kinematics.lost_motion.drift import Drift, drift_of, without_drift
from gear_kinematics.lost_motion.lag import encoder_lag, of_encoder, without_lag
from gear_kinematics.lost_motion.midline import Midlines
from gear_kinematics.lost_motion.play import PlayModel, play_model
from gear_kinematics.lost_motion.ramps import Array, Ramps, find_ramps
from gear_kinematics.lost_motion.recording import Loading
from gear_kinematics.state.uncertainty import Component, Estimate, by_steps, slope_resolution

_LOADED = 0.5
"""Share of the greatest load from which on the stiffness of the spring is taken."""
_LEVELS = 100
"""Loads at which the slope of a curve is taken."""


@dataclass(frozen=True, slots=True)
class Spring:
    """The spring alone: on the middle line, where friction cancels, and without creep."""

    low: float
    """N·m, magnitude of the load."""
    high: float
    """N·m."""
    stiffness: Estimate
    """N·m/rad."""


@dataclass(frozen=True, eq=False, slots=True)
class Effects:
    """What time does to a recording; None where it does not show, or without times."""

    lag: Estimate | None
    """s, by which corners of the angle come later than those of the torque."""
    removed: Estimate | None
    """s, what of it is ascribed to the encoder; taken out."""
    drifts: tuple[Drift | None, ...]
    """Of the ramps of each amplitude; taken out."""


@dataclass(frozen=True, eq=False, slots=True)
class Models:
    """What describes the ramps."""

    plays: tuple[PlayModel | None, ...]
    """Of the ramps of each amplitude."""
    spring: Spring | None
    """By the largest ramps."""
    creep: Creep | None


def settled(loading: Loading) -> tuple[tuple[Ramps, ...], Effects]:
    """Find the ramps of a recording, without the lag of its encoder and the drift of its zero.

    Raises:
        RampError: if there are none.
    """
    torque, angle, time = loading.torque, loading.angle, loading.time
    ramps = find_ramps(torque, angle, time)
    if time is None:
        return ramps, Effects(None, None, (None,) * len(ramps))
    lag = encoder_lag(time, torque, angle, ramps, _friction(ramps))
    removed = None
    if lag and lag.value > (lag.uncertainty or 0.0):
        removed = of_encoder(lag)
        ramps = find_ramps(torque, without_lag(time, angle, removed.value), time)
    else:
        lag = None
    drifts = tuple(map(drift_of, ramps))
    still = (
        without_drift(group, drift) if drift else group
        for group, drift in zip(ramps, drifts, strict=True)
    )
    return tuple(still), Effects(lag, removed, drifts)


def _friction(ramps: Sequence[Ramps]) -> float:
    """About the friction, N·m."""
    return float(np.median(Midlines.of(ramps[0].whole).friction))


def models_of(ramps: Sequence[Ramps], angle_step: float, removed: Estimate | None) -> Models:
    """Model ramps.

    Args:
        ramps: of a recording, in ascending order of amplitude.
        angle_step: rad, between readings of the encoder; 0 if unknown.
        removed: s, lag of the encoder that has been taken out.
    """
    creep, steeper, others = None, None, []
    if ramps[0].history[0].time is not None:
        friction = _friction(ramps)
        loads = Loads(ramps[0].history, friction)
        creep = creep_of(loads, ramps, friction, angle_step)
        if creep:
            more = creep.compliance.value + (creep.compliance.standard or 0.0)
            steeper = without_creep(ramps[-1], loads, more, creep.constant)
            others = [
                without_creep(ramps[-1], loads, compliance, constant)
                for constant, compliance in creep.others
            ]
            ramps = [
                without_creep(group, loads, creep.compliance.value, creep.constant)
                for group in ramps
            ]
    late = removed.standard or 0.0 if removed else 0.0
    plays = [_play(group, angle_step, late) for group in ramps]
    spring = _spring(ramps[-1], steeper, others, angle_step)
    if spring:
        stiffness = spring.stiffness.value
        plays = [play and play.under(stiffness) for play in plays[:-1]] + plays[-1:]
    return Models(tuple(plays), spring, creep)


def _play(ramps: Ramps, angle_step: float, late: float) -> PlayModel | None:
    hysteresis = float(np.mean([loop.width(0.0) for loop in ramps.loops]))
    rate = ramps.loops[0].fall.rate if late else 0.0
    return play_model(ramps.whole, angle_step, hysteresis, rate * late)


def _spring(
    ramps: Ramps, steeper: Ramps | None, others: Sequence[Ramps], angle_step: float
) -> Spring | None:
    """Measure the spring of ramps.

    Args:
        ramps: without their creep.
        steeper: without as much more creep as its standard uncertainty.
        others: without creep of other time constants, as likely as the one of `ramps`.
        angle_step: rad, between readings of the encoder; 0 if unknown.
    """
    lines = Midlines.of(ramps.whole)
    high = float(np.min(np.abs(lines.load[:, [0, -1]])))  # which all loops reach on both sides
    low = _LOADED * high
    own = _compliances(lines, low, high)
    if np.min(own) <= 0.0:
        return None
    likely = [own, *(_compliances(Midlines.of(other.whole), low, high) for other in others)]
    loops = np.mean(likely, axis=0)
    steps = slope_resolution(angle_step, high - low, float(np.mean(loops)), of_means=True)
    parts = [
        by_steps(steps, len(loops)),
        Component(float(np.std(np.mean(likely, axis=1)))),
    ]
    if steeper:
        more = _compliances(Midlines.of(steeper.whole), low, high)
        parts.append(Component(abs(float(np.mean(more - own)))))
    return Spring(
        low, high, mean_of_loops(loops, completed=ramps.completed).joined(*parts).inverse()
    )


def mean_of_loops(loops: Array, *, completed: bool) -> Estimate:
    """Return the mean of loops, of which two have a quarter in common if one was completed.

    With σ² of each of n loops and the covariance σ²/4 of these two, the variance of the mean is
    σ² (1 + 1/(2 n))/n, and that of the sample is expected to be σ² (1 - 1/(2 n (n - 1))).
    """
    mean, count = Estimate.of_mean(loops.tolist()), len(loops)
    if not completed or mean.standard is None:
        return mean
    hidden = (1.0 + 0.5 / count) / (1.0 - 0.5 / (count * (count - 1)))
    return replace(mean, standard=math.sqrt(hidden) * mean.standard)


def _compliances(lines: Midlines, low: float, high: float) -> Array:
    """Slopes of the lines through the middle line of each loop under both signs, rad/(N·m)."""
    found = []
    levels = np.linspace(low, high, _LEVELS)
    for angle, load in zip(lines.angle, lines.load, strict=True):
        rising = np.maximum.accumulate(load)
        slopes = [
            np.polynomial.polynomial.polyfit(side, np.interp(side, rising, angle), 1)[1]
            for side in (levels, -levels[::-1])
        ]
        found.append(float(np.mean(slopes)))
    return np.array(found)
