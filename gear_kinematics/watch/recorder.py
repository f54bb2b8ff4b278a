# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Records what gear nodes receive and publish, under the names of their topics."""

import time
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from operator import itemgetter
from typing import TYPE_CHECKING

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from gear_kinematics.bag import Message
from gear_kinematics.parameters import NODE
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.graph import Graph
from gear_kinematics.ros.live import POLL
from gear_kinematics.ros.outputs import message_type
from gear_kinematics.watch.polled import Polled
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import header_stamp
from gear_kinematics.wire.nearest import among

if TYPE_CHECKING:
    from gear_kinematics.bag.writing import BagWriter  # needs an extra

_TYPES = {topic.type for topic in topics.TOPICS.values() if topic.part != 'display'}
_LONGEST = 5.0  # s for which outputs are awaited at the end

_BEST_EFFORT, _VOLATILE = ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE


class Recorder:
    """Records the topics of gear nodes, also those of drivers that have yet to start."""

    def __init__(
        self,
        node: Node,
        bag: 'BagWriter',
        wanted: str = NODE,
        *,
        loads: bool = False,
        found: Callable[[str], None] = lambda _: None,
    ) -> None:
        """Record all gear nodes, or the one with a full name, into an open bag.

        The topics of the loads, which a node computes for listeners alone, need `loads`.
        `found` is called with the full name of each gear node.
        """
        self._found = found
        self._left_out = {topics.JOINT_STATES, *(() if loads else topics.LOAD_TOPICS)}
        self.heard: dict[str, Polled] = {}  # the topics on which messages have come
        self.gears: set[str] = set()  # full names of the gear nodes
        self.absent = ''  # that the wanted node is not running, if others are
        self.inputs: set[str] = set()  # on which messages should come; an output needs no encoder
        self._node, self._bag = node, bag
        self._wanted = '' if wanted == NODE else f'/{wanted.removeprefix("/")}'
        self._open: dict[str, tuple[str, Polled]] = {}  # with the types
        # In addition to a reliable subscription, until the driver is known: this one hears every
        # driver, and if it were made only then, it would miss the first messages.
        self._best_effort: dict[str, Polled] = {}
        self._inputs_of: dict[str, set[str]] = {}  # by topics of outputs with their stamps
        self._least: dict[str, int] = {}  # ns from the dispatch to the reception of a message

    def poll(self) -> None:
        """Look for topics, and write the messages that have arrived; to be called often."""
        running = Graph(self._node).gears
        self.absent = ''
        if running and self._wanted not in {'', *running}:
            self.absent = f'{self._wanted} is not running{among(self._wanted, running)}'
        for gear in running:
            if gear == self._wanted or not self._wanted:
                if gear not in self.gears:
                    self.gears.add(gear)
                    self._found(gear)
                self._look(*gear.rpartition('/')[::2])
        self._take()

    def _take(self) -> None:
        messages: list[Message] = []
        for topic, (kind, polled) in self._open.items():
            for data, received, sent in polled.take():
                # The middleware repeats what was lost after seconds, and delays all that follows.
                least = min(self._least.get(topic, received - sent), received - sent)
                self._least[topic] = least
                messages.append((topic, sent + least, data))
            if polled.last and topic not in self.heard:
                self.heard[topic] = polled
                self._bag.add_topic(topic, kind)
                self._bag.keeps = True  # what was heard cannot be heard again
        self._bag.write_all(sorted(messages, key=itemgetter(1)))

    def end(self, waiting: Callable[[], None]) -> None:
        """Record no more inputs, but the outputs of those recorded, which a busy node sends late.

        `waiting` is called if they take longer. A node that has ended is awaited for some seconds.
        """
        self._take()
        last = {
            output: max(map(self._stamp, heard))
            for output, inputs in self._inputs_of.items()
            if (heard := inputs & self.heard.keys())
        }
        for topic in self.inputs - self._inputs_of.keys():
            self._open.pop(topic, None)
        until = time.monotonic() + _LONGEST
        for looked in count():
            late = any(0 <= self._stamp(output) < stamp for output, stamp in last.items())
            if not late or time.monotonic() > until:
                return
            if looked == 1:
                waiting()
            time.sleep(POLL)
            self._take()

    def _stamp(self, topic: str) -> int:
        last = self.heard[topic].last if topic in self.heard else None
        return header_stamp(last.data) if last else -1  # ns

    def _look(self, namespace: str, name: str) -> None:
        with suppress(RuntimeError):  # the node has ended meanwhile
            place = name, namespace or '/'
            inputs = self._node.get_subscriber_names_and_types_by_node(*place)
            outputs = self._node.get_publisher_names_and_types_by_node(*place)
            heard = {
                topic
                for topic, types in inputs
                if topics.JOINT_STATE in types
                and (
                    topics.base_name(topic) != topics.OUTPUT_ENCODER
                    or self._node.get_publishers_info_by_topic(topic)
                )
            }
            self.inputs |= heard
            for topic, _ in outputs:
                if topics.base_name(topic) != topics.base_name(topics.DIAGNOSTICS):
                    self._inputs_of.setdefault(topic, set()).update(heard)
            for topic, [kind, *_] in inputs + outputs:
                if kind not in _TYPES or topics.base_name(topic) in self._left_out:
                    continue
                offers = self._node.get_publishers_info_by_topic(topic)
                if topic not in self._open:
                    durability = DurabilityPolicy.BEST_AVAILABLE if offers else _VOLATILE
                    qos = QoSProfile(depth=DEPTH, durability=durability)
                    message = message_type(kind)
                    self._open[topic] = kind, Polled(self._node, topic, message, qos=qos)
                    self._best_effort[topic] = Polled(self._node, topic, message)
                if len(offers) > 1:
                    self._open[topic][1].losses.numbered = False
                if offers and (unused := self._best_effort.pop(topic, None)):
                    if any(offer.qos_profile.reliability == _BEST_EFFORT for offer in offers):
                        (_, other), self._open[topic] = self._open[topic], (kind, unused)
                        unused = other
                    unused.close()
