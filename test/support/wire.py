# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""CDR written field by field: of any encapsulation, and with strings as they should not be."""

import struct
from collections.abc import Iterable

from live import SECOND

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.state.state_messages import OutputMessages, Row
from gear_kinematics.wire.topics import STATE_TOPICS

ENCAPSULATIONS = (0, 1, 2, 3, 6, 7, 8, 9, 10, 11)
"""Second bytes of the encapsulations that rclpy takes: XCDR version 2 from 6 on."""


class Wire:
    """A message in the making."""

    def __init__(self, encapsulation: int) -> None:
        self.data = bytes((0, encapsulation, 0, 0))
        self._order = '<' if encapsulation & 1 else '>'
        self._alignment = 8 if encapsulation < 6 else 4

    def number(self, code: str, value) -> None:
        """Write a number; the encapsulation tells how a float64 is aligned."""
        size = min(struct.calcsize(code), self._alignment)
        self.data += bytes(-(len(self.data) - 4) % size) + struct.pack(self._order + code, value)

    def header(self, seconds: int, nanoseconds: int, frame_id: bytes) -> None:
        """Write a std_msgs/Header."""
        self.number('i', seconds)
        self.number('I', nanoseconds)
        self.string(frame_id)

    def string(self, raw: bytes) -> None:
        """Write a string as it is: with a zero in the end, without, or with several."""
        self.number('I', len(raw))
        self.data += raw

    def joint_state(self, names, *arrays) -> None:
        """Write what a JointState has behind its header; names are raw."""
        self.number('I', len(names))
        for name in names:
            self.string(name)
        for values in arrays:
            self.number('I', len(values))
            for value in values:
                self.number('d', value)


def encoded(
    messages: OutputMessages, sample: RotorSample, topics: Iterable[str] = STATE_TOPICS
) -> dict[str, bytes]:
    """Return the messages of a sample by topic, as the node sends them."""
    return of_rows(messages.rows(sample, topics), sample.stamp)


def of_rows(rows: Iterable[Row], stamp: int) -> dict[str, bytes]:
    """Return the messages of rows by topic, with a stamp, ns."""
    return {topic: template.encode(stamp, numbers) for topic, template, numbers in rows}


def micro_ros_bytes(stamp, names, position, velocity=(), effort=()) -> bytes:
    """Write a JointState as micro-ROS does: what is unset has the length 0 and no byte."""
    wire = Wire(1)
    wire.header(*divmod(stamp, SECOND), b'')
    raw = [name.encode() + b'\0' if name else b'' for name in names]
    wire.joint_state(raw, position, velocity, effort)
    return wire.data
