# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the node has to answer to the driver of the benchmarks, by the matrix method.

It shares no formula with the node. Messages are read in batches, by what reads recordings. All
numbers of a message stand in a row; NaN is for those that are not there.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from rotor_driver import SPEED, rotor_motion

from gear_kinematics.kinematics import Mechanism, matrix_method
from gear_kinematics.wire.batches import decode_joint_states, decode_pose_arrays

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_BOUND = 1e-12  # rad, and of the eccentricity
_NO_STAMP = -1  # ns, of what is no message


class ExpectedMessages(ABC):
    """What has to come on a topic."""

    bounds: Array
    """What the numbers of a message may differ by, (k,)."""

    def __init__(self, mechanism: Mechanism) -> None:
        """Take the mechanism of the node."""
        self._mechanism = mechanism

    @abstractmethod
    def read(self, messages: Sequence[bytes]) -> tuple[Integers, Array]:
        """Give stamps (n,), ns, and numbers (n, k) of messages that came."""

    @abstractmethod
    def expected(self, numbers: Integers) -> Array:
        """Give the numbers (n, k) that answer the driver's messages of these numbers, (n,)."""


class ExpectedOutputState(ExpectedMessages):
    """What has to come on output_state."""

    bounds = _BOUND * np.array([1.0, SPEED, 1.0])

    def read(self, messages: Sequence[bytes]) -> tuple[Integers, Array]:
        """Read the output shaft's position, velocity and effort."""
        return _read_joints(messages, ['output_shaft'])

    def expected(self, numbers: Integers) -> Array:
        """Compute them."""
        position, velocity, effort = rotor_motion(numbers)
        state = matrix_method.solve(self._mechanism, position, velocity)
        effort = float(self._mechanism.gear_ratio) * effort
        return np.column_stack([state.output_angle, state.output_velocity, effort])


class ExpectedJointStates(ExpectedMessages):
    """What has to come on mechanism_joint_states."""

    def __init__(self, mechanism: Mechanism) -> None:
        """Name the joints."""
        super().__init__(mechanism)
        branches = [branch.name for branch in mechanism.branches]
        self._turning = ['rotor', *(f'satellite_{branch}' for branch in branches), 'output_shaft']
        self._sliding = [f'oldham_{branch}' for branch in branches]
        scales = [1.0] * len(self._turning) + [mechanism.eccentricity] * len(self._sliding)
        self.bounds = _BOUND * np.outer(scales, [1.0, SPEED, 1.0]).reshape(-1)

    def read(self, messages: Sequence[bytes]) -> tuple[Integers, Array]:
        """Read every joint's position and velocity."""
        return _read_joints(messages, self._turning + self._sliding)

    def expected(self, numbers: Integers) -> Array:
        """Compute them; there is no effort."""
        position, velocity, _ = rotor_motion(numbers)
        state = matrix_method.solve(self._mechanism, position, velocity)
        on_cam = [(state.output_angle - position, state.output_velocity - velocity)]
        joints = [(position, velocity), *on_cam * len(self._sliding)]
        joints += [(state.output_angle, state.output_velocity)]
        joints += zip(state.satellite_slide.T, state.satellite_slide_velocity.T, strict=True)
        absent = np.full(len(numbers), np.nan)
        return np.column_stack([column for joint in joints for column in (*joint, absent)])


class ExpectedPoses(ExpectedMessages):
    """What has to come on body_poses."""

    def __init__(self, mechanism: Mechanism) -> None:
        """Count the bodies."""
        super().__init__(mechanism)
        self._axial = np.tile([branch.axial_position for branch in mechanism.branches], 2)
        scales = [mechanism.eccentricity] * 3 + [1.0] * 4
        self.bounds = _BOUND * np.tile(scales, len(self._axial))

    def read(self, messages: Sequence[bytes]) -> tuple[Integers, Array]:
        """Read the poses in the frame `stator`."""
        found = decode_pose_arrays(messages, len(self._axial))
        frames = [number for number, name in enumerate(found.frame_ids) if name == b'stator']
        malformed = found.malformed | ~np.isin(found.frame, frames)
        return (
            np.where(malformed, _NO_STAMP, found.stamp),
            found.poses.reshape(len(messages), -1),
        )

    def expected(self, numbers: Integers) -> Array:
        """Compute them."""
        position, _, _ = rotor_motion(numbers)
        state = matrix_method.solve(self._mechanism, position)
        poses = np.zeros((len(numbers), len(self._axial), 7))
        poses[..., :2] = np.concatenate([state.satellite_centre, state.oldham_centre], axis=1)
        poses[..., 2] = self._axial
        half = 0.5 * state.output_turn_angle[:, np.newaxis]
        poses[..., 5], poses[..., 6] = np.sin(half), np.cos(half)
        return poses.reshape(len(numbers), -1)


def _read_joints(messages: Sequence[bytes], names: Sequence[str]) -> tuple[Integers, Array]:
    joints = [decode_joint_states(messages, name) for name in names]
    stamps = np.where(joints[0].malformed, _NO_STAMP, joints[0].stamp)
    return stamps, np.concatenate([joint.values for joint in joints], axis=1)
