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
from gear_kinematics.measurement.commissioning.analysis import Channel
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
) -> Read:
    """Read the positions of both encoders as they were recorded.

    Args:
        path: of a CSV file or a bag.
        sources: what is known of its columns or topics.
        joints: of rotor and output in a bag; None: the only ones on their topics.
        progress: see `read_encoders`.

    Returns:
        The recording, its encoders, and where the rotor and the output are heard.

    Raises:
        BagError, RecordingError: see `read_encoders`; if topics or joints are missing, or several.
    """
    rotor = output = Channel()
    if not is_csv(path):
        with Bag(path) as bag:
            topics = [find_rotor_topic(bag, sources.rotor_topic, joints[0] or '')]
            encoder = find_encoder_topic(bag, topics[0], sources.encoder_topic)
            encoder = encoder or other_topic(bag, topics[0], joints[1] or '')
            if not encoder:
                raise RecordingError(f'{path}: {missing_encoder(bag)}')
            topics.append(encoder)
            heard = joints_on(bag, topics)
        sources = replace(sources, rotor_topic=topics[0], encoder_topic=encoder)
        rotor, output = (
            Channel(topic, joint or _only(path, topic, heard[topic], option))
            for topic, joint, option in zip(
                topics, joints, ('--joint', '--encoder-joint'), strict=True
            )
        )
    # With the defaults, positions stay as they are.
    parameters = replace(
        NodeParameters.load(), rotor_joint=rotor.joint, output_encoder_joint=output.joint
    )
    recording, encoders = read_encoders(
        path, parameters, replace(sources, raw_counts=True), progress
    )
    return recording, encoders, rotor, output


def _only(path: Path, topic: str, heard: Sequence[str], option: str) -> str:
    if len(heard) > 1:
        raise RecordingError(
            f'{path}: which joint of {topic}{described(heard)}? Name it with {option}'
        )
    return heard[0] if heard else ''
