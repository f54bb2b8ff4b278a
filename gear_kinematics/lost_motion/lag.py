"""An angle that reverses later than the torque, by a late encoder or by the gear's inertia."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from gear_kinematics.lost_motion.ramps import Array, HalfLoop, Ramps
from gear_kinematics.lost_motion.rate import rate_of
from gear_kinematics.lost_motion.recording import Loading
from gear_kinematics.state.uncertainty import Component, Estimate, unclear

STANDSTILL = 1.5
"""The torque goes back by this times the friction while the gear certainly stands still."""
_WINDOW = 0.15
"""Share of a ramp's amplitude, before and after a reversal, in which corners are found."""
_SHARP = 0.5
"""Share of the time of the window up to which the torque does not pause at its peak."""
_ROWS = 10
"""Least number of samples on either side of a corner."""
_STEPS = 5.0
"""Least number of steps of the encoder within the window; coarser ones hide the corner."""
_ITERATIONS = 6
_NEAR = 0.6
"""Share of the window within which a corner has to be."""
OF_GEAR = 0.01
"""s, up to which it may well be the gear that is late. Its inertia moves it on after a reversal,
for about an eighth of the period with which it swings on its spring: at 10 ms, that is 12 Hz."""
_SURELY = 3.0
"""Ratio to its ± from which on a torque is late."""
_USUAL = 0.02
"""s, lag of encoders that are late, as a scale."""


def encoder_lag(
    time: Array, loading: Loading, ramps: Sequence[Ramps], friction: float
) -> Estimate | None:
    """Estimate by how much later than the torque the angle was sampled.

    Args:
        time: (n,), s, ascending, of the samples of the recording.
        loading: the recording.
        ramps: found in it.
        friction: N·m.

    Returns:
        In s; None if there are no two reversals whose corners can be seen in both.
    """
    found = []
    for group in ramps:
        window = min(_WINDOW * group.amplitude, STANDSTILL * friction)
        rate = rate_of(group)
        own = {id(half) for half in group.halves()}
        for before, half in pairwise(group.history):
            if rate and id(half) in own and _seen(before, window, loading.angle_step.size):
                corner, after = _expected(before, half, window, window / rate.rate)
                late = _late(time - corner, loading, window / rate.rate, after)
                if late is not None:
                    found.append(late)
    return Estimate.of_mean(found) if len(found) > 1 else None


def of_encoder(lag: Estimate) -> Estimate:
    """Return how much of a lag is ascribed to the encoder, s: half of one that may be the gear's.

    Its uncertainty contains that it may be all or nothing of that.
    """
    if lag.value > OF_GEAR:
        return lag
    return lag.times(0.5).joined(Component(0.5 * lag.value))


def of_torque(lag: Estimate) -> bool:
    """Whether it is the torque that is late; stick-slip looks like that, but less clearly."""
    return lag.value < -max(OF_GEAR, _SURELY * (lag.uncertainty or 0.0))


def not_clear(lag: Estimate) -> float:
    """Return the standard uncertainty of a lag that is not taken out, s."""
    values = np.array([lag.value]), np.array([lag.standard or 0.0])
    return float(unclear(*values, _USUAL)[0])


def _seen(before: HalfLoop, window: float, angle_step: float) -> bool:
    """Whether the encoder steps often enough while the torque rises to a peak by the window."""
    rise = before.angle_at(before.end) - before.angle_at(_below(before.end, window))
    return abs(float(rise)) >= _STEPS * angle_step


def _below(peak: float, torque: float) -> float:
    """A torque that is less than a peak of either sign by so many N·m."""
    return peak - math.copysign(torque, peak)


def _expected(before: HalfLoop, half: HalfLoop, window: float, span: float) -> tuple[float, float]:
    """When the torque has a corner at a peak, and how long a line may be after it, s.

    Args:
        before: the half loop that ends at the peak.
        half: the one that begins there.
        window: N·m, by which the torque changes before the corner.
        span: s, in which it does so.
    """
    levels = [_below(half.start, share * window) for share in (0.5, 1.0)]
    (last, earlier), (first, later) = before.time_at(levels), half.time_at(levels)
    arrival, departure = 2.0 * last - earlier, 2.0 * first - later
    pause = float(departure - arrival)
    if pause < _SHARP * span:
        return float(half.times[0]), span
    # The corner is where the torque arrives. That of a sine goes on to rise for half of its pause.
    return float(arrival), min(span, 0.5 * pause)


def _late(time: Array, loading: Loading, before: float, after: float) -> float | None:
    """Time from the corner of the torque near zero time to that of the angle, s."""
    rows = slice(*np.searchsorted(time, [-(1.0 + _NEAR) * before, _NEAR * before + after]))
    first, second = (
        _corner(time[rows], values[rows], before, after)
        for values in (loading.torque, loading.angle)
    )
    return None if first is None or second is None else second - first


def _corner(time: Array, values: Array, before: float, after: float) -> float | None:
    """Find where straight lines before and after a corner near zero time meet, s.

    Args:
        time: (n,), s.
        values: (n,).
        before: s, duration of the line before the corner.
        after: s, of that after it.
    """
    corner = 0.0
    for _ in range(_ITERATIONS):
        earlier = (time > corner - before) & (time < corner)
        later = (time >= corner) & (time < corner + after)
        if min(np.count_nonzero(earlier), np.count_nonzero(later)) < _ROWS:
            return None
        first, second = (
            np.polynomial.polynomial.polyfit(time[rows], values[rows], 1)
            for rows in (earlier, later)
        )
        if first[1] == second[1]:
            return None
        corner = float((second[0] - first[0]) / (first[1] - second[1]))
        if abs(corner) > _NEAR * before:
            return None
    return corner


def without_lag(time: Array, angle: Array, lag: float) -> Array:
    """Return the angles at the times of the torque, (n,), rad."""
    return np.interp(time + lag, time, angle)
