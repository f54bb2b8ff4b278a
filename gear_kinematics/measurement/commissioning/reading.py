# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads recordings of a gear of which nothing is known."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from gear_kinematics.bag import Bag, ReportProgress
from gear_kinematics.bag.roles import (
    described,
    find_encoder_topic,
    find_rotor_topic,
    joints_on,
    missing_encoder,
    other_topic,
)
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.analysis import Channel
from gear_kinematics.measurement.commissioning.positions import positions_of
from gear_kinematics.measurement.csv_files import Sources, is_csv
from gear_kinematics.measurement.reading import read_encoders
from gear_kinematics.measurement.recording import Encoders, Recording, RecordingError
from gear_kinematics.parameters import NodeParameters

Read = tuple[Recording, Encoders, Channel, Channel]


def read_positions(
    path: Path,
    sources: Sources,
    joints: Sequence[str | None],
    progress: ReportProgress | None = None,
    likely: Sequence[str] = ('', ''),
) -> Read:
    """Read the positions of both encoders as they were recorded.

    Args:
        path: of a CSV file or a bag.
        sources: what is known of its columns or topics.
        joints: of rotor and output in a bag; None: the only ones on their topics.
        progress: see `read_encoders`.
        likely: joints of rotor and output, which are taken where a topic has them.

    Returns:
        The recording, its encoders, and where the rotor and the output are heard.

    Raises:
        BagError, RecordingError: see `read_encoders`; if topics or joints are missing, or several.
    """
    rotor = output = Channel()
    if not is_csv(path):
        with Bag(path) as bag:
            topics = [find_rotor_topic(bag, sources.rotor_topic, joints[0] or likely[0])]
            encoder = find_encoder_topic(bag, sources.encoder_topic)
            encoder = encoder or other_topic(bag, topics[0], joints[1] or likely[1])
            if not encoder:
                raise RecordingError(f'{path}: {missing_encoder(bag)}')
            topics.append(encoder)
            heard = joints_on(bag, topics)
        sources = replace(sources, rotor_topic=topics[0], encoder_topic=encoder)
        rotor, output = (
            Channel(topic, joint or _only(path, topic, heard[topic], usual, option))
            for topic, joint, usual, option in zip(
                topics, joints, likely, ('--joint', '--encoder-joint'), strict=True
            )
        )
    # With the defaults, positions stay as they are.
    parameters = replace(
        NodeParameters.load(), rotor_joint=rotor.joint, output_encoder_joint=output.joint
    )
    try:
        recording, encoders = read_encoders(path, parameters, sources, progress)
    except RecordingError as error:
        if is_csv(path) and (counts := _counts(path, parameters, sources)):
            raise RecordingError(f'{error}; {counts}') from error
        raise
    return recording, encoders, rotor, output


def _only(path: Path, topic: str, heard: Sequence[str], likely: str, option: str) -> str:
    if likely in heard:
        return likely
    if len(heard) > 1:
        raise RecordingError(
            f'{path}: which joint of {topic}{described(heard)}? Name it with {option}'
        )
    return heard[0] if heard else ''


def _counts(path: Path, parameters: NodeParameters, sources: Sources) -> str:
    """Say how many counts a turn has, where a CSV file lacks nothing else, and wraps show it."""
    given = sources.rotor_counts or 1, sources.output_counts or 1
    sources = replace(sources, rotor_counts=given[0], output_counts=given[1])
    try:
        _, encoders = read_encoders(path, parameters, sources)
    except RecordingError:
        return ''
    motion = encoders.rotor
    sides = {
        'rotor': positions_of(motion.turns + motion.angle / TURN, encoders.rotor_step),
        'output': positions_of(encoders.measured / TURN, encoders.output_step),
    }
    return ', '.join(
        f'{at.evidence}: --{side}-counts {at.turn:.0f}'
        for side, at in sides.items()
        if at.unit == 'counts' and at.turn
    )
