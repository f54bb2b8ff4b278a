# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Changes of the rotor's zero or turns during a recording, by homing or the output encoder.

They are taken from the outputs.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.kinematics import split_turns
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.fields import Array, FieldSamples
from gear_kinematics.validation.report import Finding


class ZeroChange(NamedTuple):
    """A change of the zero, from a sample on."""

    number: int
    """Of the sample, in the order of reception."""
    stamp: int
    segment: int
    homed: bool
    """Whether homing explains it."""
    turns: int
    angle: float
    """rad: the rotor angle changes by 2π turns + angle."""
    stays: bool
    """Whether it lasts beyond the segment, after which turns are taken from the outputs again."""
    after: int
    """Number of the last sample before with an output."""

    def moves(self, samples: Array) -> Array:
        """Whether it moves each of the samples, (n,)."""
        mine = self.stays | (samples['segment'] == self.segment)
        return np.asarray(mine & (samples['number'] >= self.number))


class ZeroChanges:
    """Finds from which sample on the recorded outputs have another zero.

    Homing declares that the output is at `home_angle` at the latest sample, exactly. An absolute
    encoder at the output adds whole turns, or anything to a rotor that counts from its start.
    """

    def __init__(self, parameters: NodeParameters, tolerance: float, *, homing: bool) -> None:
        """Start without changes; angles agree within a tolerance, rad of the output."""
        self.found: list[ZeroChange] = []
        self.last_outputs: dict[int, tuple[int, int]] = {}
        """Number and stamp of the last sample with an output, by segment."""
        self._parameters, self._ratio = parameters, parameters.gear.gear_ratio
        self._tolerance, self._homing = tolerance, homing
        self._last = -1, np.nan  # number of the last sample with an output, and its angle, rad
        self._first: int | None = None  # number of the first one

    def move(self, samples: Array) -> None:
        """Move samples, (n,), by the changes so far."""
        first = samples['segment'].min(initial=np.iinfo(np.int64).max)
        for change in self.found:
            if change.stays or change.segment >= first:
                moved = change.moves(samples)
                samples['turns'] += change.turns * moved
                samples['angle'] += change.angle * moved

    def learn(self, samples: Array, position: FieldSamples) -> Array:
        """Find changes from moved samples, (n,), and the output angles.

        Returns:
            By how much the changes that are new move the output angles, (n,), rad.
        """
        expected, error = position.expected[:, 0], position.error
        moved = np.zeros(len(error))
        while (wrong := ~(np.abs(error - moved) <= self._tolerance)).any():
            first = int(np.argmax(wrong))
            last = first - 1
            before = (samples['number'][last], expected[last] + moved[last])
            offset = float(error[first] - moved[first])
            if not (
                change := self._explain(samples[first], before if first else self._last, offset)
            ):
                break
            moved += offset * change.moves(samples)
            self.found.append(change)
        if len(moved):
            self._last = int(samples['number'][-1]), float(expected[-1] + moved[-1])
            self._first = int(samples['number'][0]) if self._first is None else self._first
        if self._parameters.absolute:
            columns = (samples[name].tolist() for name in ('segment', 'number', 'stamp'))
            self.last_outputs |= {
                segment: (number, stamp) for segment, number, stamp in zip(*columns, strict=True)
            }
        return moved

    def uncertain(self, samples: Array) -> Array:
        """Whether the zero is unknown at samples, (n,), as no output was recorded around them."""
        number = samples['number']
        unknown = np.zeros(len(number), bool)
        if self._parameters.absolute:
            unknown |= self._first is None or number < self._first
        for change in self.found:
            if change.number > number.min(initial=change.number):
                unknown |= (change.after < number) & (number < change.number)
        return unknown

    def _explain(self, sample: Any, last: tuple[int, float], offset: float) -> ZeroChange | None:
        """The change at a sample whose output is off, rad, if any, and the last output is not."""
        after, before = last
        if not abs(rotor_angle := self._ratio.rotor_angle(offset)) <= LARGEST_ANGLE:
            return None
        segment = int(sample['segment'])
        turns, angle = split_turns(rotor_angle)
        homed = abs(before + offset - self._parameters.home_angle) <= self._tolerance
        if not (homed and self._homing):
            whole = abs(angle) <= self._tolerance * abs(float(self._ratio))
            # More than two in a segment, of which the second is a fault already, are noise.
            noise = [(c.segment, c.homed) for c in self.found[-2:]] == 2 * [(segment, False)]
            if not self._parameters.absolute or math.isnan(before) or noise:
                return None
            if self._parameters.single_turn and not whole:
                return None
            homed, angle = False, 0.0 if whole else angle
        stays, number = homed or not self._parameters.single_turn, int(sample['number'])
        stamp = int(sample['stamp'])
        return ZeroChange(number, stamp, segment, homed, turns, angle, stays, after)

    def notes(self, parameters: NodeParameters) -> Iterator[Finding]:
        """Say from where on another zero explains the outputs."""
        zero = parameters.rotor_zero
        for change in filter(lambda change: change.homed, self.found):
            before = zero
            zero -= parameters.rotor_direction * (TURN * change.turns + change.angle)
            yield Finding(
                f'compared with rotor_zero {zero:.12g} instead of {before:.12g}, as after homing',
                stamp=change.stamp,
                when='from',
            )
