"""The outputs that the node gives for a recorded rotor topic, written to a new bag without ROS."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

from gear_kinematics.bag import Bag, BagError, BagWriter
from gear_kinematics.description import urdf
from gear_kinematics.joint_input import RejectedInputError
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.messages import JOINT_STATE
from gear_kinematics.rotor_input import InputSettings, RotorInput
from gear_kinematics.state_messages import BODY_POSES, OUTPUT_STATE, STATE_TOPICS, StateMessages

_PROGRESS_EVERY = 1000  # messages


@dataclass(frozen=True, slots=True)
class ComputeResult:
    """Numbers of messages."""

    received: int
    """On the rotor topic."""
    computed: int
    """Written on each output topic."""
    rejected: Mapping[str, int]
    """Rotor messages that call for no output, by cause."""
    mostly_rejected: bool
    """Whether more rotor messages were rejected than accepted."""
    zero_stamps: int
    """Rotor messages without a stamp: their outputs have the time of their reception."""
    copied: int
    """On other topics."""


def compute(
    source: Bag,
    target: Path,
    parameters: Mapping[str, Any],
    *,
    rotor_topic: str = '/rotor_state',
    output_topic: str = '/output_state',
    poses_topic: str = '/body_poses',
    storage: Literal['mcap', 'sqlite3'] = 'mcap',
    compression: Literal['none', 'zstd'] = 'none',
    progress: Callable[[int], None] = lambda _: None,
) -> ComputeResult:
    """Copy a bag and add the output topics to it, or replace them.

    Each output comes right after its rotor message and has its time of reception. The same input
    gives the same bytes. Whatever ends this early leaves no target behind.

    Args:
        source: an open bag.
        target: the folder to make.
        parameters: of the node, as `parameters.load` gives them.
        rotor_topic: name of the input in the bag.
        output_topic: name of the node's output_state in the bag.
        poses_topic: name of the node's body_poses in the bag.
        storage: of the target, see `BagWriter`.
        compression: of the target, see `BagWriter`.
        progress: called now and then with the number of messages read.

    Raises:
        BagError: if the source has no such topics, is damaged, or no rotor message of it gives
            an output; and if the target cannot be written.
        ValueError: if the parameters describe no mechanism, or two topics have the same name.
    """
    mechanism = Mechanism.from_mapping(parameters)
    names = {name: parameters[name] for name in ('output_joint', 'frame_prefix')}
    urdf(mechanism, module=parameters['module'], **names)  # refuses the names that the node does
    state_messages = StateMessages(mechanism, **names)
    rotor_input = RotorInput(InputSettings.from_mapping(parameters))
    if len({rotor_topic, output_topic, poses_topic}) < 3:  # noqa: PLR2004
        raise ValueError(f'{rotor_topic}, {output_topic}, {poses_topic}: a name is there twice')
    topic_of = {OUTPUT_STATE: output_topic, BODY_POSES: poses_topic}
    outputs = {topic: STATE_TOPICS[state] for state, topic in topic_of.items()}
    _check_topics(source, {rotor_topic: JOINT_STATE}, outputs)

    computed = copied = 0
    with BagWriter(target, storage=storage, compression=compression) as writer:
        for topic in source.topics:
            if topic not in outputs:
                writer.copy_topic(source, topic)
        for topic, message_type in outputs.items():
            writer.add_topic(topic, message_type)
        count = 0
        for count, (topic, received, data) in enumerate(source.messages(source.topics), start=1):
            if count % _PROGRESS_EVERY == 0:
                progress(count)
            if topic in outputs:
                continue
            writer.write(topic, received, data)
            if topic != rotor_topic:
                copied += 1
                continue
            try:
                sample = rotor_input.accept(data, partial(int, received))
            except RejectedInputError:
                continue
            for state, message in state_messages.encode(sample, topic_of):
                writer.write(topic_of[state], received, message)
            computed += 1
        progress(count)
        if not computed:
            raise BagError(_nothing_computed(source, rotor_topic, rotor_input))
    return ComputeResult(
        rotor_input.received,
        computed,
        dict(rotor_input.rejected),
        rotor_input.mostly_rejected,
        rotor_input.zero_stamps,
        copied,
    )


def _check_topics(source: Bag, needed: Mapping[str, str], replaced: Mapping[str, str]) -> None:
    for topic, message_type in (*needed.items(), *replaced.items()):
        found = source.topics.get(topic)
        if found is None and topic in needed:
            there = ', '.join(sorted(source.topics)) or 'no topics'
            raise BagError(f'{source.path}: no {topic} in it; there are {there}')
        # A topic of another type is somebody else's, not an output of old.
        if found not in {None, message_type}:
            raise BagError(f'{source.path}: {topic} is of type {found}, not {message_type}')


def _nothing_computed(source: Bag, topic: str, rotor_input: RotorInput) -> str:
    if not rotor_input.received:
        return f'{source.path}: no messages on {topic}'
    causes = ', '.join(f'{cause} {count}' for cause, count in rotor_input.rejected.items())
    joint = rotor_input.settings.rotor_joint
    return f'{source.path}: nothing on {topic} is a state of the joint {joint!r}: {causes}'
