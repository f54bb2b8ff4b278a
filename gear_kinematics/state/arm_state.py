# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""All actuators of a node, from its messages to its outputs, without ROS."""

import math
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import lru_cache, partial
from operator import itemgetter

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import labelled
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections
from gear_kinematics.state.statuses import GearReport
from gear_kinematics.wire.cdr import STAMP_BYTES, JointStateTemplate
from gear_kinematics.wire.joint_reader import JointMessage, JointsReader, RejectedInputError
from gear_kinematics.wire.topics import TRANSMISSION_ERROR, topic_of

_NO_STAMP = bytes(8)
_Answered = list[tuple[str, GearState]]  # actuators with a valid joint, and states with results
_Errors = list[tuple[str, Sequence[ErrorSample]]]  # newly known transmission errors by actuator
_Rejections = list[tuple[str, RejectedInputError]]  # why other joints are not valid, by actuator
_Parts = tuple[list[JointStateTemplate], list[float]]  # templates of the parts, and numbers of all


class ArmState:
    """Distributes messages among the actuators of an arm, and joins their outputs.

    A node without `actuators` has one actuator, ''; it publishes what a `GearState` does.
    """

    def __init__(self, actuators: Mapping[str, GearState]) -> None:
        """Take the actuators by name, in the order of the joints in messages."""
        self.actuators = dict(actuators)
        self._in_order = list(self.actuators.items())
        self._single = self.actuators.get('')
        self._learn_joints()

    def apply(
        self, name: str, parameters: NodeParameters, calibration: Calibration | None
    ) -> None:
        """Change the parameters of an actuator; see `GearState.apply`."""
        self.actuators[name].apply(parameters, calibration)
        self._learn_joints()

    def _learn_joints(self) -> None:
        parameters = [state.parameters for state in self.actuators.values()]
        self._rotors = JointsReader(each.rotor_joint for each in parameters)
        self._encoders = JointsReader(each.output_encoder_joint for each in parameters)
        self.finds_turns = any(each.absolute for each in parameters)
        """Whether encoders at the outputs may find the turns of rotors."""

    @property
    def joints(self) -> Collection[str]:
        """Names in the messages of the rotors of several actuators, safe to print."""
        return self._rotors.there

    @property
    def topics(self) -> dict[str, str]:
        """All topics that can be chosen, with their names without the actuator."""
        return {
            topic_of(name, topic): topic
            for name, state in self.actuators.items()
            for topic in state.topics
        }

    def choose(self, topics: Iterable[str]) -> None:
        """Encode messages for these of `topics` from now on; see `GearState.choose`."""
        chosen = set(topics)
        for name, state in self.actuators.items():
            state.choose([topic for topic in state.topics if topic_of(name, topic) in chosen])

    def report(self, now: float, connections: Connections) -> dict[str, GearReport]:
        """Report facts by actuator and subject; see `GearState.report`."""
        return {
            labelled(name, subject): report
            for name, state in self.actuators.items()
            for subject, report in state.report(now, connections).items()
        }

    def rotor(self, data: bytes, now: Callable[[], int]) -> tuple[_Answered, _Rejections]:
        """Process the next message of the rotors; all have the same clock."""
        found, now = self._read(self._rotors, data, now)
        answered: _Answered = []
        rejections: _Rejections = []
        for actuator, message in zip(self._in_order, found, strict=True):
            name, state = actuator
            if message is None:
                state.input.received += 1
                state.input.of_others += 1
                continue
            try:
                state.rotor(message, now)
                answered.append(actuator)
            except RejectedInputError as rejection:
                rejections.append((name, rejection))
        return answered, rejections

    def encoder(self, data: bytes, now: Callable[[], int]) -> tuple[_Errors, _Rejections]:
        """Process the next message of the outputs' encoders."""
        found, now = self._read(self._encoders, data, now)
        errors: _Errors = []
        rejections: _Rejections = []
        for (name, state), message in zip(self._in_order, found, strict=True):
            if message is not None:
                try:
                    errors.append((name, state.encoder(message, now)))
                except RejectedInputError as rejection:
                    rejections.append((name, rejection))
        return errors, rejections

    def _read(
        self, joints: JointsReader, data: bytes, now: Callable[[], int]
    ) -> tuple[Sequence[JointMessage | None], Callable[[], int]]:
        """Read a message for all actuators; returns what each takes, and their common clock."""
        if self._single:
            return [data], now
        if data[STAMP_BYTES] == _NO_STAMP:
            now = partial(int, now())
        try:
            return joints.read(data), now
        except RejectedInputError as rejection:
            return [rejection] * len(self._in_order), now

    def encode(self, answered: _Answered) -> list[tuple[str, bytes]]:
        """Return topic and message of what is published for a message, on the chosen topics.

        A JointState has the joints of all actuators that are answered. A field that none of them
        has is empty; it is NaN for those that lack it.
        """
        if self._single:
            return self._single.encode()
        stamp = answered[0][1].sample.stamp
        joined: dict[str, _Parts] = defaultdict(lambda: ([], []))
        encoded: list[tuple[str, bytes]] = []
        errors: _Errors = []
        for name, state in answered:
            if state.errors:
                errors.append((name, state.errors))
            for topic, template, numbers in state.rows():
                if isinstance(template, JointStateTemplate):
                    templates, given = joined[topic]
                    templates.append(template)
                    given += numbers
                else:
                    encoded.append((topic_of(name, topic), template.encode(stamp, numbers)))
        for topic, parts in joined.items():
            encoded.append((topic, _joined(stamp, parts)))
        return encoded + self.encode_errors(errors) if errors else encoded

    def encode_errors(self, errors: _Errors) -> list[tuple[str, bytes]]:
        """Return topic and message of transmission errors by actuator, one for each stamp."""
        by_stamp: dict[int, _Parts] = defaultdict(lambda: ([], []))
        for name, samples in errors:
            state = self.actuators[name]
            for error in samples if state.errors_chosen else ():
                templates, given = by_stamp[error.stamp]
                templates.append(state.messages.angle)
                given.append(error.error)
        return [
            (TRANSMISSION_ERROR, _joined(stamp, by_stamp[stamp])) for stamp in sorted(by_stamp)
        ]


def _joined(stamp: int, parts: _Parts) -> bytes:
    templates, given = parts
    template, pick = _joined_template(tuple(templates))
    return template.encode(stamp, pick((*given, math.nan)))


@lru_cache(maxsize=1024)
def _joined_template(
    templates: tuple[JointStateTemplate, ...],
) -> tuple[JointStateTemplate, Callable[[Sequence[float]], Sequence[float]]]:
    """Return the template of the joined message, and a function that orders its numbers.

    The function takes the numbers of all templates and then a NaN, which stands for missing ones.
    """
    names = [name for template in templates for name in template.names]
    velocity = any(template.velocity for template in templates)
    effort = any(template.effort for template in templates)
    positions, velocities, efforts = list[int](), list[int](), list[int]()
    total, start = sum(len(template.offsets) for template in templates), 0
    for template in templates:
        count = len(template.names)
        for field, given in (
            (positions, True),
            (velocities, template.velocity),
            (efforts, template.effort),
        ):
            field.extend(range(start, start + count) if given else [total] * count)
            start += count if given else 0
    template = JointStateTemplate(names, velocity=velocity, effort=effort)
    if total == 1:  # of which an itemgetter would give no sequence
        return template, itemgetter(slice(1))
    return template, itemgetter(*positions, *velocity * velocities, *effort * efforts)
