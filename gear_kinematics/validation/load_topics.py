# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the topics of the loads with recomputed ones, sample by sample."""

from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any, ClassVar

import numpy as np

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.loads import NUMBERS, Loads, load_joints
from gear_kinematics.state.rotor_input import RotorSamples
from gear_kinematics.validation.corrected_topics import Unbroken
from gear_kinematics.validation.fields import Array, FieldErrors, FieldSamples
from gear_kinematics.validation.matching import Expectation, OutputTopic
from gear_kinematics.validation.output_topics import finite_or_infinite
from gear_kinematics.wire.batches import decode_numbers
from gear_kinematics.wire.cdr import joint_state_layout, wrenches_layout
from gear_kinematics.wire.topics import BRANCH_LOADS, JOINT_LOADS

LOAD_COLUMNS: Sequence[tuple[str, Any]] = [('acceleration', np.float64), ('unknown', np.bool_)]
"""Columns of the samples that the loads need, beside `SAMPLES`."""


class RecomputedLoads:
    """What the loads at the samples of a recording need."""

    def __init__(self, parameters: NodeParameters) -> None:
        self._loads = Loads(parameters)
        self._unbroken = Unbroken()

    def at(self, samples: RotorSamples) -> dict[str, Array]:
        """The columns at the next samples, (n,)."""
        segments = self._unbroken.segments(samples)
        acceleration = self._loads.accelerations(samples.stamp, samples.velocity, segments)
        unknown = np.isnan(samples.effort) | np.isnan(acceleration)
        return {'acceleration': acceleration, 'unknown': unknown}


class LoadTopic(OutputTopic):
    """A topic of the loads; where they are unknown, no message is needed and none judged."""

    topic: ClassVar[str]
    _frame: ClassVar[str] = ''
    _per_joint: ClassVar[tuple[int, int, int]]
    """Numbers of a joint in each array of a message."""
    _units: ClassVar[Mapping[str, str]]
    """Units of both fields by their names."""

    def __init__(self, name: str, parameters: NodeParameters, expectation: Expectation) -> None:
        """Take the loads from the parameters of the node."""
        self._loads = Loads(parameters)
        mechanism, tolerances = parameters.mechanism, expectation.tolerances
        self._joints = load_joints(mechanism)[self.topic]
        # A force acts at levers of the order of the eccentricity.
        force = tolerances.effort / mechanism.eccentricity
        errors = (
            FieldErrors(field, unit, force if unit == 'N' else tolerances.of(unit))
            for field, unit in self._units.items()
        )
        super().__init__(name, parameters.frame_prefix, expectation, *errors)

    def answered(self, samples: Array) -> Array:
        """Whether each of the oldest samples of the window has its message, or needs none."""
        return np.asarray(super().answered(samples) | samples['unknown'])

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        prefix = self.label
        texts = self._frame and prefix + self._frame, *(prefix + joint for joint in self._joints)
        stamp, malformed, self._numbers = decode_numbers(
            messages,
            self.layout,
            tuple(text.encode() for text in texts),
            [numbers * len(self._joints) for numbers in self._per_joint],
        )
        return stamp, malformed

    def _compare(self, rows: Array, samples: Array) -> Sequence[FieldSamples]:
        motion = samples['velocity'], samples['acceleration']
        loads = self._loads.at(samples['turns'], samples['angle'], samples['effort'], motion)
        numbers = np.broadcast_arrays(samples['turns'], *chain(*NUMBERS[self.topic](loads)))[1:]
        recorded, expected = self._numbers[rows], np.stack(numbers, axis=-1)
        error = finite_or_infinite(np.abs(recorded - expected))
        error[~(self._changes.known(samples) & ~samples['unknown'])] = np.nan
        # Of all branches the one and the other, or of each joint the force and the couple.
        together = 3 if self._frame else len(self._joints)
        groups = error.reshape(len(rows), error.shape[1] // (2 * together), 2, together)
        both = groups.max(axis=(1, 3))
        return [FieldSamples(both[:, 0]), FieldSamples(both[:, 1])]


class BranchLoads(LoadTopic):
    """branch_loads."""

    topic = BRANCH_LOADS
    layout = staticmethod(joint_state_layout)
    _per_joint = 1, 0, 1
    _units: ClassVar[Mapping[str, str]] = {'stand-off': 'rad', 'torque': 'N·m'}


class JointLoads(LoadTopic):
    """joint_loads."""

    topic = JOINT_LOADS
    _frame = 'stator'
    layout = staticmethod(wrenches_layout)
    _per_joint = 0, 0, 6
    _units: ClassVar[Mapping[str, str]] = {'force': 'N', 'couple': 'N·m'}


LOADS: Mapping[str, type[LoadTopic]] = {BRANCH_LOADS: BranchLoads, JOINT_LOADS: JointLoads}
"""What compares each of LOAD_TOPICS."""
