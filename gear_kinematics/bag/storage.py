"""The interface of storages: the files that a bag consists of."""

from collections.abc import Collection, Iterator

from gear_kinematics.bag.compression import Decompressor, expanded
from gear_kinematics.bag.limits import Budget, Descriptions
from gear_kinematics.bag.topics import Topic

Message = tuple[str, int, bytes]
"""Topic, reception in ns, CDR."""


class Storage:
    """A file of a bag."""

    def __init__(self, budget: Budget) -> None:
        """Begin.

        Args:
            budget: what may come out of the files of the bag.
        """
        self.budget = budget
        self.descriptions = Descriptions()
        self.read = 0
        """Messages that have been taken out; up to date whenever an error is raised."""

    def topics(self) -> list[Topic]:
        """Give what the file says about its topics."""
        raise NotImplementedError

    def count(self) -> int | None:
        """Count the messages; None where only reading all of them would tell."""
        raise NotImplementedError

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Read the messages on topics in the order of reception, as far as there are any."""
        raise NotImplementedError

    def close(self) -> None:
        """Close the file."""
        raise NotImplementedError

    def position(self) -> str:
        """Tell where reading is, for errors."""
        return f'after message {self.read}: ' if self.read else ''

    def decompressed(
        self, messages: Iterator[Message], decompress: Decompressor
    ) -> Iterator[Message]:
        """Decompress each message."""
        number = 0
        try:
            for topic, received, data in messages:
                message, whole = expanded(decompress, data, self.budget)
                if not whole:
                    raise ValueError('a compressed message is cut off or too large')
                yield topic, received, message
                number += 1
        finally:
            self.read = number
