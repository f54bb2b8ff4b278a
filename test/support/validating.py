# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Validates messages, and finds its way in the report."""

from collections.abc import Iterable
from pathlib import Path

from gear_kinematics.bag import Message, MessagesByTopic
from gear_kinematics.validation.arm import ArmValidator
from gear_kinematics.validation.findings import sentence
from gear_kinematics.validation.report import BagReport, FieldReport, TopicReport
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator


def validate(
    messages: list[Message], config: dict, *topics, further=None, encoder='', **options
) -> BagReport:
    """Validate messages with the options of a `Task`."""
    task = Task(Path('bag'), config, **options)
    named = {'further': further or {}, 'encoder': encoder}
    validator = Validator(task, *topics, **named)
    feed(validator, messages, 8192)
    return validator.report()


def feed(validator: Validator | ArmValidator, messages: Iterable[Message], size: int) -> None:
    """Feed messages to a validator in batches of a size."""
    every = [*messages]
    for begin in range(0, len(every), size):
        validator.take(MessagesByTopic(validator.topics, every[begin : begin + size]))


def texts(report: BagReport) -> list[str]:
    return [sentence(finding) for finding in report.findings]


def topic_of(report: BagReport, topic: str) -> TopicReport:
    (found,) = (t for t in report.topics if t.topic == topic)
    return found


def field_of(report: BagReport, topic: str, name: str) -> FieldReport:
    (found,) = (f for f in topic_of(report, topic).fields if f.name == name)
    return found
