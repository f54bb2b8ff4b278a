# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The encoder at the output shaft, and the transmission error during operation."""

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from gear_kinematics.correction.corrector import Correction
from gear_kinematics.correction.error_window import ErrorWindow
from gear_kinematics.correction.transmission_error import SAMPLES, ErrorSample, TransmissionError
from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.joint_counts import JointCounts
from gear_kinematics.state.slip import SlipWatch
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.state.turn_reference import TurnReference
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import (
    CLOCK_RESET,
    JointMessage,
    JointReader,
    RejectedInputError,
)

_APART = SECOND // 10  # ns, between the newest stamps of both encoders: few transports take longer


def measured_angle(parameters: NodeParameters, position: Any) -> Any:
    """Convert positions of the output's encoder to output angles, rad; floats or arrays."""
    return parameters.output_encoder_direction * (position - parameters.output_encoder_zero)


class OutputEncoder(JointCounts):
    """Compares the angles of the output's encoder with ideal ones, also to reference the turns."""

    def __init__(self, parameters: NodeParameters, reference: TurnReference | None = None) -> None:
        super().__init__()
        self.comparison = TransmissionError()
        """Counts the measured angles that were compared and, by cause, those that were not."""
        self._turn_reference = reference
        self.direction_checked = False  # whether both encoders moved in the same sense
        self._apart = deque[int](maxlen=SAMPLES)  # ns, between the newest stamps of both encoders
        self._latest: RotorSample | None = None
        self.parameters = parameters
        self.configure(parameters)

    def configure(self, parameters: NodeParameters) -> None:
        """Start the comparison again after a change of parameters or homing; keep all counts."""
        self.window = ErrorWindow(round(parameters.transmission_error_window * SECOND))
        if _directions(parameters) != _directions(self.parameters):
            self.direction_checked = False
        self._first: ErrorSample | None = None
        self.parameters = parameters
        self._reader, self._found = JointReader(parameters.output_encoder_joint), False
        self._ratio = parameters.gear.gear_ratio
        longest = parameters.longest_delay_ns
        self._farthest = CLOCK_RESET + longest  # ns, between the latest stamps of both encoders
        self.comparison.configure(max_gap=longest, travel=parameters.transmission_error_travel)
        self.slip_watch = SlipWatch(parameters)
        self._segment: int | None = None
        self.reference = self._turn_reference if parameters.absolute else None
        if self.reference:
            self.reference.restart()

    @property
    def clocks_apart(self) -> Fact | None:
        """By how much the clocks of both encoders differ, if no delay explains it."""
        least = min(self._apart, default=0)
        longest = max(_APART, self.parameters.longest_delay_ns)
        return Condition.CLOCKS_APART(apart=least / SECOND) if least > longest else None

    def accept(
        self, data: JointMessage, now: Callable[[], int], latest: RotorSample | None = None
    ) -> Sequence[ErrorSample]:
        """Process the next message; returns the errors that have become known, in order.

        A message without a stamp gets the time of the clock `now`, ns. If the `latest` sample of
        the rotor is known, a stamp far from its stamp is that of another clock, and not compared.
        RejectedInputError, which is counted, is raised if the message has no valid angle.
        """
        self.received += 1
        self._compare_one_segment()
        try:
            stamp, _, position, *_ = self._reader.read(data)
        except RejectedInputError as rejection:
            self.reject(rejection, found=self._found)
            raise
        if not self._found:
            self._found = True
            self.leave_others()
        stamp = stamp or now()
        apart = abs(stamp - latest[0]) if latest else 0  # its stamp, by the fastest way
        if latest and latest is not self._latest:  # the old stamp of a silent rotor tells nothing
            self._latest = latest
            self._apart.append(apart)
        if apart > self._farthest:
            self.comparison.unmatched['no rotor state of about the same time'] += 1
            return ()
        angle = measured_angle(self.parameters, position)
        return self._note(self.comparison.add_measured(stamp, angle))

    def follow(
        self, sample: RotorSample, correction: Correction | None = None
    ) -> Sequence[ErrorSample]:
        """Process the rotor's next sample; returns the errors that have become known.

        Only with a reference may its turns be unknown.
        """
        self._compare_one_segment()
        ideal = self._ratio.output_angle(*sample.position, math)
        corrected = (correction.deviation, correction.half_width) if correction else ()
        return self._note(self.comparison.add_ideal(sample.stamp, *ideal, *corrected))

    def _note(self, samples: Sequence[ErrorSample]) -> Sequence[ErrorSample]:
        if samples and not self.direction_checked:
            self._check_direction(samples[-1])
        if self.reference and samples:
            samples = self.reference.follow(samples, lambda: self.clocks_apart)
        for sample in samples:
            self.window.add(sample)
            self.slip_watch.add(sample)
        return samples

    def _check_direction(self, sample: ErrorSample) -> None:
        """Check that the error does not grow by twice the travel, as with opposed directions."""
        first, parameters = self._first or sample, self.parameters
        self._first = first
        travel = abs(sample.since(first))
        least = parameters.transmission_error_travel, 4.0 * parameters.transmission_error_limit
        change = abs(math.remainder(sample.error - first.error, TURN))
        self.direction_checked = travel > max(least) and change < 0.5 * travel

    def _compare_one_segment(self) -> None:
        """Start the comparison again if the rotor's turn count has changed."""
        if self.reference and self.reference.rotor.segment != self._segment:
            self._segment = self.reference.rotor.segment
            self._first = None
            self.comparison.reset()
            self.window.clear()
            self.slip_watch.restart()
            self.reference.restart()


def _directions(parameters: NodeParameters) -> tuple[int, int]:
    return parameters.rotor_direction, parameters.output_encoder_direction
