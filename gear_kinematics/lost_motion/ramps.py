"""Ramps of torque: where they turn back, and the angle over the torque on each way.

Nothing but the torque tells one ramp from the next: no clock, no number of a test.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROWS = 25
"""Least rows of a half-cycle."""
_CLEAR_OF_NOISE = 5.0
"""Standard deviations of the noise that the torque exceeds in a half-cycle."""
_NEAR = 3.0
"""Standard deviations of the noise within which a torque is another."""
_CLEAR_OF_ZERO = 0.01
"""Share of the largest torque that it exceeds."""
_FINE = 0.01
"""Share of a ramp's amplitude to which means bring down the noise."""
_ALIKE = 1.5
"""Peaks that differ by no more are of one amplitude."""


class RampError(ValueError):
    """A recording that holds no ramps to measure by."""


@dataclass(frozen=True, eq=False, slots=True)
class Branch:
    """One way of the torque, from a peak to the opposite one."""

    torque: Array
    """(n,), N·m, each beyond the one before."""
    angle: Array
    """(n,), rad, at these torques."""
    noise: float
    """N·m, standard deviation of a reading of the torque."""
    blur: float
    """N·m, standard deviation that is left of it: what is closer together is one."""

    @property
    def start(self) -> float:
        """N·m, where the torque turned back."""
        return float(self.torque[0])

    @property
    def end(self) -> float:
        """N·m, where it turns back next."""
        return float(self.torque[-1])

    @property
    def rising(self) -> bool:
        """Whether the torque grows."""
        return self.end > self.start

    def reaches(self, torque: float) -> bool:
        """Whether the torque comes along here, within its noise."""
        low, high = sorted((self.start, self.end))
        near = _NEAR * self.noise
        return low - near <= torque <= high + near

    def angle_at(self, torque: Array | float) -> Array:
        """The angle at torques, rad, of the same shape."""
        sign = 1.0 if self.rising else -1.0
        return np.interp(sign * np.asarray(torque), sign * self.torque, self.angle)

    def rounding(self, torque: float) -> float:
        """By how much noise may raise the angle at a torque, rad: it rounds corners."""
        before, at, after = self.angle_at(torque + 2.0 * self.blur * np.array([-1.0, 0.0, 1.0]))
        return float(0.5 * (before + after) - at)


@dataclass(frozen=True, eq=False, slots=True)
class Loop:
    """Two branches, one after the other: a hysteresis curve."""

    fall: Branch
    rise: Branch

    @property
    def amplitude(self) -> float:
        """N·m, from where both branches come."""
        return min(self.fall.start, -self.rise.start)

    def reaches(self, torque: float) -> bool:
        """Whether the torque comes along on both ways."""
        return self.fall.reaches(torque) and self.rise.reaches(torque)

    def width(self, torque: float) -> float:
        """The angle between the branches, rad."""
        return float(self.fall.angle_at(torque) - self.rise.angle_at(torque))

    def middle(self, torque: float) -> float:
        """The angle midway between the branches, rad."""
        return float(0.5 * (self.fall.angle_at(torque) + self.rise.angle_at(torque)))


@dataclass(frozen=True, eq=False, slots=True)
class Ramps:
    """Ramps of one amplitude."""

    amplitude: float
    """N·m, the mean."""
    loops: tuple[Loop, ...]
    pulls: tuple[tuple[Branch, Branch], ...]
    """Loadings to the positive and to the negative peak, as they follow each other."""


def find_ramps(torque: Array, angle: Array) -> tuple[Ramps, ...]:
    """Find the ramps of a recording, by amplitude from small to large.

    Args:
        torque: (n,), N·m.
        angle: (n,), rad.

    Raises:
        RampError: if the torque never goes to both sides and back.
    """
    branches = _branches(torque, angle)
    # What was before the first is not known: it belongs to no loop.
    loops = [_loop(*pair) for pair in zip(branches[1::2], branches[2::2], strict=False)]
    loops = [loop for loop in loops if loop.reaches(0.0)]
    if not loops:
        raise RampError('no torque ramp that goes to one side, to the other and back to zero')
    groups: list[list[Loop]] = []
    for loop in sorted(loops, key=lambda loop: loop.amplitude):
        if groups and loop.amplitude <= _ALIKE * groups[-1][0].amplitude:
            groups[-1].append(loop)
        else:
            groups.append([loop])
    return tuple(_ramps(group, loops, branches) for group in groups)


def _loop(first: Branch, second: Branch) -> Loop:
    return Loop(second, first) if first.rising else Loop(first, second)


def _ramps(group: Sequence[Loop], loops: Sequence[Loop], branches: Sequence[Branch]) -> Ramps:
    smallest = group[0].amplitude
    largest = group[-1].amplitude
    alike = [b for b in branches if smallest / _ALIKE <= abs(b.end) <= largest * _ALIKE]
    rises, falls = ([b for b in alike if b.rising == up] for up in (True, False))
    return Ramps(
        float(np.mean([loop.amplitude for loop in group])),
        tuple(loop for loop in loops if loop in group),
        tuple(zip(rises, falls, strict=False)),
    )


def _branches(torque: Array, angle: Array) -> list[Branch]:
    if len(torque) < _ROWS:
        return []
    noise = _noise(torque)
    least = max(_CLEAR_OF_NOISE * noise, _CLEAR_OF_ZERO * float(np.max(np.abs(torque))))
    mean = np.convolve(np.pad(torque, _ROWS // 2, 'edge'), np.full(_ROWS, 1.0 / _ROWS), 'valid')
    turns = [_peak(torque, rows, noise) for rows in _half_cycles(mean, least)]
    return [
        _branch(torque[first : last + 1], angle[first : last + 1], noise)
        for first, last in pairwise([0, *turns, len(torque) - 1])
        if last - first >= _ROWS
    ]


def _half_cycles(torque: Array, least: float) -> list[slice]:
    """Where the torque is clear of zero, on one side and then on the other."""
    away = np.flatnonzero(np.abs(torque) > least)
    sides = np.split(away, np.flatnonzero(np.diff(np.sign(torque[away]))) + 1)
    sides = [side for side in sides if len(side) >= _ROWS]
    # What was too short to count came between rows of the same side.
    return [
        slice(int(same[0][0]), int(same[-1][-1]) + 1)
        for _, group in groupby(sides, key=lambda side: torque[side[0]] > 0.0)
        if (same := list(group))
    ]


def _peak(torque: Array, rows: slice, noise: float) -> int:
    """Where a half-cycle turns back."""
    first: int = rows.start
    return first + int(np.argmax(np.abs(_smooth(torque[rows], noise))))


def _branch(torque: Array, angle: Array, noise: float) -> Branch:
    smooth = _smooth(torque, noise)
    blur = noise / math.sqrt(_mean_rows(torque, noise))
    sign = 1.0 if smooth[-1] > smooth[0] else -1.0
    means, counts = _isotonic(sign * smooth)
    ends = np.cumsum(counts)
    sums = np.concatenate([[0.0], np.cumsum(angle)])
    angles = (sums[ends] - sums[ends - counts]) / counts
    return Branch(sign * means, angles, noise, blur)


def _noise(torque: Array) -> float:
    """Standard deviation of a reading, from second differences: a ramp has none."""
    differences = np.abs(np.diff(torque, 2))
    return 1.4826 * float(np.median(differences)) / math.sqrt(6.0)


def _smooth(torque: Array, noise: float) -> Array:
    """Take the noise off a ramp: a moving mean, and at the ends, which have none, a line."""
    tenth = len(torque) // 10
    half = _mean_rows(torque, noise) // 2
    sums = np.concatenate([[0.0], np.cumsum(torque)])
    smooth = torque.copy()
    smooth[half : len(torque) - half] = (sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (
        2 * half + 1
    )
    if noise:
        smooth[: tenth // 2] = _line(torque[:tenth])[: tenth // 2]
        smooth[-tenth // 2 :] = _line(torque[-tenth:])[-tenth // 2 :]
    return smooth


def _mean_rows(torque: Array, noise: float) -> int:
    """Over how many rows a mean goes: no more than it takes, for a ramp may halt on its way."""
    enough = (noise / (_FINE * 0.5 * float(np.ptp(torque)))) ** 2 if noise else 0.0
    return 2 * (int(min(enough, len(torque) // 10)) // 2) + 1


def _line(values: Array) -> Array:
    rows = np.arange(len(values))
    return np.polynomial.Polynomial.fit(rows, values, 1)(rows)


def _isotonic(values: Array) -> tuple[Array, NDArray[np.intp]]:
    """Fit the nearest rising sequence by least squares: pool adjacent violators.

    M. Ayer et al., An empirical distribution function for sampling with incomplete information,
    Annals of Mathematical Statistics 26 (1955), 641.

    Returns:
        The steps of the sequence, each greater than the one before, and of how many values.
    """
    means: list[float] = []
    counts: list[int] = []
    for value in values.tolist():
        mean, count = value, 1
        while means and means[-1] >= mean:
            before, many = means.pop(), counts.pop()
            mean = (before * many + mean * count) / (many + count)
            count += many
        means.append(mean)
        counts.append(count)
    return np.array(means), np.array(counts, np.intp)
