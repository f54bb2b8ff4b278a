"""Creep: an angle that follows the load late, seen where the gear stands still.

A gear with friction stands still after each reversal of the torque, whatever its spring is. If its
angle goes on while the load stays, it creeps.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.lost_motion.midline import Midlines
from gear_kinematics.lost_motion.pause import STANDSTILL
from gear_kinematics.lost_motion.ramps import Array, HalfLoop, Ramps
from gear_kinematics.state.uncertainty import Component, Estimate, resolution, unclear

_LEVELS = 100
"""Torques of a half loop at which loads are computed."""
_FAR = 0.25
"""Share of the greatest load beyond which the twist of the spring is taken."""
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
_MISFIT = 0.1
"""Share of a correction for creep that counts as standard uncertainty, as no material has just one
time constant."""
_USUAL = 0.1
"""Share of the twist that comes late in gears that creep, as a scale."""
_CONSTANTS = np.geomspace(1.0, 50.0, 18)
"""s, time constants that are tried; known by their numbers."""


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
    """Loads on the spring through a recording, and what follows them or the twist late."""

    def __init__(
        self, history: Sequence[HalfLoop], friction: float, twist: Callable[[Array], Array]
    ) -> None:
        """Compute the loads of all half loops, in order of time, and what comes late of them.

        Args:
            history: of the recording.
            friction: N·m.
            twist: of the spring by load, as a load that would twist a linear one as much, N·m.
        """
        times, loads = [], []
        load = 0.0
        for half in history:
            torque = np.linspace(half.start, half.end, _LEVELS)
            values = transmitted(torque, load, friction)
            load = float(values[-1])
            times.append(half.time_at(torque))
            loads.append(values)
        self._time, on_time = np.concatenate(times), np.concatenate(loads)
        causes = np.repeat([on_time, twist(on_time)], len(_CONSTANTS), axis=0).T
        constants = np.tile(_CONSTANTS, 2)
        self._late: Array = np.zeros_like(causes)
        steps = zip(np.diff(self._time), 0.5 * (causes[1:] + causes[:-1]), strict=True)
        for k, (step, cause) in enumerate(steps, 1):
            left = np.exp(-max(step, 0.0) / constants)
            self._late[k] = cause + (self._late[k - 1] - cause) * left

    @property
    def numbers(self) -> range:
        """Numbers of the time constants: those after the load, and those after the twist."""
        return range(self._late.shape[1])

    def late(self, time: Array, number: int) -> Array:
        """Return the loads as they come late by the time constant of a number, (n,), N·m.

        Args:
            time: (n,), s.
            number: of the time constant.
        """
        late: Array = np.interp(time, self._time, self._late[:, number])
        return late


def _twist(lines: Midlines) -> Callable[[Array], Array]:
    """Return the twist of the spring by load, as a load that would twist a linear one as much.

    Args:
        lines: the middle lines, which are fitted by a polynomial beyond any backlash.
    """
    load, angle = lines.load.ravel(), lines.angle.ravel()
    size = float(np.max(np.abs(load)))
    far = np.abs(load) > _FAR * size

    def powers(load: Array) -> Array:
        terms: Array = np.stack([load, load * np.abs(load), load**3], axis=-1)
        return terms

    columns = np.column_stack([np.ones_like(load), np.sign(load), powers(load / size)])
    factors = np.linalg.lstsq(columns[far], angle[far])[0][2:]
    if np.sum(factors) <= 0.0:
        return lambda load: load
    shares: Array = size * factors / np.sum(factors)
    return lambda load: powers(load / size) @ shares


@dataclass(frozen=True, eq=False, slots=True)
class Creeping:
    """A gear that creeps, or may do so, through a recording."""

    clear: bool
    """Whether it certainly creeps."""
    loads: Loads
    compliance: Estimate
    """rad/(N·m), with the best time constant."""
    compliances: Array
    """rad/(N·m), with each time constant."""
    standards: Array
    """rad/(N·m), their standard uncertainties."""
    usual: float
    """rad/(N·m), a compliance that is usual for gears that creep."""
    likely: tuple[int, ...]
    """Numbers of the time constants that predict about as well, the best one first."""

    @property
    def creep(self) -> Creep | None:
        """What can be told of it; None if it is not clear."""
        if not self.clear:
            return None
        best, *likely = (k % len(_CONSTANTS) for k in self.likely)
        others = {float(_CONSTANTS[k]): float(self.compliances[k]) for k in likely if k != best}
        return Creep(self.compliance, float(_CONSTANTS[best]), tuple(others.items()))

    def out_of(self, ramps: Ramps) -> Ramps:
        """Return the ramps without what comes late, if that is clear."""
        return self._without(ramps, self.likely[0], self.compliance.value) if self.clear else ramps

    def part(self, ramps: Ramps, figure: Callable[[Ramps], float]) -> Component:
        """Return what not knowing the creep adds to the uncertainty of a figure of ramps.

        Args:
            ramps: with creep.
            figure: of ramps.
        """
        recorded, likely = figure(ramps), list(self.likely)
        # Figures change in proportion to the compliance.
        changes = [figure(self._without(ramps, k, self.usual)) - recorded for k in likely]
        slopes = np.array(changes) / self.usual
        found = slopes * self.compliances[likely]
        used = float(found[0]) if self.clear else 0.0
        unknown = slopes * self.standards[likely]
        by_constant = float(np.mean((found - used) ** 2 + unknown**2))
        return Component(math.hypot(math.sqrt(by_constant), _MISFIT * used))

    def _without(self, ramps: Ramps, number: int, compliance: float) -> Ramps:
        return ramps.changed(
            lambda half: replace(
                half, angle=half.angle - compliance * self.loads.late(half.times, number)
            )
        )


def creeping_of(
    ramps: Sequence[Ramps],
    friction: float,
    angle_step: float,
    pauses: Sequence[tuple[Array, Array]] = (),
) -> Creeping | None:
    """Estimate creep from where the gear stands still after reversals of the torque.

    Args:
        ramps: of the recording, with times.
        friction: N·m.
        angle_step: rad, between readings of the encoder; 0 if unknown.
        pauses: times, s, and angles, rad, in which the torque pauses. If they are enough, they
            tell creep better than the standstills after reversals.

    Returns:
        None if there are too few standstills to tell.
    """
    lines = Midlines.of(ramps[-1].whole)
    usual = _USUAL * float(np.mean(np.ptp(lines.angle, axis=1) / np.ptp(lines.load, axis=1)))
    loads = Loads(ramps[0].history, friction, _twist(lines))
    halves = (half for group in ramps for half in group.halves())
    reversals = (part for half in halves if (part := _after_reversal(half, friction)))
    parts = pauses if len(pauses) >= _LEAST_STILLS else reversals
    stills = [_still(*part, loads) for part in parts]
    if len(stills) < _LEAST_STILLS or not usual > 0.0:
        return None
    both, square, angle, change = (np.array([still[k] for still in stills]) for k in range(4))
    compliances = np.maximum(both.sum(0) / square.sum(0), 0.0)
    # Compliances by all standstills but one, and how these predict that one: (stills, constants).
    without = (both.sum(0) - both) / (square.sum(0) - square)
    missed = angle[:, None] - 2.0 * without * both + without**2 * square
    best = int(np.argmin(missed.sum(0)))
    gain, error = _mean(angle - missed[:, best])
    count = len(stills)
    # Steps hide the same in every loop, so that the largest changes count once, on either side.
    standards = np.hypot(
        math.sqrt(count - 1) * np.std(without, axis=0),
        resolution(angle_step) / np.sqrt(2.0 * change.max(0)),
    )
    compliance = Estimate(float(compliances[best]), float(standards[best]), count - 1, count)
    least = max(angle_step, _ROUNDING) / ramps[-1].amplitude
    clear = gain >= max(0.0, _STANDARD_ERRORS * error) and compliance.value > max(
        compliance.uncertainty or 0.0, least
    )
    if not clear:
        standards = unclear(compliances, standards, usual)
        compliances = np.zeros_like(compliances)
    worse = [_mean(column - missed[:, best]) for column in missed.T]
    likely = [
        k for k, (mean, error) in enumerate(worse) if mean <= _UNLIKELY * error and k != best
    ]
    return Creeping(clear, loads, compliance, compliances, standards, usual, (best, *likely))


def _mean(values: Array) -> tuple[float, float]:
    """Return the mean and its standard error."""
    return float(np.mean(values)), float(np.std(values, ddof=1)) / math.sqrt(len(values))


def _after_reversal(half: HalfLoop, friction: float) -> tuple[Array, Array] | None:
    """Return times and angles of the standstill with which a half loop begins."""
    back = np.abs(half.torque - half.start)
    rows = (back > max(4.0 * half.blur, _SETTLED * friction)) & (back < STANDSTILL * friction)
    return (half.times[rows], half.angle[rows]) if np.count_nonzero(rows) >= _ROWS else None


def _still(time: Array, angle: Array, loads: Loads) -> tuple[Array, Array, float, Array]:
    """Return sums over a standstill: late loads by angle, late loads squared, angle squared.

    The last are the late loads' changes during it, squared, each from its variance.
    """
    off = angle - np.mean(angle)
    late = np.array([loads.late(time, k) for k in loads.numbers])
    late -= np.mean(late, axis=1, keepdims=True)
    square = np.sum(late**2, axis=1)
    change = 12.0 * square / len(off)  # that of a straight line
    return late @ off, square, float(off @ off), change
