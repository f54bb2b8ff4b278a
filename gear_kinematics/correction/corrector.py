"""The calibrated deviation of the real from the ideal output angle, with its 95 % interval.

Along the ideal output angle x = φ2/i, the play p of a play operator of radius r follows x only
where it has to: p ← clip(p, x - r, x + r). The state of the stop operator is x - p (Prandtl and
Ishlinskii). An unknown play is the interval of all possible ones; both its ends follow the same
rule, and meet after a travel of 2 r in one direction.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

MAX_GAP = SECOND
"""ns between samples beyond which the plays are unknown again, as motion was missed."""
_SPEED_INTERVAL = SECOND // 10  # ns over which a missing velocity is averaged; begins at multiples
_FAR = 1024  # rotor turns from the reference; angles x stay small, and keep their precision
_CHUNK = 4096  # samples, so that the arrays of a chunk fit into the processor's cache


class Correction(NamedTuple):
    """What to add to the ideal output angle; floats, or arrays (n,)."""

    deviation: Any
    """rad."""
    slope: Any
    """Derivative of the deviation with respect to the ideal output angle."""
    half_width: Any
    """rad: the real output angle is within ± this of the corrected one with 95 %."""
    unknown_history: Any
    """rad: the part of `half_width` that another history before the first sample would change; as
    much of the deviation would change."""


class Corrector:
    """Computes the correction sample by sample, or for many at once with the same result.

    The half width is that of the file, or its `outside_half_width` where speed, torque or output
    angle are outside of what was calibrated. It grows by what the unknown can contribute: plays
    before a long enough travel, orders of the output while the rotor's turns are unknown, and
    wind-up without an effort.
    """

    def __init__(self, calibration: Calibration) -> None:
        self._calibration = calibration
        self._ratio = float(calibration.gear_ratio)
        self._per_rotor = float(1 / calibration.gear_ratio)
        self._period = calibration.period
        self._period_angle = self._period * TURN * abs(self._per_rotor)
        self._orders = [
            _Order(
                order.cycles.numerator % order.cycles.denominator,
                order.cycles.denominator,
                float(order.cycles),
                order.cos,
                order.sin,
            )
            for order in calibration.orders
        ]
        self._within_turn = [order for order in self._orders if order.denominator == 1]
        self._beyond_turn = sum(
            math.hypot(order.cos, order.sin) for order in self._orders if order.denominator > 1
        )
        self._stops = [(stop.radius, stop.coefficient) for stop in calibration.hysteresis]
        wind_up, span = calibration.compliance, calibration.spans.torque
        self._compliance, self._compliance_torque = (
            (0.0, 0.0) if wind_up is None else (wind_up.coefficient, wind_up.torque)
        )
        self._unknown_wind_up = (
            0.0 if span is None else 0.5 * abs(self._compliance) * (span[1] - span[0])
        )
        self._segment = 0
        self._stamp = 0
        self.reset()

    def reset(self) -> None:
        """Forget the motion so far, as after homing: the plays are unknown."""
        # The least and the greatest possible play of each operator, from the reference.
        self._least = len(self._stops) * [-math.inf]
        self._most = len(self._stops) * [math.inf]
        self._known = False  # whether these are the same
        self._reference: int | None = None  # rotor turns
        self._mean_speed = _MeanSpeed()

    def correct(
        self, sample: RotorSample, *, segment: int = 0, referenced: bool = True
    ) -> Correction:
        """Compute the correction at the next sample.

        Args:
            sample: of the rotor.
            segment: as in `RotorSamples`; the plays are unknown after it has changed.
            referenced: whether the rotor's turns are known.
        """
        stamp, (turns, angle), velocity, effort = sample
        if segment != self._segment or not 0 <= stamp - self._stamp <= MAX_GAP:
            self.reset()
        self._segment, self._stamp = segment, stamp
        file = self._calibration
        deviation, slope, unknown, history = file.constant, 0.0, 0.0, 0.0

        turn = turns % self._period
        if not referenced:
            unknown = self._beyond_turn
        for part, denominator, cycles, cos, sin in (
            self._orders if referenced else self._within_turn
        ):
            phase = TURN * (part * turn % denominator / denominator) + cycles * angle
            cosine, sine = math.cos(phase), math.sin(phase)
            deviation += cos * cosine + sin * sine
            slope += self._ratio * cycles * (sin * cosine - cos * sine)

        self._count_from(turns)
        x = self._output_angle(turns, angle)
        lag, rate = self._drag(self._least, x)
        if not self._known:
            other, other_rate = self._drag(self._most, x)
            lag, rate = 0.5 * (lag + other), 0.5 * (rate + other_rate)
            ends = zip(self._stops, self._least, self._most, strict=True)
            history = sum(0.5 * abs(stop[1]) * (most - least) for stop, least, most in ends)
            unknown += history
            self._known = self._least == self._most
        deviation += lag
        slope += rate

        torque = None if effort is None else self._ratio * effort
        if torque is None:
            unknown += self._unknown_wind_up
        else:
            deviation += self._wind_up(torque)
        if velocity is None:
            velocity = self._mean_speed.update(stamp, turns, angle)
            if math.isnan(velocity):
                history += file.outside_half_width - file.half_width
        spans = file.spans
        speed = velocity * self._per_rotor
        inside = spans.speed is None or spans.speed[0] <= speed <= spans.speed[1]
        if torque is not None and spans.torque is not None:
            inside = inside and spans.torque[0] <= torque <= spans.torque[1]
        if referenced and self._period > 1:
            inside = inside and self._beyond_span(turn, angle) <= spans.angle[1] - spans.angle[0]
        half_width = file.half_width if inside else file.outside_half_width
        return Correction(deviation, slope, half_width + unknown, history)

    def correct_batch(
        self,
        stamp: Array,
        turns: Array,
        angle: Array,
        velocity: Array,
        effort: Array,
        segment: Array,
        *,
        referenced: bool = True,
    ) -> Correction:
        """Compute the correction at the next samples, all arrays (n,) as in `RotorSamples`.

        Args:
            stamp: ns.
            turns: of the rotor.
            angle: rad.
            velocity: rad/s; NaN where there is none.
            effort: N·m; NaN where there is none.
            segment: the plays are unknown after it has changed.
            referenced: whether the rotor's turns are known.
        """
        count, file = len(stamp), self._calibration
        deviation, slope = np.full(count, file.constant), np.zeros(count)
        unknown = np.full(count, 0.0 if referenced else self._beyond_turn)

        turn = np.mod(turns, self._period)
        for part, denominator, cycles, cos, sin in (
            self._orders if referenced else self._within_turn
        ):
            phase = TURN * (np.mod(part * turn, denominator) / denominator) + cycles * angle
            cosine, sine = np.cos(phase), np.sin(phase)
            deviation += cos * cosine + sin * sine
            slope += self._ratio * cycles * (sin * cosine - cos * sine)

        velocity, history = velocity.copy(), np.zeros(count)
        coefficients = np.array([coefficient for _, coefficient in self._stops])
        for rows in self._segments(stamp, turns, segment):
            x = self._output_angle(turns[rows], angle[rows])
            least, most, still = self._drag_all(x)
            deviation[rows] += (x[:, np.newaxis] - 0.5 * (least + most)) @ coefficients
            slope[rows] += still @ coefficients
            history[rows] = 0.5 * (most - least) @ np.abs(coefficients)
            for row in rows.start + np.flatnonzero(np.isnan(velocity[rows])):
                velocity[row] = self._mean_speed.update(
                    int(stamp[row]), int(turns[row]), float(angle[row])
                )

        unknown += history
        history[np.isnan(velocity)] += file.outside_half_width - file.half_width

        torque = self._ratio * effort
        no_torque = np.isnan(torque)
        deviation += np.where(no_torque, 0.0, self._wind_up(torque))
        unknown += np.where(no_torque, self._unknown_wind_up, 0.0)
        speed = velocity * self._per_rotor
        inside = np.ones(count, bool)
        if file.spans.speed is not None:
            inside &= (file.spans.speed[0] <= speed) & (speed <= file.spans.speed[1])
        if file.spans.torque is not None:
            covered = (file.spans.torque[0] <= torque) & (torque <= file.spans.torque[1])
            inside &= no_torque | covered
        if referenced and self._period > 1:
            length = file.spans.angle[1] - file.spans.angle[0]
            inside &= self._beyond_span(turn, angle) <= length
        half_width = np.where(inside, file.half_width, file.outside_half_width)
        return Correction(deviation, slope, half_width + unknown, history)

    def _wind_up(self, torque: Any) -> Any:
        return self._compliance * (torque - self._compliance_torque)

    def _beyond_span(self, turn: Any, angle: Any) -> Any:
        """How far the output is beyond the begin of its calibrated span, within a period."""
        x = (TURN * turn + angle) * self._per_rotor
        return (x - self._calibration.spans.angle[0]) % self._period_angle

    def _count_from(self, turns: int) -> None:
        """Count the output angle from near here, so that it does not lose precision."""
        if self._reference is None:
            self._reference = turns
        elif abs(turns - self._reference) > _FAR:
            shift = (turns - self._reference) * TURN * self._per_rotor
            for plays in (self._least, self._most):
                plays[:] = [play - shift for play in plays]
            self._reference = turns

    def _output_angle(self, turns: Any, angle: Any) -> Any:
        """The ideal output angle x from the reference."""
        return ((turns - self._reference) * TURN + angle) * self._per_rotor

    def _drag(self, plays: list[float], x: float) -> tuple[float, float]:
        """Move plays; returns their part of the deviation, and its slope."""
        deviation = slope = 0.0
        for k, (radius, coefficient) in enumerate(self._stops):
            play = plays[k]
            if play < x - radius:
                plays[k] = play = x - radius
            elif play > x + radius:
                plays[k] = play = x + radius
            else:
                slope += coefficient
            deviation += coefficient * (x - play)
        return deviation, slope

    def _drag_all(self, x: Array) -> tuple[Array, Array, Array]:
        """Move plays along x (n,): their least and greatest values, and how many stand still.

        All are (n, stops); what stands still is 0, 0.5 or 1.
        """
        radii = np.array([radius for radius, _ in self._stops])
        before = np.array([self._least, self._most])[:, np.newaxis]
        ends = play_bounds(x, radii, *before[:, 0])
        self._least, self._most = (end[-1].tolist() for end in ends)
        self._known = self._least == self._most
        still = np.diff(np.concatenate([before, ends], axis=1), axis=1) == 0.0
        return *ends, 0.5 * still.sum(axis=0)

    def _segments(self, stamp: Array, turns: Array, segment: Array) -> Iterator[slice]:
        """Yield parts of a motion after having reset and counted as `correct` does."""
        gap = np.diff(stamp, prepend=self._stamp)
        anew = np.diff(segment, prepend=self._segment) != 0
        anew |= (gap < 0) | (gap > MAX_GAP)
        start = 0
        while start < len(stamp):
            if anew[start]:
                self.reset()
            self._count_from(int(turns[start]))
            inner = slice(start + 1, start + _CHUNK)
            ends = anew[inner] | (np.abs(turns[inner] - self._reference) > _FAR)
            stop = start + 1 + (int(np.argmax(ends)) if ends.any() else len(ends))
            yield slice(start, stop)
            self._stamp, self._segment = int(stamp[stop - 1]), int(segment[stop - 1])
            start = stop


class _Order(NamedTuple):
    """An order of the deviation; over whole turns its cycles add up to numerator/denominator."""

    numerator: int
    denominator: int
    cycles: float
    cos: float
    sin: float


class _MeanSpeed:
    """The rotor's speed where messages have no velocity, from its travel.

    Intervals begin at multiples of their length, so that the speed does not depend on the first
    sample once it is known.
    """

    def __init__(self) -> None:
        self._interval: int | None = None
        self._begin: tuple[int, int, float] | None = None
        self._speed = math.nan

    def update(self, stamp: int, turns: int, angle: float) -> float:
        """Add a position at a stamp, ns; returns rad/s, NaN as long as it is unknown."""
        interval, before = stamp // _SPEED_INTERVAL, self._interval
        self._interval = interval
        if before is not None and interval != before:
            if self._begin is not None:
                begin, begin_turns, begin_angle = self._begin
                travel = (turns - begin_turns) * TURN + angle - begin_angle
                self._speed = travel / ((stamp - begin) / SECOND)
            self._begin = stamp, turns, angle
        return self._speed


def play_bounds(x: Array, radii: Array, least: Array, most: Array) -> tuple[Array, Array]:
    """Follow play operators along x.

    Clipping to one interval and then to another is clipping to one interval again, so that all
    steps are composed in log2 n passes, without rounding.

    Args:
        x: (n,), rad.
        radii: (stops,), rad.
        least: (stops,): the least possible plays before; -inf where nothing is known.
        most: (stops,): the greatest possible plays before; inf where nothing is known.

    Returns:
        The least and the greatest possible plays at each x, (n, stops).
    """
    low, high = x[:, np.newaxis] - radii, x[:, np.newaxis] + radii
    step = 1
    while step < len(x):
        bounds = low[step:].copy(), high[step:].copy()
        low[step:], high[step:] = np.clip(low[:-step], *bounds), np.clip(high[:-step], *bounds)
        step *= 2
    return np.clip(least, low, high), np.clip(most, low, high)
