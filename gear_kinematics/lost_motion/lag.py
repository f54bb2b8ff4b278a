"""An angle that reverses later than the torque, by a late encoder or by the gear's inertia."""

from collections.abc import Sequence

import numpy as np

from gear_kinematics.lost_motion.ramps import Array, Ramps
from gear_kinematics.state.uncertainty import Component, Estimate

STANDSTILL = 1.5
"""The torque goes back by this times the friction while the gear certainly stands still."""
_WINDOW = 0.15
"""Share of a ramp's amplitude, before and after a reversal, in which corners are found."""
_ROWS = 10
"""Least number of samples on either side of a corner."""
_ITERATIONS = 6
_NEAR = 0.6
"""Share of the window within which a corner has to be."""
_OF_GEAR = 0.01
"""s, up to which it may well be the gear that is late. Its inertia moves it on after a reversal,
for about an eighth of the period with which it swings on its spring: at 10 ms, that is 12 Hz."""


def encoder_lag(
    time: Array, torque: Array, angle: Array, ramps: Sequence[Ramps], friction: float
) -> Estimate | None:
    """Estimate by how much later than the torque the angle was sampled.

    Args:
        time: (n,), s, ascending.
        torque: (n,), N·m.
        angle: (n,), rad.
        ramps: found in them.
        friction: N·m.

    Returns:
        In s; None if there is no reversal whose corners can be seen in both.
    """
    found = []
    for group in ramps:
        window = min(_WINDOW * group.amplitude, STANDSTILL * friction)
        for half in group.halves():
            late = _late(time - half.times[0], torque, angle, window / half.rate)
            if late is not None:
                found.append(late)
    return Estimate.of_mean(found) if len(found) > 1 else None


def of_encoder(lag: Estimate) -> Estimate:
    """Return how much of a lag is ascribed to the encoder, s: half of one that may be the gear's.

    Its uncertainty contains that it may be all or nothing of that.
    """
    if lag.value > _OF_GEAR:
        return lag
    return lag.times(0.5).joined(Component(0.5 * lag.value))


def _late(time: Array, torque: Array, angle: Array, span: float) -> float | None:
    """Time from the corner of the torque near zero time to that of the angle, s."""
    rows = slice(*np.searchsorted(time, [-(1.0 + _NEAR) * span, (1.0 + _NEAR) * span]))
    first, second = (_corner(time[rows], values[rows], span) for values in (torque, angle))
    return None if first is None or second is None else second - first


def _corner(time: Array, values: Array, span: float) -> float | None:
    """Find where the straight lines before and after a corner near zero time meet, s."""
    corner = 0.0
    for _ in range(_ITERATIONS):
        before = (time > corner - span) & (time < corner)
        after = (time >= corner) & (time < corner + span)
        if min(np.count_nonzero(before), np.count_nonzero(after)) < _ROWS:
            return None
        first, second = (
            np.polynomial.polynomial.polyfit(time[rows], values[rows], 1)
            for rows in (before, after)
        )
        if first[1] == second[1]:
            return None
        corner = float((second[0] - first[0]) / (first[1] - second[1]))
        if abs(corner) > _NEAR * span:
            return None
    return corner


def without_lag(time: Array, angle: Array, lag: float) -> Array:
    """Return the angles at the times of the torque, (n,), rad."""
    return np.interp(time + lag, time, angle)
