# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the topics of the loads with recomputed ones, sample by sample."""

from collections.abc import Sequence

import numpy as np

from gear_kinematics.state.loads import NUMBERS, LoadEstimator
from gear_kinematics.validation.fields import Array, FieldSamples, Window
from gear_kinematics.validation.matching import Expectation, OutputTopic
from gear_kinematics.validation.output_topics import finite_or_infinite
from gear_kinematics.wire.batches import JointStateBatch, decode_numbers
from gear_kinematics.wire.topics import BRANCH_LOADS, JOINT_LOADS

_UNITS = {
    BRANCH_LOADS: {'stand-off': 'rad', 'torque': 'N·m'},
    JOINT_LOADS: {'force': 'N', 'couple': 'N·m'},
}
"""Units of the two fields of each of LOAD_TOPICS."""


class LoadTopic(OutputTopic):
    """A topic of loads; where they are unknown, `acceleration` is NaN, and nothing is judged."""

    def __init__(
        self, topic: str, name: str, loads: LoadEstimator, expectation: Expectation
    ) -> None:
        self._topic, self._loads, self._template = topic, loads, loads.templates[topic]
        self.layout = self._template.layout
        if topic == BRANCH_LOADS:
            self.joints = self.layout(bytes(self._template.blank)).texts[1:]
        super().__init__(name, '', expectation, _UNITS[topic])

    def answered(self, samples: Window) -> Array:
        """Return which of the oldest samples have their message, or need none, (n,)."""
        return np.asarray(super().answered(samples) | np.isnan(samples['acceleration']))

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        if isinstance(messages, JointStateBatch):
            messages = messages.narrowed(self.joints)
        stamp, malformed, self._numbers = decode_numbers(messages, self._template, self.label)
        return stamp, malformed

    def _compare(self, rows: Array, samples: Window) -> Sequence[FieldSamples]:
        motion = samples['velocity'], samples['acceleration']
        loads = self._loads.at(samples['turns'], samples['angle'], samples['effort'], motion)
        expected = np.broadcast_arrays(samples['turns'], *NUMBERS[self._topic](loads))[1:]
        error = finite_or_infinite(np.abs(self._numbers[rows] - np.stack(expected, axis=-1)))
        error[~samples['turns_known'] | np.isnan(samples['acceleration'])] = np.nan
        # Force and couple of each joint, or the stand-offs and the torques of all branches.
        joints = np.resize([False, False, True], len(expected))
        branches = np.repeat([False, True], len(expected) // 2)
        second = joints if self._topic == JOINT_LOADS else branches
        return [FieldSamples(error[:, each].max(axis=1)) for each in (~second, second)]
