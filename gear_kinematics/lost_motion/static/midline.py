"""The middle line of hysteresis loops: the torque on the spring over the angle.

At one angle, the torque exceeds that of the spring by the friction while it rises, and falls short
of it by the friction while it falls. Half the sum of both is the load on the spring, half the
difference is the friction, whatever it depends on.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gear_kinematics.lost_motion.static.ramps import Array, HalfLoop, Loop

_LEVELS = 100
"""Angles at which a loop is known."""
_READINGS = 10
"""Of which each is a mean, as single ones would come and go with the steps of stick-slip."""
_MARGIN = 0.03
"""Share of the angles at either end that is left out, as the gear still sticks there."""
_BUILT_UP = 0.85
"""Share of the greatest load, up to which friction has certainly built up after a reversal."""
_TIE = 1e-12
"""Angles, rad, by which equal ones are told apart, in the order of their sampling."""


@dataclass(frozen=True, eq=False, slots=True)
class Midlines:
    """Loads and frictions of loops of one amplitude, (loops, levels) each."""

    angle: Array
    """rad, from the middle of each loop."""
    load: Array
    """N·m, of the spring."""
    friction: Array
    """N·m."""
    pace: Array
    """s/rad, time per angle, the mean of both ways; 0 without times."""
    centre: Array
    """(loops,), rad, the middles."""
    spacing: float
    """N·m, between samples of the torque."""
    noise: float
    """N·m, standard deviation of the noise of the torque after smoothing."""

    @classmethod
    def of(cls, loops: Sequence[Loop]) -> 'Midlines':
        """Read the middle lines of loops, at least one."""
        found = [_read(loop) for loop in loops]
        angle, load, friction, pace = (np.array([row[k] for row in found]) for k in range(4))
        centre = 0.5 * (angle[:, 0] + angle[:, -1])
        halves = [half for loop in loops for half in (loop.fall, loop.rise)]
        spacing = float(np.mean([np.median(np.abs(np.diff(half.torque))) for half in halves]))
        noise = float(np.mean([half.blur for half in halves]))
        return cls(angle - centre[:, None], load, friction, pace, centre, spacing, noise)

    @property
    def blur(self) -> float:
        """Load over which corners of the curve are rounded, by noise or between samples, N·m."""
        return max(self.noise, self.spacing)

    @property
    def reach(self) -> float:
        """Half of the angle of a loop, rad."""
        return 0.5 * float(np.mean(np.ptp(self.angle, axis=1)))


def _read(loop: Loop) -> tuple[Array, Array, Array, Array]:
    """Return angles, loads, frictions and paces."""
    fall, rise = loop.fall, loop.rise
    # A ramp may go on beyond the loop, to a larger amplitude.
    low = max(rise.angle[0], float(fall.angle_at(max(fall.end, rise.start))))
    high = min(fall.angle[0], float(rise.angle_at(min(rise.end, fall.start))))
    margin = _MARGIN * (high - low)
    angle = np.linspace(low + margin, high - margin, _LEVELS)
    load = 0.5 * (_passing(fall, angle, fall.torque) + _passing(rise, angle, rise.torque))
    inside = np.flatnonzero((load >= _BUILT_UP * load[0]) & (load <= _BUILT_UP * load[-1]))
    if len(inside):
        low, high = angle[inside[0]], angle[inside[-1]]
    angle = np.linspace(low, high, _LEVELS * _READINGS)
    back, forth = (_passing(half, angle, half.torque) for half in (fall, rise))
    pace = np.zeros_like(angle)
    if fall.time is not None and high > low:
        times = (_passing(half, angle, half.times) for half in (fall, rise))
        pace = np.mean([np.abs(np.gradient(time, angle)) for time in times], axis=0)
    load, friction = 0.5 * (forth + back), 0.5 * (forth - back)
    return _means(angle), _means(load), _means(friction), _means(pace)


def _means(readings: Array) -> Array:
    means: Array = np.mean(readings.reshape(_LEVELS, _READINGS), axis=1)
    return means


def _passing(half: HalfLoop, angle: Array, values: Array) -> Array:
    """Values where a half loop passes angles: midway between the first and the last time."""
    sign = 1.0 if half.rising else -1.0
    passed, wanted = sign * half.angle, sign * angle
    tie = _TIE * np.arange(len(passed))
    first = np.interp(wanted, np.maximum.accumulate(passed) + tie, values)
    last = np.interp(wanted, np.minimum.accumulate(passed[::-1])[::-1] + tie, values)
    return 0.5 * (first + last)
