"""The encoder at the output shaft, and the transmission error during operation."""

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from gear_kinematics.correction.transmission_error import (
    ErrorSample,
    ErrorWindow,
    TransmissionError,
)
from gear_kinematics.kinematics import Gear
from gear_kinematics.state.rotor_input import RotorSample
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import JointReader, RejectedInputError, Settings


@dataclass(frozen=True, slots=True)
class EncoderSettings(Settings):
    """Settings of the encoder and of the comparison."""

    output_encoder_joint: str
    output_encoder_direction: int
    output_encoder_zero: float
    transmission_error_window: float
    transmission_error_max_gap: float
    transmission_error_travel: float

    def output_angle(self, position: Any) -> Any:
        """The measured output angle at a position of the encoder, rad; floats or arrays."""
        return self.output_encoder_direction * (position - self.output_encoder_zero)

    def comparison(self) -> TransmissionError:
        """Create a comparison with these settings, without samples."""
        return TransmissionError(
            max_gap=round(self.transmission_error_max_gap * SECOND),
            travel=self.transmission_error_travel,
        )


class OutputEncoder:
    """Compares the angles of output_encoder messages with the ideal output angle."""

    def __init__(self, gear: Gear, settings: EncoderSettings) -> None:
        self.received = 0
        self.rejected: Counter[str] = Counter()
        self.window = ErrorWindow(round(settings.transmission_error_window * SECOND))
        self._settings = settings
        self._reader = JointReader(settings.output_encoder_joint)
        self._ratio = gear.gear_ratio
        self.comparison = settings.comparison()
        """Counts the measured angles that were compared, and those that were not by cause."""
        self._last = 0

    def accept(self, data: bytes, now: Callable[[], int]) -> Sequence[ErrorSample]:
        """Process the next message.

        Args:
            data: a serialised sensor_msgs/JointState.
            now: the clock, ns, for messages without a stamp.

        Returns:
            The errors that are known now, in the order of their stamps.

        Raises:
            RejectedInputError: if the message has no valid angle. It is counted.
        """
        self.received += 1
        try:
            stamp, _, position, *_ = self._reader.read(data)
        except RejectedInputError as rejection:
            self.rejected[str(rejection)] += 1
            raise
        angle = self._settings.output_angle(position)
        return self._note(self.comparison.add_measured(stamp or now(), angle))

    def follow(self, sample: RotorSample) -> Sequence[ErrorSample]:
        """Process the rotor's next sample, with known turns; returns the same as `accept`."""
        turns, angle = self._ratio.output_angle(*sample.position, math)
        return self._note(self.comparison.add_ideal(sample.stamp, turns, angle))

    def _note(self, samples: Sequence[ErrorSample]) -> Sequence[ErrorSample]:
        for sample in samples:
            if sample.stamp < self._last:  # the clock was set back
                self.window.reset()
            self._last = sample.stamp
            self.window.add(sample)
        return samples
