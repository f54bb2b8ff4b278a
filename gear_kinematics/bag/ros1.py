# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads ROS 1 bags, with rosbags."""

import bz2
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]
from rosbags import rosbag1
from rosbags.typesys import Stores, get_typestore

from gear_kinematics.bag.codecs import CODECS, Decompressor, ReadLimits, decompressed
from gear_kinematics.bag.storage import Message, Storage, Topic, in_batches
from gear_kinematics.wire.topics import JOINT_STATE, POSE_ARRAY


def _unbz2(data: bytes, limit: int) -> tuple[bytes, bool]:
    decompressor = bz2.BZ2Decompressor()
    return decompressor.decompress(data, limit), decompressor.eof


_BOUNDED: Mapping[Callable[[bytes], bytes], Decompressor] = {
    bz2.decompress: _unbz2,
    lz4.frame.decompress: CODECS['lz4'].decompress,
}
"""Replacements for those of rosbags, which decompress without limit."""
_CONVERTED = {JOINT_STATE, POSE_ARRAY}  # converted to CDR; they have the same fields in ROS 2


class Ros1(Storage):
    """A ROS 1 bag, whose joint states and poses are converted to CDR."""

    def __init__(self, path: Path, limits: ReadLimits) -> None:
        super().__init__(limits)
        self._reader = rosbag1.Reader(path)
        self._reader.open()
        chunks = self._reader.chunks
        for place, chunk in chunks.items():
            if bounded := _BOUNDED.get(chunk.decompressor):
                decompress = partial(
                    decompressed, decompress=bounded, limits=limits, what='a chunk'
                )
                chunks[place] = chunk._replace(decompressor=decompress)

    def close(self) -> None:
        """Close the file."""
        self._reader.close()

    def topics(self) -> list[Topic]:
        """Return the topic of each connection; the encoding of others than CDR is `ros1`."""
        return [
            Topic(found.topic, found.msgtype, 'cdr' if found.msgtype in _CONVERTED else 'ros1')
            for found in self._reader.connections
        ]

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages in the order of reception."""
        return in_batches(self._messages(topics))

    def _messages(self, topics: Collection[str]) -> Iterator[Message]:
        store = get_typestore(Stores.ROS2_JAZZY)
        wanted = [c for c in self._reader.connections if c.topic in topics]
        for connection, received, data in self._reader.messages(wanted) if wanted else ():
            content = data
            if connection.msgtype in _CONVERTED:
                # By default, rosbags loops over any length that damaged bytes claim.
                store.max_sequence_length = len(data)
                content = bytes(store.ros1_to_cdr(data, connection.msgtype))
            yield connection.topic, received, content
