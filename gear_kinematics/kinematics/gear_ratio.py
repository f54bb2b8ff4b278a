# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio as an exact fraction, and the conversions that need the ratio alone."""

import math
import re
from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache
from types import ModuleType
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.rotor_turns import (
    BELOW_HALF,
    TURN,
    largest,
    lists_as_arrays,
    nearest_turn,
)

_TEXT = re.compile(r'[-+]?\d{1,16}(/\d{1,16}|\.\d{1,16})?', re.ASCII)
MOST_TURNS = 2**52
"""Added to the turns of an angle up to `LARGEST_ANGLE`, these stay below 2^53, up to which a
float64 holds every integer exactly."""
_LARGEST_PRODUCT = 2**53
"""Greatest numerator × denominator for which the turns computed below are exact in float64."""


def whole_turns(turns: ArrayLike) -> NDArray[np.float64]:
    """Convert numbers of turns to float64.

    Raises:
        ValueError: if one is not an integer up to ±`MOST_TURNS`.
    """
    array = np.asarray(turns, np.float64)
    # Values that are not finite give NaN, which is true.
    if np.fmod(array, 1.0).any() or largest(array) > MOST_TURNS:
        given = np.array2string(array, threshold=4)
        raise ValueError(f'rotor_turns must be integers up to ±2^52, not {given}')
    return array


class GearRatio(Fraction):
    """Signed, exact ratio i = rotor speed / output speed; negative if the output turns backwards.

    Its methods take plain floats and numpy arrays alike, with the same results to the bit; `xp` is
    `math` for floats, else numpy.

    Raises:
        ValueError: if the ratio is 0, or its numerator × denominator exceeds 2^53.
    """

    __slots__ = ('_cycle', '_inverse', '_p', '_q')

    _p: float  # p/q = 1/i in lowest terms; a float, to round its products as an array does
    _q: int
    _inverse: float  # p/q, rounded
    _cycle: int  # turns, a multiple of q; p times fewer turns is exact in float64

    def __new__(cls, numerator: int | Fraction, denominator: int | None = None) -> Self:
        """Create the ratio with the arguments of Fraction."""
        self = super().__new__(cls, numerator, denominator)
        if not self:
            raise ValueError('a gear ratio must not be 0')
        if abs(self.numerator) * self.denominator > _LARGEST_PRODUCT:
            raise ValueError('numerator × denominator of a gear ratio must not exceed 2^53')
        inverse = 1 / self
        self._p, self._q = float(inverse.numerator), inverse.denominator
        self._inverse = self._p / self._q
        self._cycle = self._q * max(1, 2**50 // (abs(inverse.numerator) * self._q))
        return self

    @classmethod
    @lru_cache
    def parse(cls, text: str) -> Self:
        """Read a ratio such as `-19`, `1457/26` or `28.8`.

        Raises:
            ValueError: if the text is no number, or no gear has this ratio.
        """
        if not _TEXT.fullmatch(text):
            raise ValueError(
                'a gear ratio must be an integer, a fraction or a decimal, such as -19, 1457/26 '
                f'or 28.8, not {text!r}'
            )
        try:
            return cls(Fraction(text))
        except ZeroDivisionError as error:
            cause = 'the denominator of a gear ratio must not be 0'
            raise ValueError(f'{cause}, not {text!r}') from error
        except ValueError as error:
            raise ValueError(f'{error}, not {text!r}') from error

    @property
    def gear_ratio(self) -> Self:
        """The ratio itself, so that a ratio can stand for a gear wherever a `Mechanism` can."""
        return self

    def output_angle(self, turns: Any, angle: Any, xp: ModuleType) -> tuple[Any, Any]:
        """Output angle φ5 = φ2/i (eq. 5) as whole turns and a remainder in [-π, π], rad.

        The rotor angle is φ2 = 2π turns + angle. The remainder depends on the whole turns only
        modulo q, so no digits cancel.
        """
        p, q, cycle = self._p, self._q, self._cycle
        few = -cycle < turns < cycle if xp is math else largest(turns) < cycle
        if not few:  # whole turns of the output as well
            cycles = xp.trunc(turns / cycle)
            turns = turns - cycle * cycles
        whole = xp.floor((turns + angle / TURN) * self._inverse + 0.5)  # nearest, up to rounding
        rest = (TURN * (p * turns - q * whole) + p * angle) / q
        if xp is not math or not -BELOW_HALF < rest < BELOW_HALF:  # without a call in most cases
            whole, rest = nearest_turn(whole, rest, xp)
        if not few:
            whole = xp.trunc(whole + p * (cycle // q) * cycles)
        return whole, rest

    def output_rate(self, rotor_rate: Any) -> Any:
        """Output rate ω5 = ω2/i (eq. 3); accelerations are converted in the same way."""
        rate = rotor_rate if isinstance(rotor_rate, float) else lists_as_arrays(rotor_rate)
        return self._p * rate / self._q

    def rotor_angle(self, output_angle: Any) -> Any:
        """Rotor angle φ2 = i φ5 (eq. 5), rad."""
        return lists_as_arrays(output_angle) * self.numerator / self.denominator

    def __array__(self, dtype: Any = None, copy: Any = None) -> 'NDArray[np.float64]':
        """Convert to a float for products with arrays, which would be arrays of Fractions."""
        return np.array(float(self), dtype=dtype)


def simplest_fraction(low: Fraction, high: Fraction) -> Fraction:
    """Return the fraction in [low, high] with the least denominator, by continued fractions.

    If the interval contains several integers, the result is the one nearest to 0.

    Raises:
        ValueError: if the interval is empty.
    """
    if low > high:
        raise ValueError(f'no number is between {low} and {high}')
    if low <= 0 <= high:
        return Fraction(0)
    if high < 0:
        return -simplest_fraction(-high, -low)
    whole = -(-low.numerator // low.denominator)  # the least integer that is not below
    if whole <= high:
        return Fraction(whole)
    return whole - 1 + 1 / simplest_fraction(1 / (high - whole + 1), 1 / (low - whole + 1))


def tooth_pairs(low: Fraction, high: Fraction, most_teeth: int) -> Iterator[tuple[int, int]]:
    """Yield the tooth numbers (zk, zs) whose ratio -zs/(zk - zs) is in [low, high], by rising zk.

    Args:
        low: lower bound of the ratio.
        high: upper bound of the ratio, less than 0.
        most_teeth: greatest zk.
    """
    # zs/zk = i/(i - 1) falls from 1 to 0 while i rises from -∞ to 0.
    least, greatest = high / (high - 1), low / (low - 1)
    for ring in range(2, most_teeth + 1):
        first = -(-ring * least.numerator // least.denominator)
        last = min(ring - 1, ring * greatest.numerator // greatest.denominator)
        for satellite in range(max(first, 1), last + 1):
            yield ring, satellite
