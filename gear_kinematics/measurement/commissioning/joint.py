# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Both encoders of a gear in one recording, without wraps."""

import math
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN, split_turns
from gear_kinematics.measurement.commissioning.positions import Positions, positions_of
from gear_kinematics.measurement.recording import (
    Array,
    Encoders,
    Recording,
    RecordingError,
    unit_since_1970,
)
from gear_kinematics.wire.cdr import SECOND

_MIN_SAMPLES = 3
"""Of which anything can be said."""
_GAP = 5.0
"""Mean intervals of the rotor's samples, up to which its greatest step is that in an interval."""
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
    left_out: int
    """Samples of another stretch of the recording."""

    @classmethod
    def of(cls, recording: Recording, encoders: Encoders) -> 'Joint':
        """Take the wraps out of a recording of positions as they are.

        Of a rotor that wraps, the longest stretch without a gap is used: no turn is missed in it.

        Raises:
            RecordingError: if there are too few samples.
        """
        motion, seen = encoders.rotor, len(encoders.measured)
        if seen < _MIN_SAMPLES:
            raise RecordingError(f'{recording.path}: only {seen} samples of both encoders')
        rotor = positions_of(motion.turns * TURN + motion.angle, encoders.rotor_step)
        output = positions_of(encoders.measured, encoders.output_step)
        turns, angle = split_turns(rotor.angle)
        motion = motion._replace(turns=turns, angle=angle)
        unwrapped = replace(encoders, rotor=motion, measured=output.angle)
        if rotor.wraps:
            unwrapped = unwrapped.chosen(_longest_stretch(encoders, rotor.angle))
        turned = unwrapped.at_measured(rotor.angle)
        return cls(recording, unwrapped, rotor, output, turned, seen - len(turned))

    @property
    def travel(self) -> float:
        """rad at the output."""
        return float(np.ptp(self.encoders.measured))

    @property
    def greatest_speed(self) -> float:
        """Of the rotor, rad/s; 0 without times."""
        encoders = self.encoders
        return float(np.max(np.abs(encoders.speed(Fraction(1))))) if encoders.timed else 0.0

    @property
    def unit_fault(self) -> str:
        """Which positions are not in rad, in a sentence; else empty."""
        sides = ('rotor', self.rotor), ('output', self.output)
        faults = [f'the positions of the {side} are {at.fault}' for side, at in sides if at.fault]
        return f'No file is possible: {"; ".join(faults)}.' if faults else ''

    @property
    def sentences(self) -> list[str]:
        """What was left out or assumed."""
        gaps = f'{self.left_out} samples are left out: the rotor may have turned unseen in gaps.'
        return [*self.recording.sentences, *([gaps] if self.left_out else [])]

    def zeros(self, ratio: Fraction) -> Array:
        """(n,), rad: the rotor at 0 of the output's encoder, by each sample and a ratio."""
        zeros: Array = self.turned - float(ratio) * self.encoders.measured
        return zeros

    def row_at(self, moment: float | str) -> int:
        """Find the sample at START, END, or s from the start or since 1970.

        Raises:
            RecordingError: if there is no sample then.
        """
        if isinstance(moment, str):
            return 0 if moment == 'START' else -1
        if not self.encoders.timed:
            raise RecordingError(f'{self.recording.path}: without times, name START or END')
        first, since = float(self.encoders.rotor.stamp[0]) / SECOND, moment
        if unit_since_1970(moment) == 1.0:
            since -= first if unit_since_1970(first) else self.recording.start or 0.0
        seconds = self.encoders.seconds
        row = int(np.argmin(np.abs(seconds - since)))
        if abs(seconds[row] - since) > _NEAR:
            raise RecordingError(
                f'{self.recording.path}: no sample at {moment:.9g} s; '
                f'it is {seconds[-1]:.6g} s long'
            )
        return row


def _longest_stretch(encoders: Encoders, angle: Array) -> Array:
    """(n,): which angles are in the longest stretch in which the rotor's angle misses no turn."""
    stamp = encoders.rotor.stamp
    usual = float(np.mean(np.diff(stamp)))
    steps = np.abs(np.diff(angle))[np.diff(stamp) <= _GAP * usual]
    half_turn = usual * math.pi / max(float(steps.max()), TURN / 2**24)
    starts = encoders.starts(int(max(_GAP * usual, half_turn)))
    stretch = np.searchsorted(starts, np.arange(len(stamp)), side='right')
    first, last = stretch[encoders.before], encoders.at_measured(stretch)
    whole = first == last
    kept: Array = whole & (first == np.argmax(np.bincount(first[whole])))
    return kept
