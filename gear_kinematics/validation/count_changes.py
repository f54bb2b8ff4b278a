# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Changes of the zero or the turns from which the recorded outputs count the rotor's angle."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from gear_kinematics.kinematics import split_turns
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN, repeated
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.fields import Array, FieldSamples, Window
from gear_kinematics.validation.report import Finding

_MAX_STEPS = 65_536  # changes that are kept; samples without outputs need the last few thousand

_FEW = 64  # number of outputs, from the first one on, that must all show another zero

_STEP = np.dtype(
    [
        ('number', np.int64),  # number of the first sample that has it
        ('turns', np.float64),  # the rotor angle is 2π turns + angle more than recomputed
        ('angle', np.float64),  # rad
    ]
)


def first_number(segment: Any) -> Any:
    """Return the number of a segment's first sample, which is above those of earlier segments."""
    return segment << 40


class CountChanges:
    """Learns changes of the count from jumps of the output angle's error, each with its cause.

    - A gap that could hide turns of a single-turn encoder begins a segment, whose first
      output determines the turns. So does the first output of the recording.
    - Homing before the recording gave another zero to all outputs; homing during it declares that
      the output is at `home_angle` at the latest sample, exactly.
    - An absolute encoder at the output adds whole turns, or anything to a rotor that counts from
      its start, before the recording and once in a segment.

    Any other jump is an error.
    """

    def __init__(self, parameters: NodeParameters, tolerance: float, *, homing: bool) -> None:
        """Start without changes; angles agree within a tolerance, rad of the output."""
        self.count = 0  # number of changes so far
        self.homed = False  # whether homing was one of them
        self._parameters, self._ratio = parameters, parameters.gear.gear_ratio
        self._tolerance, self._homing = tolerance, homing
        self._steps = np.array([(-1, 0.0, 0.0)], _STEP)  # ascending
        self._notes = list[Finding]()
        self._turns_taken = self._last_alone = False
        self._referenced = -1  # the latest segment that an encoder has referenced
        self._latest = -1, 0.0, 0.0  # segment, angle and error of the latest output

    def move(self, samples: Window, sign: int = 1) -> None:
        """Move samples, (n,), by the changes so far, or, -1, back."""
        if len(self._steps) > 1:
            count = self._count_at(samples['number'])
            for name in ('turns', 'angle'):
                samples[name] = samples[name] + sign * count[name]

    def learn(self, samples: Window, position: FieldSamples) -> bool:
        """Learn from output angles at moved samples, (n,), and move these if a change was found.

        Returns whether one was found, so that the expected angles are others.
        """
        before, angle_before, error_before = self._latest
        numbers, error, angle = samples['number'], position.error, position.recorded
        rows = np.argsort(numbers, kind='stable')
        rows = rows[np.isfinite(error[rows])]
        if not len(rows):
            return False
        error, angle = error[rows], angle[rows]
        jumps = np.abs(np.diff(error, prepend=error_before)) > self._tolerance
        constant = not jumps[1:_FEW].any()
        if not self._parameters.rotor_period:  # then no gap changes the count: a jump is lasting
            jumps[:-1] &= ~jumps[1:]
        steps, moved, turns, rest = [], 0.0, 0.0, 0.0
        self._last_alone = False
        for k in np.flatnonzero(jumps).tolist():
            row, jump = rows[k], float(error[k]) - moved
            if k:
                before, angle_before = int(samples['segment'][rows[k - 1]]), float(angle[k - 1])
            rotor_angle = self._ratio.rotor_angle(jump)
            if abs(jump) <= self._tolerance or abs(rotor_angle) > LARGEST_ANGLE:
                continue
            period, near = self._parameters.rotor_period, self._tolerance * abs(float(self._ratio))
            more_turns, more = split_turns(rotor_angle)
            whole = abs(math.remainder(rotor_angle, period or TURN)) <= near
            if whole:
                more_turns, more = repeated(round(rotor_angle / (period or TURN)), period or TURN)
            sample = {name: samples[name][row] for name in ('segment', 'stamp', 'number')}
            sample['output'] = angle[k]
            number = self._explain(
                sample, before, angle_before, jump, whole=whole, constant=constant
            )
            if number is None:
                continue
            self._last_alone = not whole and self._parameters.absolute and k == len(rows) - 1
            moved, turns, rest = moved + jump, turns + more_turns, rest + more
            count = self._count_at(sample['number'])
            steps.append((number, count['turns'] + turns, count['angle'] + rest))
        segment = int(samples['segment'][rows[-1]])
        self._latest = segment, float(angle[-1]), float(error[-1]) - moved
        if not steps:
            return False
        self.count += len(steps)
        self.move(samples, -1)
        found = np.concatenate([self._steps, np.array(steps, _STEP)])
        # An output can come late.
        self._steps = found[np.argsort(found['number'], kind='stable')][-_MAX_STEPS:]
        self.move(samples)
        return True

    def notes(self) -> Iterator[Finding]:
        """Yield notes on what the outputs are compared with."""
        yield from self._notes
        if self._last_alone:
            yield Finding(FindingCause.LAST_ALONE, fails=True)
        if self._turns_taken:
            yield Finding(FindingCause.TURNS_TAKEN)

    def _explain(
        self, sample: Any, before: int, angle: float, jump: float, *, whole: bool, constant: bool
    ) -> int | None:
        """Return the number of the first sample that a jump, rad, moves; None if unexplained.

        `sample` is the first whose output shows the jump. The output before it had the segment
        `before` (-1: none) and the `angle`, rad. The jump may be `whole` periods of the rotor, or
        stay `constant` over many outputs.
        """
        repeats, absolute = bool(self._parameters.rotor_period), self._parameters.absolute
        segment = int(sample['segment'])
        if repeats and whole and segment != before:
            self._turns_taken = True
            return int(first_number(segment))
        if before < 0 and constant and (self._homing or absolute):
            cause = (
                FindingCause.ALL_MOVED_BY_ENCODER if absolute else FindingCause.ALL_MOVED_BY_HOMING
            )
            self._notes.append(Finding(cause, values={'angle': jump}))
            return 0
        at_home = abs(angle + jump - self._parameters.home_angle) <= self._tolerance
        if segment != before and self._parameters.unreferenced_outputs == 'withhold':
            # Outputs were withheld before homing: the angle of the first one is somewhat later.
            later = self._parameters.home_max_speed * self._parameters.input_timeout
            at_home = abs(sample['output'] - self._parameters.home_angle) <= later
        if self._homing and at_home:
            self.homed = True
            self._notes.append(Finding(FindingCause.HOMED, stamp=int(sample['stamp'])))
        elif absolute and segment != self._referenced and (whole or not repeats):
            self._referenced = segment
        else:
            return None
        return int(sample['number'])

    def _count_at(self, number: Array) -> Array:
        """Return the step of each sample, (n,), by its number."""
        steps = self._steps
        return steps[np.maximum(np.searchsorted(steps['number'], number, 'right') - 1, 0)]
