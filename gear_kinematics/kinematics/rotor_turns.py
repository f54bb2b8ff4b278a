# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The rotor's position as whole turns and an angle within the turn, which never loses precision.

A float64 angle of 10^10 turns has a spacing of 7.6e-6 rad. An integer turn count with an angle
within [-π, π] keeps full precision however long the motor runs, and suffices for the kinematics:
the positions of the bodies are periodic in the turns of the rotor.
"""

import math
from fractions import Fraction
from types import ModuleType
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

TURN = 2.0 * math.pi
TURN_TAIL = 2.4492935982947064e-16  #: 2π - TURN: the rounding error of TURN
EXACT_TURN = Fraction(TURN) + Fraction(TURN_TAIL)  #: 2π to 32 digits
LARGEST_ANGLE = 2**51 * TURN
"""Angle, rad. Up to it, 2^51 turns, `split_turns` finds the right turn: the two roundings of its
quotient add up to at most 3/8 of a turn, less than the half that rounding to the nearest allows.
The spacing of float64 is at most 2 rad here; from 2^54 rad = 1.8e16 rad on it is 4 rad, more than
half a turn, so that an angle within the turn has no meaning."""
_MANY_TURNS = 2**25 * TURN  # rad; fewer turns times _TURN_HIGH or _TURN_LOW fit into 53 bits
_TURN_HIGH = math.floor(TURN * 2.0**24) / 2.0**24
_TURN_LOW = TURN - _TURN_HIGH
_WHOLE = 1e-6  # relative difference of a period from the whole turns that are meant
_USUAL, _MOST_GAPS = 20, 40  # surplus of gaps that were too long: least for usual; greatest
_NOISE = 0.05  # rad, greatest noise of any encoder
_Speed = float | None  # rad/s; None if unknown
BELOW_HALF = math.nextafter(math.pi, 0.0)  #: rad; any smaller angle is 0 turns, however rounded


class RotorPosition(NamedTuple):
    """A rotor angle of 2π `turns` + `angle`."""

    turns: int
    angle: float
    """Angle within the turn, rad."""

    def since(self, before: 'RotorPosition') -> float:
        """Travel from another position, rad."""
        return TURN * (self.turns - before.turns) + (self.angle - before.angle)


_new = tuple.__new__  # for what each message takes: faster than RotorPosition(...)


class RotorSample(NamedTuple):
    """A state of the rotor: its angle φ2, its rate and torque at a time."""

    stamp: int
    """Time, ns."""
    position: RotorPosition
    velocity: float | None
    """Rate, rad/s; None if it is not known."""
    effort: float | None
    """Torque, N·m; None if it is not known."""


def lists_as_arrays(value: Any) -> Any:
    """Convert a list or tuple to an array; return anything else as it is."""
    return np.asarray(value, np.float64) if isinstance(value, (list, tuple)) else value


@overload
def split_turns(angle: float) -> RotorPosition: ...
@overload
def split_turns(angle: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def split_turns(angle: Any) -> Any:
    """Split an angle into the nearest whole turns and the rest in [-π, π], both exact.

    Exact with respect to 2π itself, not to its float64; the rest is rounded once. Near half a turn
    it can exceed π by the rounding error of TURN times the number of turns.

    Args:
        angle: rad, up to ±`LARGEST_ANGLE`; a float, or a list or array of any shape.

    Returns:
        Turns (an int; for arrays whole numbers as float64) and the rest in rad. In arrays both
        are NaN where an angle is not finite or too large.

    Raises:
        ValueError: if a float angle is not finite or too large.
    """
    if isinstance(angle, float) and -_MANY_TURNS < angle < _MANY_TURNS:
        return _new(RotorPosition, _split_few(angle))
    angle = lists_as_arrays(angle)
    xp = np if isinstance(angle, np.ndarray) else math
    size = abs(angle) if xp is math else largest(angle)
    if not size <= LARGEST_ANGLE:  # NaN compares false
        if xp is math:
            raise ValueError(f'an angle is at most {LARGEST_ANGLE:g} rad, not {angle:g}')
        angle = np.where(np.abs(angle) <= LARGEST_ANGLE, angle, np.nan)
    # Every step is exact. fmod by TURN alone would do, but is slow for angles beyond a turn.
    rest, few = angle, size < _MANY_TURNS
    if not few:  # else fmod changes nothing
        rest = xp.fmod(angle, _MANY_TURNS)
        many = xp.floor((angle - rest) / TURN + 0.5)
    turns = xp.floor(rest / TURN + 0.5)  # off by one at most, by rounding
    turns, rest = nearest_turn(turns, rest - turns * _TURN_HIGH - turns * _TURN_LOW, xp)
    if not few:
        turns = many + turns
    return _new(RotorPosition, (turns, rest - turns * TURN_TAIL))


def _split_few(angle: float) -> tuple[int, float]:
    """Split an angle of less than `_MANY_TURNS` as `split_turns` does, faster."""
    turns = math.floor(angle / TURN + 0.5)
    rest = angle - turns * _TURN_HIGH - turns * _TURN_LOW
    if not -BELOW_HALF < rest < BELOW_HALF:
        turns, rest = nearest_turn(turns, rest, math)
    return turns, rest - turns * TURN_TAIL


def nearest_turn(turns: Any, rest: Any, xp: ModuleType) -> tuple[Any, Any]:
    """Correct turns that a rounded quotient gave, where their rest, rad, is beyond half a turn.

    `xp` is `math` for floats, else numpy. Most arrays need no correction, which is quickly seen.
    """
    if (abs(rest) if xp is math else largest(rest)) < BELOW_HALF:
        return turns, rest
    more = xp.floor(rest / TURN + 0.5)
    return turns + more, rest - TURN * more


def largest(values: NDArray[np.float64]) -> np.float64:
    """Return the largest magnitude in an array; NaN if it contains one, 0 if it is empty."""
    magnitude: np.float64 = max(values.max(initial=0.0), -values.min(initial=0.0))
    return magnitude


def repeated(count: int, period: float) -> RotorPosition:
    """Multiply a period, rad, by a count, exactly except for one rounding of the angle.

    A period that differs from whole turns only by its last digits stands for these turns.
    """
    turns = round(period / TURN)
    if abs(period - turns * TURN) <= _WHOLE * period:
        return RotorPosition(count * turns, 0.0)
    product = count * Fraction(period)
    turns = round(product / EXACT_TURN)
    return RotorPosition(turns, float(product - turns * EXACT_TURN))


class RotorTurns:
    """Follows the rotor's encoder and counts its whole turns.

    The position of a multi-turn encoder is used unchanged. One that repeats after a period, such
    as a turn, is unwrapped here; `referenced` is whether the number of periods is known. It is
    unknown at the start, and after a gap in which the rotor could have turned half a period or
    more either way from its expected angle; `home` makes it known. While it is unknown, counting
    goes on from the nearest period.
    """

    def __init__(self, *, period: float, max_speed: float, max_acceleration: float) -> None:
        """Start with no position.

        Args:
            period: rad after which the encoder's position repeats, TURN for once a turn; 0: never.
            max_speed: rad/s, the greatest speed of the rotor.
            max_acceleration: rad/s², the greatest acceleration of the rotor.
        """
        self.period = period
        self.max_speed = max_speed
        self.max_acceleration = max_acceleration
        self.longest_silence = 0.0
        """Time without a sample, ns, after which a multi-turn encoder may have restarted, so that
        its turns are unknown at the start, too; 0: it never does."""
        self.lost = False  # whether they are unknown until the next reference, because of a jump
        self.unknown_gaps = 0  # in which the rotor could have turned half a period or more unseen
        self.reset()

    @property
    def usual_gap(self) -> tuple[float, float, float, float]:
        """Period, limits, and the usual time between samples if too long for them, else 0."""
        gap = self._gap if self._gaps >= _USUAL else 0.0
        return self.period, self.max_speed, self.max_acceleration, gap

    @property
    def position(self) -> RotorPosition | None:
        """The position at the last update; None before the first one."""
        return self._position and RotorPosition(*self._position)

    def reset(self) -> None:
        """Forget the position and the turns; the next update counts as the first."""
        self._position: tuple[int, float] | None = None
        self.forget_turns()
        self.longest_gap: float | None = None  # s, that made the turns unknown; None: nothing did
        self._gaps, self._gap = 0, 0.0  # surplus of those too long for the speed; their mean, s
        self.periods = 0  #: number of periods that are added to the readings
        self._offset = 0, 0, 0.0  # periods, and their sum as turns and angle, rad
        self._reading, self._stamp, self._changed = math.nan, 0, 0
        self._latest = 0  # ns, the last stamp of all, also of readings that are repeated
        self.narrowed = 0  # ns, the stamp after the last gap whose turn depends on velocities
        self._velocity: float | None = None
        self._since_gap: tuple[_Speed, float, float, float] | None = None
        """Velocity before a gap that velocities narrowed, rad/s; turn, rad, and time since, s;
        gap. Behind a late message, others come in a burst, and turn too far in all."""

    def forget_turns(self) -> None:
        """Make the turns as unknown as at the start; counting goes on."""
        self.referenced = not (self.period or self.longest_silence or self.lost)
        self.unseen_travel = math.inf  # rad, greatest error of the count

    def lose(self) -> None:
        """Treat the turns as unknown until the next reference, because the encoder has jumped."""
        self.lost = True
        self.forget_turns()

    def lose_unseen(self) -> None:
        """Treat known turns as lost, because their readings or velocities are in doubt."""
        if self.referenced:
            self.unknown_gaps += 1
            self.lose()

    def set_back(self, time: int) -> None:
        """Note that the clock of the stamps was set back by a time, ns, since the last sample."""
        self._stamp, self._changed = self._stamp - time, self._changed - time
        self._latest -= time

    def update(
        self,
        position: float,
        stamp: int,
        velocity: float | None = None,
        lasts: float = 0.0,
        likely: tuple[int, float] = (0, 0.0),
    ) -> None:
        """Process the encoder's next sample.

        Args:
            position: rad, up to ±`LARGEST_ANGLE`; if it repeats, in any range.
            stamp: ns, not earlier than the last.
            velocity: rad/s, or None if unknown.
            lasts: ns, for which the driver repeats each reading; 0: it does not.
            likely: a stamp, ns, and the likeliest turn up to it by the motion so far, rad.
        """
        self._latest = stamp
        if lasts and position == self._reading and stamp < self._stamp + lasts:
            return
        period = self.period
        few = -_MANY_TURNS < position < _MANY_TURNS
        split: tuple[int, float] = _split_few(position) if few else split_turns(position)
        if period and self._position is not None:
            elapsed, longer = (stamp - self._stamp) * 1e-9, (stamp - self._changed) * 1e-9
            hides = 2.0 * self.max_speed * longer >= period  # whether the repeated reading does
            within = elapsed if hides else longer
            expected, width = self._possible_turn(within, self._velocity, velocity)
            apparent, since = position - self._reading, self._since_gap
            more = round((expected - apparent) / period)
            # It is outside by stamps that are early or late, if any other is far less possible.
            turn, gap, wide = apparent + period * more, elapsed, width >= period
            if wide:
                self._gap += (elapsed - self._gap) / (self._gaps + 1)
            self._gaps = min(self._gaps + 1, _MOST_GAPS) if wide else max(self._gaps - 1, 0)
            if 2.0 * self.max_speed * elapsed >= period:
                since, self.narrowed = (self._velocity, 0.0, 0.0, elapsed), stamp
            if since:
                before, turned, time = since[0], since[1] + turn, since[2] + elapsed
                middle, between = self._possible_turn(time, before, velocity)
                since = (before, turned, time, since[3]) if between < period else None
                if since:
                    turn, expected, width, gap = turned, middle, between, since[3]
            outside = abs(turn - expected) - 0.5 * width
            # By the motion it was another turn: this reading or the last one is wrong.
            other = not since and stamp == likely[0] and abs(turn - likely[1]) > 0.5 * period
            if wide or other or outside > _NOISE + (period - width - outside) / 5.0:
                self.referenced, since = False, None
                self.unknown_gaps += 1
                self.longest_gap = max(self.longest_gap or 0.0, gap)
                self.unseen_travel += self.max_speed * gap + 0.5 * period
            self._since_gap = since
            self.periods += more
            if self.periods != self._offset[0]:
                self._offset = (self.periods, *repeated(self.periods, period))
            _, turns, angle = self._offset
            split = split[0] + turns, split[1]
            if angle:
                split = nearest_turn(split[0], split[1] + angle, math)
        elif self._position and 0.0 < self.longest_silence < stamp - self._stamp:
            self.referenced = False
            self.unknown_gaps += 1
        self._position = split
        if position != self._reading:
            self._changed = stamp
        self._reading, self._stamp, self._velocity = position, stamp, velocity

    def _possible_turn(self, elapsed: float, before: _Speed, after: _Speed) -> tuple[float, float]:
        """The middle and the width of the possible turns of the rotor in a gap, rad.

        Within `elapsed` the rotor reaches at most ±max_speed·elapsed. Where that is ambiguous,
        the speeds v0 and v1 at both ends narrow it: with accelerations of at most A, the turn is
        (v0 + v1)/2·elapsed ± (A·elapsed²/4 - (v1 - v0)²/(4 A)).
        """
        reach = self.max_speed * elapsed
        low, high = -reach, reach
        if 2.0 * reach >= self.period and before is not None and after is not None:
            change = after - before
            middle = 0.5 * (after + before) * elapsed
            # No **, which raises on overflow.
            spread = self.max_acceleration * elapsed * elapsed / 4.0
            spread -= change * change / (4.0 * self.max_acceleration)
            if spread >= 0.0 and abs(middle) <= reach:  # else the limits or the speeds are wrong
                low, high = max(low, middle - spread), min(high, middle + spread)
        return 0.5 * (low + high), high - low

    def relative_to(self, zero: RotorPosition, direction: int) -> RotorPosition:
        """Return the rotor angle φ2 = direction·(position - zero), without cancellation.

        Raises:
            RuntimeError: before the first update.
        """
        turns, angle = self._position or self._known_position()
        zero_turns, zero_angle = zero
        relative = direction * (turns - zero_turns), direction * (angle - zero_angle)
        return _new(RotorPosition, relative)

    def home(self, rotor_angle: float, direction: int) -> float:
        """Declare that the rotor angle φ2 is `rotor_angle` now; the turns are known from now on.

        The zero, rad, with which `relative_to` gives that angle at the present position is
        returned. RuntimeError is raised before the first update.
        """
        zero = self.zero_for(rotor_angle, direction)
        # Drop the periods counted so far.
        self.periods, self._offset = 0, (0, 0, 0.0)
        self._position = split_turns(self._reading)
        self.refer()
        return zero

    def refer(self) -> None:
        """Treat the counted turns as known from now on."""
        self.referenced, self.unseen_travel, self.lost = True, 0.0, False
        self.longest_gap, self.narrowed, self._stamp = None, 0, self._latest

    def zero_for(self, rotor_angle: float, direction: int) -> float:
        """Return the zero that `home` would give, and change nothing.

        Raises:
            RuntimeError: before the first update.
        """
        self._known_position()
        return self._reading - direction * rotor_angle

    def _known_position(self) -> tuple[int, float]:
        if self._position is None:
            raise RuntimeError('the rotor has no position before the first update')
        return self._position
