# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compute the node's outputs for a recorded rotor topic into a new bag, without ROS."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np

from gear_kinematics.bag import Bag, BagError, ReportProgress, TopicError
from gear_kinematics.bag.roles import Topics, in_namespace
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.topics import (
    BODY_POSES,
    CORRECTED_TOPICS,
    JOINT_STATE,
    LOAD_TOPICS,
    OUTPUT_STATE,
    TOPICS,
)

_TOPICS = Topics()


@dataclass(frozen=True, slots=True)
class ComputeResult:
    """Numbers of messages that were computed and copied."""

    rotor_input: RotorInput
    """Input that has counted the messages on the rotor's topic, and the rejected ones."""
    computed: int
    """Messages written on each output topic."""
    copied: int
    """Messages copied from other topics."""
    left_out: tuple[str, ...]
    """Topics that were not copied: those not chosen, and those that a rosbag2 cannot hold."""


def compute(
    source: Bag,
    target: Path,
    parameters: NodeParameters,
    *,
    topics: Topics = _TOPICS,
    encoder_topic: str = '',
    calibration: Calibration | None = None,
    others: Collection[str] | None = None,
    files: Mapping[str, bytes] = MappingProxyType({}),
    storage: Literal['mcap', 'sqlite3'] = 'mcap',
    compression: Literal['none', 'zstd'] = 'none',
    progress: ReportProgress | None = None,
) -> ComputeResult:
    """Copy a bag and add or replace the output topics: `output_state` alone with `gear_ratio`.

    With a preload, the loads are outputs too.

    Each output directly follows its rotor message and has its time of reception. The same input
    gives the same bytes. From mcap to mcap, copies keep their times of publication. If this fails
    or is interrupted, no target is left.

    Where an output encoder references the rotor's count, outputs are those of the node: before the
    reference those of the nearest turn, or of the configured zero, and referenced from then on.

    Args:
        source: an open bag.
        target: the folder to create.
        parameters: of the node.
        topics: names of the input and the node's outputs in the bag.
        encoder_topic: name of the output encoder in the bag, if it references the rotor; it is
            copied too.
        calibration: of the gear, to compute CORRECTED_TOPICS in the namespace of the output.
        others: other topics to copy; None copies all.
        files: contents of further files of the target, by name.
        storage: of the target, see `BagWriter`.
        compression: of the target, see `BagWriter`.
        progress: called after each batch; the total counts all topics of the bag.

    Raises:
        BagError: if the source lacks a topic, is damaged or has no valid rotor message, or if the
            target cannot be written.
        ValueError: if the parameters are invalid, or two topics have the same name.
    """
    from gear_kinematics.bag.writing import BagWriter  # noqa: PLC0415, needs an extra

    gear, rotor_topic = GearState(parameters, calibration), topics.rotor
    topic_of = {OUTPUT_STATE: topics.output, BODY_POSES: topics.poses}
    topic_of = {state: topic_of[state] for state in topic_of if state in gear.topics}
    if calibration:
        topic_of |= in_namespace(CORRECTED_TOPICS, topics.output)
    if parameters.preload:
        topic_of |= in_namespace(LOAD_TOPICS, topics.output)
    gear.choose(topic_of)
    if len(set(all_names := (rotor_topic, *topic_of.values()))) < len(all_names):
        raise ValueError(f'{", ".join(all_names)}: the names must differ')
    outputs = {topic: TOPICS[name].type for name, topic in topic_of.items()}
    inputs = {rotor_topic, encoder_topic} if encoder_topic else {rotor_topic}
    chosen = {*inputs, *(source.topics if others is None else others)}
    _check_topics(source, rotor_topic, chosen, outputs)
    kept, computed, copied = list[str](), 0, 0
    with BagWriter(target, storage=storage, compression=compression) as writer:
        for name, content in files.items():
            writer.add_file(name, content)
        for topic in source.topics:
            if topic not in chosen or topic in outputs:
                continue
            try:
                writer.copy_topic(source, topic)
            except TopicError:
                if topic in inputs:
                    raise
            else:
                kept.append(topic)
        for topic, message_type in outputs.items():
            writer.add_topic(topic, message_type)
        for batch in source.batches({*kept, *outputs}, progress, publish_times=True):
            messages = [message for message in batch if message[0] not in outputs]
            answers = gear.batch(messages, rotor_topic, encoder_topic)
            answered = answers.samples.row.tolist()
            computed += len(answered)
            copied += sum(topic != rotor_topic for topic, *_ in messages)
            # A stable sort by these puts each output directly after its rotor message.
            places, received = [*range(len(messages))], [messages[place][1] for place in answered]
            for state, encoded in gear.encode_batch(answers).items():
                known = [k for k, data in enumerate(encoded) if data]
                places += [answered[k] for k in known]
                messages += [(topic_of[state], received[k], encoded[k]) for k in known]
            writer.write_all([messages[k] for k in np.argsort(places, kind='stable').tolist()])
        if not computed:
            raise BagError(_nothing_computed(source, rotor_topic, gear.input))
    return ComputeResult(
        gear.input,
        computed,
        copied,
        left_out=tuple(sorted(source.topics.keys() - {*kept, *outputs})),
    )


def _check_topics(
    source: Bag, rotor: str, needed: Collection[str], outputs: Mapping[str, str]
) -> None:
    source.type_of(rotor, JOINT_STATE)
    for topic in sorted(needed):
        source.type_of(topic)
    for topic, message_type in outputs.items():
        # A topic of another type is not an earlier output, and must not be replaced.
        found = source.topics.get(topic, message_type)
        if found != message_type:
            raise BagError(f'{source.path}: {topic} is of type {found}, not {message_type}')


def _nothing_computed(source: Bag, topic: str, rotor_input: RotorInput) -> str:
    if not rotor_input.received:
        return f'{source.path}: no messages on {topic}'
    joint, why = rotor_input.parameters.rotor_joint, rotor_input.why_rejected
    return f'{source.path}: no valid state of the joint {joint!r} on {topic}: {why}'
