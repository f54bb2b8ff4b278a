# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The drivers, with their joints and rates."""

import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

from rclpy.node import Node

from gear_kinematics.bag import Message
from gear_kinematics.ros.graph import Graph
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.polled import Polled
from gear_kinematics.wire.cdr import MalformedMessageError, joint_names, joint_state_layout

_PERIOD = 0.1  # s between looks at graph and messages
_WAIT = 4.0  # s; a driver may find a listener only when it announces itself, every 3 s


@dataclass(frozen=True, slots=True)
class DriverTopic:
    """A topic of type JointState that no gear node publishes."""

    topic: str
    joints: tuple[str, ...]  # as `rotor_joint` selects them; empty before the first message
    rate: float  # messages per second
    messages: Sequence[Message] = ()  # as heard by `listen`


class Listener:
    """Listens to topics of type JointState, to all messages or those that are wanted."""

    def __init__(self, node: Node, wanted: Callable[[str, bytes], bool] = lambda *_: True) -> None:
        self._node, self._wanted = node, wanted
        self.heard: dict[str, Polled] = {}

    def look(self, found: Iterable[str]) -> None:
        """Subscribe to the topics that exist now."""
        found = set(found)
        for topic in self.heard.keys() - found:
            self.heard.pop(topic).close()
        for topic in found - self.heard.keys():
            self.heard[topic] = Polled(self._node, topic, wanted=partial(self._wanted, topic))

    def poll(self) -> list[Message]:
        """Take the messages that have arrived."""
        return [
            (topic, received, data)
            for topic, heard in self.heard.items()
            for data, received, *_ in heard.take()
        ]

    def drivers(self) -> list[DriverTopic]:
        """List the topics by name."""
        return [
            DriverTopic(topic, _joints([heard.last.data] if heard.last else []), heard.rate)
            for topic, heard in sorted(self.heard.items())
        ]


def _joints(messages: Iterable[bytes]) -> tuple[str, ...]:
    """Return the joints of all messages; which of several drivers comes first is no chance."""
    found = set[tuple[bytes, ...]]()
    for data in messages:
        with suppress(MalformedMessageError):
            found.add(tuple(joint_names(joint_state_layout(data))))
    names = dict.fromkeys(name for names in sorted(found) for name in names)
    return tuple(name.decode(errors='replace') for name in names)


def listen(seconds: float = _WAIT) -> list[DriverTopic]:
    """Search for drivers for a number of seconds, and listen to them for as long again."""
    with replay_node('') as node:
        listener = Listener(node)
        found: list[DriverTopic] = []
        messages: list[Message] = []
        end = time.monotonic() + seconds
        while (now := time.monotonic()) < end or (
            now < end + seconds and not all(driver.joints for driver in found)
        ):
            listener.look(Graph(node).drivers())
            messages += listener.poll()
            found = listener.drivers()
            time.sleep(_PERIOD)
        heard = {
            driver.topic: [each for each in messages if each[0] == driver.topic]
            for driver in found
        }
        return [
            replace(
                driver,
                joints=_joints(data for _, _, data in heard[driver.topic]) or driver.joints,
                rate=listener.heard[driver.topic].mean_rate,
                messages=heard[driver.topic],
            )
            for driver in found
        ]
