"""Recorded bags: raw messages in and out, without ROS.

`rosbags` reads ROS 1, knows the message types and writes. rosbag2 files are read here, because
rosbags refuses unfinished and damaged files as a whole and takes longer over each message.
"""

import os
import re
import shutil
import sqlite3
import struct
import sys
import tempfile
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, nullcontext, suppress
from itertools import chain
from operator import itemgetter
from pathlib import Path, PurePath
from types import MappingProxyType, TracebackType
from typing import IO, Any, Literal, NamedTuple, Self
from zlib import crc32

import lz4.frame  # type: ignore[import-untyped]
import yaml
from rosbags import rosbag1
from rosbags.interfaces import (
    Connection,
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.rosbag2.metadata import parse_qos
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

TOPIC_TYPES: Mapping[str, str] = {
    '/rotor_state': 'sensor_msgs/msg/JointState',
    '/output_state': 'sensor_msgs/msg/JointState',
    '/body_poses': 'geometry_msgs/msg/PoseArray',
}
"""The topics of a recording, by their names in the root namespace."""

RawMessage = tuple[str, int, bytes]
"""Topic, reception in ns, CDR."""

_MAX_RECORD = 2**30  # bytes, of a chunk or message, also once decompressed
_MAX_EXPANSION = 1000  # of a compressed file; recordings reach about 20


class BagError(ValueError):
    """A bag that cannot be used; the text is one line that names it and the cause."""


class DamagedBagError(BagError):
    """A bag that is damaged behind messages that could be read; the text also says where."""


class BagMessage(NamedTuple):
    """A message as it was recorded."""

    topic: str
    received: int
    """ns."""
    data: bytes
    """CDR."""


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


class Bag:
    """A recording: a rosbag2 folder, one of its files alone, or a ROS 1 bag.

    A context manager; at its end the readings under way are over too.
    """

    topics: Mapping[str, str]
    """The types by the names, such as sensor_msgs/msg/JointState."""
    message_count: int | None
    """On all topics; None where only reading all of them would tell."""

    def __init__(self, path: Path | str) -> None:
        """Look what is in a bag.

        Raises:
            BagError: if there is no bag, or none that can be read.
        """
        self.path = Path(path)
        self._readings = ExitStack()
        self._described: dict[str, Topic] = {}
        self._listed: dict[str, Topic] = {}
        self.message_count = 0
        with _bag_errors(self.path):
            self._files = self._find_files()
        if not self._listed:
            self._describe()
        known = self._listed or self._described
        self.topics = MappingProxyType({topic.name: topic.type for topic in known.values()})

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._readings.close()

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """Read raw messages in the order in which they were received, those of ROS 1 as CDR.

        Args:
            topics: which to read; one that is not in the bag has no messages.

        Yields:
            Topic, reception in ns, CDR in the byte order of the recording.

        Raises:
            BagError: if none can be read.
            DamagedBagError: behind the last that can be read.
        """
        reading = self._read(frozenset(topics))
        self._readings.callback(reading.close)
        return reading

    def describe(self, name: str) -> Topic:
        """Give what the bag says about a topic.

        Raises:
            BagError: if it is not in the bag, or the bag cannot be read.
        """
        if name not in self.topics:
            raise BagError(f'{self.path}: no topic {name}')
        if not self._described:
            self._describe()
        listed = self._listed.get(name) or self._described[name]
        topic = self._described.get(name, listed)
        return topic._replace(
            type=listed.type,
            type_hash=topic.type_hash or listed.type_hash,
            qos=topic.qos or listed.qos,
        )

    def _find_files(self) -> list[Path]:
        """Find the files in the order of recording, and what metadata.yaml says about topics."""
        if self.path.is_file():
            return [self.path]
        if not self.path.is_dir():
            raise ValueError('no such file or folder')
        metadata = self.path / 'metadata.yaml'
        if metadata.exists():
            with _bag_errors(metadata):
                return self._read_metadata(metadata)
        # A recorder that is killed writes none.
        files = [file for file in self.path.iterdir() if _STORAGE_NAME.search(file.name)]
        if not files:
            raise ValueError('the folder holds neither metadata.yaml nor a .mcap or .db3 file')
        if len({_STORAGE_NAME.sub('', file.name) for file in files}) > 1:
            raise ValueError('several recordings without a metadata.yaml; name one of its files')
        return sorted(files, key=lambda file: (len(file.name), file.name))

    def _read_metadata(self, path: Path) -> list[Path]:
        document = yaml.safe_load(path.read_text('utf-8'))
        if not isinstance(document, dict):
            raise ValueError('no metadata in it')  # noqa: TRY004, of what is on disk
        information = document['rosbag2_bagfile_information']
        if information.get('compression_mode', '').lower() == 'message' and (
            information['compression_format'] not in _DECOMPRESSORS
        ):
            raise ValueError(f'unsupported compression {information["compression_format"]!r}')
        self.message_count = int(information['message_count'])
        for entry in information['topics_with_message_count']:
            known = entry['topic_metadata']
            topic = Topic(
                known['name'],
                known['type'],
                known['serialization_format'],
                type_hash=known.get('type_description_hash', ''),
                qos=known.get('offered_qos_profiles', ''),
            )
            if not all(isinstance(text, str) for text in topic[:-1]):
                raise ValueError('a topic is not described by texts')
            self._listed.setdefault(topic.name, topic)
        folder = self.path.absolute()
        files = []
        for name in information['relative_file_paths']:
            file = folder / name
            if '..' in PurePath(name).parts or not file.is_relative_to(folder):
                raise ValueError(f'{name!r} leads outside the folder')
            # Before version 4 names began with that of the folder, which may have changed since.
            files.append(self.path / (name if file.exists() else file.name))
        if not files:
            raise ValueError('no files are listed')
        return files

    def _describe(self) -> None:
        """Collect what the files say about topics, and count messages if nothing else did."""
        counts: list[int | None] = []
        for file in self._files:
            try:
                with _opened(file) as storage:
                    for topic in storage.topics():
                        self._described.setdefault(topic.name, topic)
                    counts.append(storage.count())
            except BagError:
                if not counts:
                    raise
                counts.append(None)  # reading will come to it, and say it then
            if self._listed and self._listed.keys() <= self._described.keys():
                return
        if not self._listed:
            known = [count for count in counts if count is not None]
            self.message_count = sum(known) if len(known) == len(counts) else None

    def _read(self, topics: frozenset[str]) -> Generator[RawMessage, None, None]:
        read = 0
        for file in self._files:
            with _opened(file, read) as storage:
                messages = storage.messages(topics)
                for first in messages:
                    messages = chain([first], messages)
                    decompress = _MESSAGE_DECOMPRESSORS.get(first[2][:4])
                    if decompress:
                        messages = storage.decompressed(messages, decompress)
                    yield from messages
            read += storage.read


class BagWriter:
    """Writes a rosbag2 folder, version 9; the same messages always give the same bytes.

    A context manager. The folder gets its name when it is whole; after an exception, an
    interruption included, nothing is left.
    """

    def __init__(
        self,
        path: Path | str,
        storage: Literal['mcap', 'sqlite3'] = 'mcap',
        compression: Literal['none', 'zstd'] = 'none',
    ) -> None:
        """Say what to write.

        Args:
            path: the folder to make, in one that exists.
            storage: of the messages.
            compression: zstd compresses the chunks of an mcap file, and an sqlite3 file whole.
        """
        self.path = Path(path)
        self._storage = StoragePlugin[storage.upper()]
        modes = {'mcap': CompressionMode.STORAGE, 'sqlite3': CompressionMode.FILE}
        self._compression = modes[storage] if compression == 'zstd' else CompressionMode.NONE
        self._connections: dict[str, Connection] = {}

    def __enter__(self) -> Self:
        """Begin.

        Raises:
            BagError: if the path exists already or nothing can be written there.
        """
        with _bag_errors(self.path), ExitStack() as stack:
            if self.path.exists() or self.path.is_symlink():
                raise ValueError('exists already')
            # rosbags names the file after its folder, which has to have the final name already.
            folder = tempfile.mkdtemp(prefix=f'.{self.path.name}.', dir=self.path.parent)
            stack.callback(shutil.rmtree, folder)
            self._partial = Path(folder, self.path.name)
            self._writer = Writer(self._partial, version=9, storage_plugin=self._storage)
            self._writer.set_compression(self._compression, CompressionFormat.ZSTD)
            self._writer.open()
            self._folder = stack.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Finish, or clear away after an exception.

        Raises:
            BagError: if it cannot be finished.
        """
        with _bag_errors(self.path), self._folder:
            self._writer.__exit__(kind, error, trace)
            if kind is None:
                self._partial.rename(self.path)

    def add_topic(self, name: str, message_type: str) -> None:
        """Add a topic of a type that ROS 2 Jazzy has, such as sensor_msgs/msg/JointState.

        Raises:
            BagError: if it has been added already, or the type is unknown.
        """
        with _bag_errors(self.path):
            self._add(name, message_type, *_jazzy_definition(message_type), [_RELIABLE])

    def copy_topic(self, bag: Bag, name: str) -> None:
        """Add a topic as it is in another bag, with its type definition, hash and QoS.

        Raises:
            BagError: if it has been added already, or the bag lacks what is needed for it.
        """
        topic = bag.describe(name)
        with _bag_errors(f'{bag.path}: {name} cannot be copied'):
            if topic.encoding != 'cdr':
                raise ValueError(f'its messages are {topic.encoding!r}, not CDR')
            definition, type_hash = _ros2_definition(topic)
            self._add(name, topic.type, definition, type_hash, parse_qos(topic.qos))

    def write(self, topic: str, received: int, data: bytes) -> None:
        """Write a message.

        Args:
            topic: one that has been added.
            received: ns.
            data: CDR.

        Raises:
            BagError: if the topic has not been added, or the message cannot be written.
        """
        if topic not in self._connections:
            raise BagError(f'{self.path}: topic {topic} has not been added')
        if not 0 <= received < 2**63:
            raise BagError(f'{self.path}: {received} is no time of reception')
        try:
            self._writer.write(self._connections[topic], received, data)
        except (OSError, sqlite3.Error) as error:
            raise BagError(f'{self.path}: {_cause(error)}') from error

    def _add(
        self, name: str, message_type: str, definition: str, type_hash: str, qos: list[Qos]
    ) -> None:
        if name in self._connections:
            raise BagError(f'{self.path}: topic {name} has been added already')
        self._connections[name] = self._writer.add_connection(
            name, message_type, msgdef=definition, rihs01=type_hash, offered_qos_profiles=qos
        )


def read_bag(path: Path, topics: Collection[str]) -> Iterator[BagMessage]:
    """Read the messages of a bag, all of whose topics must be there.

    Raises:
        BagError: if a topic is missing or the bag cannot be read; see `Bag.messages`.
    """
    with Bag(path) as bag:
        missing = set(topics) - set(bag.topics)
        if missing:
            raise BagError(f'{path}: no messages on {", ".join(sorted(missing))}')
        yield from map(BagMessage._make, bag.messages(topics))


def write_bag(
    path: Path, messages: Iterable[BagMessage], *, storage: Literal['mcap', 'sqlite3'] = 'mcap'
) -> None:
    """Write a rosbag2 recording, chunks compressed with zstd where the storage has chunks.

    Args:
        path: the folder to make, in one that exists.
        messages: on topics of `TOPIC_TYPES`.
        storage: of the messages.

    Raises:
        BagError: if it cannot be written.
    """
    with BagWriter(path, storage, 'zstd' if storage == 'mcap' else 'none') as writer:
        for topic, message_type in TOPIC_TYPES.items():
            writer.add_topic(topic, message_type)
        for message in messages:
            writer.write(*message)


def _cause(error: BaseException) -> str:
    """Put an error of any library into one line."""
    if isinstance(error, KeyError):
        return f'{error} is missing'
    text = str(error.strerror if isinstance(error, OSError) else error)
    return ' '.join(text.split()) or type(error).__name__


@contextmanager
def _bag_errors(name: object) -> Iterator[None]:
    """Turn whatever a library raises about bytes on disk into a BagError that names the file."""
    try:
        yield
    except BagError:
        raise
    except Exception as error:
        raise BagError(f'{name}: {_cause(error)}') from error


# Decompression. The output is bounded, whatever size the input claims.


def _unzstd(data: bytes, limit: int) -> tuple[bytes, bool]:
    """Decompress at most `limit` bytes of a frame, and tell whether that was all of it."""
    decompressor = zstd.ZstdDecompressor()
    return decompressor.decompress(data, limit), decompressor.eof


def _unlz4(data: bytes, limit: int) -> tuple[bytes, bool]:
    # The format cannot do better than 255 to 1, and lz4 allocates the limit at once.
    decompressor = lz4.frame.LZ4FrameDecompressor()
    return decompressor.decompress(data, min(limit, 256 * len(data))), decompressor.eof


_Decompressor = Callable[[bytes, int], tuple[bytes, bool]]
_DECOMPRESSORS: Mapping[str, _Decompressor] = {'zstd': _unzstd, 'lz4': _unlz4}
_ZSTD_MAGIC, _LZ4_MAGIC = b'\x28\xb5\x2f\xfd', b'\x04\x22\x4d\x18'
# CDR begins with a zero, so that a message in these is known by its first bytes.
_MESSAGE_DECOMPRESSORS: Mapping[bytes, _Decompressor] = {_ZSTD_MAGIC: _unzstd, _LZ4_MAGIC: _unlz4}
_FILE_OPENERS: Mapping[bytes, Callable[[IO[bytes]], Any]] = {
    _ZSTD_MAGIC: zstd.ZstdFile,
    _LZ4_MAGIC: lz4.frame.LZ4FrameFile,
}


def _decompress_file(source: IO[bytes], target: Path) -> str:
    """Decompress as much as there is, and tell what stopped it early, if anything."""
    left = _MAX_EXPANSION * os.fstat(source.fileno()).st_size
    with target.open('wb') as output, _FILE_OPENERS[_start(source, 4)](source) as expanded:
        try:
            while piece := expanded.read1(2**18):  # what there is, unlike read()
                left -= output.write(piece)
                if left < 0:
                    raise ValueError(f'decompresses to more than {_MAX_EXPANSION} times its size')
        except Exception as error:  # noqa: BLE001, of two libraries
            return _cause(error)
    return ''


# Storages: the files that a bag consists of.

_STORAGE_NAME = re.compile(r'(_\d+)?\.(mcap|db3)(\.(zstd|zst|lz4))?$')


class _Storage:
    """A file of a bag."""

    def __init__(self) -> None:
        self.read = 0
        """Messages that have been taken out; up to date whenever an error is raised."""

    def topics(self) -> list[Topic]:
        raise NotImplementedError

    def count(self) -> int | None:
        raise NotImplementedError

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError

    def position(self) -> str:
        """Tell where reading is, for errors."""
        return f'after message {self.read}: ' if self.read else ''

    def decompressed(
        self, messages: Iterator[RawMessage], decompress: _Decompressor
    ) -> Iterator[RawMessage]:
        """Decompress each message."""
        number = 0
        try:
            for topic, received, data in messages:
                message, whole = decompress(data, _MAX_RECORD)
                if not whole:
                    raise ValueError('a compressed message is cut off or too large')
                yield topic, received, message
                number += 1
        finally:
            self.read = number


@contextmanager
def _opened(file: Path, read: int = 0) -> Iterator[_Storage]:
    """Open a file of a bag, whatever it is named; a compressed one by way of a temporary file.

    Args:
        file: to open.
        read: messages that were read before, from other files.

    Raises:
        BagError: for whatever is raised about the file, also by the one who uses it.
    """
    storage, broken = None, ''
    try:
        with ExitStack() as stack:
            source = stack.enter_context(file.open('rb'))
            content = file
            if _start(source, 4) in _FILE_OPENERS:
                content = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'bag')
                broken = _decompress_file(source, content)
                source = stack.enter_context(content.open('rb'))
            start = _start(source, 16)
            kind = next((kind for magic, kind in _KINDS.items() if start.startswith(magic)), None)
            if not kind:
                raise ValueError('not a bag of a known kind' if start else 'the file is empty')
            storage = stack.enter_context(closing(kind(content)))
            yield storage
            if broken:
                raise ValueError(broken)
    except BagError:
        raise
    except Exception as error:
        where, here = (storage.position(), storage.read) if storage else ('', 0)
        text = f'{file}: {where}{broken or _cause(error)}'
        raise (DamagedBagError if read + here else BagError)(text) from error


def _start(source: IO[bytes], size: int) -> bytes:
    start = source.read(size)
    source.seek(0)
    return start


_RECEIVED = itemgetter(1)
_MCAP_MAGIC = b'\x89MCAP0\r\n'
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _STATISTICS, _DATA_END = 2, 3, 4, 5, 6, 11, 15
_DATA = frozenset({_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK})
_KNOWLEDGE = frozenset({_SCHEMA, _CHANNEL, _STATISTICS})
_NO_SCHEMA = ('', '', '')  # type, syntax, definition
_RECORD = struct.Struct('<BQ')  # opcode, length of what follows
_MESSAGE_START = struct.Struct('<H4xQ')  # channel, reception; the data begin at byte 22
_BATCH = 4096  # messages outside of chunks that are handled together


class _Mcap(_Storage):
    """An mcap file, read from front to back: https://mcap.dev/spec.

    The index serves to know topics and counts without reading everything, no more. So a file
    without one is read like any other.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._stream = path.open('rb')
        self._size = os.fstat(self._stream.fileno()).st_size
        self._offset = 0
        self._schemas: dict[int, tuple[str, str, str]] = {}
        self._channels: dict[int, Topic] = {}
        self._total: int | None = None
        self._counts: dict[int, int] = {}
        self._wanted: Collection[str] = ()
        self._wanted_channels: dict[int, str] = {}

    def close(self) -> None:
        self._stream.close()

    def position(self) -> str:
        return f'at byte {self._offset}: '

    def topics(self) -> list[Topic]:
        self._read_summary()
        if not self._channels:
            try:
                for _ in self._batches():
                    pass
            except Exception:
                if not self._channels:
                    raise
        return list(self._channels.values())

    def count(self) -> int | None:
        return self._total

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        # Recorders with several threads, and those with several chunks open at a time, put
        # messages aside by up to a chunk: as much is held back to bring them into order.
        number = 0
        held: list[RawMessage] = []
        self._read_summary()
        self._wanted = topics
        for channel, topic in self._channels.items():
            self._want(channel, topic)
        batches = self._batches()
        while True:
            error, batch = None, None
            try:
                batch = next(batches, None)
            except Exception as caught:  # noqa: BLE001, raised below, behind what was held back
                error = caught
            if batch:
                batch.sort(key=_RECEIVED)
                if held and batch[0][1] < held[-1][1]:
                    merged = sorted(held + batch, key=_RECEIVED)
                    held, batch = merged[: len(held)], merged[len(held) :]
            yield from held
            number += len(held)
            self.read = number
            if batch is None:
                break
            held = batch
        if error:
            raise error
        expected = sum(self._counts.get(channel, 0) for channel in self._wanted_channels)
        if number < expected:
            raise ValueError(f'the index lists {expected} messages, there are {number}')

    def _batches(self) -> Iterator[list[RawMessage]]:
        """Walk through the file; on damage, give the messages before it and then raise."""
        stream, batch = self._stream, list[RawMessage]()
        self._offset = stream.seek(len(_MCAP_MAGIC))
        try:
            while header := stream.read(_RECORD.size):  # an unfinished file just ends
                if len(header) < _RECORD.size:
                    raise _CutOffError
                opcode, length = _RECORD.unpack(header)
                left = self._size - self._offset - 9
                if opcode in {_FOOTER, _DATA_END}:
                    break
                if not opcode:
                    raise ValueError('there is no record')
                if opcode in _DATA:
                    if min(length, left) > _MAX_RECORD:
                        raise ValueError(f'a record of {length} bytes is too large')
                    body = stream.read(min(length, left))
                    if opcode != _CHUNK:
                        self._walk(header + body, batch)
                    else:
                        with suppress(Exception) if length > left else nullcontext():
                            self._walk(_chunk_records(body, whole=length <= left), batch)
                if length > left:
                    raise _CutOffError
                if opcode == _CHUNK or len(batch) >= _BATCH:
                    yield batch
                    batch = []
                self._offset += 9 + length
                stream.seek(self._offset)
        except Exception:
            yield batch
            raise
        yield batch

    def _walk(self, records: bytes, batch: list[RawMessage]) -> None:
        """Append the wanted messages among records, up to the first damage."""
        wanted = self._wanted_channels
        unpack_record, unpack_message = _RECORD.unpack_from, _MESSAGE_START.unpack_from
        end, size = 0, len(records)
        try:
            while end < size:
                opcode, length = unpack_record(records, end)
                start = end + 9
                end = start + length
                if end > size:
                    raise _CutOffError
                if opcode == _MESSAGE:
                    channel, received = unpack_message(records, start)
                    if channel in wanted:
                        batch.append((wanted[channel], received, records[start + 22 : end]))
                elif opcode in _KNOWLEDGE:
                    self._learn(opcode, records[start:end])
        except struct.error as error:
            raise _CutOffError from error

    def _learn(self, opcode: int, body: bytes) -> None:
        if opcode == _STATISTICS:
            self._total, size = struct.unpack_from('<Q34xI', body)
            self._counts = dict(struct.iter_unpack('<HQ', body[46 : 46 + size]))
            return
        number, schema = struct.unpack_from('<HH', body)
        if opcode == _SCHEMA:
            # Definitions that are no text belong to encodings that are of no use here.
            texts = [text.decode(errors='replace') for text in _strings(body[2:], 3)]
            self._schemas[number] = texts[0], texts[1], texts[2]
        elif number not in self._channels:
            name, encoding, metadata = _strings(body[4:], 3)
            texts = [text.decode() for text in _strings(metadata)]
            known = dict(zip(texts[::2], texts[1::2], strict=True))
            topic = Topic(
                name.decode(),
                self._schemas.get(schema, _NO_SCHEMA)[0],
                encoding.decode(),
                *self._schemas.get(schema, _NO_SCHEMA)[1:],
                known.get('topic_type_hash', ''),
                known.get('offered_qos_profiles', ''),
            )
            self._channels[number] = topic
            self._want(number, topic)

    def _want(self, channel: int, topic: Topic) -> None:
        if topic.name in self._wanted:
            _check_encoding(topic)
            self._wanted_channels[channel] = topic.name

    def _read_summary(self) -> None:
        """Learn from the index, if there is one and it is sound."""
        try:
            end = self._stream.seek(-37, os.SEEK_END)
            opcode, _, start, _, _, magic = struct.unpack('<BQQQI8s', self._stream.read())
            if (opcode, magic) == (_FOOTER, _MCAP_MAGIC) and 0 < end - start < _MAX_RECORD:
                self._stream.seek(start)
                self._walk(self._stream.read(end - start), [])
        except Exception:  # noqa: BLE001, bytes of any kind
            self._schemas, self._channels, self._counts, self._total = {}, {}, {}, None


class _CutOffError(ValueError):
    def __str__(self) -> str:
        return 'cut off within a record'


def _strings(data: bytes, count: int | None = None) -> list[bytes]:
    """Split strings that stand one after the other, each behind its length."""
    strings: list[bytes] = []
    end = 0
    while len(strings) < count if count else end < len(data):
        (length,) = struct.unpack_from('<I', data, end)
        start, end = end + 4, end + 4 + length
        if end > len(data):
            raise ValueError('a string is longer than its record')
        strings.append(data[start:end])
    return strings


def _chunk_records(body: bytes, *, whole: bool) -> bytes:
    """Take the records out of a chunk; as many as there are, if it is not whole."""
    size, crc, name_length = struct.unpack_from('<16xQII', body)
    name = body[32 : 32 + name_length].decode()
    (length,) = struct.unpack_from('<Q', body, 32 + name_length)
    data = body[40 + name_length :][:length]
    if size > _MAX_RECORD:
        raise ValueError(f'a chunk of {size} bytes is too large')
    if name and name not in _DECOMPRESSORS:
        raise ValueError(f'unsupported compression {name!r}')
    records = _DECOMPRESSORS[name](data, size + 1)[0] if name else data
    if whole and len(records) != size:
        raise ValueError('a chunk is not of the size that it should have')
    if whole and crc and crc32(records) != crc:
        raise ValueError('a chunk does not match its checksum')
    return records


def _check_encoding(topic: Topic) -> None:
    if topic.encoding != 'cdr':
        raise ValueError(f'messages on {topic.name} are {topic.encoding!r}, not CDR')


class _Sqlite(_Storage):
    """An sqlite3 file."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        with ExitStack() as stack:
            path = _whole_pages(path, stack)
            # Without a journal nothing changes: no need for locks, which read-only media lack.
            journal = path.with_name(f'{path.name}-wal').exists()
            options = '?mode=ro' if journal else '?mode=ro&immutable=1'
            self._database = stack.enter_context(
                closing(
                    sqlite3.connect(
                        path.absolute().as_uri() + options, uri=True, check_same_thread=False
                    )
                )
            )
            self._resources = stack.pop_all()

    def close(self) -> None:
        self._resources.close()

    def _execute(self, query: str, parameters: Collection[object] = ()) -> sqlite3.Cursor:
        # So asked, sqlite reads a file that is shorter than it should be as far as it goes.
        self._database.execute('PRAGMA writable_schema=ON')
        return self._database.execute(query, tuple(parameters))

    def _rows(self, table: str) -> list[dict[str, Any]]:
        cursor = self._execute(f'SELECT * FROM {table}')  # noqa: S608, our own names
        return [dict(zip((c[0] for c in cursor.description), row, strict=True)) for row in cursor]

    def topics(self) -> list[Topic]:
        return list(self._topics().values())

    def _topics(self) -> dict[int, Topic]:
        definitions = {}
        with suppress(sqlite3.Error):  # there were none before version 4 of the schema
            definitions = {row['topic_type']: row for row in self._rows('message_definitions')}
        topics = {}
        for row in self._rows('topics'):
            known = definitions.get(row['type'], {}) | row
            topic = Topic(
                known['name'],
                known['type'],
                known['serialization_format'],
                known.get('encoding', ''),
                known.get('encoded_message_definition', ''),
                known.get('type_description_hash', ''),
                known.get('offered_qos_profiles', ''),
            )
            if not all(isinstance(text, str) for text in topic):
                raise ValueError('a topic is not described by texts')
            topics[known['id']] = topic
        return topics

    def count(self) -> int | None:
        with suppress(sqlite3.Error):
            return int(self._execute('SELECT count(*) FROM messages').fetchone()[0])
        return None

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        wanted = {key: topic for key, topic in self._topics().items() if topic.name in topics}
        for topic in wanted.values():
            _check_encoding(topic)
        names = {key: topic.name for key, topic in wanted.items()}
        places = ','.join('?' * len(names))
        number = 0
        try:
            for key, received, data in self._execute(
                'SELECT topic_id, timestamp, data FROM messages'  # noqa: S608, question marks
                f' WHERE topic_id IN ({places}) ORDER BY timestamp',
                names,
            ):
                if type(data) is not bytes or type(received) is not int:
                    raise ValueError('a message without a time or data')
                yield names[key], received, data
                number += 1
        finally:
            self.read = number


def _whole_pages(path: Path, stack: ExitStack) -> Path:
    """Give the path of a copy without the last page if that is cut off.

    sqlite would fill it up with zeros, and messages with them.
    """
    with path.open('rb') as source:
        (page_size,) = struct.unpack('>16xH', source.read(18))
        size = os.fstat(source.fileno()).st_size
        excess = size % (page_size if page_size > 1 else 2**16)
        if not excess:
            return path
        source.seek(0)
        copy = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'bag')
        with copy.open('wb') as target:
            shutil.copyfileobj(source, target)
            target.truncate(size - excess)
        return copy


class _Ros1(_Storage):
    """A ROS 1 bag."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._reader = rosbag1.Reader(path)
        self._reader.open()

    def close(self) -> None:
        self._reader.close()

    def topics(self) -> list[Topic]:
        return [self._topic(connection) for connection in self._reader.connections]

    def count(self) -> int | None:
        return self._reader.message_count

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        wanted = [c for c in self._reader.connections if c.topic in topics]
        stores = {c.msgtype: _typestore(self._topic(c)) for c in wanted}
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


_KINDS: Mapping[bytes, Callable[[Path], _Storage]] = {
    _MCAP_MAGIC: _Mcap,
    b'SQLite format 3\0': _Sqlite,
    b'#ROSBAG V2.0': _Ros1,
}


# Types, which only ROS 1 messages and the writer need.

_IDL_FILE = f'{"=" * 80}\nIDL: '


def _typestore(topic: Topic) -> Typestore:
    """Make a store of the types that a topic's definition defines, as they are in ROS 2."""
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


def _jazzy_definition(message_type: str) -> tuple[str, str]:
    """Give the definition and the hash of a type of ROS 2 Jazzy."""
    store = get_typestore(Stores.ROS2_JAZZY)
    if message_type not in store.fielddefs:
        raise ValueError(f'type {message_type} is not of ROS 2 Jazzy and needs a definition')
    return store.generate_msgdef(message_type, ros_version=2)[0], store.hash_rihs01(message_type)


def _ros2_definition(topic: Topic) -> tuple[str, str]:
    """Give the definition and the hash of a topic's type, the bag's own if it has them."""
    if not topic.definition:
        return _jazzy_definition(topic.type)
    if topic.syntax == 'ros1msg':
        store = _typestore(topic)
        return store.generate_msgdef(topic.type, ros_version=2)[0], store.hash_rihs01(topic.type)
    # rosbags takes a definition that does not begin so for one of the other syntax.
    if topic.syntax != ('ros2idl' if topic.definition.startswith(_IDL_FILE) else 'ros2msg'):
        raise ValueError(f'its type is defined in unknown {topic.syntax!r}')
    return topic.definition, topic.type_hash or _typestore(topic).hash_rihs01(topic.type)


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
