"""Recorded bags: raw messages in and out by `rosbags`, without ROS."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import (
    CompressionFormat,
    CompressionMode,
    Reader,
    ReaderError,
    StoragePlugin,
    Writer,
)
from rosbags.typesys import Stores, get_typestore

TOPIC_TYPES: Mapping[str, str] = {
    '/rotor_state': 'sensor_msgs/msg/JointState',
    '/output_state': 'sensor_msgs/msg/JointState',
    '/body_poses': 'geometry_msgs/msg/PoseArray',
}
"""The topics of a recording, by their names in the root namespace."""


class BagError(ValueError):
    """A bag that cannot be used; the text names it and the cause."""


class BagMessage(NamedTuple):
    """A message as it was recorded."""

    topic: str
    received: int
    """ns."""
    data: bytes
    """CDR."""


def read_bag(path: Path, topics: Collection[str]) -> Iterator[BagMessage]:
    """Read a rosbag2 recording in the order in which it was received.

    Args:
        path: a bag's directory, or a single .mcap or .db3 file.
        topics: which to read.

    Raises:
        BagError: if there is no bag there, or none of a topic in it.
    """
    try:
        with Reader(path) as reader:
            connections = [c for c in reader.connections if c.topic in topics]
            missing = set(topics) - {c.topic for c in connections}
            if missing:
                raise BagError(f'{path}: no messages on {", ".join(sorted(missing))}')
            for connection, received, data in reader.messages(connections):
                yield BagMessage(connection.topic, received, bytes(data))
    except (OSError, ReaderError) as error:
        raise BagError(f'{path}: {error}') from error


def write_bag(path: Path, messages: Iterable[BagMessage], *, storage: str = 'mcap') -> None:
    """Write a rosbag2 recording, chunks compressed with zstd where the storage has chunks.

    Args:
        path: the directory to make.
        messages: on topics of `TOPIC_TYPES`.
        storage: 'mcap' or 'sqlite3'.
    """
    typestore = get_typestore(Stores.ROS2_JAZZY)
    writer = Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()])
    if storage == 'mcap':
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(
                topic, message_type, typestore=typestore, offered_qos_profiles=[_RELIABLE]
            )
            for topic, message_type in TOPIC_TYPES.items()
        }
        for topic, received, data in messages:
            writer.write(connections[topic], received, data)


_FOREVER = QosTime(9223372036, 854775807)
_RELIABLE = Qos(
    QosHistory.KEEP_LAST,
    2000,
    QosReliability.RELIABLE,
    QosDurability.VOLATILE,
    _FOREVER,
    _FOREVER,
    QosLiveliness.AUTOMATIC,
    _FOREVER,
    avoid_ros_namespace_conventions=False,
)
