"""Reads ROS 1 bags."""

import bz2
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import BinaryIO, cast

import lz4.frame  # type: ignore[import-untyped]
from rosbags import rosbag1
from rosbags.interfaces import Connection
from rosbags.rosbag1.reader import IndexData

from gear_kinematics.bag.ros1_types import MAX_PARTS, ros1_types
from gear_kinematics.bag.storage import (
    DECOMPRESSORS,
    MAX_DEFINITIONS,
    Budget,
    Decompressor,
    Descriptions,
    Message,
    Storage,
    expanded,
)
from gear_kinematics.bag.topics import Topic


def _unbz2(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = bz2.BZ2Decompressor()
    return decompressor.decompress(data, limit), decompressor.eof


_BOUNDED: Mapping[Callable[[bytes], bytes], Decompressor] = {
    bz2.decompress: _unbz2,
    lz4.frame.decompress: DECOMPRESSORS['lz4'],
}
"""Replacements for those of rosbags, which decompress without limit."""


class _Reader(rosbag1.Reader):
    """Bounds the index, because a file can refer to the same part of it repeatedly."""

    def __init__(self, path: Path, descriptions: Descriptions) -> None:
        super().__init__(path)
        self._descriptions = descriptions
        self._definitions: set[str] = set()
        self._left = path.stat().st_size

    def read_connection(self) -> Connection:
        connection = super().read_connection()
        self._descriptions.add(len(connection.topic) + len(connection.msgdef.data))
        self._definitions.add(connection.msgdef.data)
        if sum(map(len, self._definitions)) > MAX_DEFINITIONS:
            raise ValueError(f'its type definitions have more than {MAX_DEFINITIONS} bytes')
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

    def __init__(self, path: Path, budget: Budget) -> None:
        super().__init__(budget)
        self._reader = _Reader(path, self.descriptions)
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

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Read messages in the order of reception, as CDR."""
        wanted = [c for c in self._reader.connections if c.topic in topics]
        types = {c.msgtype: ros1_types(c.msgtype, c.msgdef.data) for c in wanted}
        if sum(parts for _, parts in types.values()) > MAX_PARTS:
            raise ValueError(f'its messages consist of more than {MAX_PARTS} parts')
        number = 0
        try:
            for connection, received, data in self._reader.messages(wanted) if wanted else ():
                kind = connection.msgtype
                store, _ = types[kind]
                # By default, rosbags loops over any length that damaged bytes claim.
                store.max_sequence_length = len(data)
                yield connection.topic, received, bytes(store.ros1_to_cdr(data, kind))
                number += 1
        finally:
            self.read = number

    def _records(self, decompress: Decompressor, chunk: bytes) -> bytes:
        records, whole = expanded(decompress, chunk, self.budget)
        if not whole:
            raise ValueError('a chunk is cut off or too large')
        return records

    @staticmethod
    def _topic(connection: Connection) -> Topic:
        return Topic(
            connection.topic, connection.msgtype, 'cdr', 'ros1msg', connection.msgdef.data
        )
