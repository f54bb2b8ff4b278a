"""What a node published, against what it should have published."""

from collections import defaultdict, deque
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import BagMessage
from gear_kinematics.kinematics import Mechanism, MotionState, matrix_method
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.messages import decode_joint_state, decode_pose_array
from gear_kinematics.rotor_input import InputSettings, RejectedInputError, RotorInput, RotorSample

Array = NDArray[np.float64]
_Published = defaultdict[int, deque[tuple[float, ...]]]
"""The numbers of a topic's messages by stamp."""


@dataclass(frozen=True, slots=True)
class TopicValidation:
    """How the messages of one topic compare with the recomputed ones, matched by stamp."""

    topic: str
    compared: int
    missing: int
    extra: int
    worst_angle: float
    """rad."""
    worst_position: float
    """In units of the eccentricity."""

    def agrees(self, tolerance: float) -> bool:
        """Whether nothing is missing or extra and no error exceeds the tolerance."""
        complete = self.compared > 0 and not self.missing and not self.extra
        return complete and self.worst_angle <= tolerance and self.worst_position <= tolerance


@dataclass(frozen=True, slots=True)
class Validation:
    """How a node's outputs compare with those recomputed from its input."""

    received: int
    """Messages on rotor_state."""
    rejected: int
    """Those among them that call for no output."""
    topics: tuple[TopicValidation, ...]

    def agrees(self, tolerance: float) -> bool:
        """Whether every topic agrees."""
        return all(topic.agrees(tolerance) for topic in self.topics)


def validate(messages: Iterable[BagMessage], parameters: Mapping[str, Any]) -> Validation:
    """Recompute the outputs by the matrix method, which the node does not use, and compare.

    Args:
        messages: on /rotor_state, /output_state and /body_poses; each topic in its order.
        parameters: of the node, as `parameters.load` gives them.

    Raises:
        MalformedMessageError: if an output is no message of its type.
    """
    mechanism = Mechanism.from_mapping(parameters)
    rotor_input = RotorInput(InputSettings.from_mapping(parameters))
    samples: list[RotorSample] = []
    output_states: _Published = defaultdict(deque)
    body_poses: _Published = defaultdict(deque)
    for topic, received, data in messages:
        if topic == '/output_state':
            output_state = decode_joint_state(data)
            output_states[output_state.stamp].append(output_state.position)
        elif topic == '/body_poses':
            poses = decode_pose_array(data)
            body_poses[poses.stamp].append(poses.numbers)
        else:
            with suppress(RejectedInputError):
                samples.append(rotor_input.accept(data, partial(int, received)))

    rotor_angles = [TURN * sample.position.turns + sample.position.angle for sample in samples]
    expected = matrix_method.solve(mechanism, rotor_angles)
    stamps = [sample.stamp for sample in samples]
    return Validation(
        rotor_input.received,
        rotor_input.rejected.total(),
        (
            _output_state(stamps, output_states, expected),
            _body_poses(stamps, body_poses, expected, mechanism),
        ),
    )


def _output_state(stamps: list[int], found: _Published, state: MotionState) -> TopicValidation:
    rows, numbers = _match(stamps, found, width=1)
    errors = np.abs(numbers[:, 0] - state.output_angle[rows])
    return _topic('/output_state', stamps, found, errors, np.zeros(len(rows)))


def _body_poses(
    stamps: list[int], found: _Published, state: MotionState, mechanism: Mechanism
) -> TopicValidation:
    branches = len(mechanism.branches)
    rows, numbers = _match(stamps, found, width=14 * branches)
    poses = numbers.reshape(len(rows), 2 * branches, 7)
    position, quaternion = np.zeros((*poses.shape[:2], 3)), np.zeros((*poses.shape[:2], 4))
    position[:, :branches, :2] = state.satellite_centre[rows]
    position[:, branches:, :2] = state.oldham_centre[rows]
    position[..., 2] = [branch.axial_position for branch in mechanism.branches] * 2
    quaternion[..., 2] = np.sin(0.5 * state.output_angle[rows, np.newaxis])
    quaternion[..., 3] = np.cos(0.5 * state.output_angle[rows, np.newaxis])
    # A quaternion and its negative are the same rotation.
    distances = [np.abs(poses[..., 3:] - sign * quaternion).max(axis=-1) for sign in (1.0, -1.0)]
    return _topic(
        '/body_poses',
        stamps,
        found,
        2.0 * np.minimum(*distances),
        np.abs(poses[..., :3] - position) / mechanism.eccentricity,
    )


def _match(stamps: list[int], found: _Published, width: int) -> tuple[list[int], Array]:
    """Take out what was published at each stamp: the rows of the stamps, and the numbers."""
    rows = []
    numbers = []
    for row, stamp in enumerate(stamps):
        if found[stamp]:
            rows.append(row)
            numbers.append(found[stamp].popleft())
    return rows, np.reshape(numbers, (len(rows), width))


def _topic(
    topic: str, stamps: list[int], left: _Published, angle_errors: Array, position_errors: Array
) -> TopicValidation:
    return TopicValidation(
        topic,
        compared=len(angle_errors),
        missing=len(stamps) - len(angle_errors),
        extra=sum(map(len, left.values())),
        worst_angle=float(np.max(angle_errors, initial=0.0)),
        worst_position=float(np.max(position_errors, initial=0.0)),
    )
