# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds the rotor's turns by an absolute encoder at the output, and watches that they agree."""

import math
from collections import deque
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.kinematics import turn_reference
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.kinematics.turn_reference import nearest_turns
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.cdr import SECOND

SAMPLES = 20
"""Consecutive samples that must agree. The true error lies outside the range of n independent
samples with a probability of 2^(1 - n), whatever the distribution of the noise (both sides of its
median are equally likely): 2e-6 here. That is 20 ms of an encoder at 1 kHz, 0.2 s at 100 Hz."""


class Decision(NamedTuple):
    """What the last samples say of the turns: angles of the output, rad."""

    used: float  # of the margin: the distance if nothing known explains it, else the budget
    budget: float  # what measured and ideal angle may differ by
    delay: float  # the part of it that a delay makes at this speed
    margin: float  # of which the budget must be less


class TurnReference:
    """Follows the errors of the output, and references the rotor's count where it is unambiguous.

    The count of a single-turn encoder gets turns, which is exact: of all that are the same modulo
    |N| (i = N/D) those nearest to output angle 0, or after a gap in which the rotor cannot have
    turned half of |N| turns those nearest to the count. A multi-turn encoder gets a zero, so that
    the ideal output angle is the measured one, within half a turn of 0; after a silence only if
    the old one is wrong. A referenced count is watched, never changed.
    """

    def __init__(self, rotor_input: RotorInput) -> None:
        self.rotor = rotor_input
        self.decision: Decision | None = None
        """The last one of the search, also of one that has ended."""
        self.disagreement: tuple[float, float] | None = None
        """Output angle by the encoder and by the rotor, rad, where so many samples disagree."""
        self._found_in: int | None = None  # segment
        self._uncertainty = self._scatter = 0.0
        self.restart()

    def restart(self) -> None:
        """Forget all errors, as the count has changed."""
        self._errors: deque[tuple[float, float, float]] = deque(maxlen=SAMPLES)
        """What is unexplained, the most that the gear makes of it, and that a delay makes, rad."""
        self._waiting: deque[ErrorSample] = deque()
        self._speeds: deque[tuple[int, float]] = deque()  # later ones are less
        self._began = 0  # ns: since then the motion is known
        self._interval = 0.0  # s, between the last two errors
        self._disagreeing, self.disagreement = 0, None
        if not self.rotor.referenced:
            self.decision = None

    @property
    def compared(self) -> int:
        """Errors about which the motion within a delay is known, up to `SAMPLES`."""
        return len(self._errors)

    @property
    def too_slow(self) -> str:
        """That the encoder sends too rarely to tell or watch the turns; '' if it does not."""
        longest = self.rotor.parameters.transmission_error_max_gap
        if self._interval <= longest:
            return ''
        limit = f'transmission_error_max_gap {longest:g} s'
        return f'output_encoder every {self._interval:.2g} s, {limit}'

    @property
    def uncertainty(self) -> float | None:
        """Of the output angle, rad, 0 for exact turns; None if it was not referenced here."""
        return self._uncertainty if self._found_in == self.rotor.segment else None

    @property
    def origin(self) -> str:
        """What the turns are known from."""
        if not self.rotor.referenced:
            return 'none'
        if self.uncertainty is None:
            return 'homed'
        if self.rotor.parameters.single_turn:
            return 'turns of a single-turn encoder, exact'
        return f'output encoder, ± {math.degrees(self._uncertainty):.2g}°'

    def follow(self, samples: Sequence[ErrorSample]) -> Sequence[ErrorSample]:
        """Take the next errors of the present count; returns those of known turns.

        It can begin a new segment, whose errors are yet to come.
        """
        referenced = self.rotor.referenced
        for newest in samples:
            for sample, delay in self._known_motion(newest):
                error, known = self._explain(sample)
                self._errors.append((error, known, delay))
                if referenced:
                    self._watch(sample, error, known + delay)
                elif len(self._errors) == SAMPLES and self._decide(sample):
                    return ()
        return samples if referenced else ()

    def _known_motion(self, sample: ErrorSample) -> Iterator[tuple[ErrorSample, float]]:
        """Take the next error; yields those about which the motion is known now, late or early.

        With each comes what the output turns within the delay, rad, at its greatest speed about
        then. The longest gap of rotor states in which angles are compared bounds the delay.
        """
        longest = self.rotor.parameters.transmission_error_max_gap
        waiting, speeds, speed = self._waiting, self._speeds, abs(sample.speed)
        self._interval = (sample.stamp - waiting[-1].stamp) / SECOND if waiting else 0.0
        if not waiting or self._interval > longest:
            waiting.clear()
            speeds.clear()
            self._began = sample.stamp
        waiting.append(sample)
        while speeds and speeds[-1][1] <= speed:
            speeds.pop()
        speeds.append((sample.stamp, speed))
        while speeds[0][0] < sample.stamp - 2.0 * longest * SECOND:
            speeds.popleft()
        while waiting[0].stamp <= sample.stamp - longest * SECOND:
            if waiting[0].stamp - self._began >= longest * SECOND:
                yield waiting[0], speeds[0][1] * longest
            waiting.popleft()

    def _explain(self, sample: ErrorSample) -> tuple[float, float]:
        """Return the error, and the most that the gear makes of it."""
        parameters = self.rotor.parameters
        if parameters.single_turn and not math.isnan(sample.half_width):
            # The calibration tells both; it needs the rotor angle, at least within the turn.
            return sample.error - sample.deviation, sample.half_width
        # Play and transmission error: what is in order, peak to peak, as the zero of the encoder
        # may be anywhere in it.
        return sample.error, parameters.transmission_error_limit

    def _watch(self, sample: ErrorSample, error: float, budget: float) -> None:
        """Compare with the budget; so many samples beyond it are not explained by their noise."""
        scatter = 0.0 if self.uncertainty is None else self._scatter  # else it was homed
        if abs(math.remainder(error, TURN)) <= budget + scatter:
            self._disagreeing, self.disagreement = 0, None
            return
        self._disagreeing += 1
        if self._disagreeing >= SAMPLES:
            by_rotor = TURN * sample.turns + sample.ideal
            self.disagreement = by_rotor + math.remainder(sample.error, TURN), by_rotor

    def _decide(self, last: ErrorSample) -> bool:
        """Decide by the errors that are kept, and reference the count if they allow it."""
        errors, known, delays = zip(*self._errors, strict=True)
        delay, offsets = max(delays), [math.remainder(error - errors[0], TURN) for error in errors]
        offset = math.fsum(offsets) / SAMPLES
        # Noise: the true mean is somewhere in the range of the samples.
        scatter = max(max(offsets) - offset, offset - min(offsets)) + delay
        error, budget = errors[0] + offset, max(known) + scatter
        parameters = self.rotor.parameters
        ratio, turns, distance, agree = parameters.gear.gear_ratio, 0, 0.0, True
        if parameters.single_turn:
            limit = turn_reference.margin(ratio)
            turns, distance = nearest_turns(ratio, error)
            agree = all(nearest_turns(ratio, each)[0] == turns for each in errors)
        else:
            # Any angle has its zero: wait until noise and delay are less than the gear's error.
            limit = 2.0 * parameters.transmission_error_limit
        self.decision = Decision(max(abs(distance), budget), budget, delay, limit)
        if not agree or not turn_reference.unambiguous(distance, budget, limit):
            return False
        self._scatter = scatter
        self._uncertainty = 0.0 if parameters.single_turn else budget
        self._refer(turns, error, last)
        self._found_in = self.rotor.segment
        return True

    def _refer(self, turns: int, error: float, last: ErrorSample) -> None:
        """Add turns, or what is missing to the measured angle, to the rotor's count."""
        parameters, unseen = self.rotor.parameters, self.rotor.unseen_travel
        ratio = parameters.gear.gear_ratio
        if parameters.single_turn:
            if unseen >= math.pi * abs(ratio.numerator):  # half a period
                turns = turn_reference.about_zero(ratio, turns, TURN * last.turns + last.ideal)
            self.rotor.refer(turns)
        elif math.isfinite(unseen) and abs(math.remainder(error, TURN)) <= self._uncertainty:
            self.rotor.refer(0)
        else:
            missing = math.remainder(last.ideal + error, TURN) - last.ideal - TURN * last.turns
            self.rotor.refer(0, ratio.rotor_angle(missing))
