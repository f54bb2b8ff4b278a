# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Descriptions of topics."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics.bag.errors import BagError
from gear_kinematics.wire.nearest import listed, nearest


class Topic(NamedTuple):
    """The description of a topic in a bag; a missing text is empty."""

    name: str
    type: str
    """As in ROS 2: sensor_msgs/msg/JointState."""
    encoding: str
    """Encoding of the messages: cdr, or an unsupported one."""
    syntax: str = ''
    """Syntax of the type definition: ros2msg, ros2idl, ros1msg or an unknown one."""
    definition: str = ''
    type_hash: str = ''
    qos: Any = ''
    """The offered QoS profiles, as a list or as YAML."""


def missing_topic(
    path: Path, topics: Mapping[str, str], name: str, wanted: str, *, suggest: bool = True
) -> BagError:
    """Return the error for a topic that is not in a bag, or not of the wanted type ('': any).

    It names what is there, and if that is to be suggested the topic whose name is nearest.
    """
    of_type = {topic for topic, kind in topics.items() if kind == wanted}
    text = f'{path}: no topic {name}' + (f' of type {wanted}' if wanted else '') + ' in it'
    if name in topics:
        text += f', it is of type {topics[name]}'
    elif suggest:
        text += nearest(name, sorted(of_type or topics))
    there = f'there are: {listed(topics, of_type)}' if topics else 'there are no topics'
    return BagError(f'{text}{"" if text.endswith("?") else ";"} {there}')
