"""Topics: what a bag says about them, and the definitions of their types."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

TOPIC_TYPES: Mapping[str, str] = {
    '/rotor_state': 'sensor_msgs/msg/JointState',
    '/output_state': 'sensor_msgs/msg/JointState',
    '/body_poses': 'geometry_msgs/msg/PoseArray',
}
"""The topics of a recording, by their names in the root namespace."""

_IDL_FILE = f'{"=" * 80}\nIDL: '


class Topic(NamedTuple):
    """What a bag says about a topic; a text that it lacks is empty."""

    name: str
    type: str
    """As in ROS 2: sensor_msgs/msg/JointState."""
    encoding: str
    """Of the messages: cdr, or something that is of no use here."""
    syntax: str = ''
    """Of the type definition: ros2msg, ros2idl, ros1msg or unknown to rosbags."""
    definition: str = ''
    type_hash: str = ''
    qos: Any = ''
    """The offered profiles, as a list or as YAML."""


def check_encoding(topic: Topic) -> None:
    """Make sure that the messages on a topic are CDR.

    Raises:
        ValueError: if they are not.
    """
    if topic.encoding != 'cdr':
        raise ValueError(f'messages on {topic.name} are {topic.encoding!r}, not CDR')


def typestore(topic: Topic) -> Typestore:
    """Make a store of the types that a topic's definition defines, as they are in ROS 2.

    Only ROS 1 messages and the writer need it.
    """
    types: dict[str, Any] = {}
    if topic.syntax == 'ros2idl':
        for text in topic.definition.split(_IDL_FILE):
            types.update(get_types_from_idl(text.partition('\n')[2]) if text.strip() else {})
    else:
        types.update(get_types_from_msg(topic.definition, topic.type))
    jazzy = get_typestore(Stores.ROS2_JAZZY).fielddefs
    if topic.syntax == 'ros1msg':  # its header also has a number
        types['std_msgs/msg/Header'] = jazzy['std_msgs/msg/Header']
    for name in ('builtin_interfaces/msg/Time', 'builtin_interfaces/msg/Duration'):
        types.setdefault(name, jazzy[name])  # primitive in ROS 1
    store = get_typestore(Stores.EMPTY)
    store.register(types)
    return store


def jazzy_definition(message_type: str) -> tuple[str, str]:
    """Give the definition and the hash of a type of ROS 2 Jazzy."""
    store = get_typestore(Stores.ROS2_JAZZY)
    if message_type not in store.fielddefs:
        raise ValueError(f'type {message_type} is not of ROS 2 Jazzy and needs a definition')
    return store.generate_msgdef(message_type, ros_version=2)[0], store.hash_rihs01(message_type)


def ros2_definition(topic: Topic) -> tuple[str, str]:
    """Give the definition and the hash of a topic's type, the bag's own if it has them."""
    if not topic.definition:
        return jazzy_definition(topic.type)
    if topic.syntax == 'ros1msg':
        store = typestore(topic)
        return store.generate_msgdef(topic.type, ros_version=2)[0], store.hash_rihs01(topic.type)
    # rosbags takes a definition that does not begin so for one of the other syntax.
    if topic.syntax != ('ros2idl' if topic.definition.startswith(_IDL_FILE) else 'ros2msg'):
        raise ValueError(f'its type is defined in unknown {topic.syntax!r}')
    return topic.definition, topic.type_hash or typestore(topic).hash_rihs01(topic.type)
