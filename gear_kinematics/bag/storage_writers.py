"""The writers of rosbags, extended to write many messages at a time and types without definition.

Everything else has the same bytes as written by rosbags.
"""

import struct
from collections import Counter
from collections.abc import Sequence
from types import MappingProxyType
from typing import cast

import yaml
from rosbags.interfaces import (
    Connection,
    ConnectionExtRosbag2,
    MessageDefinition,
    MessageDefinitionFormat,
    Qos,
)
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.rosbag2.metadata import dump_qos_v9
from rosbags.rosbag2.storage_mcap import McapWriter, Schema, write_schema
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Writer

from gear_kinematics.bag.mcap import MESSAGE, RECORD
from gear_kinematics.bag.topics import Topic

_FORMATS = {
    'ros2msg': MessageDefinitionFormat.MSG,
    'ros2idl': MessageDefinitionFormat.IDL,
    '': MessageDefinitionFormat.NONE,
}
_MAX_CHUNK = 2**20  # bytes; rosbags ends a chunk after the message that exceeds it
_MESSAGE_START = struct.Struct('<BQHIQQ')  # opcode, length, channel, number, two times


class _McapWriter(McapWriter):
    def add_msgtype(self, connection: Connection) -> None:
        if connection.msgdef.format != MessageDefinitionFormat.NONE:
            super().add_msgtype(connection)
            return
        # rosbags would write a definition in IDL, but rosbag2 writes the name of the type alone.
        self.schemas.append(Schema(len(self.schemas) + 1, connection.msgtype, '', ''))
        write_schema(self.chunk.bio, self.schemas[-1])

    def write_all(
        self, channels: Sequence[int], times: Sequence[int], data: Sequence[bytes]
    ) -> None:
        pack, without_data = _MESSAGE_START.pack, _MESSAGE_START.size - RECORD.size
        begin, size, records = 0, self.chunk.bio.tell(), list[bytes]()
        for end, (channel, time, item) in enumerate(zip(channels, times, data, strict=True), 1):
            self.chunk.msgs[channel].append((time, size))
            length = without_data + len(item)
            records += (pack(MESSAGE, length, channel, 0, time, time), item)
            size += RECORD.size + length
            if size > _MAX_CHUNK or end == len(data):
                self.chunk.bio.write(b''.join(records))
                for span in (self, self.chunk):
                    span.message_start_time = min(span.message_start_time, *times[begin:end])
                    span.message_end_time = max(span.message_end_time, *times[begin:end])
                begin, records = end, []
            if size > _MAX_CHUNK:
                self.close_chunk()
                size = 0
        for channel, count in Counter(channels).items():
            self.channel_stats[channel] += count

    def flush(self) -> None:
        """Write what a reader needs to find every message so far."""
        if self.chunk.msgs:
            self.close_chunk()
        self.bio.flush()


class _SqliteWriter(Sqlite3Writer):
    def add_msgtype(self, connection: Connection) -> None:
        if connection.msgdef.format != MessageDefinitionFormat.NONE:
            super().add_msgtype(connection)

    def write_all(
        self, topics: Sequence[int], times: Sequence[int], data: Sequence[bytes]
    ) -> None:
        self.cursor.executemany(
            'INSERT INTO messages (topic_id, timestamp, data) VALUES(?, ?, ?)',
            zip(topics, times, data, strict=True),
        )


class BulkWriter(Writer):
    """Writes a rosbag2 folder of version 9."""

    STORAGE_PLUGINS = MappingProxyType(
        {StoragePlugin.MCAP: _McapWriter, StoragePlugin.SQLITE3: _SqliteWriter}
    )

    @property
    def _file(self) -> _McapWriter | _SqliteWriter:
        return cast('_McapWriter | _SqliteWriter', self.storage)

    def add_topic(self, topic: Topic, qos: Sequence[Qos]) -> int:
        """Add a topic, whose definition and hash may be empty; returns its number."""
        connection = Connection(
            len(self.connections) + 1,
            topic.name,
            topic.type,
            MessageDefinition(_FORMATS[topic.syntax], topic.definition),
            topic.type_hash,
            0,
            ConnectionExtRosbag2(topic.encoding, list(qos)),
            self,
        )
        if topic.type not in self.added_types:
            self._file.add_msgtype(connection)
            self.added_types.add(topic.type)
        self._file.add_connection(connection, yaml.safe_dump(dump_qos_v9(list(qos))).strip())
        self.connections.append(connection)
        self.counts[connection.id] = 0
        return connection.id

    def write_all(
        self, topics: Sequence[int], times: Sequence[int], data: Sequence[bytes]
    ) -> None:
        """Write messages by topic number, time of reception in ns, and CDR."""
        self._file.write_all(topics, times, data)
        for topic, count in Counter(topics).items():
            self.counts[topic] += count
        self.min_timestamp = min(self.min_timestamp, *times)
        self.max_timestamp = max(self.max_timestamp, *times)

    def number_file(self) -> None:
        """Number the open mcap file: rosbag2 finds only numbered files when it reindexes a bag."""
        file = cast('_McapWriter', self.storage)
        file.path = file.path.rename(file.path.with_stem(f'{file.path.stem}_0'))

    def flush(self) -> None:
        """Write all messages so far to the mcap file; they are found even if it is never ended."""
        cast('_McapWriter', self.storage).flush()
