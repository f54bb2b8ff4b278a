"""The transmission error, sample by sample: measured minus ideal output angle.

Encoder and rotor are sampled at different times. A measured angle is compared with the ideal one
interpolated to its stamp, once ideal samples on both sides of it are known.
"""

import math
from collections import Counter, deque
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.reversals import Pair, Reversals, separate
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN, split_turns
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import CLOCK_RESET

_DEPTH = 8192
"""Samples of each kind that are kept."""
_UNIT = 2.0**52
"""Units of a sum per radian: integers can be added and subtracted without rounding."""
_BINS = 720
"""Bins of output angles in a turn, in which both directions are compared."""


class ErrorSample(NamedTuple):
    """The transmission error at the stamp of a measured angle."""

    stamp: int
    """ns."""
    error: float
    """Measured minus ideal, rad."""
    turns: int
    ideal: float
    """rad: the ideal output angle is 2π `turns` + `ideal`."""
    direction: int
    """Of the output: 1, -1, or 0 until it has moved far enough after a reversal."""
    speed: float
    """Of the ideal output angle, rad/s."""


class Direction:
    """Direction of a motion, once it has travelled far enough after a reversal.

    Noise or a standstill thus does not change the direction, and travel across the lost motion
    belongs to neither direction.
    """

    def __init__(self, travel: float) -> None:
        """Start without a direction.

        Args:
            travel: rad after a reversal until the new direction counts.
        """
        self._travel = travel
        self.reset()

    def reset(self) -> None:
        """Forget the direction."""
        self._risen = self._fallen = 0.0

    def move(self, step: float) -> int:
        """Add a step, rad; returns 1, -1, or 0 if the direction is unknown."""
        self._risen = min(max(self._risen + step, 0.0), self._travel)
        self._fallen = min(max(self._fallen - step, 0.0), self._travel)
        return int(self._risen >= self._travel) - int(self._fallen >= self._travel)


class _Ideal(NamedTuple):
    """The ideal output angle 2π `turns` + `angle`."""

    stamp: int
    turns: int
    angle: float
    direction: int


class _Place(NamedTuple):
    """Where and in which direction an error was measured."""

    angle: int
    """Number of the bin of output angles."""
    direction: int


class TransmissionError:
    """Compares measured with ideal output angles.

    Angles are compared within the turn, so the encoder may be a single-turn one. Each error is
    within half a turn of the first one, whatever the offset of the encoder's zero.
    """

    def __init__(self, *, max_gap: int, travel: float) -> None:
        """Start with no samples.

        Args:
            max_gap: ns between ideal samples beyond which nothing is interpolated.
            travel: rad of the output after a reversal until the new direction counts.
        """
        self.matched = 0
        self.unmatched: Counter[str] = Counter()
        """Numbers of measured angles without an error, by cause."""
        self._max_gap = max_gap
        self._direction = Direction(travel)
        self._ideal: deque[_Ideal] = deque(maxlen=_DEPTH)
        self._measured: deque[tuple[int, float]] = deque()
        self.reset()

    def reset(self) -> None:
        """Forget all samples, as after homing."""
        self._direction.reset()
        self._ideal.clear()
        self._measured.clear()
        self._last_measured: int | None = None
        self._first_error: float | None = None

    def add_ideal(self, stamp: int, turns: int, angle: float) -> list[ErrorSample]:
        """Add the ideal output angle 2π `turns` + `angle` at a stamp, ns.

        A stamp that is not newer than the last is ignored; one that is older by more than a second
        resets the comparison.

        Returns:
            The errors that are known now, in the order of their stamps.
        """
        direction = 0
        if self._ideal:
            last = self._ideal[-1]
            if stamp <= last.stamp:
                if last.stamp - stamp <= CLOCK_RESET:
                    return []
                self.reset()
            elif stamp - last.stamp > self._max_gap:
                self._direction.reset()
            else:
                direction = self._direction.move((turns - last.turns) * TURN + angle - last.angle)
        self._ideal.append(_Ideal(stamp, turns, angle, direction))
        return self._match()

    def add_measured(self, stamp: int, angle: float) -> list[ErrorSample]:
        """Add a measured output angle, rad, at a stamp, ns.

        Returns:
            The errors that are known now, in the order of their stamps.
        """
        if not abs(angle) <= LARGEST_ANGLE:  # NaN compares false
            self.unmatched['not finite, or too large'] += 1
            return []
        if self._last_measured is not None and stamp < self._last_measured:
            if self._last_measured - stamp <= CLOCK_RESET:
                self.unmatched['out of order'] += 1
                return []
            self.reset()
        self._last_measured = stamp
        if len(self._measured) == _DEPTH:
            self._measured.popleft()
            self.unmatched['no ideal angle since'] += 1
        self._measured.append((stamp, split_turns(angle).angle))
        return self._match()

    def _match(self) -> list[ErrorSample]:
        """Compare the measured angles up to the last ideal sample."""
        samples = []
        ideal, measured = self._ideal, self._measured
        while measured and len(ideal) > 1:
            stamp, angle = measured[0]
            before, after = ideal[0], ideal[1]
            if stamp > after.stamp:
                ideal.popleft()
                continue
            measured.popleft()
            if stamp < before.stamp:
                self.unmatched['no ideal angle before'] += 1
            elif after.stamp - before.stamp > self._max_gap:
                self.unmatched['gap of the ideal angle'] += 1
            else:
                samples.append(self._compare(stamp, angle, before, after))
        return samples

    def _compare(self, stamp: int, measured: float, before: _Ideal, after: _Ideal) -> ErrorSample:
        interval = after.stamp - before.stamp
        share = (stamp - before.stamp) / interval
        step = (after.turns - before.turns) * TURN + after.angle - before.angle
        ideal = before.angle + share * step
        error = math.remainder(measured - ideal, TURN)
        if self._first_error is None:
            self._first_error = error
        error = self._first_error + math.remainder(error - self._first_error, TURN)
        self.matched += 1
        known = before.direction == after.direction
        direction = after.direction if known else 0
        speed = step / interval * SECOND
        return ErrorSample(stamp, error, before.turns, ideal, direction, speed)


class SlidingStatistics:
    """Mean and peak-to-peak value of a sliding window; adding takes amortised constant time."""

    def __init__(self) -> None:
        self._values: deque[tuple[int, int]] = deque()
        self._sum = 0
        # Values that are greater, or less, than all later ones.
        self._greatest: deque[tuple[int, float]] = deque()
        self._least: deque[tuple[int, float]] = deque()

    def __len__(self) -> int:
        return len(self._values)

    def add(self, stamp: int, value: float) -> None:
        """Add a value, rad, at a stamp, ns, not before the last."""
        counted = round(value * _UNIT)
        self._values.append((stamp, counted))
        self._sum += counted
        while self._greatest and self._greatest[-1][1] <= value:
            self._greatest.pop()
        self._greatest.append((stamp, value))
        while self._least and self._least[-1][1] >= value:
            self._least.pop()
        self._least.append((stamp, value))

    def drop(self, before: int) -> None:
        """Drop values older than a stamp, ns."""
        while self._values and self._values[0][0] < before:
            self._sum -= self._values.popleft()[1]
        for extremes in (self._greatest, self._least):
            while extremes and extremes[0][0] < before:
                extremes.popleft()

    @property
    def mean(self) -> float | None:
        """rad; None without values."""
        return self._sum / len(self._values) / _UNIT if self._values else None

    @property
    def peak_to_peak(self) -> float | None:
        """rad; None without values."""
        return self._greatest[0][1] - self._least[0][1] if self._values else None


class ReversalWindow:
    """Errors and speeds of a sliding window by output angle and direction.

    Adding takes amortised constant time; `reversals` takes a time in proportion to the angles.
    """

    def __init__(self) -> None:
        self._samples: deque[tuple[int, _Place, int, int]] = deque()
        # Number of samples, sum of errors, sum of speeds.
        self._sums: dict[_Place, list[int]] = {}

    def add(self, sample: ErrorSample) -> None:
        """Add an error that is not older than the last."""
        angle = sample.turns * _BINS + math.floor(sample.ideal / TURN * _BINS)
        place = _Place(angle, sample.direction)
        error, speed = round(sample.error * _UNIT), round(sample.speed * _UNIT)
        self._samples.append((sample.stamp, place, error, speed))
        self._count(place, 1, error, speed)

    def drop(self, before: int) -> None:
        """Drop samples older than a stamp, ns."""
        while self._samples and self._samples[0][0] < before:
            _, place, error, speed = self._samples.popleft()
            self._count(place, -1, -error, -speed)

    def _count(self, place: _Place, *steps: int) -> None:
        sums = self._sums.setdefault(place, [0, 0, 0])
        for k, step in enumerate(steps):
            sums[k] += step
        if not sums[0]:
            del self._sums[place]

    def reversals(self) -> Reversals | None:
        """What differs between both directions, over the angles that both cover, if any."""
        angles = sorted(
            angle
            for angle, direction in self._sums
            if direction > 0 and _Place(angle, -1) in self._sums
        )
        if not angles:
            return None
        forward, backward = (
            np.array([self._mean(_Place(angle, way)) for angle in angles]) for way in (1, -1)
        )
        difference = backward - forward
        return separate([Pair(difference[:, 0], -difference[:, 1])])

    def _mean(self, place: _Place) -> tuple[float, float]:
        count, error, speed = self._sums[place]
        return error / count / _UNIT, speed / count / _UNIT


class ErrorWindow:
    """Statistics of the transmission error over a sliding window, by direction."""

    def __init__(self, length: int) -> None:
        """Start empty.

        Args:
            length: ns, of the window.
        """
        self._length = length
        self.reset()

    def reset(self) -> None:
        """Forget all samples."""
        self.both = SlidingStatistics()
        """Statistics of all samples."""
        self.forward = SlidingStatistics()
        """Statistics of forward motion."""
        self.backward = SlidingStatistics()
        """Statistics of backward motion."""
        self._reversals = ReversalWindow()

    def add(self, sample: ErrorSample) -> None:
        """Add an error that is not older than the last."""
        self.both.add(sample.stamp, sample.error)
        if sample.direction:
            statistics = self.forward if sample.direction > 0 else self.backward
            statistics.add(sample.stamp, sample.error)
            self._reversals.add(sample)
        for window in (self.both, self.forward, self.backward, self._reversals):
            window.drop(sample.stamp - self._length)

    @property
    def reversals(self) -> Reversals | None:
        """Lost motion and delay; None unless both directions cover the same angles."""
        return self._reversals.reversals()
