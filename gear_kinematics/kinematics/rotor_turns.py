"""The rotor's position as whole turns and an angle within the turn, which never loses precision.

A float64 angle of 10^10 turns has a spacing of 7.6e-6 rad. An integer turn count beside an angle
within [-π, π] keeps its last bits however long the motor runs, and it is all the kinematics needs:
the positions of the bodies repeat with the turns of the rotor.
"""

import math
from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

TURN = 2.0 * math.pi
TURN_TAIL = 2.4492935982947064e-16  # 2π - TURN: what the float64 leaves out
LARGEST_ANGLE = 2**51 * TURN
"""rad. Up to here `split_turns` finds the turn: the two roundings of its quotient, of up to 2^51
turns, are at most 3/8 of a turn together, less than the half that rounding to the nearest allows.
And up to here a float64 tells where in the turn an angle is: its spacing is 2 rad, and from
2^54 rad = 1.8e16 rad on 4 rad, more than half a turn."""
MOST_TURNS = 2**52
"""With the turns of an angle up to `LARGEST_ANGLE` they make a whole number below 2^53, which a
float64 holds exactly."""
_MANY = 2**25  # turns: up to so many, their products with either part of TURN fit into 53 bits
_TURN_HIGH = math.floor(TURN * 2.0**24) / 2.0**24
_TURN_LOW = TURN - _TURN_HIGH


class RotorPosition(NamedTuple):
    """A rotor angle of 2π `turns` + `angle`."""

    turns: int
    angle: float
    """rad, within the turn."""


@overload
def split_turns(angle: float) -> RotorPosition: ...
@overload
def split_turns(angle: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def split_turns(angle: Any) -> Any:
    """Split an angle into the nearest whole turns and the rest in [-π, π], both exact.

    Exact means: of 2π itself, not of its float64; the rest is rounded once. Near half a turn it
    can exceed π by what the float64 of so many turns leaves out.

    Args:
        angle: rad, up to ±`LARGEST_ANGLE`; a float, or an array of any shape.

    Returns:
        Turns (an int; for arrays whole numbers as float64) and the rest in rad. In arrays both
        are NaN for any other angle.

    Raises:
        ValueError: if a float is any other angle.
    """
    xp: ModuleType
    if isinstance(angle, np.ndarray):
        xp = np
        inside = np.abs(angle) <= LARGEST_ANGLE  # NaN compares false
        if not inside.all():
            angle = np.where(inside, angle, np.nan)
    else:
        xp = math
        if not abs(angle) <= LARGEST_ANGLE:
            raise ValueError(f'an angle is at most {LARGEST_ANGLE:g} rad, not {angle:g}')
    # All is exact here. fmod alone would do, but is slow where it takes something off.
    rest = xp.fmod(angle, _MANY * TURN)
    whole = xp.floor(rest / TURN + 0.5)  # rounded: one turn more may have to be taken off
    rest = rest - whole * _TURN_HIGH - whole * _TURN_LOW
    rest = rest - TURN * xp.floor(rest / TURN + 0.5)
    turns = xp.floor((angle - rest) / TURN + 0.5)
    return RotorPosition(turns, rest - turns * TURN_TAIL)


def whole_turns(turns: ArrayLike) -> NDArray[np.float64]:
    """Take numbers of turns as float64.

    Raises:
        ValueError: if one is no integer up to ±`MOST_TURNS`.
    """
    array = np.asarray(turns, np.float64)
    # What is not finite leaves NaN, which counts as true.
    if np.fmod(array, 1.0).any() or np.abs(array).max(initial=0.0) > MOST_TURNS:
        given = np.array2string(array, threshold=4)
        raise ValueError(f'rotor_turns must be integers up to ±2^52, not {given}')
    return array


_split_zero = lru_cache(maxsize=1)(split_turns)  # the same for many samples


class RotorTurns:
    """Follows the rotor's encoder and counts its whole turns.

    A multi-turn encoder is taken at its word. The position of a single-turn encoder wraps once a
    turn and is unwrapped here; `referenced` then tells whether the number of turns is known: it
    is not at the start, nor after a gap in which the rotor could have turned half a turn or more
    either way from where it is expected, and it is known again after `home`. Meanwhile counting
    goes on from the nearest turn.
    """

    def __init__(self, *, single_turn: bool, max_speed: float, max_acceleration: float) -> None:
        """Start with no position.

        Args:
            single_turn: whether the encoder's position wraps once a turn.
            max_speed: rad/s, the fastest that the rotor can turn.
            max_acceleration: rad/s², the fastest that its speed can change.
        """
        self.single_turn = single_turn
        self.max_speed = max_speed
        self.max_acceleration = max_acceleration
        self.unknown_gaps = 0
        self.reset()

    def reset(self) -> None:
        """Forget the position and the turns: the next update is the first again."""
        self.position: RotorPosition | None = None
        self.referenced = not self.single_turn
        self._reading = 0.0
        self._stamp = 0
        self._velocity: float | None = None

    def update(self, position: float, stamp: int, velocity: float | None = None) -> None:
        """Take the encoder's next sample.

        Args:
            position: rad, up to ±`LARGEST_ANGLE`; of a single-turn encoder in any range.
            stamp: ns, not earlier than the last.
            velocity: rad/s, or None where it is not known.
        """
        split = split_turns(position)
        if self.single_turn and self.position is not None:
            expected, known = self._expected_turn((stamp - self._stamp) * 1e-9, velocity)
            self.referenced = self.referenced and known
            self.unknown_gaps += not known
            apparent = split.angle - self.position.angle
            turns = self.position.turns + round((expected - apparent) / TURN)
            split = RotorPosition(turns, split.angle)
        self.position = split
        self._reading, self._stamp, self._velocity = position, stamp, velocity

    def _expected_turn(self, elapsed: float, velocity: float | None) -> tuple[float, bool]:
        """Where within the gap's reachable angles the rotor is expected, and whether one fits.

        Within `elapsed` the rotor reaches at most ±max_speed·elapsed. Where that leaves a doubt,
        the speeds v0 and v1 at both ends narrow it: with accelerations of at most A, the angle is
        (v0 + v1)/2·elapsed ± (A·elapsed²/4 - (v1 - v0)²/(4 A)).
        """
        reach = self.max_speed * elapsed
        low, high = -reach, reach
        if reach >= math.pi and velocity is not None and self._velocity is not None:
            change = velocity - self._velocity
            middle = 0.5 * (velocity + self._velocity) * elapsed
            # Products, since a power that overflows raises.
            spread = self.max_acceleration * elapsed * elapsed / 4.0
            spread -= change * change / (4.0 * self.max_acceleration)
            if spread >= 0.0 and abs(middle) <= reach:  # else the limits or the speeds are wrong
                low, high = max(low, middle - spread), min(high, middle + spread)
        return 0.5 * (low + high), high - low < TURN

    def relative_to(self, zero: float, direction: int) -> RotorPosition:
        """Give the rotor angle φ2 = direction·(position - zero), with no loss to cancellation.

        Raises:
            RuntimeError: before the first update.
        """
        turns, angle = self._known_position()
        zero_turns, zero_angle = _split_zero(zero)
        return RotorPosition(direction * (turns - zero_turns), direction * (angle - zero_angle))

    def home(self, rotor_angle: float, direction: int) -> float:
        """Declare that the rotor angle φ2 is `rotor_angle` now: the turns are known from here.

        Returns:
            The zero that `relative_to` gives `rotor_angle` with, at the present position.

        Raises:
            RuntimeError: before the first update.
        """
        self._known_position()
        # The turns that a single-turn encoder has made so far do not matter any more.
        self.position = split_turns(self._reading)
        self.referenced = True
        return self._reading - direction * rotor_angle

    def _known_position(self) -> RotorPosition:
        if self.position is None:
            raise RuntimeError('the rotor has no position before the first update')
        return self.position
