# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Computes the node's outputs for a recorded rotor topic into a new bag, without ROS."""

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress, TopicError
from gear_kinematics.bag.roles import Topics, find_in_namespace, in_namespace
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import counted
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.state.turn_reference import farthest_outside
from gear_kinematics.validation.input_health import MANY_REPEATED
from gear_kinematics.wire.batches import join_joint_states
from gear_kinematics.wire.topics import (
    BODY_POSES,
    CORRECTED_TOPICS,
    JOINT_STATE,
    LOAD_TOPICS,
    OUTPUT_STATE,
    STATE_TOPICS,
    TOPICS,
    TRANSMISSION_ERROR,
    base_name,
    topic_of,
)

_TOPICS = Topics()
_OUTPUTS = *STATE_TOPICS, *CORRECTED_TOPICS, TRANSMISSION_ERROR, *LOAD_TOPICS


@dataclass(frozen=True, slots=True)
class ComputeResult:
    """What was computed and copied, and what makes the outputs doubtful."""

    inputs: Mapping[str, RotorInput]  # by actuator, with counts of the rotor's messages
    computed: int  # messages written on each output topic
    copied: int  # messages copied from other topics
    doubts: Mapping[str, Sequence[Fact]]  # by actuator: what seems wrong with its input
    left_out: tuple[str, ...]  # topics not copied: not chosen, or not possible in a rosbag2


def compute(
    source: Bag,
    target: Path,
    actuators: Mapping[str, NodeParameters],
    *,
    topics: Topics = _TOPICS,
    encoder_topic: str = '',
    calibrations: Mapping[str, Calibration | None] = MappingProxyType({}),
    others: Collection[str] | None = None,
    files: Mapping[str, bytes] = MappingProxyType({}),
    storage: Literal['mcap', 'sqlite3'] = 'mcap',
    compression: Literal['none', 'zstd'] = 'none',
    progress: ReportProgress | None = None,
) -> ComputeResult:
    """Copy an open bag to a new folder, and add or replace the topics that the node publishes.

    The actuators are given by name, '' for one gear. They have the topics that the node gives
    them: only `output_state` if just the ratio is known, the loads with a preload, and
    CORRECTED_TOPICS with a calibration. Of the other topics, those in `others` are copied, or all
    but outputs of the node that are not computed, such as the transmission error; an
    `encoder_topic` that references the rotor always is. `files` are contents by name.

    Each output follows its rotor message, with the same time of reception. Until the output's
    encoder references the rotor, outputs are those of the nearest turn or the configured zero, as
    in the node. The same input gives the same bytes; from mcap to mcap, copies keep their times of
    publication. If this fails or is interrupted, no target is left.

    Raises:
        BagError: if the source lacks a topic, is damaged or has no valid rotor message, or if the
            target cannot be written.
        ValueError: if the parameters are invalid, or two topics have the same name.
    """
    from gear_kinematics.bag.writing import BagWriter  # noqa: PLC0415, needs an extra

    gears = {name: GearState(each, calibrations.get(name)) for name, each in actuators.items()}
    inputs_of = {name: gear.input for name, gear in gears.items()}
    rotor_topic = topics.rotor
    names = _choose(gears, topics)
    all_names = [rotor_topic, *names.values()]
    if len(set(all_names)) < len(all_names):
        raise ValueError(f'{", ".join(all_names)}: the names must differ')
    outputs = {topic: TOPICS[base_name(name)].type for name, topic in names.items()}
    inputs = {rotor_topic, encoder_topic} if encoder_topic else {rotor_topic}
    if others is None:  # further outputs of the earlier node would contradict the new ones
        earlier = (topic_of(name, topic) for name in ('', *gears) for topic in _OUTPUTS)
        others = source.topics.keys() - find_in_namespace(source, earlier, topics.output).values()
    chosen = {*inputs, *others}
    _check_topics(source, rotor_topic, chosen, outputs)
    kept, computed, copied = list[str](), 0, 0
    outside = dict[str, Fact | None].fromkeys(gears)
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
            copied += sum(topic != rotor_topic for topic, *_ in messages)
            answers = _answers(gears, messages, rotor_topic, encoder_topic, outside)
            computed += len(answers[OUTPUT_STATE])
            # A stable sort by these puts each output directly after its rotor message.
            places, received = [*range(len(messages))], [message[1] for message in messages]
            for name, found in answers.items():
                places += found
                messages += [(names[name], received[place], found[place]) for place in found]
            writer.write_all([messages[k] for k in np.argsort(places, kind='stable').tolist()])
        if not computed:
            raise BagError(_nothing_computed(source, rotor_topic, [*inputs_of.values()]))
    return ComputeResult(
        inputs_of,
        computed,
        copied,
        {name: _doubts(each, outside[name]) for name, each in inputs_of.items()},
        left_out=tuple(sorted(source.topics.keys() - {*kept, *outputs})),
    )


def _choose(gears: Mapping[str, GearState], topics: Topics) -> dict[str, str]:
    """Choose topics that the gears encode; return their names in the bag by name in the node."""
    given = {OUTPUT_STATE: topics.output, BODY_POSES: topics.poses}
    names: dict[str, str] = {}
    for actuator, gear in gears.items():
        chosen = [state for state in given if state in gear.topics]
        if gear.calibration:
            chosen += CORRECTED_TOPICS
        if gear.parameters.preload:
            chosen += LOAD_TOPICS
        gear.choose(chosen)
        names |= in_namespace((topic_of(actuator, state) for state in chosen), topics.output)
    return names | {name: topic for name, topic in given.items() if name in names}


def _answers(
    gears: Mapping[str, GearState],
    messages: Sequence[Message],
    rotor: str,
    encoder: str,
    outside: dict[str, Fact | None],
) -> dict[str, dict[int, bytes]]:
    """Return outputs by name in the node and row of the input.

    Sets the first angles `outside` of their ranges.
    """
    found = defaultdict[str, list[dict[int, bytes]]](list)
    for actuator, gear in gears.items():
        answers = gear.batch(messages, rotor, encoder)
        samples = answers.samples
        outside[actuator] = outside[actuator] or farthest_outside(
            gear.parameters, samples.turns, samples.angle, samples.referenced
        )
        for state, encoded in gear.encode_batch(answers).items():
            rows = zip(samples.row.tolist(), encoded, strict=True)
            found[topic_of(actuator, state)].append({row: data for row, data in rows if data})
    joined = {}
    for name, parts in found.items():
        places = sorted({place for part in parts for place in part})
        columns = [[part.get(place, b'') for place in places] for part in parts]
        data = columns[0] if len(columns) == 1 else join_joint_states(columns)
        joined[name] = dict(zip(places, data, strict=True))
    return joined


def _doubts(rotor: RotorInput, outside: Fact | None) -> list[Fact]:
    """Return what seems wrong with an input, by its state at the end."""
    unstamped = Condition.UNSTAMPED(messages=counted(rotor.zero_stamps, 'message'))
    repeated = Condition.REPEATED_STAMPS(count=rotor.duplicates)
    doubts = (
        rotor.why_lost,
        rotor.plausibility.beyond_limits,
        rotor.disorder.fault,
        unstamped if rotor.zero_stamps else None,
        repeated if rotor.duplicates > MANY_REPEATED * rotor.received else None,
        rotor.velocity_field.in_recording,
        rotor.effort_field.doubt,
        outside,
        None if rotor.referenced else Condition.UNREFERENCED_AT_END(),
    )
    return [doubt for doubt in doubts if doubt]


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


def _nothing_computed(source: Bag, topic: str, inputs: Sequence[RotorInput]) -> str:
    if not inputs[0].received:
        return f'{source.path}: no messages on {topic}'
    states = [
        f'of the joint {each.parameters.rotor_joint!r} on {topic}: {each.why_rejected}'
        for each in inputs
    ]
    return f'{source.path}: no valid state {"; ".join(states)}'
