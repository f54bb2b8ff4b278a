"""Creep: an angle that follows the load late, seen where the gear stands still.

A gear with friction stands still after each reversal of the torque, whatever its spring is. If its
angle goes on while the load stays, it creeps.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.lost_motion.lag import STANDSTILL
from gear_kinematics.lost_motion.ramps import Array, HalfLoop, Ramps
from gear_kinematics.state.uncertainty import Estimate

_LEVELS = 100
"""Torques of a half loop at which loads are computed."""
_SETTLED = 0.2
"""Share of the friction by which the torque has gone back when the corner is certainly over."""
_ROWS = 10
"""Least number of samples of a standstill."""
_LEAST_STILLS = 4
_ROUNDING = 1e-9
"""rad."""
_STANDARD_ERRORS = 2.0
"""Creep has to predict better than none by this many standard errors."""
_UNLIKELY = 3.0
"""A time constant that predicts worse than the best one by so many standard errors is unlikely."""
_CONSTANTS = np.array([1.0, 2.0, 5.0, 10.0, 20.0, 50.0])
"""s, time constants that are tried."""


@dataclass(frozen=True, eq=False, slots=True)
class Creep:
    """An angle that follows the load late, by one time constant."""

    compliance: Estimate
    """rad/(N·m), of the part that comes late."""
    constant: float
    """s."""
    others: tuple[tuple[float, float], ...]
    """Other time constants, s, that predict as well, with their compliances, rad/(N·m)."""


def transmitted(torque: Array, load: float, friction: float, growth: float = 0.0) -> Array:
    """Load on the spring while the torque goes one way, N·m.

    Args:
        torque: (n,), N·m, monotonic.
        load: N·m, at the start.
        friction: N·m, without load.
        growth: share of the load that adds to it.
    """
    sign = 1.0 if torque[-1] > torque[0] else -1.0
    driven = sign * torque - friction
    moving = np.where(driven > 0.0, driven / (1.0 + growth), driven / (1.0 - growth))
    return sign * np.maximum(moving, sign * load)


class Loads:
    """Loads on the spring through a recording, and what follows them late."""

    def __init__(self, history: Sequence[HalfLoop], friction: float) -> None:
        """Compute the loads of all half loops, in order of time."""
        times, loads = [], []
        load = 0.0
        for half in history:
            torque = np.linspace(half.start, half.end, _LEVELS)
            values = transmitted(torque, load, friction)
            load = float(values[-1])
            times.append(half.time_at(torque))
            loads.append(values)
        self._time, self._load = np.concatenate(times), np.concatenate(loads)

    def late(self, constants: Array) -> Callable[[Array], Array]:
        """Return the loads as they come late by time constants, over time.

        Args:
            constants: (n,), s.

        Returns:
            A function of times, (m,), s, to loads, (n, m), N·m.
        """
        late = np.zeros((len(self._time), len(constants)))
        for k, (step, load) in enumerate(
            zip(np.diff(self._time), 0.5 * (self._load[1:] + self._load[:-1]), strict=True), 1
        ):
            late[k] = load + (late[k - 1] - load) * np.exp(-max(step, 0.0) / constants)
        return lambda time: np.array([np.interp(time, self._time, column) for column in late.T])


def creep_of(
    loads: Loads, ramps: Sequence[Ramps], friction: float, angle_step: float
) -> Creep | None:
    """Estimate creep from where the gear stands still after reversals of the torque.

    Args:
        loads: of the recording.
        ramps: of the recording.
        friction: N·m.
        angle_step: rad, between readings of the encoder; 0 if unknown.

    Returns:
        None if creep does not predict the standstills that were left out.
    """
    late = loads.late(_CONSTANTS)
    halves = (half for group in ramps for half in group.halves())
    stills = [still for half in halves if (still := _still(half, friction, late))]
    if len(stills) < _LEAST_STILLS:
        return None
    both, square, angle = (np.array([still[k] for still in stills]) for k in range(3))
    # Compliances by all standstills but one, and how these predict that one: (stills, constants).
    without = (both.sum(0) - both) / (square.sum(0) - square)
    missed = angle[:, None] - 2.0 * without * both + without**2 * square
    count = len(stills)
    best = int(np.argmin(missed.sum(0)))
    gain = angle - missed[:, best]
    if np.mean(gain) < _STANDARD_ERRORS * np.std(gain, ddof=1) / math.sqrt(count):
        return None
    compliance = both.sum(0) / square.sum(0)
    spread = without[:, best] - np.mean(without[:, best])
    standard = math.sqrt((count - 1) / count * float(np.sum(spread**2)))
    found = Estimate(float(compliance[best]), standard, count - 1, count)
    least = max(angle_step, _ROUNDING) / ramps[-1].amplitude
    if found.value <= max(found.uncertainty or 0.0, least):
        return None
    worse = missed - missed[:, [best]]
    close = np.mean(worse, 0) <= _UNLIKELY * np.std(worse, 0, ddof=1) / math.sqrt(count)
    others = [k for k in np.flatnonzero(close).tolist() if k != best]
    return Creep(
        found,
        float(_CONSTANTS[best]),
        tuple((float(_CONSTANTS[k]), float(compliance[k])) for k in others),
    )


def _still(
    half: HalfLoop, friction: float, late: Callable[[Array], Array]
) -> tuple[Array, Array, float] | None:
    """Return sums over a standstill: late loads by angle, late loads squared, angle squared."""
    back = np.abs(half.torque - half.start)
    rows = (back > max(4.0 * half.blur, _SETTLED * friction)) & (back < STANDSTILL * friction)
    if np.count_nonzero(rows) < _ROWS:
        return None
    time = half.times[rows]
    angle = half.angle[rows] - np.mean(half.angle[rows])
    loads = late(time)
    loads = loads - np.mean(loads, axis=1, keepdims=True)
    return loads @ angle, np.sum(loads**2, axis=1), float(angle @ angle)


def without_creep(ramps: Ramps, loads: Loads, compliance: float, constant: float) -> Ramps:
    """Return the ramps without what comes late."""
    late = loads.late(np.array([constant]))
    return ramps.changed(
        lambda half: replace(half, angle=half.angle - compliance * late(half.times)[0])
    )
