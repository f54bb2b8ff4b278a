"""What shows the mechanism: robot_description and markers."""

import time
from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.event_handler import QoSPublisherMatchedInfo
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.meshes import folder_uri
from gear_kinematics.ros.markers import Markers
from gear_kinematics.shape.urdf import urdf
from gear_kinematics.wire import topics


class Display:
    """Publishes the URDF after every change, and the markers while they have viewers."""

    def __init__(
        self,
        node: Node,
        parameters: NodeParameters,
        create_output: Callable[..., Publisher],
        publish: Callable[[Publisher, Any], None],
    ) -> None:
        """Open the topics.

        Args:
            node: the node.
            parameters: of the node, which knows the mechanism.
            create_output: creates a publisher of the node, from type, topic and QoS.
            publish: publishes a message.
        """
        self._mechanism, self._module = parameters.mechanism, parameters.module
        self._publish = publish
        self._meshes = folder_uri(parameters.meshes, self._mechanism, self._module)
        self._description = String()
        self._description_publisher = create_output(String, topics.ROBOT_DESCRIPTION, _latched())
        if rate := parameters.markers_rate:
            steady = Clock(clock_type=ClockType.STEADY_TIME)
            self._timer = node.create_timer(
                1.0 / rate, self._publish_markers, clock=steady, autostart=False
            )
            self._marker_publisher = create_output(
                MarkerArray, topics.MARKERS, _latched(), matched=self._on_viewers
            )

    def update(self, parameters: NodeParameters) -> None:
        """Use names of joints and links; publishes the URDF if it has changed.

        Raises:
            ValueError: if `output_joint` is empty or the name of another joint.
        """
        prefix = parameters.frame_prefix
        text = urdf(
            self._mechanism,
            module=self._module,
            output_joint=parameters.output_joint,
            frame_prefix=prefix,
            meshes=self._meshes,
        )
        description = String(data=text)
        if description == self._description:
            return
        self._description = description
        self._publish(self._description_publisher, description)
        self._markers = Markers(self._mechanism, module=self._module, frame_prefix=prefix)

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
            self._publish(self._marker_publisher, message)


def _latched() -> QoSProfile:
    """Create a new profile for each topic, since QoS overrides change it."""
    return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
