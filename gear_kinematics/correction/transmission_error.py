# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The transmission error, sample by sample: measured minus ideal output angle.

Encoder and rotor are sampled at different times. A measured angle is compared with the ideal one
interpolated to its stamp, once ideal samples on both sides of it are known.
"""

import math
from collections import Counter, deque
from collections.abc import Sequence
from typing import NamedTuple

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN, split_turns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import CLOCK_RESET

_DEPTH = 8192  # number of samples of each kind that are kept


class ErrorSample(NamedTuple):
    """The transmission error at the stamp of a measured angle."""

    stamp: int  #: stamp of the measured angle, ns
    error: float  #: measured minus ideal output angle, rad
    turns: int
    ideal: float  #: remainder of the ideal output angle 2π `turns` + `ideal`, rad
    direction: int  #: of the output: 1, -1, or 0 until far enough from a reversal
    speed: float  #: rate of the ideal output angle, rad/s
    deviation: float = 0.0  #: deviation of the calibrated from the ideal output angle, rad
    half_width: float = math.nan  #: of the calibration's interval, rad; NaN without one

    def since(self, before: 'ErrorSample') -> float:
        """Travel of the ideal output from another sample, rad."""
        return TURN * (self.turns - before.turns) + self.ideal - before.ideal


SAMPLES = 60
"""Errors of a block, at least. The true error lies outside of the range of n independent ones with
a probability of 2^(1 - n), whatever the distribution of the noise (both sides of its median are
equally likely): 2e-6 here."""


class ErrorBlock:
    """Collects the latest errors into blocks, of each of which a third is new.

    A block lasts three times as long as the longest delay between the encoders, so that the motion
    is known that a delayed error of its middle third can be of.
    """

    def __init__(self, parameters: NodeParameters, *, gaps: bool = False) -> None:
        """Start empty; without `gaps`, no two errors of a block are further apart than a delay."""
        longest = parameters.longest_delay_ns
        self._least, self._max_gap = 3 * longest, math.inf if gaps else longest
        self._errors: list[ErrorSample] = []

    def add(self, sample: ErrorSample) -> Sequence[ErrorSample]:
        """Take the next error; returns the block that it completes, or nothing."""
        errors = self._errors
        if errors and not 0 <= sample.stamp - errors[-1].stamp <= self._max_gap:
            errors.clear()  # a stamp before the last one is that of a clock that was set back
        errors.append(sample)
        if len(errors) < SAMPLES or sample.stamp - errors[0].stamp < self._least:
            return ()
        self._errors = errors[len(errors) // 3 :]
        return errors


class Direction:
    """Direction of a motion, once it has travelled far enough after a reversal.

    Noise or a standstill thus does not change the direction, and travel across the lost motion
    belongs to neither direction.
    """

    def __init__(self, travel: float) -> None:
        """Start without a direction; a new one counts after a travel, rad, from a reversal."""
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
    deviation: float
    half_width: float


class TransmissionError:
    """Compares measured with ideal output angles.

    Angles are compared within the turn, so the encoder may be a single-turn one. Each error is
    within half a turn of the first one, whatever the offset of the encoder's zero.
    """

    def __init__(self, *, max_gap: int = 0, travel: float = 0.0) -> None:
        """Start with no samples; see `configure`. By default, no angle is compared."""
        self.matched = 0
        self.unmatched: Counter[str] = Counter()
        """Numbers of measured angles without an error, by cause."""
        self.configure(max_gap=max_gap, travel=travel)

    def configure(self, *, max_gap: int, travel: float) -> None:
        """Forget all samples, but no counts.

        Args:
            max_gap: ns between ideal samples beyond which nothing is interpolated.
            travel: rad of the output after a reversal until the new direction counts.
        """
        self._max_gap = max_gap
        self._direction = Direction(travel)
        self.reset()

    def reset(self) -> None:
        """Forget all samples, as after homing."""
        self._direction.reset()
        self._ideal: deque[_Ideal] = deque(maxlen=_DEPTH)
        self._measured: deque[tuple[int, float]] = deque()
        self._last_measured: int | None = None
        self._first_error: float | None = None

    def add_ideal(
        self,
        stamp: int,
        turns: int,
        angle: float,
        deviation: float = 0.0,
        half_width: float = math.nan,
    ) -> list[ErrorSample]:
        """Add the ideal output angle 2π `turns` + `angle` at a stamp, ns, and its correction, rad.

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
        self._ideal.append(_Ideal(stamp, turns, angle, direction, deviation, half_width))
        return self._match()

    def add_measured(self, stamp: int, angle: float) -> list[ErrorSample]:
        """Add a measured output angle, rad, at a stamp, ns; see `add_ideal`."""
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
        return ErrorSample(
            stamp,
            error,
            before.turns,
            ideal,
            after.direction if before.direction == after.direction else 0,
            step / interval * SECOND,
            before.deviation + share * (after.deviation - before.deviation),
            max(before.half_width, after.half_width),
        )
