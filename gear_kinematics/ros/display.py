# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The topics that show the mechanism: robot_description and markers."""

import time
from collections.abc import Mapping

from rclpy.clock import Clock, ClockType
from rclpy.event_handler import QoSPublisherMatchedInfo
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import arm_urdf
from gear_kinematics.ros.markers import Markers
from gear_kinematics.ros.outputs import PublishingNode, latched
from gear_kinematics.wire import topics
from gear_kinematics.wire.topics import topic_of


class Display:
    """Publishes the URDF after every change, and the markers while they have viewers."""

    def __init__(self, node: PublishingNode, actuators: Mapping[str, NodeParameters]) -> None:
        """Show actuators with known bodies, by name."""
        self._node, self._description = node, ''
        node.open_output(topics.ROBOT_DESCRIPTION, latched())
        self.markers = {
            name: MarkerOutput(node, topic_of(name, topics.MARKERS), each.markers_rate)
            for name, each in actuators.items()
            if each.markers_rate
        }

    def update(self, actuators: Mapping[str, NodeParameters]) -> None:
        """Use names of joints and links; publishes the URDF if it has changed."""
        description, _ = arm_urdf(actuators)
        if description == self._description:
            return
        self._description = description
        message = serialize_message(String(data=description))
        self._node.send([(topics.ROBOT_DESCRIPTION, message)])
        for name, output in self.markers.items():
            of = actuators[name]
            output.shown = Markers(of.mechanism, module=of.module, frame_prefix=of.frame_prefix)


class MarkerOutput:
    """Publishes the markers of a mechanism while there are viewers."""

    shown: Markers

    def __init__(self, node: PublishingNode, topic: str, rate: float) -> None:
        self._topic, self._node = topic, node
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.timer = node.create_timer(1.0 / rate, self.publish, clock=steady, autostart=False)
        node.open_output(topic, latched(), self._on_viewers)

    def _on_viewers(self, event: QoSPublisherMatchedInfo) -> None:
        """Run the timer of the markers while there are subscribers; resend for a new one."""
        # Do not use the change of the count: some executors report 0 for an earlier subscriber.
        if event.current_count:
            self.shown.repeat()
            self.timer.reset()
        else:
            self.timer.cancel()

    def publish(self) -> None:
        """Publish the markers if they are due."""
        if message := self.shown.due(time.monotonic()):
            self._node.send([(self._topic, message)])
