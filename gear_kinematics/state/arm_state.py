# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""All actuators of a node, from its messages to its outputs, without ROS."""

import math
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import lru_cache, partial
from typing import TypeVar

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import labelled
from gear_kinematics.state.gear_state import GearState, RotorAnswer
from gear_kinematics.state.monitors import Connections
from gear_kinematics.state.statuses import GearReport
from gear_kinematics.wire.cdr import STAMP_BYTES, JointStateTemplate
from gear_kinematics.wire.joint_reader import JointMessage, JointsReader, RejectedInputError
from gear_kinematics.wire.topics import TRANSMISSION_ERROR, topic_of

_NO_STAMP = bytes(8)
_Answer = TypeVar('_Answer')
_Row = tuple[JointStateTemplate, Sequence[float]]
_Take = Callable[[GearState, JointMessage, Callable[[], int]], _Answer]
_Taken = list[tuple[str, _Answer | RejectedInputError]]
"""What came of a message, by actuator, for those whose joint was in it."""


class ArmState:
    """Distributes messages among the actuators of an arm, and joins what they publish.

    A node without `actuators` has one actuator, ''; it publishes what a `GearState` does.
    """

    def __init__(self, actuators: Mapping[str, GearState]) -> None:
        """Take the actuators by name, in the order of the joints in messages."""
        self.actuators = dict(actuators)
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

    @property
    def joints(self) -> Collection[str]:
        """Names in the messages of the rotors of several actuators, safe to print."""
        return self._rotors.there

    @property
    def topics(self) -> dict[str, str]:
        """All topics that can be chosen, and their names without that of an actuator."""
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

    def rotor(self, data: bytes, now: Callable[[], int]) -> _Taken[RotorAnswer]:
        """Process the next message of the rotors; all have the same clock."""
        return self._take(data, now, self._rotors, GearState.rotor)

    def encoder(self, data: bytes, now: Callable[[], int]) -> _Taken[Sequence[ErrorSample]]:
        """Process the next message of the outputs' encoders."""
        return self._take(data, now, self._encoders, GearState.encoder)

    def _take(
        self, data: bytes, now: Callable[[], int], joints: JointsReader, take: _Take[_Answer]
    ) -> _Taken[_Answer]:
        if self._single:
            try:
                return [('', take(self._single, data, now))]
            except RejectedInputError as rejection:
                return [('', rejection)]
        if data[STAMP_BYTES] == _NO_STAMP:
            now = partial(int, now())  # all joints get the same
        found: Sequence[JointMessage | None]
        try:
            found = joints.read(data)
        except RejectedInputError as rejection:
            found = [rejection] * len(self.actuators)
        taken: _Taken[_Answer] = []
        for (name, state), values in zip(self.actuators.items(), found, strict=True):
            if values is not None:
                try:
                    taken.append((name, take(state, values, now)))
                except RejectedInputError as rejection:
                    taken.append((name, rejection))
            elif joints is self._rotors:
                state.input.received += 1
                state.input.of_others += 1
        return taken

    def encode(self, answers: Sequence[tuple[str, RotorAnswer]]) -> list[tuple[str, bytes]]:
        """Return topic and message of what is published for a message, on the chosen topics.

        A JointState has the joints of all answers: a field that none has is empty, and NaN where
        one lacks it.
        """
        if self._single:
            return self._single.encode(answers[0][1])
        joined: dict[str, list[_Row]] = defaultdict(list)
        encoded: list[tuple[str, bytes]] = []
        for name, answer in answers:
            for topic, template, numbers in self.actuators[name].rows(answer):
                if isinstance(template, JointStateTemplate):
                    joined[topic].append((template, numbers))
                else:
                    message = template.encode(answer.sample.stamp, numbers)
                    encoded.append((topic_of(name, topic), message))
        for topic, rows in joined.items():
            encoded.append((topic, _joined(answers[0][1].sample.stamp, rows)))
        errors = [(name, answer.errors) for name, answer in answers if answer.errors]
        return encoded + self.encode_errors(errors) if errors else encoded

    def encode_errors(
        self, errors: Iterable[tuple[str, Sequence[ErrorSample]]]
    ) -> list[tuple[str, bytes]]:
        """Return topic and message of transmission errors by actuator, one for each stamp."""
        by_stamp: dict[int, list[_Row]] = defaultdict(list)
        for name, samples in errors:
            state = self.actuators[name]
            for error in samples if state.errors_chosen else ():
                by_stamp[error.stamp].append((state.messages.angle, [error.error]))
        return [
            (TRANSMISSION_ERROR, _joined(stamp, by_stamp[stamp])) for stamp in sorted(by_stamp)
        ]


def _joined(stamp: int, rows: Sequence[_Row]) -> bytes:
    """Encode a JointState with the joints of several."""
    template, places = _joined_template(tuple([template for template, _ in rows]))
    given: list[float] = []
    for _, numbers in rows:
        given += numbers
    given.append(math.nan)
    return template.encode(stamp, [given[place] for place in places])


@lru_cache(maxsize=1024)
def _joined_template(
    templates: tuple[JointStateTemplate, ...],
) -> tuple[JointStateTemplate, list[int]]:
    """Return the template of the joined message, and the places of its numbers.

    A place is an index in the numbers of all templates; NaN, for what one lacks, follows them.
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
    places = positions + velocity * velocities + effort * efforts
    return JointStateTemplate(names, velocity=velocity, effort=effort), places
