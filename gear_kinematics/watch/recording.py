"""Records topics to a bag, message by message as they come, and counts what is lost."""

import time
from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from types import MappingProxyType
from typing import NamedTuple

from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy

from gear_kinematics.bag import BagError, LiveBagWriter, Message
from gear_kinematics.watch.polled import PolledSubscription, Taken
from gear_kinematics.wire.cdr import header_stamp

_PERIOD = 0.01  # s between looks into the queues, which hold 2000 messages
_PATIENCE = 2.0  # s to wait for the answers to the last inputs
_FLUSH_PERIOD = 1.0  # s; as much is missing at most if the process is killed


class Recorded(NamedTuple):
    """What a recording holds."""

    path: Path
    seconds: float
    counts: Mapping[str, int]
    """Messages by topic."""
    lost: int | None
    """Messages that are missing between those; None if the middleware does not number them."""
    error: str
    """Why the recording ended by itself; '' while it goes on."""

    @property
    def messages(self) -> int:
        """Messages of all topics."""
        return sum(self.counts.values())


class _Channel:
    """A topic, and the number that its next message should have."""

    def __init__(self, node: Node, topic: str, message_type: type) -> None:
        # Reliable, unless a publisher offers less.
        self.source = PolledSubscription(
            node, topic, message_type, ReliabilityPolicy.BEST_AVAILABLE
        )
        self.count = 0
        self.lost = 0
        self.numbered = True
        self.stamp = -1
        """Of the latest message, ns."""
        self._last: int | None = None

    def take(self) -> list[Message]:
        """Take what has come."""
        topic = self.source.topic
        taken = list(self.source.take())
        if taken:
            self._count_losses(taken)
            self.stamp = header_stamp(taken[-1].data)
        return [(topic, message.received, message.data) for message in taken]

    def _count_losses(self, taken: list[Taken]) -> None:
        self.count += len(taken)
        several = self.source.publishers() > 1  # which of them sent a message is not known
        for message in taken:
            if message.number is None:
                self.numbered = False
            elif self._last is not None and message.number > self._last and not several:
                self.lost += message.number - self._last - 1
            self._last = message.number


class Recording:
    """A recording in progress.

    One thread takes the messages from the middleware and another writes them, so that a slow disk
    does not make the queues overflow.
    """

    def __init__(
        self,
        node: Node,
        topics: Mapping[str, tuple[str, type]],
        path: Path,
        answers: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        """Begin to record.

        Args:
            node: subscribes; subscriptions are made and removed by the caller's thread only.
            topics: type of each topic, by name and as a class.
            path: folder to create.
            answers: topics whose messages have the stamps of those that they answer, each with
                the topic of these.

        Raises:
            BagError: if it exists already or cannot be written.
        """
        self.path = path
        self._bag = LiveBagWriter(path)
        with ExitStack() as stack:
            stack.enter_context(self._bag)
            for topic, (message_type, _) in topics.items():
                self._bag.add_topic(topic, message_type)
            self._open = stack.pop_all()
        self._began = time.monotonic()
        self._seconds: float | None = None
        self._error = ''
        self._channels = [_Channel(node, topic, kind) for topic, (_, kind) in topics.items()]
        by_topic = {channel.source.topic: channel for channel in self._channels}
        self._answers = {by_topic[topic]: by_topic[asked] for topic, asked in answers.items()}
        self._stopping = Event()
        self._queue: SimpleQueue[list[Message] | None] = SimpleQueue()
        self._threads = [Thread(target=self._take), Thread(target=self._write)]
        for thread in self._threads:
            thread.start()

    def status(self) -> Recorded:
        """What there is so far."""
        numbered = all(channel.numbered for channel in self._channels)
        elapsed = time.monotonic() - self._began
        return Recorded(
            self.path,
            elapsed if self._seconds is None else self._seconds,
            Counter({channel.source.topic: channel.count for channel in self._channels}),
            sum(channel.lost for channel in self._channels) if numbered else None,
            self._error,
        )

    def stop(self) -> Recorded:
        """Take what has come, and finish the bag, or leave it as it is after an error."""
        self._seconds = time.monotonic() - self._began
        self._stopping.set()
        for thread in self._threads:
            thread.join()
        for channel in self._channels:
            channel.source.close()
        error = BagError(self._error) if self._error else None
        try:
            self._open.__exit__(type(error) if error else None, error, None)
        except BagError as problem:
            self._error = self._error or str(problem)
        return self.status()

    def _take(self) -> None:
        stopping = False
        while not stopping:
            stopping = self._stopping.wait(_PERIOD)
            self._pass_on(self._channels)
        # A node that is behind has not answered the last inputs yet.
        end = time.monotonic() + _PATIENCE
        while time.monotonic() < end and any(
            answer.stamp < asked.stamp for answer, asked in self._answers.items()
        ):
            time.sleep(_PERIOD)
            self._pass_on(self._answers)
        self._queue.put(None)

    def _pass_on(self, channels: Iterable[_Channel]) -> None:
        messages = [message for channel in channels for message in channel.take()]
        self._queue.put(sorted(messages, key=lambda message: message[1]))

    def _write(self) -> None:
        flushed = time.monotonic()
        while (messages := self._queue.get()) is not None:
            if self._error:
                continue
            try:
                self._bag.write_all(messages)
                if time.monotonic() >= flushed + _FLUSH_PERIOD:
                    self._bag.flush()
                    flushed = time.monotonic()
            except BagError as error:
                self._error = str(error)
