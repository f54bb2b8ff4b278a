# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Suggests another topic of joint states while that of the rotor has no publisher."""

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
from gear_kinematics.wire.topics import JOINT_STATE, ROTOR_STATE

_MAX_TOPICS = 20


class MissingPublisher:
    """Logs a suggestion once in each time without a publisher."""

    def __init__(self, node: Node) -> None:
        """Start with the node that subscribes to the rotor's topic."""
        self._node = node
        self._topic = node.resolve_topic_name(ROTOR_STATE)
        self._suggested = False
        self._subscriptions: list[Subscription] = []
        self._joints: dict[str, list[str] | None] = {}
        """Those of each topic; None before it has a message."""

    def update(self, publishers: int) -> None:
        """Take the number of publishers on the rotor's topic; to be called once a second."""
        if self._joints and not publishers:  # a second later, so that there are messages
            self._node.get_logger().warning(self._suggestion())
            self._suggested = True
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()
        self._joints.clear()
        self._suggested &= not publishers
        if not (publishers or self._suggested):
            self._subscribe()

    def _subscribe(self) -> None:
        """Subscribe to the other topics of joint states, except those of the node itself."""
        own = {self._topic, *(publisher.topic_name for publisher in self._node.publishers)}
        topics = [
            name
            for name, types in self._node.get_topic_names_and_types()
            if JOINT_STATE in types and name not in own and self._node.count_publishers(name)
        ]
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        for topic in sorted(topics)[:_MAX_TOPICS]:

            def note(data: bytes, topic: str = topic) -> None:
                self._joints[topic] = []
                with suppress(MalformedMessageError):
                    self._joints[topic] = joints_of(data)

            with suppress(rclpy_implementation.RCLError):  # a security policy may forbid it
                self._subscriptions.append(
                    self._node.create_subscription(JointState, topic, note, qos, raw=True)
                )
                self._joints[topic] = None

    def _suggestion(self) -> str:
        """Name the topics, and the arguments for the one that is meant, if that is clear."""
        joint = self._node.get_parameter('rotor_joint').value
        topics = [f'{topic} ({_described(joints)})' for topic, joints in self._joints.items()]
        text = f'{self._topic} has no publisher; there are: {listed(topics)}'
        known = {topic: joints for topic, joints in self._joints.items() if joints}
        candidates = [topic for topic, joints in known.items() if joint in joints] or [*known]
        if len(candidates) > 1:
            candidates = get_close_matches(self._topic, sorted(candidates), n=1)
        if not candidates:
            return text
        [topic] = candidates
        renamed, parameter, joints = f'{ROTOR_STATE}:={topic}', '', known[topic]
        if joint not in joints and (joint or len(joints) > 1):
            # However far the nearest name is.
            [nearest] = get_close_matches(joint, joints, n=1, cutoff=0.0)
            parameter = f'rotor_joint:={nearest}'
        command = f'--ros-args -r {renamed}' + f' -p {parameter}' * bool(parameter)
        launched = f'{renamed} {parameter}'.rstrip()
        return f'{text}; did you mean `{command}`, or with ros2 launch `{launched}`?'


def _described(joints: list[str] | None) -> str:
    if not joints:
        return 'no message yet' if joints is None else 'no joints'
    return f'joint {joints[0]}' if len(joints) == 1 else f'joints {listed(joints)}'
