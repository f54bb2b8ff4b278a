# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Writes recordings, with rosbags."""

import secrets
import shutil
import struct
from collections.abc import Iterable, Sequence
from contextlib import ExitStack, suppress
from functools import cache
from io import BytesIO
from pathlib import Path
from types import TracebackType
from typing import Literal, Self, cast

import yaml
from rosbags.interfaces import (
    Connection,
    ConnectionExtRosbag2,
    MessageDefinition,
    MessageDefinitionFormat,
    Qos,
)
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.rosbag2.metadata import dump_qos_v9, parse_qos
from rosbags.rosbag2.storage_mcap import (
    McapWriter,
    Schema,
    write_channel,
    write_schema,
    write_string,
)
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Writer
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from gear_kinematics.bag.errors import BagError, TopicError, bag_errors
from gear_kinematics.bag.finding import parse_yaml
from gear_kinematics.bag.reading import Bag
from gear_kinematics.bag.storage import Message, Published, Topic

_MAX_ENTRIES = 4000  # topics and QoS in the metadata; rosbags takes 3 ms to write one
_PUBLISH_TIME = 23  # its offset in the record of a message
_FORMATS = {
    'ros2msg': MessageDefinitionFormat.MSG,
    'ros2idl': MessageDefinitionFormat.IDL,
    '': MessageDefinitionFormat.NONE,
}


class _McapFile(McapWriter):
    """An mcap file as rosbag2 writes it: with hashes of types and times of publication."""

    def __init__(self, path: Path, compression: CompressionMode) -> None:
        super().__init__(path, compression)
        self._published: list[tuple[int, int]] = []  # positions in the chunk, and times, ns

    def add_connection(self, connection: Connection, offered_qos_profiles: str) -> None:
        start = self.chunk.bio.tell()
        super().add_connection(connection, offered_qos_profiles)
        if connection.digest:
            metadata = BytesIO()
            write_string(metadata, 'topic_type_hash')
            write_string(metadata, connection.digest)
            channel = self.channels[-1]
            whole = channel._replace(metadata=channel.metadata + metadata.getvalue())
            self.channels[-1] = whole
            self.chunk.bio.seek(start)
            write_channel(self.chunk.bio, whole, self.schemas)

    def write(self, connection: Connection, timestamp: int, data: bytes | memoryview) -> None:
        if isinstance(data, Published):
            self._published.append((self.chunk.bio.tell() + _PUBLISH_TIME, data.time))
        super().write(connection, timestamp, data)

    def close_chunk(self) -> None:
        with self.chunk.bio.getbuffer() as records:
            for place, time in self._published:
                struct.pack_into('<Q', records, place, time)
        self._published.clear()
        super().close_chunk()


def _remove_if_empty(folder: Path) -> None:
    with suppress(OSError):
        folder.rmdir()


class BagWriter:
    """Writes a rosbag2 folder, version 9; the same messages always give the same bytes.

    A context manager. The folder is renamed to `path` when it is complete; after an exception or
    an interruption, nothing is left, unless it `keeps` what was written before.
    """

    keeps = False

    def __init__(
        self,
        path: Path | str,
        storage: Literal['mcap', 'sqlite3'] = 'mcap',
        compression: Literal['none', 'zstd'] = 'none',
    ) -> None:
        """Define a folder that `__enter__` creates; zstd compresses chunks, or a sqlite3 file."""
        self.path = Path(path)
        self._storage = StoragePlugin[storage.upper()]
        modes = {'mcap': CompressionMode.STORAGE, 'sqlite3': CompressionMode.FILE}
        self._compression = modes[storage] if compression == 'zstd' else CompressionMode.NONE
        self._topics: dict[str, Connection] = {}
        self._entries = 0

    def __enter__(self) -> Self:
        """Create a folder, in missing ones too; BagError if it exists or cannot be written."""
        with bag_errors(self.path), ExitStack() as stack:
            if self.path.exists() or self.path.is_symlink():
                raise ValueError('exists already')
            # rosbags names the file after its folder; rosbag2 finds only numbered files when it
            # reindexes a bag.
            folder = self.path.parent / f'.{self.path.name}.{secrets.token_hex(4)}'
            # Registered before the folders exist, so that no interruption leaves them behind.
            for parent in reversed([each for each in folder.parents if not each.exists()]):
                stack.callback(_remove_if_empty, parent)
                parent.mkdir(exist_ok=True)
            stack.callback(shutil.rmtree, folder, ignore_errors=True)
            folder.mkdir(mode=0o700)
            self._partial = folder / f'{self.path.name}_0'
            self._writer = Writer(self._partial, version=9, storage_plugin=self._storage)
            self._writer.STORAGE_PLUGINS = {
                **Writer.STORAGE_PLUGINS,
                StoragePlugin.MCAP: _McapFile,
            }
            self._writer.set_compression(self._compression, CompressionFormat.ZSTD)
            self._writer.open()
            self._file = cast('McapWriter | Sqlite3Writer', self._writer.storage)
            self._folder = stack.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Finish the recording, or remove it after an exception; raises BagError if that fails."""
        with bag_errors(self.path), self._folder:
            try:
                with bag_errors(self.path):
                    self._writer.__exit__(kind, error, trace)
            except BagError as unfinished:
                if not self.keeps:
                    raise
                error = error or unfinished
            # Of a first chunk that is cut off, nothing can be read.
            readable = not isinstance(self._file, McapWriter) or self._file.chunks
            if error is None or (self.keeps and readable):
                self._partial.rename(self.path)
            if self.keeps and isinstance(error, BagError):
                kept = 'what was written before' if readable else 'nothing'
                raise BagError(f'{error}; {kept} is kept') from error

    def add_file(self, name: str, content: bytes) -> None:
        """Put another file into the folder; raises BagError if it cannot be written."""
        with bag_errors(self.path):
            (self._partial / name).write_bytes(content)

    def add_topic(self, name: str, message_type: str) -> None:
        """Add a topic of a type of ROS 2 Jazzy; BagError if it is there or the type is unknown."""
        with bag_errors(self.path):
            definition = _jazzy_definition(message_type)
            self._add(Topic(name, message_type, 'cdr', 'ros2msg', *definition), [])

    def copy_topic(self, bag: Bag, name: str) -> None:
        """Add a topic of another bag, with hash, QoS and, if the bag or Jazzy has it, definition.

        Raises:
            TopicError: if it cannot be copied.
            BagError: if it has been added already, or the bag cannot be read.
        """
        topic = bag.describe(name)
        with bag_errors(f'{bag.path}: {name} cannot be copied', TopicError):
            if topic.encoding != 'cdr':
                raise ValueError(f'its messages are {topic.encoding!r}, not CDR')
            topic = _as_ros2(topic)
            qos = parse_yaml(topic.qos) if isinstance(topic.qos, str) else topic.qos
            self._add(topic, parse_qos(qos))

    def write_all(self, messages: Iterable[Message]) -> None:
        """Write messages; raises BagError if one cannot be written, or its topic is not added."""
        with bag_errors(self.path):
            for topic, received, data in messages:
                self._writer.write(self._topics[topic], received, data)

    def _add(self, topic: Topic, qos: Sequence[Qos]) -> None:
        if topic.name in self._topics:
            raise BagError(f'{self.path}: topic {topic.name} has been added already')
        self._entries += 1 + len(qos)
        if self._entries > _MAX_ENTRIES:
            many = f'more than {_MAX_ENTRIES} topics and QoS profiles'
            raise BagError(f'{self.path}: {many}; --topics says which to copy')
        writer = self._writer
        # `Writer.add_connection` would need a definition and a hash of every type.
        connection = Connection(
            len(writer.connections) + 1,
            topic.name,
            topic.type,
            MessageDefinition(_FORMATS[topic.syntax], topic.definition),
            topic.type_hash,
            0,
            ConnectionExtRosbag2(topic.encoding, list(qos)),
            writer,
        )
        if topic.type not in writer.added_types:
            writer.added_types.add(topic.type)
            if topic.syntax:
                self._file.add_msgtype(connection)
            elif isinstance(self._file, McapWriter):  # the name alone, as rosbag2 writes it
                self._file.schemas.append(Schema(len(self._file.schemas) + 1, topic.type, '', ''))
                write_schema(self._file.chunk.bio, self._file.schemas[-1])
        self._file.add_connection(connection, yaml.safe_dump(dump_qos_v9(list(qos))).strip())
        writer.connections.append(connection)
        writer.counts[connection.id] = 0
        self._topics[topic.name] = connection


@cache
def _jazzy() -> Typestore:
    return get_typestore(Stores.ROS2_JAZZY)


@cache
def _jazzy_definition(message_type: str) -> tuple[str, str]:
    """Return the definition and the hash of a type of ROS 2 Jazzy."""
    store = _jazzy()
    if message_type not in store.fielddefs:
        raise ValueError(f'type {message_type} is not of ROS 2 Jazzy and needs a definition')
    return store.generate_msgdef(message_type, ros_version=2)[0], store.hash_rihs01(message_type)


def _as_ros2(topic: Topic) -> Topic:
    """Return a topic as ROS 2 records it, without a definition if there is none.

    Raises ValueError if the type is defined in a syntax that ROS 2 does not have.
    """
    if not topic.definition and topic.type in _jazzy().fielddefs:
        definition, type_hash = _jazzy_definition(topic.type)
        type_hash = topic.type_hash or type_hash
        return topic._replace(syntax='ros2msg', definition=definition, type_hash=type_hash)
    if topic.syntax in {'ros2msg', 'ros2idl'}:
        return topic
    if topic.definition:
        raise ValueError(f'its type is defined in unknown {topic.syntax!r}')
    return topic._replace(syntax='')
