"""Descriptions of topics, and the definitions of their types."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rosbags.typesys import Stores, get_typestore

from gear_kinematics.bag.errors import BagError
from gear_kinematics.bag.ros1_types import ros1_types
from gear_kinematics.wire.nearest import listed, nearest


class Topic(NamedTuple):
    """The description of a topic in a bag; a missing text is empty."""

    name: str
    type: str
    """As in ROS 2: sensor_msgs/msg/JointState."""
    encoding: str
    """Encoding of the messages: cdr, or an unsupported one."""
    syntax: str = ''
    """Syntax of the type definition: ros2msg, ros2idl, ros1msg or one unknown to rosbags."""
    definition: str = ''
    type_hash: str = ''
    qos: Any = ''
    """The offered QoS profiles, as a list or as YAML."""


def missing_topic(
    path: Path, topics: Mapping[str, str], name: str, wanted: str, *, suggest: bool = True
) -> BagError:
    """Return the error for a topic that is not in a bag, or not of the wanted type.

    Args:
        path: path of the bag.
        topics: its topics, types by name.
        name: name of the topic.
        wanted: its type; '' for any.
        suggest: whether to name the topic whose name is nearest.
    """
    of_type = {topic for topic, kind in topics.items() if kind == wanted}
    text = f'{path}: no topic {name}' + (f' of type {wanted}' if wanted else '') + ' in it'
    if name in topics:
        text += f', it is of type {topics[name]}'
    elif suggest:
        text += nearest(name, sorted(of_type or topics))
    there = f'there are: {listed(topics, of_type)}' if topics else 'there are no topics'
    return BagError(f'{text}{"" if text.endswith("?") else ";"} {there}')


def jazzy_definition(message_type: str) -> tuple[str, str]:
    """Return the definition and the hash of a type of ROS 2 Jazzy."""
    store = get_typestore(Stores.ROS2_JAZZY)
    if message_type not in store.fielddefs:
        raise ValueError(f'type {message_type} is not of ROS 2 Jazzy and needs a definition')
    return store.generate_msgdef(message_type, ros_version=2)[0], store.hash_rihs01(message_type)


def as_ros2(topic: Topic) -> Topic:
    """Return a topic as ROS 2 records it; with the name of the type alone if it is undefined.

    Raises:
        ValueError: if the type is defined in a syntax that ROS 2 does not have.
    """
    if topic.syntax == 'ros1msg':
        store, _ = ros1_types(topic.type, topic.definition)
        definition, _ = store.generate_msgdef(topic.type, ros_version=2)
        type_hash = store.hash_rihs01(topic.type)
    elif not topic.definition and topic.type in get_typestore(Stores.ROS2_JAZZY).fielddefs:
        definition, type_hash = jazzy_definition(topic.type)
    elif topic.syntax in {'ros2msg', 'ros2idl'}:
        return topic
    elif topic.definition:
        raise ValueError(f'its type is defined in unknown {topic.syntax!r}')
    else:
        return topic._replace(syntax='')
    return topic._replace(
        syntax='ros2msg', definition=definition, type_hash=topic.type_hash or type_hash
    )
