"""Torque ramps: their reversals, and the angle over the torque between these.

Ramps are found by the torque alone, without numbers of tests; times are optional.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROWS = 25
"""Minimum number of rows of a half-cycle."""
_CLEAR_OF_NOISE = 5.0
"""In a half-cycle the torque exceeds this many standard deviations of the noise."""
_NEAR = 3.0
"""Torques closer than this many standard deviations of the noise count as equal."""
_CLEAR_OF_ZERO = 0.01
"""In a half-cycle the torque exceeds this share of the largest torque."""
_FINE = 0.01
"""Moving means reduce the noise to this share of a ramp's amplitude."""
_ALIKE = 1.5
"""Ratio up to which peaks count as of one amplitude."""


class RampError(ValueError):
    """A recording without usable torque ramps."""


@dataclass(frozen=True, eq=False, slots=True)
class HalfLoop:
    """Half of a hysteresis loop: from a torque peak to the opposite one."""

    torque: Array
    """(n,), N·m, strictly monotonic."""
    angle: Array
    """(n,), rad, at these torques."""
    noise: float
    """N·m, standard deviation of a reading of the torque."""
    blur: float
    """N·m, standard deviation of the noise after smoothing."""
    time: Array | None = None
    """(n,), s, at these torques; None if it is not known."""

    @property
    def start(self) -> float:
        """N·m, the peak at which the half loop begins."""
        return float(self.torque[0])

    @property
    def end(self) -> float:
        """N·m, the peak at which it ends."""
        return float(self.torque[-1])

    @property
    def rising(self) -> bool:
        """Whether the torque increases."""
        return self.end > self.start

    @property
    def times(self) -> Array:
        """The times at these torques, where they are known.

        Raises:
            ValueError: if they are not.
        """
        if self.time is None:
            raise ValueError('the times of these ramps are not known')
        return self.time

    def reaches(self, torque: float) -> bool:
        """Whether the half loop includes a torque, within the noise."""
        low, high = sorted((self.start, self.end))
        near = _NEAR * self.noise
        return low - near <= torque <= high + near

    def angle_at(self, torque: Array | float) -> Array:
        """The angle at torques, rad, of the same shape."""
        return self._at(torque, self.angle)

    def time_at(self, torque: Array | Sequence[float] | float) -> Array:
        """The time at torques, s, of the same shape.

        Raises:
            ValueError: if times are not known.
        """
        return self._at(torque, self.times)

    def _at(self, torque: Array | Sequence[float] | float, values: Array) -> Array:
        sign = 1.0 if self.rising else -1.0
        return np.interp(sign * np.asarray(torque), sign * self.torque, values)

    def rounding(self, torque: float) -> float:
        """Greatest rise of the angle at a torque by noise, which rounds corners, rad."""
        before, at, after = self.angle_at(torque + 2.0 * self.blur * np.array([-1.0, 0.0, 1.0]))
        return float(0.5 * (before + after) - at)


@dataclass(frozen=True, eq=False, slots=True)
class Loop:
    """A hysteresis loop: two successive half loops."""

    fall: HalfLoop
    rise: HalfLoop

    @property
    def amplitude(self) -> float:
        """N·m, the smaller of the peaks at which the half loops begin."""
        return min(self.fall.start, -self.rise.start)

    def reaches(self, torque: float) -> bool:
        """Whether both half loops include a torque."""
        return self.fall.reaches(torque) and self.rise.reaches(torque)

    def width(self, torque: float) -> float:
        """The angle between the half loops, rad."""
        return float(self.fall.angle_at(torque) - self.rise.angle_at(torque))

    def middle(self, torque: float) -> float:
        """The angle midway between the half loops, rad."""
        return float(0.5 * (self.fall.angle_at(torque) + self.rise.angle_at(torque)))


@dataclass(frozen=True, eq=False, slots=True)
class Ramps:
    """Ramps of one amplitude."""

    amplitude: float
    """N·m, the mean."""
    loops: tuple[Loop, ...]
    pulls: tuple[tuple[HalfLoop, HalfLoop], ...]
    """Half loops to the positive and to the negative peak, paired in order of time."""
    history: tuple[HalfLoop, ...]
    """All half loops of the recording in order of time, also those of other amplitudes."""
    whole: tuple[Loop, ...]
    """The loops, where a recording ends before one is closed with the end of the one before it."""
    completed: bool
    """Whether one was closed so; it has about a quarter in common with the one before it."""

    def halves(self) -> Iterator[HalfLoop]:
        """Yield the half loops of all loops."""
        return (half for loop in self.loops for half in (loop.fall, loop.rise))

    def changed(self, change: Callable[[HalfLoop], HalfLoop]) -> 'Ramps':
        """Return the ramps with changed angles, beside an unchanged history."""
        return replace(
            self,
            loops=tuple(Loop(change(loop.fall), change(loop.rise)) for loop in self.loops),
            pulls=tuple((change(first), change(second)) for first, second in self.pulls),
            whole=tuple(Loop(change(loop.fall), change(loop.rise)) for loop in self.whole),
        )


def find_ramps(torque: Array, angle: Array, time: Array | None = None) -> tuple[Ramps, ...]:
    """Find the ramps of a recording, in ascending order of amplitude.

    Args:
        torque: (n,), N·m.
        angle: (n,), rad.
        time: (n,), s, increasing.

    Raises:
        RampError: if the torque never goes to both sides and back.
    """
    halves = _half_loops(torque, angle, time)
    # What preceded the first half loop is not known, so it belongs to no loop.
    loops = [_loop(*pair) for pair in zip(halves[1::2], halves[2::2], strict=False)]
    loops = [loop for loop in loops if loop.reaches(0.0)]
    if not loops:
        raise RampError('no torque ramp that goes to one side, to the other and back to zero')
    groups: list[list[Loop]] = []
    for loop in sorted(loops, key=lambda loop: loop.amplitude):
        if groups and loop.amplitude <= _ALIKE * groups[-1][0].amplitude:
            groups[-1].append(loop)
        else:
            groups.append([loop])
    return tuple(_ramps(group, loops, halves) for group in groups)


def _loop(first: HalfLoop, second: HalfLoop) -> Loop:
    return Loop(second, first) if first.rising else Loop(first, second)


def _ramps(group: Sequence[Loop], loops: Sequence[Loop], halves: Sequence[HalfLoop]) -> Ramps:
    smallest = group[0].amplitude
    largest = group[-1].amplitude
    alike = [b for b in halves if smallest / _ALIKE <= abs(b.end) <= largest * _ALIKE]
    rises, falls = ([b for b in alike if b.rising == up] for up in (True, False))
    own = tuple(loop for loop in loops if loop in group)
    whole = tuple(_whole(loop, halves) for loop in own)
    return Ramps(
        float(np.mean([loop.amplitude for loop in group])),
        own,
        tuple(zip(rises, falls, strict=False)),
        tuple(halves),
        whole,
        whole != own,
    )


def _whole(loop: Loop, halves: Sequence[HalfLoop]) -> Loop:
    """Close a loop, from the peak of its first half loop to the same torque."""
    last = next(k for k, half in enumerate(halves) if half is loop.fall or half is loop.rise) + 1
    first, second = halves[last - 1], halves[last]
    sign = 1.0 if second.rising else -1.0
    if sign * second.end >= sign * first.start:
        return loop
    # The first half loop of a recording starts anywhere, so the other branch takes its place.
    before = _turned(first, second) if first is halves[1] else halves[last - 2]
    beyond = sign * before.torque > sign * second.end
    times = (half.times[rows] for half, rows in ((second, slice(None)), (before, beyond)))
    closed = replace(
        second,
        torque=np.concatenate([second.torque, before.torque[beyond]]),
        angle=np.concatenate([second.angle, before.angle[beyond]]),
        time=None if second.time is None else np.concatenate([*times]),
    )
    return _loop(first, closed)


def _turned(first: HalfLoop, second: HalfLoop) -> HalfLoop:
    """Turn the first half of a loop round its centre, by which it becomes like the second."""
    torque = -first.torque
    low, high = sorted((second.start, second.end))
    both = (torque >= low) & (torque <= high)
    centre = 0.5 * float(np.mean(first.angle[both] + second.angle_at(torque[both])))
    return replace(first, torque=torque, angle=2.0 * centre - first.angle)


def _half_loops(torque: Array, angle: Array, time: Array | None) -> list[HalfLoop]:
    if len(torque) < _ROWS:
        return []
    noise = _noise(torque)
    least = max(_CLEAR_OF_NOISE * noise, _CLEAR_OF_ZERO * float(np.max(np.abs(torque))))
    mean = np.convolve(np.pad(torque, _ROWS // 2, 'edge'), np.full(_ROWS, 1.0 / _ROWS), 'valid')
    turns = [_peak(torque, rows, noise) for rows in _half_cycles(mean, least)]
    parts = [
        slice(first, last + 1)
        for first, last in pairwise([0, *turns, len(torque) - 1])
        if last - first >= _ROWS
    ]
    return [
        _half_loop(torque[rows], angle[rows], noise, None if time is None else time[rows])
        for rows in parts
    ]


def _half_cycles(torque: Array, least: float) -> list[slice]:
    """Find the rows in which the torque is clear of zero, with alternating sign."""
    away = np.flatnonzero(np.abs(torque) > least)
    sides = np.split(away, np.flatnonzero(np.diff(np.sign(torque[away]))) + 1)
    sides = [side for side in sides if len(side) >= _ROWS]
    # Rows of the same sign become neighbours where a short part between them was dropped.
    return [
        slice(int(same[0][0]), int(same[-1][-1]) + 1)
        for _, group in groupby(sides, key=lambda side: torque[side[0]] > 0.0)
        if (same := list(group))
    ]


def _peak(torque: Array, rows: slice, noise: float) -> int:
    """Find the row of the peak of a half-cycle."""
    first: int = rows.start
    return first + int(np.argmax(np.abs(_smooth(torque[rows], noise))))


def _half_loop(torque: Array, angle: Array, noise: float, time: Array | None) -> HalfLoop:
    smooth = _smooth(torque, noise)
    blur = noise / math.sqrt(_mean_rows(torque, noise))
    sign = 1.0 if smooth[-1] > smooth[0] else -1.0
    means, counts = _isotonic(sign * smooth)
    times = None if time is None else _means(time, counts)
    return HalfLoop(sign * means, _means(angle, counts), noise, blur, times)


def _means(values: Array, counts: NDArray[np.intp]) -> Array:
    """Means of successive groups of so many values."""
    ends = np.cumsum(counts)
    sums = np.concatenate([[0.0], np.cumsum(values)])
    means: Array = (sums[ends] - sums[ends - counts]) / counts
    return means


def _noise(torque: Array) -> float:
    """Standard deviation of a reading, from second differences, which vanish on a ramp."""
    differences = np.abs(np.diff(torque, 2))
    return 1.4826 * float(np.median(differences)) / math.sqrt(6.0)


def _smooth(torque: Array, noise: float) -> Array:
    """Smooth a ramp by a moving mean, and by a straight line at the ends, where it has none."""
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
    """Rows of the moving mean: no more than needed, as a ramp may pause."""
    enough = (noise / (_FINE * 0.5 * float(np.ptp(torque)))) ** 2 if noise else 0.0
    return 2 * (int(min(enough, len(torque) // 10)) // 2) + 1


def _line(values: Array) -> Array:
    rows = np.arange(len(values))
    return np.polynomial.Polynomial.fit(rows, values, 1)(rows)


def _isotonic(values: Array) -> tuple[Array, NDArray[np.intp]]:
    """Fit a non-decreasing sequence by least squares: pool adjacent violators.

    M. Ayer et al., An empirical distribution function for sampling with incomplete information,
    Annals of Mathematical Statistics 26 (1955), 641.

    Returns:
        The distinct values of the sequence, ascending, and how often each occurs.
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
