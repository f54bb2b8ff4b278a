# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Both encoders of a gear in one recording, without wraps."""

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN, split_turns
from gear_kinematics.measurement.commissioning.positions import Positions, positions_of
from gear_kinematics.measurement.recording import Array, Encoders, Recording, RecordingError
from gear_kinematics.wire.cdr import SECOND

_MIN_SAMPLES = 3
"""Of which anything can be said."""
_NEAR = 0.1
"""s between a moment that is named and the sample that is taken for it."""


@dataclass(frozen=True, eq=False, slots=True)
class Joint:
    """Both encoders in one recording."""

    recording: Recording
    encoders: Encoders
    """Angles without wraps, rad."""
    rotor: Positions
    output: Positions
    turned: Array
    """(n,), rad, of the rotor, at the output's angles `encoders.measured`."""

    @classmethod
    def of(cls, recording: Recording, encoders: Encoders) -> 'Joint':
        """Take the wraps out of a recording of positions as they are.

        Raises:
            RecordingError: if there are too few samples, or no times.
        """
        motion = encoders.rotor
        if (seen := len(encoders.measured)) < _MIN_SAMPLES:
            raise RecordingError(f'{recording.path}: only {seen} samples of both encoders')
        if not encoders.timed:
            raise RecordingError(f'{recording.path}: no column of times, such as time_s')
        rotor = positions_of(motion.turns * TURN + motion.angle, encoders.rotor_step)
        output = positions_of(encoders.measured, encoders.output_step)
        turns, angle = split_turns(rotor.angle)
        motion = motion._replace(turns=turns, angle=angle)
        unwrapped = replace(encoders, rotor=motion, measured=output.angle)
        return cls(recording, unwrapped, rotor, output, unwrapped.at_measured(rotor.angle))

    @property
    def travel(self) -> float:
        """rad at the output."""
        return float(np.ptp(self.encoders.measured))

    @property
    def greatest_speed(self) -> float:
        """Of the rotor, rad/s."""
        return float(np.max(np.abs(self.encoders.speed(Fraction(1)))))

    @property
    def unit_fault(self) -> str:
        """Which positions are not in rad, in a sentence; else empty."""
        sides = ('rotor', self.rotor), ('output', self.output)
        faults = [f'the positions of the {side} are {at.fault}' for side, at in sides if at.fault]
        hint = 'of a CSV, --angle-unit, --rotor-counts and --output-counts tell the unit'
        return f'No file is possible: {"; ".join(faults)}; {hint}.' if faults else ''

    def zeros(self, ratio: Fraction) -> Array:
        """(n,), rad: the rotor at 0 of the output's encoder, by each sample and a ratio."""
        zeros: Array = self.turned - float(ratio) * self.encoders.measured
        return zeros

    def row_at(self, moment: float | str) -> int:
        """Find the sample at START, END, or a time of the recording, s.

        Raises:
            RecordingError: if there is no sample then.
        """
        if isinstance(moment, str):
            return 0 if moment == 'START' else -1
        seconds = float(self.encoders.rotor.stamp[0]) / SECOND + self.encoders.seconds
        row = int(np.argmin(np.abs(seconds - moment)))
        if abs(seconds[row] - moment) > _NEAR:
            raise RecordingError(
                f'{self.recording.path}: no sample at {moment:.13g} s; it is from '
                f'{seconds[0]:.13g} to {seconds[-1]:.13g} s'
            )
        return row
