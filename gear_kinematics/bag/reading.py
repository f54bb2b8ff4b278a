"""Reads recordings of any storage, and opens their files by content, whatever their names."""

import tempfile
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import IO, Self

from gear_kinematics.bag.contents import find_contents
from gear_kinematics.bag.errors import BagError, DamagedBagError, bag_errors, cause
from gear_kinematics.bag.mcap import MCAP_MAGIC, Mcap
from gear_kinematics.bag.ros1 import Ros1
from gear_kinematics.bag.sqlite import Sqlite
from gear_kinematics.bag.storage import (
    FILE_OPENERS,
    MESSAGE_DECOMPRESSORS,
    Budget,
    Descriptions,
    Message,
    Storage,
    decompress_file,
)
from gear_kinematics.bag.topics import Topic, missing_topic

ReportProgress = Callable[[int, int | None], None]
"""Called repeatedly with the number of messages done, and the total if known."""

_BATCH = 8192  # messages
_BATCH_SIZE = 2**24  # bytes
_KINDS: Mapping[bytes, Callable[[Path, Budget], Storage]] = {
    MCAP_MAGIC: Mcap,
    b'SQLite format 3\0': Sqlite,
    b'#ROSBAG V2.0': Ros1,
}


@dataclass(slots=True)
class TopicMessages:
    """Messages of one topic."""

    data: list[bytes] = field(default_factory=list)
    """CDR."""
    received: list[int] = field(default_factory=list)
    """ns."""


class Bag:
    """A recording: a rosbag2 folder, one of its files alone, or a ROS 1 bag.

    A context manager, which ends unfinished reading on exit.
    """

    topics: Mapping[str, str]
    """Types by name, such as sensor_msgs/msg/JointState."""
    message_count: int | None
    """On all topics; None if unknown without reading all of them."""
    named: Mapping[str, str]
    """Its topics by the names that the recorder gave them, see `BagWriter.name_topic`."""

    def __init__(self, path: Path | str) -> None:
        """Read the topics and the number of messages.

        Raises:
            BagError: if there is no readable bag.
        """
        self.path = Path(path)
        self._readings = ExitStack()
        self._described: dict[str, Topic] = {}
        with bag_errors(self.path):
            self._files, self._listed, self.message_count, custom = find_contents(self.path)
        if not self._listed:
            self._describe()
        known = self._listed or self._described
        self.topics = MappingProxyType({topic.name: topic.type for topic in known.values()})
        self.named = {name: topic for name, topic in custom.items() if topic in self.topics}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._readings.close()

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Read raw messages in the order in which they were received, those of ROS 1 as CDR.

        Args:
            topics: names; a topic that is not in the bag has no messages.

        Yields:
            Topic, time of reception in ns, CDR in the byte order of the recording.

        Raises:
            BagError: if no message can be read.
            DamagedBagError: after the last readable message.
        """
        reading = self._read(frozenset(topics))
        self._readings.callback(reading.close)
        return reading

    def read(
        self, columns: Mapping[str, TopicMessages], progress: ReportProgress | None = None
    ) -> None:
        """Read all messages on topics.

        Args:
            columns: filled with the messages of each topic, up to an error.
            progress: called after each batch; the total counts all topics of the bag.

        Raises:
            BagError: as `messages` does.
        """
        messages = self.messages(columns)
        for batch in in_batches(messages, progress=progress, total=self.message_count):
            sort_by_topic(batch, columns)

    def type_of(self, topic: str, wanted: str = '') -> str:
        """Return the type of a topic.

        Raises:
            BagError: if the topic is not in the bag, or not of the wanted type.
        """
        found = self.topics.get(topic)
        if found is None or (wanted and found != wanted):
            raise missing_topic(self.path, self.topics, topic, wanted)
        return found

    def describe(self, name: str) -> Topic:
        """Return the description of a topic.

        Raises:
            BagError: if it is not in the bag, or the bag cannot be read.
        """
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

    def _budget(self) -> Budget:
        return Budget(sum(file.stat().st_size for file in self._files if file.exists()))

    def _describe(self) -> None:
        """Collect the descriptions of the topics, and count messages if metadata did not."""
        counts: list[int | None] = []
        budget, descriptions, definitions = self._budget(), Descriptions(), set[str]()
        for file in self._files:
            try:
                with _opened(file, budget) as storage:
                    for topic in storage.topics():
                        if topic.name in self._described:
                            continue
                        new = topic.definition not in definitions
                        descriptions.add(len(topic.definition) if new else 0)
                        definitions.add(topic.definition)
                        self._described[topic.name] = topic
                    counts.append(storage.count())
            except BagError:
                if not counts:
                    raise
                counts.append(None)  # reading the messages will raise it
            if self._listed and self._listed.keys() <= self._described.keys():
                return
        if not self._listed:
            known = [count for count in counts if count is not None]
            self.message_count = sum(known) if len(known) == len(counts) else None

    def _read(self, topics: frozenset[str]) -> Generator[Message, None, None]:
        read, budget = 0, self._budget()
        for file in self._files:
            with _opened(file, budget, read) as storage:
                messages = storage.messages(topics)
                for first in messages:
                    messages = chain([first], messages)
                    decompress = MESSAGE_DECOMPRESSORS.get(first[2][:4])
                    if decompress:
                        messages = storage.decompressed(messages, decompress)
                    yield from messages
            read += storage.read


def in_batches(
    messages: Iterable[Message],
    size: int = _BATCH,
    progress: ReportProgress | None = None,
    total: int | None = None,
) -> Iterator[list[Message]]:
    """Group messages into batches of up to `size` messages and 16 MiB.

    Messages before an exception are yielded before it is raised; the last batch may be empty.

    Args:
        messages: the messages.
        size: largest number of messages in a batch.
        progress: called after each batch.
        total: number of all messages, for `progress`.
    """
    done = 0
    for batch in _batches(messages, size):
        yield batch
        done += len(batch)
        if progress:
            progress(done, total)


def _batches(messages: Iterable[Message], size: int) -> Iterator[list[Message]]:
    batch, taken = list[Message](), 0
    try:
        for message in messages:
            batch.append(message)
            taken += len(message[2])
            if len(batch) == size or taken >= _BATCH_SIZE:
                yield batch
                batch, taken = [], 0
    except Exception:
        yield batch
        raise
    yield batch


def sort_by_topic(messages: Iterable[Message], columns: Mapping[str, TopicMessages]) -> None:
    """Append messages to the columns of their topics."""
    for topic, received, data in messages:
        column = columns[topic]
        column.data.append(data)
        column.received.append(received)


def is_bag_file(path: Path) -> bool:
    """Return whether a file is one of a bag, or compressed as such are, by its content.

    Raises:
        OSError: if it cannot be read.
    """
    with path.open('rb') as file:
        start = _start(file, 16)
    return start.startswith(tuple(_KINDS)) or start[:4] in FILE_OPENERS


@contextmanager
def _opened(file: Path, budget: Budget, read: int = 0) -> Iterator[Storage]:
    """Open a file of a bag, if compressed via a temporary file.

    Args:
        file: to open.
        budget: limits on the files of the bag.
        read: number of messages already read from other files.

    Raises:
        BagError: for any exception about the file, also from the body of the with statement.
    """
    storage, broken = None, ''
    try:
        with ExitStack() as stack:
            source = stack.enter_context(file.open('rb'))
            content = file
            if opener := FILE_OPENERS.get(_start(source, 4)):
                content = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'bag')
                broken = decompress_file(source, content, opener)
                source = stack.enter_context(content.open('rb'))
            start = _start(source, 16)
            kind = next((kind for magic, kind in _KINDS.items() if start.startswith(magic)), None)
            if not kind:
                raise ValueError('not a bag of a known kind' if start else 'the file is empty')
            storage = stack.enter_context(closing(kind(content, budget)))
            yield storage
            if broken:
                raise ValueError(broken)
    except BagError:
        raise
    except Exception as error:
        where, here = (storage.position(), storage.read) if storage else ('', 0)
        text = f'{file}: {where}{broken or cause(error)}'
        raise (DamagedBagError if read + here else BagError)(text) from error


def _start(source: IO[bytes], size: int) -> bytes:
    start = source.read(size)
    source.seek(0)
    return start
