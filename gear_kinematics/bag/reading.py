# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads recordings of any storage, and opens their files by content, whatever their names."""

import tempfile
from collections import defaultdict
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import IO, Any, Self

from gear_kinematics.bag.codecs import ReadLimits, codec_of, decompress_file, decompressed
from gear_kinematics.bag.errors import BagError, DamagedBagError, bag_errors, cause
from gear_kinematics.bag.finding import METADATA, NO_CONTENT, POINTER, find_contents, table_format
from gear_kinematics.bag.mcap import MCAP_MAGIC, Mcap
from gear_kinematics.bag.sqlite import Sqlite
from gear_kinematics.bag.storage import (
    Message,
    Storage,
    Topic,
    UnsortedError,
    in_batches,
    joined,
    missing_topic,
)

ReportProgress = Callable[[int, int | None], None]
"""Called repeatedly with the number of messages done, and the total if known."""
_BATCH, _BATCH_SIZE, _TOPICS = 32_768, 2**23, 3
"""Messages and bytes of so many topics; with half of them, validating takes 1.1 times as long."""


def _ros1(path: Path, limits: ReadLimits) -> Storage:
    from gear_kinematics.bag.ros1 import Ros1  # noqa: PLC0415, needs rosbags

    return Ros1(path, limits)


_KINDS: Mapping[bytes, Callable[[Path, ReadLimits], Storage]] = {
    MCAP_MAGIC: Mcap,
    b'SQLite format 3\0': Sqlite,
    b'#ROSBAG V2.0': _ros1,
}
_TABLES = '; tables are read by calibrate, commission, loads and lost-motion'


@dataclass(slots=True)
class TopicMessages:
    """Messages of one topic."""

    data: list[bytes] = field(default_factory=list)  # contents as CDR
    received: list[int] = field(default_factory=list)  # times of reception, ns


class MessagesByTopic(dict[str, TopicMessages]):
    """The messages of each topic, in the order of reception; other topics have none."""

    def __init__(self, topics: Iterable[str], messages: Iterable[Message] = ()) -> None:
        """Divide messages by their topics, all of which must be among the given ones."""
        super().__init__({topic: TopicMessages() for topic in topics})
        self._append = {topic: (of.data.append, of.received.append) for topic, of in self.items()}
        self += messages

    def __iadd__(self, messages: Iterable[Message]) -> Self:
        append = self._append
        for topic, received, data in messages:
            add_data, add_received = append[topic]
            add_data(data)
            add_received(received)
        return self

    def __missing__(self, topic: str) -> TopicMessages:
        return TopicMessages()


class Bag:
    """A recording: a rosbag2 folder, one of its files, or a ROS 1 bag; on exit, reading ends."""

    topics: Mapping[str, str]  # types by name, such as sensor_msgs/msg/JointState
    not_cdr: frozenset[str]  # topics whose messages are of another encoding
    message_count: int | None  # number of messages on all topics; None without metadata.yaml
    unclosed = False  # whether a file that was read was never closed, as by a killed recorder
    joints: dict[tuple[str, ...], dict[str, list[str]]]  # what `roles.joints_on` has returned

    def __init__(self, path: Path | str) -> None:
        """Read the topics; raises BagError if there is no readable bag."""
        self.path = Path(path)
        self._readings = ExitStack()
        self._described: dict[str, Topic] = {}
        self._found = defaultdict[Path, dict[int, Topic]](dict)
        self.joints = {}
        with bag_errors(self.path):
            self._files, self._listed, self.message_count = find_contents(self.path)
        if not self._listed:
            self._describe()
        known = self._listed or self._described
        self.topics = MappingProxyType({topic.name: topic.type for topic in known.values()})
        self.not_cdr = frozenset(name for name, topic in known.items() if topic.encoding != 'cdr')

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._readings.close()

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Read raw messages in the order of reception; messages of ROS 1 are converted to CDR.

        Raises:
            BagError: if no message can be read.
            DamagedBagError: after the last readable message.
        """
        return chain.from_iterable(self._pieces(topics))

    def batches(
        self,
        topics: Collection[str],
        progress: ReportProgress | None = None,
        *,
        any_encoding: bool = False,
        publish_times: bool = False,
    ) -> Iterator[list[Message]]:
        """Read raw messages as `messages` does, many at a time, which is faster.

        The total in `progress` counts all topics of the bag. `any_encoding` reads messages that
        are not CDR as well; with `publish_times`, those of an mcap are `Published`.
        """
        options = {'any_encoding': any_encoding, 'publish_times': publish_times}
        return self._batches(self._pieces(topics, **options), topics, progress, list)

    def by_topic(
        self, topics: Collection[str], progress: ReportProgress | None = None
    ) -> Iterator[MessagesByTopic]:
        """Read the messages of each topic as `batches` does, in less time."""
        new = partial(MessagesByTopic, topics)
        return self._batches(self._pieces(topics), topics, progress, new)

    def _batches(
        self,
        pieces: Iterator[list[Message]],
        topics: Collection[str],
        progress: ReportProgress | None,
        new: Callable[[], Any],
    ) -> Iterator[Any]:
        share, done = max(1, len(topics) // _TOPICS), 0

        def counted() -> Iterator[list[Message]]:
            nonlocal done
            for piece in pieces:
                done += len(piece)
                yield piece

        for batch in joined(counted(), share * _BATCH, share * _BATCH_SIZE, new):
            yield batch
            if progress:
                progress(done, self.message_count)

    def type_of(self, topic: str, wanted: str = '') -> str:
        """Return the type of a topic; BagError if the bag lacks it, or it is not as wanted."""
        found = self.topics.get(topic)
        if found is None or (wanted and found != wanted):
            raise missing_topic(self.path, self.topics, topic, wanted)
        return found

    def describe(self, name: str) -> Topic:
        """Return the description of a topic; raises BagError if it is missing or unreadable."""
        self.type_of(name)
        if not self._described:
            self._describe()
        listed = self._listed.get(name) or self._described[name]
        topic = self._described.get(name, listed)
        return topic._replace(
            type=listed.type,
            type_hash=topic.type_hash or listed.type_hash,
            qos=topic.qos or listed.qos,
        )

    def _limits(self) -> ReadLimits:
        return ReadLimits(sum(file.stat().st_size for file in self._files if file.exists()))

    def _describe(self) -> None:
        limits = self._limits()
        for file in self._files:
            try:
                with _opened(file, limits) as storage:
                    storage.found = self._found[file]
                    for topic in storage.topics():
                        self._described.setdefault(topic.name, topic)
            except BagError:
                if not self._described:
                    raise  # otherwise, reading the messages will raise it
            if self._listed and self._listed.keys() <= self._described.keys():
                return

    def _pieces(self, topics: Collection[str], **options: bool) -> Iterator[list[Message]]:
        reading = self._read(frozenset(topics), options)
        self._readings.callback(reading.close)
        return reading

    def _read(
        self, topics: frozenset[str], options: Mapping[str, bool]
    ) -> Generator[list[Message], None, None]:
        read, after, limits = 0, 0, self._limits()
        for file in self._files:
            with _opened(file, limits, read) as storage:
                storage.found, storage.after = self._found[file], after
                storage.any_encoding = options.get('any_encoding', False)
                storage.publish_times = options.get('publish_times', False)
                for piece in _plain(storage.pieces(topics), limits):
                    storage.read += len(piece)
                    after = piece[-1][1] if piece else after
                    yield piece
            read += storage.read
            self.unclosed |= storage.unclosed


def _plain(pieces: Iterator[list[Message]], limits: ReadLimits) -> Iterator[list[Message]]:
    """Decompress messages, if the first one is compressed."""
    first = next(pieces, [])
    pieces = chain([first], pieces)
    if not first or not (codec := codec_of(first[0][2])):
        return pieces
    return in_batches(
        (topic, received, decompressed(data, codec.decompress, limits, 'a compressed message'))
        for topic, received, data in chain.from_iterable(pieces)
    )


@contextmanager
def _opened(file: Path, limits: ReadLimits, read: int = 0) -> Iterator[Storage]:
    """Open a file of a bag after `read` messages of others; if compressed, a temporary copy.

    Any exception about the file, also from the body of the with statement, becomes a BagError.
    """
    storage, broken = None, ''
    try:
        with ExitStack() as stack:
            source = stack.enter_context(file.open('rb'))
            content = file
            if codec := codec_of(_start(source, 4)):
                content = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'bag')
                broken = decompress_file(source, content, codec)
                source = stack.enter_context(content.open('rb'))
            start = _start(source, 16)
            kind = next((kind for magic, kind in _KINDS.items() if start.startswith(magic)), None)
            if not kind:
                known = f'not a bag of a known kind{_TABLES if table_format(file) else ""}'
                known = NO_CONTENT if start == POINTER else known
                raise ValueError(known if start else 'the file is empty')
            storage = stack.enter_context(closing(kind(content, limits)))
            yield storage
            if broken:
                raise ValueError(broken)
    except BagError:
        raise
    except Exception as error:
        where, here = (storage.position(), storage.read) if storage else ('', 0)
        text = f'{file}: {where}{broken or cause(error)}'
        if isinstance(error, FileNotFoundError) and (file.parent / METADATA).exists():
            text += f'; {METADATA} lists it; without {METADATA}, the other files are read'
        damaged = read + here and not isinstance(error, UnsortedError)
        raise (DamagedBagError if damaged else BagError)(text) from error


def _start(source: IO[bytes], size: int) -> bytes:
    start = source.read(size)
    source.seek(0)
    return start
