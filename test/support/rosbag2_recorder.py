# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A recorder that does to a recording what rosbag2 does, without ROS.

It finds the topics when they appear, subscribes to one after another, and takes messages from its
queues between subscriptions only: of what arrives while it is busy, the first few and the last few
of each topic survive. At the end it lets go of the topics one after another too.
"""

import random
from typing import NamedTuple

MILLISECOND = 1_000_000
QUEUE = 10
"""Messages that are kept of a topic while the recorder is busy."""


class Message(NamedTuple):
    topic: str
    received: int
    data: bytes


def record(
    messages: list[Message],
    rng: random.Random,
    *,
    begin: int,
    end: int,
    late: float,
    busy: float = 0.1,
) -> list[Message]:
    """Record part of what goes over the topics.

    Args:
        messages: on all topics, in the order of their sending.
        rng: decides on what differs from one recording to the next.
        begin: when the recorder starts, ns.
        end: when it is stopped, ns.
        late: s at the most between one subscription and the next.
        busy: s at the most for which the recorder is busy after its last subscription.
    """
    appear = {m.topic: m.received for m in reversed(messages)}
    topics = sorted(appear)
    rng.shuffle(topics)
    topics.sort(key=lambda topic: max(appear[topic], begin))
    subscriptions, now = {}, begin
    for topic in topics:
        now = max(now, appear[topic]) + round(rng.uniform(0.0005, late) * 1e9)
        subscriptions[topic] = now
    free = now + round(rng.uniform(0.01, busy) * 1e9)
    ends = {topic: end + round(rng.uniform(0.0, 5.0)) * MILLISECOND for topic in topics}
    recorded = []
    for topic in topics:
        own = [m for m in messages if m.topic == topic and subscriptions[topic] <= m.received]
        taken_at_once = rng.randrange(4)
        during = [m for m in own if m.received < free]
        recorded += during[:taken_at_once]
        # The queue is emptied when the recorder is free again.
        recorded += [m._replace(received=free) for m in during[taken_at_once:][-QUEUE:]]
        recorded += [m for m in own if free <= m.received < ends[topic]]
    return sorted(recorded, key=lambda m: m.received)
