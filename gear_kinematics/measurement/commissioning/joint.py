# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Both encoders of a gear in one recording, without wraps."""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN, split_turns
from gear_kinematics.measurement.encoder_range import find_range, other_unit
from gear_kinematics.measurement.gate import gated
from gear_kinematics.measurement.recording import Array, Encoders, Recording, RecordingError
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.measurement.two_encoders import output_by_rotor
from gear_kinematics.wire.cdr import SECOND

_NEAR = 0.1  # s, greatest distance of the sample from the moment that the user names


@dataclass(frozen=True, eq=False, slots=True)
class Joint:
    """Both encoders in one recording."""

    recording: Recording
    encoders: Encoders  # angles without wraps, rad
    turned: Array  # angle of the rotor at the output's angles `encoders.measured`, (n,), rad
    rotor_wraps: int
    output_wraps: int
    rotor_range: float  # angle after which the rotor's position repeats, rad; 0 if it does not

    @classmethod
    def of(cls, recording: Recording) -> 'Joint':
        """Unwrap a recording of positions as they were read.

        Raises:
            RecordingError: if there are too few samples, or another unit than rad.
        """
        encoders, path = recording.both, recording.path
        motion, measured = encoders.rotor, encoders.measured
        if len(measured) <= 1:
            raise RecordingError(f'{path}: only one sample of both encoders')
        rotor = motion.turns * TURN + motion.angle
        for body, values, step in (
            ('rotor', rotor, encoders.rotor_step),
            ('output', measured, encoders.output_step),
        ):
            if unit := other_unit(values, step):
                hint = 'for a CSV, --angle-unit, --rotor-counts and --output-counts give the unit'
                raise RecordingError(f'{path}: the positions of the {body} are {unit}; {hint}')
        period, wraps = find_range(rotor, motion.seconds, encoders.rotor_step)
        own, output_wraps = find_range(measured, encoders.seconds, encoders.output_step)
        rotor = np.unwrap(rotor, period=period) if wraps else rotor
        measured = np.unwrap(measured, period=own) if output_wraps else measured
        output_wraps *= own == TURN
        turns, angle = split_turns(rotor)
        motion = motion._replace(turns=turns, angle=angle)
        unwrapped = replace(encoders, rotor=motion, measured=measured)
        # By the rotor, as a fast output may turn by half a turn from row to row.
        if output_wraps and (
            slope := output_by_rotor(unwrapped.at_measured(motion.turned), measured)
        ):
            ratio = Fraction(1.0 / slope)
            measured = unwrapped.at_measured(unwrapped.ideal(ratio)) + unwrapped.error(ratio)
            unwrapped = replace(unwrapped, measured=measured)
        if period not in {0.0, TURN}:  # a range that the gate did not know
            recording = gated(replace(recording, encoders=unwrapped))
            unwrapped = recording.both
            rotor = unwrapped.rotor.turns * TURN + unwrapped.rotor.angle
        return cls(recording, unwrapped, unwrapped.at_measured(rotor), wraps, output_wraps, period)

    @property
    def travel(self) -> float:
        """Travel of the output, rad."""
        return float(np.ptp(self.encoders.measured))

    @property
    def spoilt(self) -> bool:
        """Whether the recording has other faults than single readings, which are left out."""
        return any(fault.what is not Observation.STRAY for fault in self.recording.faults)

    def row_at(self, moment: float | Literal['START', 'END']) -> int:
        """Find the sample at START, END or a time, s; RecordingError if none is near."""
        if isinstance(moment, str):
            return 0 if moment == 'START' else -1
        seconds = float(self.encoders.rotor.stamp[0]) / SECOND + self.encoders.seconds
        row = int(np.argmin(np.abs(seconds - moment)))
        if abs(seconds[row] - moment) > _NEAR:
            span = f'{seconds[0]:.13g} to {seconds[-1]:.13g} s'
            raise RecordingError(f'{self.recording.path}: {moment:.13g} s is not in {span}')
        return row
