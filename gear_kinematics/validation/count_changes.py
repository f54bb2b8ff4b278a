# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Samples from which on the recorded outputs count the rotor's angle from elsewhere."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.kinematics import split_turns
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.fields import Array, FieldSamples
from gear_kinematics.validation.report import Finding

_MAX_STEPS = 65_536
"""Of which samples that still wait for their outputs need the last few thousand."""

_STEP = np.dtype(
    [
        ('number', np.int64),  # of the first sample that has it, in the order of reception
        ('after', np.int64),  # number of the last sample that is known not to have it
        ('turns', np.float64),  # the rotor angle is 2π turns + angle more than recomputed
        ('angle', np.float64),  # rad
    ]
)


class Change(NamedTuple):
    """A change of the count within a segment."""

    stamp: int
    """Of the first sample that has it, ns."""
    number: int
    segment: int
    homed: bool
    """Whether homing explains it, and not an encoder at the output."""
    turns: int
    angle: float
    """rad: the rotor angle changes by 2π turns + angle."""


class LastOutput(NamedTuple):
    """The last sample with an output in a segment, and what its count is more by."""

    number: int
    stamp: int
    turns: float
    angle: float


class CountChanges:
    """Learns changes of the count from the output angles, each with its cause.

    - A gap that could hide turns of a single-turn encoder begins a segment, a number of which all
      its samples have: that of the first one. Within it the turns are certain; they are taken from
      its first output that differs by whole turns. So are those before the recording.
    - Homing declares that the output is at `home_angle` at the latest sample, exactly.
    - An absolute encoder at the output adds whole turns, or anything to a rotor that counts from
      its start.
    """

    def __init__(self, parameters: NodeParameters, tolerance: float, *, homing: bool) -> None:
        """Start without changes; angles agree within a tolerance, rad of the output."""
        self.found: list[Change] = []
        """Those within segments."""
        self.last_outputs: dict[int, LastOutput] = {}
        """By segment, where an encoder at the output references the rotor."""
        self._parameters, self._ratio = parameters, parameters.gear.gear_ratio
        self._tolerance, self._homing = tolerance, homing
        self._rotor_tolerance = tolerance * abs(float(self._ratio))
        self._steps = np.array([(-1, -1, 0.0, 0.0)], _STEP)  # ascending
        self._turns_taken = False
        self._latest: tuple[int, float] | None = None
        """Number of the last sample with an output, and its angle, rad."""

    def move(self, samples: Array) -> None:
        """Move samples, (n,), by the changes so far."""
        if len(self._steps) > 1:
            count = _step_at(self._steps, samples)
            samples['turns'] += count['turns']
            samples['angle'] += count['angle']

    def known(self, samples: Array) -> Array:
        """Whether the outputs tell the count at samples, (n,)."""
        parameters, number = self._parameters, samples['number']
        known = np.ones(len(number), bool)
        if parameters.single_turn:
            known &= _step_at(self._steps, samples)['number'] >= samples['segment']
        if not (parameters.absolute or self._homing):
            return known
        if self._latest is None:
            return known & (not parameters.absolute)
        # A change can lie between two outputs, and after the latest one.
        after = np.append(self._steps['after'], self._latest[0])
        following = np.searchsorted(self._steps['number'], number, 'right')
        return np.asarray(known & (number <= after[following]))

    def learn(self, samples: Array, position: FieldSamples) -> bool:
        """Learn from output angles at samples, (n,), and move these by what is found.

        Returns:
            Whether something is, so that the expected angles are others.
        """
        if not len(samples):
            return False
        steps = self._steps
        if not (self._parameters.single_turn and self._learn_gaps(samples, position.error)):
            self._learn_changes(samples, position)
        if self._steps is steps:
            return False
        before, count = _step_at(steps, samples), _step_at(self._steps, samples)
        samples['turns'] += count['turns'] - before['turns']
        samples['angle'] += count['angle'] - before['angle']
        return True

    def note(self, samples: Array, angle: Array) -> None:
        """Note output angles at samples, (n,), from which everything is learnt, rad."""
        if not len(samples):
            return
        number = samples['number']
        if self._parameters.absolute and not self._parameters.single_turn and not self._latest:
            self._add(number[:1], -1, 0.0, 0.0)  # the zero before is unknown
        self._latest = int(number[-1]), float(angle[-1])
        if self._parameters.absolute:
            count = _step_at(self._steps, samples)
            last = np.flatnonzero(np.diff(samples['segment'], append=-1))
            of = samples['segment'], number, samples['stamp'], count['turns'], count['angle']
            for segment, *row in zip(*(each[last].tolist() for each in of), strict=True):
                self.last_outputs[segment] = LastOutput(*row)

    def notes(self, parameters: NodeParameters) -> Iterator[Finding]:
        """Say with what the outputs are compared."""
        zero = parameters.rotor_zero
        for change in filter(lambda change: change.homed, self.found):
            before = zero
            zero -= parameters.rotor_direction * (TURN * change.turns + change.angle)
            yield Finding(
                f'compared with rotor_zero {zero:.12g} instead of {before:.12g}, as after homing',
                stamp=change.stamp,
                when='from',
            )
        if self._turns_taken:
            yield Finding('the turns of the single-turn encoder are taken from the outputs')

    def _add(self, number: Array, after: Any, turns: Any, angle: Any) -> None:
        new = np.empty(len(number), _STEP)
        new['number'], new['after'], new['turns'], new['angle'] = number, after, turns, angle
        steps = np.concatenate([self._steps, new])
        steps = steps[np.argsort(steps['number'], kind='stable')]  # an output can come late
        self._steps = steps[-_MAX_STEPS:]

    def _learn_gaps(self, samples: Array, error: Array) -> bool:
        """Learn the turns of segments from their first outputs that are off by whole turns."""
        count, segment = _step_at(self._steps, samples), samples['segment']
        turns = error * float(self._ratio) / TURN
        whole = np.round(turns)
        # Numbers too large to have a fraction are garbage.
        wrong = np.maximum(np.abs(turns - whole), np.spacing(np.abs(turns)))
        fits = (wrong <= self._rotor_tolerance / TURN) & (count['number'] < segment)
        segments, rows = np.unique(segment[fits], return_index=True)
        if not len(segments):
            return False
        count, whole = count[fits][rows], whole[fits][rows]
        self._turns_taken |= bool(whole.any())
        self._add(segments, segments - 1, count['turns'] + whole, count['angle'])
        return True

    def _learn_changes(self, samples: Array, position: FieldSamples) -> None:
        """Learn the changes within segments, each from the first output that is off by it."""
        number, expected, error = samples['number'], position.expected, position.error
        moved = np.zeros(len(error))
        while (wrong := ~(np.abs(error - moved) <= self._tolerance)).any():
            first = int(np.argmax(wrong))
            last = first - 1
            latest = (int(number[last]), expected[last] + moved[last]) if first else self._latest
            offset = float(error[first] - moved[first])
            change = self._explain(samples[first], latest, offset)
            if not (change and latest):
                break
            count = _step_at(self._steps, samples[first])
            turns, angle = count['turns'] + change.turns, count['angle'] + change.angle
            self._add(number[first : first + 1], latest[0], turns, angle)
            self.found.append(change)
            moved += offset * (_step_at(self._steps, samples)['number'] == change.number)

    def _explain(
        self, sample: Any, latest: tuple[int, float] | None, offset: float
    ) -> Change | None:
        """The change at a sample whose output is off, rad, and the latest one is not; if any."""
        parameters, segment = self._parameters, int(sample['segment'])
        rotor_angle = self._ratio.rotor_angle(offset)
        if not (latest and abs(rotor_angle) <= LARGEST_ANGLE):
            return None
        turns, angle = split_turns(rotor_angle)
        homed = abs(latest[1] + offset - parameters.home_angle) <= self._tolerance
        if not (homed and self._homing):
            homed, whole = False, abs(angle) <= self._rotor_tolerance
            # More than two in a segment, of which the second is a fault already, are noise.
            noise = [(c.segment, c.homed) for c in self.found[-2:]] == 2 * [(segment, False)]
            if not parameters.absolute or noise or (parameters.single_turn and not whole):
                return None
            angle = 0.0 if whole else angle
        return Change(int(sample['stamp']), int(sample['number']), segment, homed, turns, angle)


def _step_at(steps: Array, samples: Array) -> Array:
    """The step of each sample, (n,)."""
    return steps[np.maximum(np.searchsorted(steps['number'], samples['number'], 'right') - 1, 0)]
