"""Creep: an angle that follows the load late, seen where the gear stands still.

A gear with friction stands still after each reversal of the torque, whatever its spring is. If its
angle goes on while the load stays, it creeps.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.pause import STANDSTILL
from gear_kinematics.lost_motion.static.ramps import Array, HalfLoop, Ramps
from gear_kinematics.state.uncertainty import Component, Estimate, expected_effect, resolution

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
_TINY = 1e-300
"""rad², so that equal predictions can be divided by their standard error."""
_STANDARD_ERRORS = 2.0
"""Creep has to predict better than none by this many standard errors."""
_SHARED = 1.2
"""Factor by which errors of predictions exceed those of independent ones, as all standstills have
the same shape, and steps of the encoder at the same angles."""
_UNKNOWN = 1e3
"""Standard uncertainty of a compliance that nothing shows, relative to a usual one."""
_NEGLIGIBLE = 1e-3
"""Least weight of a time constant, relative to the greatest one."""
_TOLD = math.exp(-2.0)
"""Relative weight of a time constant within two standard uncertainties of the likeliest one."""
_MISFIT = 0.1
"""Share of a correction for creep that counts as standard uncertainty, as no material has just one
time constant."""
_USUAL = 0.1
"""Share of the twist that comes late in gears that creep, as a scale."""
_CONSTANTS = np.geomspace(1.0, 50.0, 18)
"""s, time constants that are tried, of creep after the load and of creep after the twist."""


@dataclass(frozen=True, eq=False, slots=True)
class Creep:
    """An angle that follows the load late, by one time constant."""

    compliance: Estimate
    """rad/(N·m), of the part that comes late."""
    constant: float
    """s."""
    others: tuple[tuple[float, float], ...]
    """Other time constants, s, that are about as likely, with their compliances, rad/(N·m)."""


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

    def late(self, factors: Array) -> Callable[[Array], Array]:
        """Return what comes late, by the time in s: a sum of loads, N·m.

        Args:
            factors: (constants,), of what comes late by each time constant, first after the
                load, then after the twist.
        """
        loads = self._late @ factors
        return lambda time: np.interp(time, self._time, loads)


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

    loads: Loads
    compliance: Estimate | None
    """rad/(N·m), with the likeliest time constant; None if the gear may not creep."""
    compliances: Array
    """(constants,), rad/(N·m), as expected with each time constant."""
    standards: Array
    """(constants,), rad/(N·m), their standard uncertainties."""
    usual: float
    """rad/(N·m), a compliance that is usual for gears that creep."""
    weights: Array
    """(constants,), how likely each time constant is; their sum is 1."""

    @property
    def creep(self) -> Creep | None:
        """What can be told of it; None if the gear may not creep."""
        if not self.compliance:
            return None
        best = int(np.argmax(self.weights)) % len(_CONSTANTS)
        told = np.flatnonzero(self.weights > _TOLD * np.max(self.weights))
        likely = (int(k) % len(_CONSTANTS) for k in told)
        others = {float(_CONSTANTS[k]): float(self.compliances[k]) for k in likely if k != best}
        return Creep(self.compliance, float(_CONSTANTS[best]), tuple(others.items()))

    def out_of(self, ramps: Ramps) -> Ramps:
        """Return the ramps without what is expected to come late."""
        return self._without(ramps, self.weights * self.compliances)

    def part(self, ramps: Ramps, figure: Callable[[Ramps], float]) -> Component:
        """Return what not knowing the creep adds to the uncertainty of a figure of ramps.

        Args:
            ramps: with creep.
            figure: of ramps.
        """
        recorded, likely = figure(ramps), np.flatnonzero(self.weights)
        # Figures change in proportion to the compliance.
        usual = self.usual * np.eye(len(self.weights))[likely]
        changes = [figure(self._without(ramps, factors)) - recorded for factors in usual]
        slopes, weights = np.array(changes) / self.usual, self.weights[likely]
        found, unknown = slopes * self.compliances[likely], slopes * self.standards[likely]
        expected = float(weights @ found)
        by_constant = float(weights @ ((found - expected) ** 2 + unknown**2))
        return Component(math.hypot(math.sqrt(by_constant), _MISFIT * expected))

    def _without(self, ramps: Ramps, compliances: Array) -> Ramps:
        late = self.loads.late(compliances)
        return ramps.changed(lambda half: replace(half, angle=half.angle - late(half.times)))


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
        None if the gear does not yield to the torque.
    """
    lines = Midlines.of(ramps[-1].whole)
    usual = _USUAL * float(np.mean(np.ptp(lines.angle, axis=1) / np.ptp(lines.load, axis=1)))
    if not usual > 0.0:
        return None
    loads = Loads(ramps[0].history, friction, _twist(lines))
    halves = (half for group in ramps for half in group.halves())
    reversals = (part for half in halves if (part := _after_reversal(half, friction)))
    parts = pauses if len(pauses) >= _LEAST_STILLS else reversals
    lates = [loads.late(factors) for factors in np.eye(2 * len(_CONSTANTS))]
    stills = [_still(*part, lates) for part in parts]
    if len(stills) >= _LEAST_STILLS:
        least = max(angle_step, _ROUNDING) / ramps[-1].amplitude
        seen = _seen(stills, angle_step, usual, least)
    else:
        seen = _unseen(usual)
    expected = expected_effect(seen.compliances, seen.standards, usual)
    return Creeping(loads, seen.compliance, *expected, usual, seen.weights)


class _Seen(NamedTuple):
    """What standstills show, rad/(N·m) with each time constant, (constants,)."""

    compliance: Estimate | None
    """With the likeliest one; None if the gear may not creep."""
    compliances: Array
    standards: Array
    """Standard uncertainties."""
    weights: Array
    """How likely each time constant is; their sum is 1."""


def _unseen(usual: float) -> _Seen:
    """Return what no standstill shows: nothing, and nothing of any time constant."""
    count = 2 * len(_CONSTANTS)
    unknown, alike = np.full(count, _UNKNOWN * usual), np.full(count, 1.0 / count)
    return _Seen(None, np.zeros(count), unknown, alike)


def _seen(
    stills: Sequence[tuple[Array, Array, float, Array]],
    angle_step: float,
    usual: float,
    least: float,
) -> _Seen:
    """Estimate creep from standstills.

    Args:
        stills: as `_still` returns them.
        angle_step: rad, between readings of the encoder; 0 if unknown.
        usual: rad/(N·m), a compliance that is usual for gears that creep.
        least: rad/(N·m), that can be told.
    """
    both, square, angle, change = (np.array([still[k] for still in stills]) for k in range(4))
    compliances = np.maximum(both.sum(0) / square.sum(0), 0.0)
    # Compliances by all standstills but one, and how these predict that one: (stills, constants).
    without = (both.sum(0) - both) / (square.sum(0) - square)
    missed = angle[:, None] - 2.0 * without * both + without**2 * square
    count = len(stills)
    # Steps hide the same in every loop, so that the largest changes count once, on either side.
    standards = np.hypot(
        math.sqrt(count - 1) * np.std(without, axis=0),
        resolution(angle_step) / np.sqrt(2.0 * change.max(0)),
    )
    worse = missed - missed[:, [np.argmin(missed.sum(0))]]
    errors = _SHARED * np.std(worse, axis=0, ddof=1) / math.sqrt(count)
    unlikely = (np.mean(worse, axis=0) / np.maximum(errors, _TINY)) ** 2
    # By more creep than gears usually have.
    unlikely += compliances**2 / (usual**2 + standards**2)
    weights = np.exp(-0.5 * (unlikely - np.min(unlikely)))
    weights[weights < _NEGLIGIBLE] = 0.0
    best = int(np.argmax(weights))
    gain, error = _mean(angle - missed[:, best])
    compliance = Estimate(float(compliances[best]), float(standards[best]), count - 1, count)
    clear = gain >= max(0.0, _STANDARD_ERRORS * error) and compliance.value > max(
        compliance.uncertainty or 0.0, least
    )
    return _Seen(compliance if clear else None, compliances, standards, weights / np.sum(weights))


def _mean(values: Array) -> tuple[float, float]:
    """Return the mean and its standard error."""
    return float(np.mean(values)), float(np.std(values, ddof=1)) / math.sqrt(len(values))


def _after_reversal(half: HalfLoop, friction: float) -> tuple[Array, Array] | None:
    """Return times and angles of the standstill with which a half loop begins."""
    back = np.abs(half.torque - half.start)
    rows = (back > max(4.0 * half.blur, _SETTLED * friction)) & (back < STANDSTILL * friction)
    return (half.times[rows], half.angle[rows]) if np.count_nonzero(rows) >= _ROWS else None


def _still(
    time: Array, angle: Array, lates: Sequence[Callable[[Array], Array]]
) -> tuple[Array, Array, float, Array]:
    """Return sums over a standstill: late loads by angle, late loads squared, angle squared.

    The last are the late loads' changes during it, squared, each from its variance.
    """
    off = angle - np.mean(angle)
    late = np.array([loads(time) for loads in lates])
    late -= np.mean(late, axis=1, keepdims=True)
    square = np.sum(late**2, axis=1)
    change = 12.0 * square / len(off)  # that of a straight line
    return late @ off, square, float(off @ off), change
