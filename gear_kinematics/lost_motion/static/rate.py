"""How fast the torque of ramps changes: a static test is one that does not depend on it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gear_kinematics.lost_motion.static.ramps import HalfLoop, Ramps

_MIDDLE = 0.8
"""Share of a ramp whose rate is taken: it is slower where it reverses."""
DIFFERENT = 1.25
"""Ratio from which rates are called different.

Below it are the differences between ramps of the same command: up to 1.12 in 28 recordings of one
actuator that could follow it. Creep and friction often change with the logarithm of the rate, of
which this is a tenth of a decade.
"""


@dataclass(frozen=True, slots=True)
class Rate:
    """Change of the torque with time in ramps of one amplitude."""

    amplitude: float
    """N·m, of the ramps."""
    rate: float
    """N·m/s, median of the half loops."""
    duration: float
    """s, of a loop at this rate: four times from zero to the peak."""

    def differs_from(self, other: 'Rate') -> bool:
        """Whether the figures of the two may differ by their rates."""
        return max(self.rate, other.rate) > DIFFERENT * min(self.rate, other.rate)


def rates(ramps: Sequence[Ramps]) -> tuple[Rate | None, ...]:
    """Find the rates of ramps, one per amplitude; None without times."""
    return tuple(map(rate_of, ramps))


def rate_of(ramps: Ramps) -> Rate | None:
    """Find the rate of ramps of one amplitude; None without times."""
    found = [rate for half in ramps.halves() if (rate := _of_half(half, ramps.amplitude))]
    if not found:
        return None
    # The last half loop may go on to ramps of another amplitude, at their rate.
    rate = float(np.median(found))
    return Rate(ramps.amplitude, rate, 4.0 * ramps.amplitude / rate)


def _of_half(half: HalfLoop, amplitude: float) -> float | None:
    """N·m/s, over the middle of a half loop, up to the amplitude."""
    if half.time is None:
        return None
    sign = 1.0 if half.rising else -1.0
    ends = [
        sign * _MIDDLE * min(max(sign * end, -amplitude), amplitude)
        for end in (half.start, half.end)
    ]
    begin, finish = np.interp(sign * np.array(ends), sign * half.torque, half.time)
    return abs(ends[1] - ends[0]) / float(finish - begin) if finish > begin else None
