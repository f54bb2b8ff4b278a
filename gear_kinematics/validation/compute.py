# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compute the node's outputs for a recorded rotor topic into a new bag, without ROS."""

from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress, TopicError
from gear_kinematics.bag.roles import Topics, beside
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.corrector import Correction, Corrector
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.loads import Loads
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.rotor_samples import RotorSamples
from gear_kinematics.state.state_messages import state_messages
from gear_kinematics.state.turn_reference import TurnReference
from gear_kinematics.wire.joint_reader import RejectedInputError
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
    """What was computed, from which messages."""

    rotor_input: RotorInput
    """Has counted the messages on the rotor topic, and those that were rejected."""
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
        calibration: of the gear, to compute CORRECTED_TOPICS beside the topic of the output.
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

    messages_of = state_messages(parameters)
    rotor_input, rotor_topic = RotorInput(parameters), topics.rotor
    topic_of = {OUTPUT_STATE: topics.output, BODY_POSES: topics.poses}
    topic_of = {state: topic_of[state] for state in topic_of if state in messages_of.topics}
    corrector = None
    if calibration:
        corrector = Corrector(calibration, parameters.max_rotor_acceleration)
        topic_of |= beside(CORRECTED_TOPICS, topics.output)
    encoder = OutputEncoder(parameters, TurnReference(rotor_input))
    loads = Loads(parameters) if parameters.preload else None
    if loads:
        topic_of |= beside(LOAD_TOPICS, topics.output)
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
            messages, correction = [each for each in batch if each[0] not in outputs], None
            rotor = [place for place, (topic, *_) in enumerate(messages) if topic == rotor_topic]
            if encoder_topic:
                samples, correction = _referenced(
                    messages, rotor_topic, encoder_topic, rotor_input, encoder, corrector
                )
                answered = samples.row.tolist()
            else:
                samples = rotor_input.accept_batch(
                    [messages[place][2] for place in rotor],
                    [messages[place][1] for place in rotor],
                )
                answered = [rotor[row] for row in samples.row.tolist()]
            computed += len(answered)
            copied += len(messages) - len(rotor)
            encoded_outputs = messages_of.encode_outputs(samples)
            if corrector:
                correction = correction or corrector.correct_batch(
                    *samples[:5], samples.segment, referenced=rotor_input.referenced
                )
                encoded_outputs |= messages_of.encode_corrections(samples, correction)
            if loads:
                encoded_outputs |= loads.encode_batch(samples.stamp, loads.follow_batch(samples))
            # A stable sort by these puts each output directly after its rotor message.
            places, received = [*range(len(messages))], [messages[place][1] for place in answered]
            for state, encoded in encoded_outputs.items():
                known = [k for k, data in enumerate(encoded) if data]
                places += [answered[k] for k in known]
                messages += [(topic_of[state], received[k], encoded[k]) for k in known]
            writer.write_all([messages[k] for k in np.argsort(places, kind='stable').tolist()])
        if not computed:
            raise BagError(_nothing_computed(source, rotor_topic, rotor_input))
    return ComputeResult(
        rotor_input,
        computed,
        copied,
        left_out=tuple(sorted(source.topics.keys() - {*kept, *outputs})),
    )


def _referenced(
    messages: Sequence[Message],
    rotor_topic: str,
    encoder_topic: str,
    rotor: RotorInput,
    encoder: OutputEncoder,
    corrector: Corrector | None,
) -> tuple[RotorSamples, Correction | None]:
    """Take messages of both encoders one by one, as the node does; rows are those of messages."""
    rows, corrections = [], []
    for row, (topic, received, data) in enumerate(messages):
        with suppress(RejectedInputError):  # which is counted
            if topic == encoder_topic:
                encoder.accept(data, partial(int, received))
            if topic != rotor_topic:
                continue
            sample, correction = rotor.accept(data, partial(int, received)), None
            motion = *sample.position, sample.velocity, sample.effort
            rows.append((sample.stamp, *motion, row, received, rotor.segment))
            if corrector:
                correction = corrector.correct(
                    sample, segment=rotor.segment, referenced=rotor.referenced
                )
                corrections.append(correction)
            if encoder.received:
                encoder.follow(sample, correction)
    columns = np.array(corrections, float).reshape(-1, len(Correction._fields)).T
    return RotorSamples.of(rows, np.zeros(0, np.int64)), Correction(*columns)


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
