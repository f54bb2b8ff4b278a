# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Records topics to a bag, message by message as they come, and counts what is lost."""

import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from typing import NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray
from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import JointState

from gear_kinematics.bag import BagError, Message
from gear_kinematics.bag.errors import bag_errors
from gear_kinematics.state.losses import Losses
from gear_kinematics.watch.polled import PolledSubscription
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import header_stamp

_PERIOD = 0.01  # s between looks into the queues, which hold 2000 messages
_PATIENCE = 2.0  # s to wait for the answers to the last inputs
_FLUSH_PERIOD = 1.0  # s; as much is missing at most if the process is killed


RECORDED_TYPES = {
    topics.JOINT_STATE: JointState,
    topics.POSE_ARRAY: PoseArray,
    topics.TOPICS[topics.DIAGNOSTICS].type: DiagnosticArray,
}  # classes by name


class Recorded(NamedTuple):
    """What a recording holds."""

    path: Path
    seconds: float
    counts: Mapping[str, int]  # messages by topic
    lost: int  # messages that are missing on the topics whose losses are counted
    uncounted: tuple[str, ...]  # topics of several publishers, or of messages without numbers
    error: str  # why the recording ended by itself; '' while it goes on

    def __str__(self) -> str:
        lost = f'{self.lost} lost'
        if self.uncounted:
            lost += f', not counted on {", ".join(self.uncounted)}'
        return f'{sum(self.counts.values())} messages, {lost}'


class Channel:
    """A topic that is recorded: reliably, unless a publisher offers less."""

    def __init__(self, node: Node, topic: str, kind: str) -> None:
        reliability = ReliabilityPolicy.BEST_AVAILABLE
        self.source = PolledSubscription(node, topic, RECORDED_TYPES[kind], reliability)
        self.type = kind
        self.count = 0
        self.losses = Losses()
        self.counted = True  # whether every loss is known
        self.stamp = -1  # of the latest message, ns

    def take(self) -> list[Message]:
        """Take what has come."""
        taken = list(self.source.take())
        for message in taken:
            self.losses.note(message.number)
        if taken:
            self.count += len(taken)
            self.stamp = header_stamp(taken[-1].data)
            # Which of several has sent a message is not known.
            self.counted &= self.losses.numbered and self.source.publishers() <= 1
        return [(self.source.topic, message.received, message.data) for message in taken]


class Recording:
    """A recording in progress.

    One thread takes the messages from the middleware and another writes them, so that a slow disk
    does not make the queues overflow. BagError is raised if the folder cannot be created, or
    rosbags is not installed.
    """

    def __init__(self, path: Path) -> None:
        with bag_errors(path):
            from gear_kinematics.bag.writing import LiveBagWriter  # noqa: PLC0415, needs rosbags
        self.path = path
        self._bag = LiveBagWriter(path)
        self._bag.__enter__()
        self._began = time.monotonic()
        self._seconds = 0.0  # at its end
        self._error = ''
        self._channels: dict[str, Channel] = {}  # by topic
        self._answers: dict[str, str] = {}
        self._stopping = Event()
        self._queue: SimpleQueue[list[Message] | None] = SimpleQueue()
        self._threads = [Thread(target=self._take), Thread(target=self._write)]
        for thread in self._threads:
            thread.start()

    def add(self, node: Node, types: Mapping[str, str], answers: Mapping[str, str]) -> None:
        """Record topics, given with their types, from now on, beside those that are recorded.

        `answers` are topics whose messages have the stamps of those that they answer, each with
        the topic of these. Subscriptions are made and removed by the caller's thread only.
        """
        for topic, kind in types.items():
            if topic not in self._channels:
                self._channels[topic] = Channel(node, topic, kind)
        self._answers |= answers

    def status(self) -> Recorded:
        """What there is so far."""
        channels = list(self._channels.items())
        return Recorded(
            self.path,
            self._seconds or time.monotonic() - self._began,
            {topic: channel.count for topic, channel in channels},
            sum(channel.losses.missing for _, channel in channels if channel.counted),
            tuple(topic for topic, channel in channels if not channel.counted),
            self._error,
        )

    def stop(self) -> Recorded:
        """Take what has come, and finish the bag, or leave it as it is after an error."""
        self._seconds = time.monotonic() - self._began
        self._stopping.set()
        for thread in self._threads:
            thread.join()
        for channel in self._channels.values():
            channel.source.close()
        try:
            self._bag.__exit__(BagError if self._error else None, None, None)
        except BagError as problem:
            self._fail(problem)
        return self.status()

    def _take(self) -> None:
        try:
            stopping = False
            while not stopping:
                stopping = self._stopping.wait(_PERIOD)
                self._pass_on(list(self._channels.values()))
            # A node that is behind has not answered the last inputs yet.
            waiting = [
                (self._channels[answer], self._channels[asked])
                for answer, asked in self._answers.items()
                if {answer, asked} <= self._channels.keys()
            ]
            end = time.monotonic() + _PATIENCE
            while time.monotonic() < end and any(a.stamp < b.stamp for a, b in waiting):
                time.sleep(_PERIOD)
                self._pass_on([answer for answer, _ in waiting])
        except Exception as error:  # noqa: BLE001, ends the recording, and is shown
            self._fail(error)
        finally:
            self._queue.put(None)

    def _pass_on(self, channels: Iterable[Channel]) -> None:
        messages = [message for channel in channels for message in channel.take()]
        self._queue.put(sorted(messages, key=lambda message: message[1]))

    def _write(self) -> None:
        flushed, known = time.monotonic(), 0
        while (messages := self._queue.get()) is not None:
            if self._error:
                continue
            try:
                for topic, channel in list(self._channels.items())[known:]:
                    self._bag.add_topic(topic, channel.type)
                    known += 1
                self._bag.write_all(messages)
                if time.monotonic() >= flushed + _FLUSH_PERIOD:
                    self._bag.flush()
                    flushed = time.monotonic()
            except Exception as error:  # noqa: BLE001, as above
                self._fail(error)

    def _fail(self, error: Exception) -> None:
        cause = str(error) if isinstance(error, BagError) else f'{type(error).__name__}: {error}'
        self._error = self._error or cause
