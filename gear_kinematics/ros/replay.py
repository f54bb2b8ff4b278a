# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Plays the rotor topic of a bag with the timing of the recording."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from rclpy.duration import Duration
from rclpy.exceptions import NameValidationException
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from gear_kinematics.bag import Bag, ReportProgress
from gear_kinematics.bag.schedule import due_messages, throttled
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.live import POLL, ReplayError, replay_node
from gear_kinematics.wire.topics import JOINT_STATE

_GRACE = 5.0  # s; subscribers acknowledge messages every 3 s


@dataclass(slots=True)
class Played:
    """Result of `play`."""

    messages: int = 0
    worst_delay: float = 0.0  # greatest delay of a message, s


def play(
    source: Bag,
    topic: str,
    published: str,
    *,
    rate: float = 1.0,
    loop: bool = False,
    wait: bool = True,
    stopped: Callable[[], bool] = lambda: False,
    progress: ReportProgress = lambda _done, _total: None,
) -> Played:
    """Publish a bag's joint states unchanged, with their original timing.

    A late message does not delay the next ones. The publisher is reliable, which is compatible
    with every subscription; it may `wait` for a first one. A `loop` begins again a mean period
    after the last message, until `stopped`, which is called at least every 0.1 s. `rate` is bag
    time / real time.

    Raises:
        BagError: if the bag lacks the topic, has nothing to play or is damaged; the messages
            before the damage have been played.
        ReplayError: if nothing can be published under that name.
        ValueError: if the rate is out of range.
    """
    source.type_of(topic, JOINT_STATE)
    schedule = due_messages(source, [topic], rate, loop=loop)
    played = Played()
    report = throttled(progress)
    with replay_node('') as node:
        try:
            publisher = node.create_publisher(JointState, published, QoSProfile(depth=DEPTH))
        except NameValidationException as error:
            raise ReplayError(' '.join(str(error).split())) from error
        while wait and not (stopped() or publisher.get_subscription_count()):
            time.sleep(0.01)
        progress(0, None)
        start = time.monotonic()
        try:
            for due, (_, _, data) in schedule:
                while (left := start + due - time.monotonic()) > 0.0 and not stopped():
                    time.sleep(min(left, POLL))
                if stopped():
                    break
                publisher.publish(data)
                played.messages += 1
                played.worst_delay = max(played.worst_delay, time.monotonic() - start - due)
                report(played.messages, None)
        finally:
            # Lost messages are sent again as long as the publisher exists.
            publisher.wait_for_all_acked(Duration(seconds=0.0 if stopped() else _GRACE))
    progress(played.messages, None)
    return played
