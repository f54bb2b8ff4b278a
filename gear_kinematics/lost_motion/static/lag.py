"""An angle that reverses later than the torque, by a late encoder or by the gear's inertia."""

import math
from collections.abc import Sequence

import numpy as np

from gear_kinematics.lost_motion.recorded.recording import Loading
from gear_kinematics.lost_motion.static.pause import SHARP, pause_between, reversals, window_of
from gear_kinematics.lost_motion.static.ramps import Array, HalfLoop, Ramps
from gear_kinematics.lost_motion.static.rate import rate_of
from gear_kinematics.state.uncertainty import Component, Estimate, expected_effect

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
    time: Array, loading: Loading, ramps: Sequence[Ramps], friction: float, about: float = 0.0
) -> Estimate | None:
    """Estimate by how much later than the torque the angle was sampled.

    Args:
        time: (n,), s, ascending, of the samples of the recording.
        loading: the recording.
        ramps: found in it.
        friction: N·m.
        about: s, the lag near which it is sought.

    Returns:
        In s; None if there are no two reversals whose corners can be seen in both.
    """
    found = []
    for group in ramps:
        rate, window = rate_of(group), window_of(group, friction)
        for before, half in reversals(group):
            if rate and _seen(before, window, loading.angle_step.size):
                corner, after = _expected(before, half, window, window / rate.rate)
                first, second = (
                    _corner(time - at, values, window / rate.rate, after)
                    for at, values in (
                        (corner, loading.torque),
                        (corner + about, loading.angle),
                    )
                )
                if first is not None and second is not None:
                    found.append(about + second - first)
    return Estimate.of_mean(found) if len(found) > 1 else None


def of_encoder(lag: Estimate) -> Estimate:
    """Return how much of a lag is expected to be the encoder's, s.

    One of up to `OF_GEAR` is the gear's as likely as the encoder's, a longer one the encoder's.
    """
    if not lag.standard:
        longer = float(lag.value > OF_GEAR)
    else:
        longer = 0.5 * (1.0 + math.erf((lag.value - OF_GEAR) / (math.sqrt(2.0) * lag.standard)))
    share = 0.5 + 0.5 * longer
    by_gear = Component(lag.value * math.sqrt(share * (1.0 - share)))
    return lag.times(share).joined(by_gear)


def of_torque(lag: Estimate) -> bool:
    """Whether it is the torque that is late; stick-slip looks like that, but less clearly."""
    return lag.value < -max(OF_GEAR, _SURELY * (lag.uncertainty or 0.0))


def not_clear(lag: Estimate) -> float:
    """Return the standard uncertainty of a lag that is not taken out, s."""
    values = np.array([lag.value]), np.array([lag.standard or 0.0])
    (expected,), (standard,) = expected_effect(*values, _USUAL)
    return math.hypot(expected, standard)


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
    arrival, departure = pause_between(before, half, window)
    pause = departure - arrival
    if pause < SHARP * span:
        return float(half.times[0]), span
    # The corner is where the torque arrives. That of a sine goes on to rise for half of its pause.
    return arrival, min(span, 0.5 * pause)


def _corner(time: Array, values: Array, before: float, after: float) -> float | None:
    """Find where straight lines before and after a corner near zero time meet, s.

    Args:
        time: (n,), s.
        values: (n,).
        before: s, duration of the line before the corner.
        after: s, of that after it.
    """
    near = slice(*np.searchsorted(time, [-(1.0 + _NEAR) * before, _NEAR * before + after]))
    time, values = time[near], values[near]
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
