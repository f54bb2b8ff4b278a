"""The other end of the node: a driver that sends rotor states, a recorder of the answers."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Self

import rclpy
from geometry_msgs.msg import PoseArray
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState

from gear_kinematics.bag import BagMessage
from gear_kinematics.node import make_executor

_DEPTH = 2000  # messages
_LISTENERS = 2  # on rotor_state: the node and our own recorder
_MESSAGE_TYPES: Mapping[str, type] = {
    'rotor_state': JointState,
    'output_state': JointState,
    'body_poses': PoseArray,
}


class ReplayError(RuntimeError):
    """The node did not answer in time."""


@contextmanager
def running_node(arguments: Sequence[str] = (), **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Run gear_state_publisher as a process of its own and stop it at the end.

    Args:
        arguments: its command line, such as `--ros-args -p rotor_joint:=m1`.
        options: of `subprocess.Popen`.
    """
    command = [sys.executable, '-m', 'gear_kinematics.node', *arguments]
    process = subprocess.Popen(command, text=True, **options)  # noqa: S603  # our own node
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


class Replay:
    """A driver on rotor_state and a recorder of rotor_state and of the node's outputs, in one.

    A context manager with a ROS context of its own. Nothing runs in the background: messages are
    received within `receive_until` and the waits.
    """

    def __init__(self, namespace: str = '') -> None:
        """Open the topics, in a namespace."""
        self.received: list[BagMessage] = []
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self._node = Node('gear_kinematics_replay', context=self._context, namespace=namespace)
        self._executor = make_executor(self._context)
        self._executor.add_node(self._node)
        qos = QoSProfile(depth=_DEPTH)
        self._publisher = self._node.create_publisher(JointState, 'rotor_state', qos)
        self._subscriptions = [
            self._node.create_subscription(
                message_type, topic, self._recorder('/' + topic), qos, raw=True
            )
            for topic, message_type in _MESSAGE_TYPES.items()
        ]

    def __enter__(self) -> Self:
        """Start."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the topics."""
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def wait_for_node(self, timeout: float = 20.0) -> None:
        """Wait until every topic has both ends: the node's and ours.

        Raises:
            ReplayError: if they have not found each other after `timeout` s.
        """
        self.wait_until(
            lambda: (
                self._publisher.get_subscription_count() >= _LISTENERS
                and all(s.get_publisher_count() >= 1 for s in self._subscriptions)
            ),
            timeout,
        )

    def receive_until(self, moment: float) -> None:
        """Receive until a `time.monotonic()`."""
        while (left := moment - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def send(self, data: bytes) -> None:
        """Send a serialised JointState as rotor_state."""
        self._publisher.publish(data)

    def wait_until(self, condition: Callable[[], bool], timeout: float) -> None:
        """Receive until a condition holds.

        Raises:
            ReplayError: if it does not after `timeout` s.
        """
        deadline = time.monotonic() + timeout
        while not condition():
            if time.monotonic() > deadline:
                raise ReplayError(f'the node did not answer within {timeout:g} s')
            self._executor.spin_once(timeout_sec=0.01)

    def _recorder(self, topic: str) -> Callable[[bytes], None]:
        return lambda data: self.received.append(BagMessage(topic, time.time_ns(), data))
