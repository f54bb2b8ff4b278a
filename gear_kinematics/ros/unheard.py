"""Tells which topics of joint states there are, when the rotor's has no publisher."""

import math
from collections.abc import Callable
from contextlib import suppress
from difflib import get_close_matches

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState

from gear_kinematics.wire.cdr import MalformedMessageError
from gear_kinematics.wire.joint_reader import joints_of
from gear_kinematics.wire.nearest import listed
from gear_kinematics.wire.topics import JOINT_STATE

_PATIENCE = 5.0
"""Time without a publisher after which it is told, s."""
_LISTENING = 1.5
"""Part of it in which other topics are listened to, s: more than a period of `look`."""
_LEAST = 0.9
"""Time for their messages, s, of topics that appear later, too."""
_MOST = 20  # topics


class UnheardTopic:
    """Watches a topic of joint states; `look` is to be called about once a second."""

    def __init__(self, node: Node, name: str, parameter: str) -> None:
        """Begin to watch.

        Args:
            node: the subscribing node.
            name: of the topic, before remapping.
            parameter: the one that names the joint.
        """
        self._node = node
        self._name = name
        self._topic = node.resolve_topic_name(name)
        self._parameter = parameter
        self._since = math.nan
        self._begun = math.nan
        self._told = False
        self._listening: dict[str, Subscription] = {}
        self._joints: dict[str, list[str]] = {}

    def look(self, publishers: int, now: float) -> None:
        """Log the topics that there are, once in each time without a publisher.

        Args:
            publishers: number of publishers on the topic.
            now: of a steady clock, s.
        """
        if publishers:
            self._since, self._told = math.nan, False
            self._end()
            return
        if math.isnan(self._since):
            self._since = now
        age = now - self._since
        if self._told or age < _PATIENCE - _LISTENING:
            return
        if not self._listening:
            self._listen()
            self._begun = now
        elif age >= _PATIENCE and now - self._begun >= _LEAST:
            self._node.get_logger().warning(self._text())
            self._told = True
            self._end()

    def _listen(self) -> None:
        """Subscribe to the other topics of joint states, but for those of the node itself."""
        own = {publisher.topic_name for publisher in self._node.publishers}
        topics = [
            name
            for name, types in self._node.get_topic_names_and_types()
            if JOINT_STATE in types
            and name not in {self._topic, *own}
            and self._node.count_publishers(name)
        ]
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        for topic in sorted(topics)[:_MOST]:
            with suppress(rclpy_implementation.RCLError):  # a security policy may forbid it
                self._listening[topic] = self._node.create_subscription(
                    JointState, topic, self._note(topic), qos, raw=True
                )

    def _note(self, topic: str) -> Callable[[bytes], None]:
        def note(data: bytes) -> None:
            if topic not in self._joints:
                try:
                    self._joints[topic] = joints_of(data)
                except MalformedMessageError:
                    self._joints[topic] = []

        return note

    def _text(self) -> str:
        """Name the topics, and the arguments that take the one that is meant, if that is clear."""
        joint = self._node.get_parameter(self._parameter).value
        topics = [f'{topic} ({self._described(topic)})' for topic in self._listening]
        text = f'{self._topic} has no publisher; there are: {listed(topics)}'
        having = [topic for topic in self._listening if joint in self._joints.get(topic, ())]
        meant = having or [topic for topic in self._listening if self._joints.get(topic)]
        if len(meant) > 1:
            meant = get_close_matches(self._topic, meant, n=1)
        if not meant:
            return text
        arguments = f'-r {self._name}:={meant[0]}'
        joints = self._joints.get(meant[0], [])
        if joints and joint not in joints and (joint or len(joints) > 1):
            # However far the nearest name is.
            (nearest,) = get_close_matches(joint, joints, n=1, cutoff=0.0)
            arguments += f' -p {self._parameter}:={nearest}'
        return f'{text}; did you mean `--ros-args {arguments}`?'

    def _described(self, topic: str) -> str:
        joints = self._joints.get(topic)
        if not joints:
            return 'no message yet' if joints is None else 'no joints'
        return f'joint {joints[0]}' if len(joints) == 1 else f'joints {listed(joints)}'

    def _end(self) -> None:
        for subscription in self._listening.values():
            self._node.destroy_subscription(subscription)
        self._listening.clear()
        self._joints.clear()
