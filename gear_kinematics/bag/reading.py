"""Reading a recording, whatever it consists of."""

from collections.abc import Collection, Generator, Iterator, Mapping
from contextlib import ExitStack
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, Self

from gear_kinematics.bag.compression import MESSAGE_DECOMPRESSORS
from gear_kinematics.bag.contents import find_contents
from gear_kinematics.bag.errors import BagError, bag_errors
from gear_kinematics.bag.limits import Budget, Descriptions
from gear_kinematics.bag.opening import opened
from gear_kinematics.bag.storage import RawMessage
from gear_kinematics.bag.topics import Topic


class BagMessage(NamedTuple):
    """A message as it was recorded."""

    topic: str
    received: int
    """ns."""
    data: bytes
    """CDR."""


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
        with bag_errors(self.path):
            self._files, self._listed, self.message_count = find_contents(self.path)
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

    def _budget(self) -> Budget:
        return Budget(sum(file.stat().st_size for file in self._files if file.exists()))

    def _describe(self) -> None:
        """Collect what the files say about topics, and count messages if nothing else did."""
        counts: list[int | None] = []
        budget, descriptions, definitions = self._budget(), Descriptions(), set[str]()
        for file in self._files:
            try:
                with opened(file, budget) as storage:
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
                counts.append(None)  # reading will come to it, and say it then
            if self._listed and self._listed.keys() <= self._described.keys():
                return
        if not self._listed:
            known = [count for count in counts if count is not None]
            self.message_count = sum(known) if len(known) == len(counts) else None

    def _read(self, topics: frozenset[str]) -> Generator[RawMessage, None, None]:
        read, budget = 0, self._budget()
        for file in self._files:
            with opened(file, budget, read) as storage:
                messages = storage.messages(topics)
                for first in messages:
                    messages = chain([first], messages)
                    decompress = MESSAGE_DECOMPRESSORS.get(first[2][:4])
                    if decompress:
                        messages = storage.decompressed(messages, decompress)
                    yield from messages
            read += storage.read


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
