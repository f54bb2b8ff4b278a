# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Validates messages, and finds its way in the report."""

from contextlib import suppress
from pathlib import Path

from gear_kinematics.bag import Message, in_batches
from gear_kinematics.kinematics import solve
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.validation.report import BagReport, FieldReport, TopicReport
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.joint_reader import RejectedInputError


def validate(
    messages: list[Message],
    config: dict,
    *topics,
    further=None,
    solver=solve,
    encoder='',
    **options,
) -> BagReport:
    """Validate messages with the options of a `Task`."""
    task = Task(Path('bag'), config, **options)
    named = {'further': further or {}, 'solver': solver, 'encoder': encoder}
    validator = Validator(task, *topics, **named)
    validator.feed(in_batches(messages, 8192))
    return validator.report()


def with_answers(messages: list[Message], config, answer) -> list[Message]:
    """Add what a node publishes, one message after the other.

    `answer` returns the topics and messages for a sample and the `RotorInput` that accepted it.
    """
    rotor, added = RotorInput(config), []
    for topic, received, data in messages:
        added.append((topic, received, data))
        if topic != '/rotor_state':
            continue
        with suppress(RejectedInputError):
            sample = rotor.accept(data, lambda received=received: received)
            added += ((name, received, message) for name, message in answer(sample, rotor))
    return added


def texts(report: BagReport) -> list[str]:
    return [finding.text for finding in report.findings]


def topic_of(report: BagReport, topic: str) -> TopicReport:
    (found,) = (t for t in report.topics if t.topic == topic)
    return found


def field_of(report: BagReport, topic: str, name: str) -> FieldReport:
    (found,) = (f for f in topic_of(report, topic).fields if f.name == name)
    return found
