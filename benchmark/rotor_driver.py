# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The driver of the benchmarks: publishes rotor_state at a steady rate, and does little else.

It sends probes until it is ordered to drive, and reports when it has.
"""

import struct
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from peer import DEPTH, next_order, obey_benchmark, order_waits, peer, report, wait_for_end
from rclpy.duration import Duration
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

SECOND = 1_000_000_000  # ns

SPEED = 300.0
"""rad/s, of the rotor."""

_FIRST_STAMP = 1_000 * SECOND  # ns; those of probes are below a second
_STAMP_STEP = 1_000_001  # ns
_PROBE_PERIOD = 0.01  # s
_STEP = 0.3  # rad
_SWEEP = 2_000  # messages one way, about a hundred turns of the rotor
_GRACE = 10.0  # s, for what has to be sent again


def rotor_motion(number: Any) -> tuple[Any, Any, Any]:
    """The rotor's position (rad), velocity (rad/s) and effort (N·m) in a message, by its number.

    To and fro, with an effort that tells a sweep from the others. An array of numbers gives the
    same as one by one, to the last bit.
    """
    sweep, phase = number // _SWEEP, number % _SWEEP
    backwards = sweep % 2
    position = _STEP * (phase + backwards * (_SWEEP - 2 * phase) - _SWEEP // 2)
    return position, SPEED * (1 - 2 * backwards), 0.001 * (1 + sweep % 1_000)


def counted_stamp(number: Any) -> Any:
    """Give the stamp of a message by its number, ns; likewise of an array of them."""
    return _FIRST_STAMP + _STAMP_STEP * number


def counted_number(stamp: Any) -> Any:
    """Give the number of the message with a stamp, or of the last before it."""
    return (stamp - _FIRST_STAMP) // _STAMP_STEP


class RotorState:
    """The message in bytes, made once by rclpy; only numbers are written into it."""

    def __init__(self, joints: Sequence[str] = ('rotor',)) -> None:
        """Find the places of the numbers, which are the same for all joints."""
        arrays = [[mark] * len(joints) for mark in (1.5, 2.5, 3.5)]
        position, velocity, effort = arrays
        message = JointState(name=joints, position=position, velocity=velocity, effort=effort)
        self._data = bytearray(serialize_message(message))
        packed = [struct.pack(f'<{len(joints)}d', *array) for array in arrays]
        self._pack = struct.Struct(f'<{len(joints)}d').pack_into
        self._joints, self._places = len(joints), [self._data.index(data) for data in packed]

    def encode(self, stamp: int, number: int) -> bytes:
        """Give the message of a number."""
        struct.pack_into('<iI', self._data, 4, *divmod(stamp, SECOND))
        for place, value in zip(self._places, rotor_motion(number), strict=True):
            self._pack(self._data, place, *(value,) * self._joints)
        return bytes(self._data)


def main() -> None:
    """Follow the orders until the standard input ends."""
    obey_benchmark()
    # Sleep to the point; Linux is up to 50 µs late otherwise, to gather what is to be woken.
    with suppress(OSError):  # read-only in some containers, and then it is later
        Path('/proc/self/timerslack_ns').write_text('1', 'ascii')
    with peer('rotor_driver') as node, suppress(EOFError):
        depth = node.declare_parameter('depth', DEPTH).value
        joints = node.declare_parameter('joints', ['rotor']).value
        publisher = node.create_publisher(JointState, 'rotor_state', QoSProfile(depth=depth))
        message = RotorState(joints)
        report()
        probes = 0
        while not order_waits(_PROBE_PERIOD):
            probes += 1
            publisher.publish(message.encode(probes, 0))
        report(**drive(publisher, message, **next_order()))
        wait_for_end()


def drive(
    publisher: Publisher,
    message: RotorState,
    *,
    rate: float,
    count: int,
    allowed: int,
    counted: bool,
) -> dict[str, Any]:
    """Publish messages in time.

    What is late is made up for at twice the rate at most: no driver sends a second's messages at
    once, and if they got lost, it would not be the node's fault.

    Args:
        publisher: of rotor_state.
        message: what to send.
        rate: Hz.
        count: how many.
        allowed: how many at first, before further orders allow more.
        counted: whether stamps are `counted_stamp`; else they are the times of sending.

    Returns:
        The number `sent`, the `rate` that became of it, and whether the node has `acknowledged`
        every message.
    """
    period = 1.0 / rate
    start = now = time.monotonic()
    for number in range(count):
        while number >= allowed:
            allowed = next_order()['allowed']
        due = max(start + number * period, now + 0.5 * period)
        while (now := time.monotonic()) < due:
            time.sleep(due - now)
        stamp = counted_stamp(number) if counted else time.time_ns()
        publisher.publish(message.encode(stamp, number))
    return {
        'sent': count,
        'rate': count / (now - start),
        'acknowledged': publisher.wait_for_all_acked(Duration(seconds=_GRACE)),
    }


if __name__ == '__main__':
    main()
