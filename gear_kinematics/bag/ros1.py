# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads ROS 1 bags, with rosbags."""

import bz2
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any, BinaryIO, cast

import lz4.frame  # type: ignore[import-untyped]
from rosbags import rosbag1
from rosbags.interfaces import Connection, Nodetype
from rosbags.interfaces.typing import Typesdict
from rosbags.rosbag1.reader import IndexData
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from gear_kinematics.bag.codecs import CODECS, Decompressor, decompressed
from gear_kinematics.bag.limits import Limits
from gear_kinematics.bag.storage import Message, Storage, in_batches
from gear_kinematics.bag.topics import Topic


def _unbz2(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = bz2.BZ2Decompressor()
    return decompressor.decompress(data, limit), decompressor.eof


_BOUNDED: Mapping[Callable[[bytes], bytes], Decompressor] = {
    bz2.decompress: _unbz2,
    lz4.frame.decompress: CODECS['lz4'].decompress,
}
"""Replacements for those of rosbags, which decompress without limit."""
_MAX_DEFINITIONS = 2**19
"""Largest type definitions together, bytes: rosbags takes 25 µs for each."""
_MAX_PARTS = 10_000
"""Most parts of all types together: rosbags takes up to a millisecond to prepare each."""
_MAX_PARTS_FOR_BYTES = 8
_TEXTS = {'string', 'wstring'}


class _Reader(rosbag1.Reader):
    """Bounds the index, because a file can refer to the same part of it repeatedly."""

    def __init__(self, path: Path, limits: Limits) -> None:
        super().__init__(path)
        self._limits = limits
        self._definitions: set[str] = set()
        self._left = path.stat().st_size

    def read_connection(self) -> Connection:
        connection = super().read_connection()
        self._limits.describe(str(connection.id), connection.topic, connection.msgdef.data)
        self._definitions.add(connection.msgdef.data)
        if sum(map(len, self._definitions)) > _MAX_DEFINITIONS:
            raise ValueError(f'its type definitions have more than {_MAX_DEFINITIONS} bytes')
        return connection

    def read_index_data(self, pos: int, indexes: dict[int, list[IndexData]]) -> None:
        stream = cast('BinaryIO', self.bio)
        start = stream.tell()
        super().read_index_data(pos, indexes)
        self._left -= stream.tell() - start
        if self._left < 0:
            raise ValueError('the index is longer than the file')


class Ros1(Storage):
    """A ROS 1 bag."""

    def __init__(self, path: Path, limits: Limits) -> None:
        super().__init__(limits)
        self._reader = _Reader(path, limits)
        self._reader.open()
        chunks = self._reader.chunks
        for place, chunk in chunks.items():
            if decompress := _BOUNDED.get(chunk.decompressor):
                chunks[place] = chunk._replace(decompressor=partial(self._records, decompress))

    def close(self) -> None:
        """Close the file."""
        self._reader.close()

    def topics(self) -> list[Topic]:
        """Return the topic of each connection."""
        return [self._topic(connection) for connection in self._reader.connections]

    def count(self) -> int | None:
        """Return the number in the index."""
        return sum(connection.msgcount for connection in self._reader.connections)

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages in the order of reception, as CDR."""
        wanted = [c for c in self._reader.connections if c.topic in topics]
        types = {c.msgtype: _types_of(c.msgtype, c.msgdef.data) for c in wanted}
        if sum(parts for _, parts in types.values()) > _MAX_PARTS:
            raise ValueError(f'its messages consist of more than {_MAX_PARTS} parts')
        stores = {kind: store for kind, (store, _) in types.items()}
        return in_batches(self._messages(wanted, stores))

    def _messages(
        self, wanted: list[Connection], stores: Mapping[str, Typestore]
    ) -> Iterator[Message]:
        for connection, received, data in self._reader.messages(wanted) if wanted else ():
            kind = connection.msgtype
            # By default, rosbags loops over any length that damaged bytes claim.
            stores[kind].max_sequence_length = len(data)
            yield connection.topic, received, bytes(stores[kind].ros1_to_cdr(data, kind))

    def _records(self, decompress: Decompressor, chunk: bytes) -> bytes:
        return decompressed(chunk, decompress, self.limits, 'a chunk')

    @staticmethod
    def _topic(connection: Connection) -> Topic:
        return Topic(
            connection.topic, connection.msgtype, 'cdr', 'ros1msg', connection.msgdef.data
        )


def ros2_definition(message_type: str, definition: str) -> tuple[str, str]:
    """Return the definition and the hash that a type of ROS 1 has in ROS 2."""
    store, _ = _types_of(message_type, definition)
    converted, _ = store.generate_msgdef(message_type, ros_version=2)
    return converted, store.hash_rihs01(message_type)


@cache
def _types_of(message_type: str, definition: str) -> tuple[Typestore, int]:
    """Create a store of the types of a definition, as they are in ROS 2.

    Returns:
        The store, and the number of parts in which rosbags converts a message.

    Raises:
        ValueError: if the conversion of a small message could take long.
    """
    types = get_types_from_msg(definition, message_type)
    jazzy = get_typestore(Stores.ROS2_JAZZY).fielddefs
    types['std_msgs/msg/Header'] = jazzy['std_msgs/msg/Header']  # ROS 1 has a sequence number
    for name in ('builtin_interfaces/msg/Time', 'builtin_interfaces/msg/Duration'):
        types.setdefault(name, jazzy[name])  # primitive types in ROS 1
    parts, _ = _extent((Nodetype.NAME, message_type), types, {})
    store = get_typestore(Stores.EMPTY)
    store.register(types)
    return store, parts


def _extent(
    field: tuple[Nodetype, Any], types: Typesdict, known: dict[str, tuple[int, int]]
) -> tuple[int, int]:
    """The parts that rosbags converts one by one, and how many of them are never empty."""
    kind, detail = field
    if kind == Nodetype.BASE:
        return 1, 1
    if kind == Nodetype.NAME:
        if detail not in known:
            extents = [_extent(inner, types, known) for _, inner in types[detail][1]]
            known[detail] = 1 + sum(parts for parts, _ in extents), sum(n for _, n in extents)
        return known[detail]
    element, count = detail
    parts, filled = _extent(element, types, known)
    if kind == Nodetype.SEQUENCE:
        # A message can claim any number of elements that take no bytes.
        if parts > _MAX_PARTS_FOR_BYTES * filled:
            raise ValueError('a sequence of nearly empty messages')
        return 1 + parts, 1
    if element[0] == Nodetype.BASE and element[1][0] not in _TEXTS:
        return 1, 1
    return count * parts, count * filled
