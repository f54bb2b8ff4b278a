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
from gear_kinematics.measurement.commissioning.joint import Joint
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
    channels = [Channel(), Channel()]
    if not is_csv(path):
        with Bag(path) as bag:
            rotor = find_rotor_topic(bag, sources.rotor_topic, joints[0] or likely[0])
            output = find_encoder_topic(bag, sources.encoder_topic)
            output = output or other_topic(bag, rotor, joints[1] or likely[1])
            if not output:
                raise RecordingError(f'{path}: {missing_encoder(bag)}')
            sources = replace(sources, rotor_topic=rotor, encoder_topic=output)
            heard = joints_on(bag, [rotor, output])
        channels = [
            Channel(topic, joint or _only(path, topic, heard[topic], usual, option))
            for topic, joint, usual, option in zip(
                (rotor, output), joints, likely, ('--joint', '--encoder-joint'), strict=True
            )
        ]
    parameters = replace(
        NodeParameters.load(),  # the defaults, with which positions stay as they are
        rotor_joint=channels[0].joint,
        output_encoder_joint=channels[-1].joint,
    )
    try:
        recording, encoders = read_encoders(path, parameters, sources, progress)
    except RecordingError as error:
        if counts := _counts(path, parameters, sources):
            raise RecordingError(f'{error}; {counts}') from error
        raise
    return recording, encoders, channels[0], channels[-1]


def _only(path: Path, topic: str, heard: Sequence[str], likely: str, option: str) -> str:
    if likely in heard:
        return likely
    if len(heard) > 1:
        raise RecordingError(
            f'{path}: which joint of {topic}{described(heard)}? Name it with {option}'
        )
    return heard[0] if heard else ''


def _counts(path: Path, parameters: NodeParameters, sources: Sources) -> str:
    """Say how many counts a turn has, if a CSV file lacks nothing but these, and wraps show it."""
    unknown = replace(
        sources,
        rotor_counts=sources.rotor_counts or 1,
        output_counts=sources.output_counts or 1,
    )
    if unknown == sources or not is_csv(path):
        return ''
    try:
        joint = Joint.of(*read_encoders(path, parameters, unknown), unit=TURN)
    except RecordingError:
        return ''
    return ', '.join(
        f'{positions.evidence}: --{role}-counts {positions.turn:.0f}'
        for role, positions, given in (
            ('rotor', joint.rotor, sources.rotor_counts),
            ('output', joint.output, sources.output_counts),
        )
        if positions.unit == 'counts' and positions.turn and not given
    )
