"""The stop operators of a calibration, followed along the motion of the output.

Along the ideal output angle x = φ2/i, the play p of a play operator of radius r follows x only
where it has to: p ← clip(p, x - r, x + r). The state of the stop operator is x - p (Prandtl and
Ishlinskii). An unknown play is the interval of all possible ones; both its ends follow the same
rule, and meet after a travel of 2 r in one direction.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.calibration_file import Stop
from gear_kinematics.kinematics.rotor_turns import TURN

Array = NDArray[Any]

_FAR = 1024  # rotor turns from the reference; angles x stay small, and keep their precision
_CHUNK = 4096  # samples, so that the arrays of a chunk fit into the processor's cache


class StopOperators:
    """The stop operators of a calibration.

    `follow` takes a sample, and `follow_all` arrays (n,): two operators cost 1.1 µs a sample in
    floats, 0.3 µs in long arrays, but 72 µs in an array of a single sample.

    Both return what the operators add to the deviation, rad, halfway between its extremes over
    all possible histories; its slope, the derivative with respect to the ideal output angle; and
    half the distance of the extremes, rad.
    """

    def __init__(self, stops: Sequence[Stop], per_rotor: float) -> None:
        """Begin with unknown plays; `per_rotor` is 1/i."""
        self._stops = [(stop.radius, stop.coefficient) for stop in stops]
        self._per_rotor = per_rotor
        self.reset()

    def reset(self) -> None:
        """Forget the motion so far: the plays are unknown."""
        # The least and the greatest possible play of each operator, from the reference.
        self._least = len(self._stops) * [-math.inf]
        self._most = len(self._stops) * [math.inf]
        self._known = False  # whether these are the same; then only the first are moved on
        self._reference: int | None = None  # rotor turns

    def widen(self, turns: float, angle: float, least: float, most: float) -> None:
        """Let the plays have followed the rotor unseen, from an angle by `least` and `most`, rad.

        These are inf and -inf where it was not beyond what is seen.
        """
        if self._reference is None:
            return
        if self._known:
            self._most, self._known = self._least.copy(), False
        x = self._output_angle(turns, angle)
        low, high = x + least * self._per_rotor, x + most * self._per_rotor
        if self._per_rotor < 0.0:
            low, high = high, low
        for k, (radius, _) in enumerate(self._stops):
            self._least[k] = min(self._least[k], low + radius)
            self._most[k] = max(self._most[k], high - radius)

    def follow(self, turns: int, angle: float) -> tuple[float, float, float]:
        """Follow the motion to the next sample at the rotor angle 2π turns + angle."""
        self._count_from(turns)
        x = self._output_angle(turns, angle)
        deviation, slope = self._moved(self._least, x)
        if self._known:
            return deviation, slope, 0.0
        other, other_slope = self._moved(self._most, x)
        ends = zip(self._stops, self._least, self._most, strict=True)
        unknown = sum(0.5 * abs(stop[1]) * (most - least) for stop, least, most in ends)
        self._known = self._least == self._most
        return 0.5 * (deviation + other), 0.5 * (slope + other_slope), unknown

    def follow_all(self, turns: Array, angle: Array) -> Array:
        """Follow the motion to the next samples, arrays (n,); returns (3, n)."""
        radii, coefficients = np.array(self._stops).reshape(-1, 2).T
        found = np.empty((3, len(turns)))
        start = 0
        while start < len(turns):
            self._count_from(int(turns[start]))
            near = np.abs(turns[start : start + _CHUNK] - self._reference) <= _FAR
            rows = slice(start, start + (len(near) if near.all() else int(np.argmin(near))))
            x = self._output_angle(turns[rows], angle[rows])
            column = x[:, np.newaxis]
            before = np.array([self._least, self._least if self._known else self._most])
            least, most = ends = play_bounds(x, radii, *before)
            self._least, self._most = least[-1].tolist(), most[-1].tolist()
            plays = np.concatenate([before[:, np.newaxis], ends], axis=1)
            standing = 0.5 * (np.diff(plays, axis=1) == 0.0).sum(axis=0)
            found[:, rows] = (
                0.5 * ((column - least) + (column - most)) @ coefficients,
                standing @ coefficients,
                0.5 * (most - least) @ np.abs(coefficients),
            )
            self._known = self._least == self._most
            start = rows.stop
        return found

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

    def _moved(self, plays: list[float], x: float) -> tuple[float, float]:
        """Move plays; returns the deviation that they make, and its slope."""
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
