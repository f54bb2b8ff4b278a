# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What shows the mechanism: robot_description and markers."""

import time

from rclpy.clock import Clock, ClockType
from rclpy.event_handler import QoSPublisherMatchedInfo
from rclpy.node import Node
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.markers import Markers
from gear_kinematics.ros.outputs import Outputs, latched
from gear_kinematics.wire import topics


class Display:
    """Publishes the URDF after every change, and the markers while they have viewers."""

    def __init__(self, node: Node, parameters: NodeParameters, outputs: Outputs) -> None:
        self._outputs = outputs
        self._description = ''
        outputs.create(topics.ROBOT_DESCRIPTION, String, latched())
        if rate := parameters.markers_rate:
            steady = Clock(clock_type=ClockType.STEADY_TIME)
            self._timer = node.create_timer(
                1.0 / rate, self._publish_markers, clock=steady, autostart=False
            )
            outputs.create(topics.MARKERS, MarkerArray, latched(), self._on_viewers)

    def update(self, parameters: NodeParameters) -> None:
        """Use names of joints and links; publishes the URDF if it has changed."""
        description = parameters.urdf()
        if description == self._description:
            return
        self._description = description
        message = serialize_message(String(data=description))
        self._outputs.send([(topics.ROBOT_DESCRIPTION, message)])
        self._markers = Markers(
            parameters.mechanism, module=parameters.module, frame_prefix=parameters.frame_prefix
        )

    def _on_viewers(self, event: QoSPublisherMatchedInfo) -> None:
        """Run the timer of the markers while there are subscribers; resend for a new one."""
        # Not the change of the count: some executors report 0 for an earlier subscriber.
        if event.current_count:
            self._markers.repeat()
            self._timer.reset()
        else:
            self._timer.cancel()

    def _publish_markers(self) -> None:
        if message := self._markers.due(time.monotonic()):
            self._outputs.send([(topics.MARKERS, message)])
