# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The interface of a file of a bag."""

from collections.abc import Collection, Iterable, Iterator

from gear_kinematics.bag.limits import Limits
from gear_kinematics.bag.topics import Topic

Message = tuple[str, int, bytes]
"""Topic, time of reception in ns, CDR. A named tuple would take 15 times as long to make."""


class Storage:
    """A file of a bag."""

    def __init__(self, limits: Limits) -> None:
        """Start with the limits on the files of the bag."""
        self.limits = limits
        self.read = 0
        """Number of messages that the caller has taken from `pieces`."""

    def topics(self) -> list[Topic]:
        """Return the topics of the file."""
        raise NotImplementedError

    def count(self) -> int | None:
        """Return the number of messages; None if unknown without reading all of them."""
        raise NotImplementedError

    def pieces(self, topics: Collection[str]) -> Iterator[list[Message]]:
        """Read the messages on the given topics, some at a time, in the order of reception.

        Those before an error are yielded before it is raised.
        """
        raise NotImplementedError

    def close(self) -> None:
        """Close the file."""
        raise NotImplementedError

    def position(self) -> str:
        """Position of reading, for error messages."""
        return f'after message {self.read}: ' if self.read else ''


def in_batches(
    messages: Iterable[Message], count: int = 256, size: int = 2**20
) -> Iterator[list[Message]]:
    """Group messages into batches of up to `count` messages, and of about `size` bytes at most.

    Messages before an exception are yielded before it is raised.
    """
    batch, taken = list[Message](), 0
    try:
        for message in messages:
            batch.append(message)
            taken += len(message[2])
            if len(batch) == count or taken >= size:
                yield batch
                batch, taken = [], 0
    except Exception:
        if batch:
            yield batch
        raise
    if batch:
        yield batch


def check_encoding(topic: Topic) -> None:
    """Make sure that the messages on a topic are CDR.

    Raises:
        ValueError: if they are not.
    """
    if topic.encoding != 'cdr':
        raise ValueError(f'messages on {topic.name} are {topic.encoding!r}, not CDR')
