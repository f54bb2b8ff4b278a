"""Models of the ramps of a recording: the spring, its play and friction, and what time does."""

import math
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.lost_motion.recorded.recording import Loading
from gear_kinematics.lost_motion.static.breakaway import breakaway_friction
from gear_kinematics.lost_motion.static.creep import Creeping, creeping_of
from gear_kinematics.lost_motion.static.drift import Drift, drift_of, without_drift
from gear_kinematics.lost_motion.static.friction import friction_of
from gear_kinematics.lost_motion.static.lag import (
    encoder_lag,
    not_clear,
    of_encoder,
    of_torque,
    without_lag,
)
from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.pause import pauses_of
from gear_kinematics.lost_motion.static.play import PlayModel, play_model
from gear_kinematics.lost_motion.static.ramps import Array, Ramps, find_ramps
from gear_kinematics.lost_motion.static.rate import rate_of
from gear_kinematics.state.uncertainty import Component, Estimate, by_steps, slope_resolution

_CLEARLY = 1.5
"""Ratio to its ± from which on a lag is taken out, as gears do not stand perfectly still."""
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
    by_creep: float
    """N·m/rad, part of its standard uncertainty that comes from creep."""


@dataclass(frozen=True, eq=False, slots=True)
class Effects:
    """What time does to a recording; None where it does not show, or without times."""

    lag: Estimate | None
    """s, by which corners of the angle come later than those of the torque; negative: earlier."""
    removed: Estimate | None
    """s, what of it is ascribed to the encoder; taken out. None if they come earlier."""
    late: float | None
    """s, standard uncertainty of how late the angle still is; None if nothing shows it."""
    drifts: tuple[Drift | None, ...]
    """Of the ramps of each amplitude; taken out."""


@dataclass(frozen=True, eq=False, slots=True)
class Settled:
    """Ramps without the lag of their encoder and the drift of their zero."""

    ramps: tuple[Ramps, ...]
    """In ascending order of amplitude."""
    effects: Effects
    creeping: Creeping | None = None
    """Not taken out."""


@dataclass(frozen=True, eq=False, slots=True)
class Models:
    """What describes the ramps."""

    plays: tuple[PlayModel | None, ...]
    """Of the ramps of each amplitude."""
    spring: Spring | None
    """By the largest ramps."""


def settled(loading: Loading) -> Settled:
    """Find the ramps of a recording, and take out what time does to them.

    Raises:
        RampError: if there are none.
    """
    torque, angle, time = loading.torque, loading.angle, loading.time
    ramps = find_ramps(torque, angle, time)
    if time is None:
        return Settled(ramps, Effects(None, None, None, (None,) * len(ramps)))
    friction = breakaway_friction(ramps[0])
    lag = encoder_lag(time, loading, ramps, friction)
    removed, late = None, None
    if lag and lag.value > _CLEARLY * (lag.uncertainty or 0.0):
        # The latest corners were too late to be found from none.
        lag = encoder_lag(time, loading, ramps, friction, lag.value) or lag
        removed = of_encoder(lag)
        late = removed.standard
        angle = without_lag(time, angle, removed.value)
        ramps = find_ramps(torque, angle, time)
        friction = breakaway_friction(ramps[0])
    elif lag:
        late, lag = not_clear(lag), lag if of_torque(lag) else None
    # A drift hardly shows in creep, which goes to and fro with the torque, but creep in a drift.
    pauses = list(pauses_of(time, torque, angle, ramps[-1], friction))
    creeping = creeping_of(ramps, friction, loading.angle_step.size, pauses)
    drifts = tuple(drift_of(_without(creeping, group)) for group in ramps)
    still = (
        without_drift(group, drift) if drift else group
        for group, drift in zip(ramps, drifts, strict=True)
    )
    return Settled(tuple(still), Effects(lag, removed, late, drifts), creeping)


def _without(creeping: Creeping | None, ramps: Ramps) -> Ramps:
    return creeping.out_of(ramps) if creeping else ramps


def models_of(found: Settled, angle_step: float) -> Models:
    """Model ramps.

    Args:
        found: the ramps of a recording.
        angle_step: rad, between readings of the encoder; 0 if unknown.
    """
    creeping, late = found.creeping, found.effects.late or 0.0
    plays = [_play(group, angle_step, late, creeping) for group in found.ramps]
    spring = _spring(found.ramps[-1], angle_step, creeping)
    if spring:
        stiffness = spring.stiffness.value
        plays = [play and play.under(stiffness) for play in plays[:-1]] + plays[-1:]
    return Models(tuple(plays), spring)


def _play(
    ramps: Ramps, angle_step: float, late: float, creeping: Creeping | None
) -> PlayModel | None:
    """Model the play of ramps.

    Args:
        ramps: with creep.
        angle_step: rad, between readings of the encoder; 0 if unknown.
        late: s, standard uncertainty of the lag of the encoder.
        creeping: of the recording.
    """
    still = _without(creeping, ramps)
    rate = rate_of(ramps)
    by_time = late * rate.rate if rate else 0.0
    if creeping:
        by_time = math.hypot(by_time, creeping.part(ramps, _friction_of).standard)
    hysteresis = float(np.mean([loop.width(0.0) for loop in still.loops]))
    return play_model(still.whole, angle_step, hysteresis, by_time)


def _friction_of(ramps: Ramps) -> float:
    """The friction without load, N·m."""
    return friction_of(Midlines.of(ramps.whole), 0.0)[0].value


def _spring(ramps: Ramps, angle_step: float, creeping: Creeping | None) -> Spring | None:
    """Measure the spring of ramps.

    Args:
        ramps: with creep.
        angle_step: rad, between readings of the encoder; 0 if unknown.
        creeping: of the recording.
    """
    lines = Midlines.of(_without(creeping, ramps).whole)
    high = float(np.min(np.abs(lines.load[:, [0, -1]])))  # which all loops reach on both sides
    low = _LOADED * high
    loops = _compliances(lines, low, high)
    if np.min(loops) <= 0.0:
        return None
    steps = slope_resolution(angle_step, high - low, float(np.mean(loops)), of_means=True)
    creep = Component(0.0)
    if creeping:
        creep = creeping.part(
            ramps, lambda ramps: float(np.mean(_compliances(Midlines.of(ramps.whole), low, high)))
        )
    compliance = mean_of_loops(loops, completed=ramps.completed)
    stiffness = compliance.joined(by_steps(steps, len(loops)), creep).inverse()
    return Spring(low, high, stiffness, stiffness.value**2 * creep.standard)


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
