# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Validates the recording of an arm: each actuator by its own joints, and the joined messages.

The actuators of an arm share the messages of rotors and outputs. A `Validator` for each takes the
joints of its actuator from them. What is left to judge is the order of the joints, which of them
belong together in a message, and which fields of it are empty.
"""

import math
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from gear_kinematics.bag import MessagesByTopic, TopicMessages
from gear_kinematics.report.document import worst
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.fields import Array, Occurrences
from gear_kinematics.validation.load_topics import LoadTopic
from gear_kinematics.validation.matching import WINDOW
from gear_kinematics.validation.output_topics import JointStateTopic
from gear_kinematics.validation.report import BagReport, Finding, InputReport
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.batches import FIELDS, JointStateBatch
from gear_kinematics.wire.cdr import SECOND

_Fault = tuple[int | None, FindingCause, str, str]
"""An actuator or none, what is wrong, and with which field and joints."""


class JoinedMessages:
    """Judges which joints the messages of a topic have, in which order, and which empty fields."""

    def __init__(
        self, joints: Mapping[bytes, int], needed: Collection[int], count: int, *, others: bool
    ) -> None:
        """Start without messages.

        `joints` are all that can be in a message, in their order, with the numbers of their
        actuators, of which there are `count`. Those that are `needed` have a joint in a message
        whenever their rotor is valid. Nothing is known of joints of `others`, if there are any.
        """
        self._actuators, self._order, self._others = joints, list(joints), others
        self._all = np.arange(count)
        self._needed = np.isin(self._all, [*needed])
        self._inputs = np.zeros(0, np.int64), np.zeros((count, 0), bool)
        """Stamps of the latest inputs, ns, and which actuators need a joint then, (count, n)."""
        self._waiting = self._inputs  # those of messages whose inputs may be in the next batch
        self._faults: defaultdict[_Fault, Occurrences] = defaultdict(Occurrences)

    def take(self, messages: JointStateBatch, stamps: Array, valid: Array) -> None:
        """Judge the next messages of the topic.

        The next inputs have stamps, ns, (n,), and may be valid for an actuator, (actuators, n).
        """
        needed = self._needed[:, np.newaxis]
        before, sets = (each[..., -WINDOW:] for each in self._inputs)
        self._inputs = np.append(before, stamps), np.hstack([sets, valid & needed])
        at, having = ([each] for each in self._waiting)
        for _, names, stamp, fields in messages.contents():
            if not self._others:
                self._judge(names, stamp, fields)
            there = np.isin(self._all, [self._actuators.get(name, -1) for name in names])
            at.append(stamp)
            having.append(np.tile(needed & there[:, np.newaxis], len(stamp)))
        self._compare(np.concatenate(at), np.hstack(having), waited=len(at[0]))

    def findings(self, topic: str, actuator: int | None = None) -> Iterator[Finding]:
        """Yield what is wrong with the messages as a whole, or with the joints of an actuator."""
        for (of, cause, field, joints), found in self._faults.items():
            if found.count and of == actuator:
                values = {'field': field, 'joints': joints}
                yield Finding(cause, topic, found.first, found.count, values, fails=True)

    def _judge(self, names: Sequence[bytes], stamp: Array, fields: Sequence[Array]) -> None:
        """Judge messages with the same names."""
        places = [self._order.index(name) for name in names if name in self._actuators]
        joints = ', '.join(name.decode(errors='replace') for name in names) or 'none'
        if len(places) < len(names) or not names:
            self._faults[None, FindingCause.OTHER_JOINTS, '', joints].add(stamp)
        elif places != sorted(set(places)):
            self._faults[None, FindingCause.JOINTS_DISORDERED, '', joints].add(stamp)
        for field, values in zip(FIELDS, fields, strict=True):
            if (count := values.shape[1]) not in {0, len(names)}:
                self._faults[None, FindingCause.ARRAY_SIZE, field, joints].add(stamp)
            elif count and field != FIELDS[0]:
                empty = np.flatnonzero(np.isnan(values[:, 0]))
                empty = empty[np.isnan(values[empty]).all(axis=1)]
                self._faults[None, FindingCause.NAN_FOR_ALL, field, joints].add(stamp[empty])

    def _compare(self, stamps: Array, having: Array, waited: int) -> None:
        """Find messages that lack joints of their input and answer no other input."""
        in_stamps, needed = self._inputs
        if (np.diff(in_stamps) < 0).any():
            order = np.argsort(in_stamps, kind='stable')
            in_stamps, needed = in_stamps[order], needed[:, order]
        first, last = (np.searchsorted(in_stamps, stamps, side) for side in ('left', 'right'))
        # One more, for those behind all inputs.
        needed = np.hstack([needed, self._needed[:, np.newaxis]])
        rows = np.flatnonzero((last - first != 1) | (needed[:, first] != having).any(axis=0))
        first, last, stamps, having = (each[..., rows] for each in (first, last, stamps, having))
        waiting = (first == last) & (rows >= waited)
        self._waiting = stamps[waiting], having[:, waiting]
        own = _first_alike(needed, first, last, having, np.equal)
        larger = _first_alike(needed, first, last, having, np.greater_equal)
        lacking = (needed[:, larger] > having) & (own == last) & (larger < last)
        for k in np.flatnonzero(lacking.any(axis=1)).tolist():
            fault = k, FindingCause.JOINT_LEFT_OUT, '', ''
            self._faults[fault].add(stamps[lacking[k]])


def _first_alike(inputs: Array, first: Array, last: Array, sets: Array, alike: np.ufunc) -> Array:
    """Find the first of the inputs from `first` to `last`, (n,), whose set is alike, or `last`.

    Sets of actuators are (actuators, n).
    """
    at = first.copy()
    while (other := (at < last) & ~alike(inputs[:, at], sets).all(axis=0)).any():
        at += other
    return at


class ArmValidator:
    """Validates the actuators of an arm from the same messages."""

    def __init__(self, validators: Sequence[Validator]) -> None:
        self._validators = validators
        self.topics = {topic for each in validators for topic in each.topics}
        """Names of all topics."""
        self._rotor = validators[0].given.rotor
        self._messages = 0
        joints: defaultdict[str, dict[bytes, int]] = defaultdict(dict)
        needed: defaultdict[str, set[int]] = defaultdict(set)
        outputs = {each.output.joints[0]: k for k, each in enumerate(validators)}
        for k, validator in enumerate(validators):
            withholds = validator.task.parameters.unreferenced_outputs == 'withhold'
            for output in validator.outputs:
                if isinstance(output, JointStateTopic):
                    joints[output.name] = outputs
                else:
                    joints[output.name] |= dict.fromkeys(output.joints, k)
                if not (isinstance(output, LoadTopic) or withholds):
                    needed[output.name].add(k)
        count = len(validators)
        others = count < len(validators[0].task.parameters.actuators)
        self._joined = {
            topic: JoinedMessages(of, needed[topic], count, others=others)
            for topic, of in joints.items()
            if of
        }

    def take(self, messages: MessagesByTopic) -> None:
        """Process messages; see `Validator.take`."""
        self._messages += sum(len(of.data) for of in messages.values())
        states = {
            topic: JointStateBatch(messages[topic].data) for topic in (self._rotor, *self._joined)
        }
        for topic, data in states.items():
            received: Any = np.array(messages[topic].received, np.int64)  # once for all
            messages[topic] = TopicMessages(data, received)
        stamps = np.zeros(len(messages[self._rotor].data), np.int64)
        valid = np.zeros((len(self._validators), len(stamps)), bool)
        for rows, _, stamp, _ in states[self._rotor].contents():
            stamps[rows] = stamp
        for k, validator in enumerate(self._validators):
            validator.take(messages)
            valid[k, validator.samples.row] = True
        for topic, joined in self._joined.items():
            joined.take(states[topic], stamps, valid)

    def reports(self, error: str | None, lost: Mapping[str, int]) -> list[BagReport]:
        """Return the report on each actuator; see `Validator.report`."""
        reports = [each.report(error, lost) for each in self._validators]
        last = max(_end(each.rotor) for each in reports)
        found = []
        for k, (validator, report) in enumerate(zip(self._validators, reports, strict=True)):
            parameters, findings = validator.task.parameters, [*self._findings(k)]
            early = last - _end(report.rotor)
            if parameters.input_timeout < early < math.inf:
                values = {'rotor': report.rotor, 'seconds': early}
                findings.append(Finding(FindingCause.STOPPED, values=values))
            found.append(replace(report.adding(*findings), actuator=parameters.actuator))
        return found

    def report(self, task: Task, reports: Sequence[BagReport]) -> BagReport:
        """Return the report on the arm, from those on its actuators."""
        errors: defaultdict[str, list[str]] = defaultdict(list)
        for each in reports:
            if each.error:
                errors[each.error].append(each.actuator)
        named = [
            error if len(of) == len(reports) else f'{", ".join(of)}: {error}'
            for error, of in errors.items()
        ]
        report = BagReport(
            str(task.bag),
            worst(each.verdict for each in reports),
            task.config,
            error='; '.join(named) or None,
            messages=self._messages,
            actuators=tuple(reports),
        )
        return report.adding(*self._findings())

    def _findings(self, actuator: int | None = None) -> Iterator[Finding]:
        for topic, joined in self._joined.items():
            yield from joined.findings(topic, actuator)


def _end(rotor: InputReport | None) -> float:
    """Return the last stamp of a rotor, s; -inf if it is unknown, as after a clock reset."""
    if rotor is None or rotor.first_stamp is None or rotor.resets:
        return -math.inf
    return rotor.first_stamp / SECOND + rotor.duration
