"""ROS 1 bags."""

import bz2
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]
from rosbags import rosbag1
from rosbags.interfaces import Connection

from gear_kinematics.bag.compression import DECOMPRESSORS, MAX_RECORD, Decompressor
from gear_kinematics.bag.storage import RawMessage, Storage
from gear_kinematics.bag.topics import Topic, typestore


def _unbz2(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = bz2.BZ2Decompressor()
    return decompressor.decompress(data, limit), decompressor.eof


_BOUNDED: Mapping[Callable[[bytes], bytes], Decompressor] = {
    bz2.decompress: _unbz2,
    lz4.frame.decompress: DECOMPRESSORS['lz4'],
}
"""In place of those of rosbags, which decompress whatever there is."""


class Ros1(Storage):
    """A ROS 1 bag."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._reader = rosbag1.Reader(path)
        self._reader.open()
        chunks = self._reader.chunks
        for place, chunk in chunks.items():
            if decompress := _BOUNDED.get(chunk.decompressor):
                chunks[place] = chunk._replace(decompressor=partial(_records, decompress))

    def close(self) -> None:
        """Close the file."""
        self._reader.close()

    def topics(self) -> list[Topic]:
        """Give the topic of each connection."""
        return [self._topic(connection) for connection in self._reader.connections]

    def count(self) -> int | None:
        """Give the number in the index."""
        return self._reader.message_count

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """Read messages in the order of reception, as CDR."""
        wanted = [c for c in self._reader.connections if c.topic in topics]
        stores = {c.msgtype: typestore(self._topic(c)) for c in wanted}
        number = 0
        try:
            for connection, received, data in self._reader.messages(wanted) if wanted else ():
                kind = connection.msgtype
                store = stores[kind]
                # Left alone, rosbags counts through any length that damaged bytes claim.
                store.max_sequence_length = len(data)
                yield connection.topic, received, bytes(store.ros1_to_cdr(data, kind))
                number += 1
        finally:
            self.read = number

    @staticmethod
    def _topic(connection: Connection) -> Topic:
        return Topic(
            connection.topic, connection.msgtype, 'cdr', 'ros1msg', connection.msgdef.data
        )


def _records(decompress: Decompressor, chunk: bytes) -> bytes:
    records, whole = decompress(chunk, MAX_RECORD)
    if not whole:
        raise ValueError('a chunk is cut off or too large')
    return records
