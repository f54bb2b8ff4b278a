# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The interface of a file of a bag, and the description of its topics."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple, Self

from gear_kinematics.bag.codecs import ReadLimits
from gear_kinematics.bag.errors import BagError
from gear_kinematics.wire.nearest import listed, nearest

_DATA = itemgetter(2)
Message = tuple[str, int, bytes]
"""Topic, time of reception in ns, CDR. A named tuple would take 15 times as long to make."""


class Published(bytes):
    """CDR that was published at another time than it was received."""

    time: int  # time of publication, ns

    @classmethod
    def at(cls, time: int, data: bytes) -> Self:
        """Attach a time of publication, ns, to bytes."""
        published = cls(data)
        published.time = time
        return published


class Topic(NamedTuple):
    """The description of a topic in a bag; a missing text is empty."""

    name: str
    type: str  # type as ROS 2 writes it, such as sensor_msgs/msg/JointState
    encoding: str  # encoding of the messages: cdr, or an unsupported one
    syntax: str = ''  # syntax of the type definition: ros2msg, ros2idl, ros1msg or an unknown one
    definition: str = ''
    type_hash: str = ''
    qos: Any = ''  # the offered QoS profiles, as a list or as YAML

    @classmethod
    def of(cls, known: Mapping[str, Any]) -> Self:
        """Take a description as rosbag2 writes it, in its metadata or database.

        Raises:
            KeyError: if something is missing.
            ValueError: if something is not text.
        """
        topic = cls(
            known['name'],
            known['type'],
            known['serialization_format'],
            known.get('encoding', ''),
            known.get('encoded_message_definition', ''),
            known.get('type_description_hash', ''),
            known.get('offered_qos_profiles', ''),
        )
        if not all(isinstance(text, str) for text in topic[:-1]):
            raise ValueError('the description of a topic is not text')
        return topic


class UnsortedError(ValueError):
    """Messages of an mcap that are too far out of order to be sorted while they are read."""

    def __init__(self) -> None:
        """Say how to sort them."""
        super().__init__(
            'messages are too far out of order in time; sort them: mcap recover IN.mcap -o '
            'INDEXED.mcap, then mcap sort INDEXED.mcap -o SORTED.mcap'
        )


class Storage:
    """A file of a bag."""

    def __init__(self, limits: ReadLimits) -> None:
        """Start with the limits on the files of the bag."""
        self.limits = limits
        self.found: dict[int, Topic] = {}  # channels that only reading the whole file shows
        self.after = 0  # ns, the time of reception at which the file before this one ends
        self.read = 0  # number of messages that the caller has taken from `pieces`
        self.unclosed = False  # whether it ended, when it was read, as if more could follow
        self.any_encoding = False  # whether messages are read that are not CDR, too
        self.publish_times = False  # whether messages are `Published` if the file has the times

    def topics(self) -> list[Topic]:
        """Return the topics of the file."""
        raise NotImplementedError

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read messages in the order of reception; an error comes after the last readable one.

        Where the clock of the recorder was reset, times of reception begin anew.
        """
        raise NotImplementedError

    def close(self) -> None:
        """Close the file."""
        raise NotImplementedError

    def check_encoding(self, topic: Topic) -> None:
        """Raise ValueError if the messages on a topic cannot be read, as they are not CDR."""
        if topic.encoding != 'cdr' and not self.any_encoding:
            raise ValueError(f'messages on {topic.name} are {topic.encoding!r}, not CDR')

    def position(self) -> str:
        """Position of reading, for error messages."""
        return f'after message {self.read}: ' if self.read else ''


def in_batches(messages: Iterable[Message], count: int = 256) -> Iterator[list[Message]]:
    """Group messages into batches of up to `count` messages and about 1 MiB; see `joined`."""
    return joined(([message] for message in messages), count, 2**20)


def joined(
    pieces: Iterable[list[Message]], count: int, size: int, new: Callable[[], Any] = list
) -> Iterator[Any]:
    """Join pieces to batches, each until it has `count` messages or `size` bytes.

    A batch begins as what `new` returns, to which pieces are added by `+=`. Messages before an
    exception are yielded before it is raised.
    """
    batch, messages, taken = new(), 0, 0
    try:
        for piece in pieces:
            batch += piece
            messages += len(piece)
            taken += sum(map(len, map(_DATA, piece)))
            if messages >= count or taken >= size:
                yield batch
                batch, messages, taken = new(), 0, 0
    except Exception:
        if messages:
            yield batch
        raise
    if messages:
        yield batch


def missing_topic(
    path: Path, topics: Mapping[str, str], name: str, wanted: str, *, suggest: bool = True
) -> BagError:
    """Return the error for a topic that is not in a bag, or not of the wanted type ('': any).

    It lists the topics, and may suggest the one with the nearest name.
    """
    of_type = {topic for topic, kind in topics.items() if kind == wanted}
    if name in topics:
        kind = f'type {topics[name]}' if topics[name] else 'unknown type'
        text = f'topic {name} is of {kind}, not {wanted}'
    else:
        text = f'no topic {name}' + (f' of type {wanted}' if wanted else '') + ' in it'
        text += nearest(name, sorted(of_type or topics)) if suggest else ''
    there = f'there are: {listed(topics, of_type)}' if topics else 'there are no topics'
    if '' in topics.values():
        there += '; some have no recorded type, as channels without a schema'
    return BagError(f'{path}: {text}{"" if text.endswith("?") else ";"} {there}')
