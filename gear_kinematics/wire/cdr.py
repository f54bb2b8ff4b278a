# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The wire format (CDR) of the messages with numbers, without ROS.

sensor_msgs/JointState, geometry_msgs/PoseArray, sensor_msgs/MultiDOFJointState: each starts with a
std_msgs/Header. CDR (XCDR version 1, as ROS 2 writes it): four bytes of
encapsulation, the second of which gives the byte order; then the fields, each aligned to its size,
counted from the end of the encapsulation.

This module reads whatever rclpy's `deserialize_message` reads (Fast CDR 2.2), with the same
content: the encapsulations of XCDR version 2 and of parameter lists change at most the alignment,
a string may lack its terminating zero or have length 0, as micro-ROS writes unset ones, and it
ends at its first zero; bytes after the message are ignored.
"""

import struct
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

SECOND = 1_000_000_000  # ns
STAMP_OFFSET = 4  # after the encapsulation
STAMP = struct.Struct('<iI')
STAMP_BYTES = slice(STAMP_OFFSET, STAMP_OFFSET + STAMP.size)
"""Position of the stamp in the bytes of a message with a header."""
LATEST = 2**31 * SECOND - 1  # latest stamp, ns, whose seconds fit into 32 bits
_ENCAPSULATION = b'\x00\x01\x00\x00'  # of what is written here: little endian
_ENCAPSULATIONS = {
    bytes((0, kind + little)): ('><'[little], alignment)
    for kind, alignment in ((0, 8), (2, 8), (6, 4), (8, 4), (10, 4))
    for little in (0, 1)
}
"""Byte order and alignment of float64 by the first two bytes, as Fast CDR defines them."""


class MalformedMessageError(ValueError):
    """Bytes that are not a message of this type."""


class MessageLayout(NamedTuple):
    """Positions in a message; messages of one layout differ only in the stamp and the arrays."""

    order: str  # byte order as in `struct`: '<' or '>'
    size: int  # size of the whole message, bytes
    texts: tuple[bytes, ...]  # strings of the message: frame_id, then the names of a JointState
    arrays: tuple[tuple[int, int], ...]  # offset and count of the float64 of each array
    fixed: tuple[tuple[int, int], ...]  # spans of what defines it: encapsulation, lengths, strings


def joint_names(layout: MessageLayout) -> list[bytes]:
    """List the names of the joints of a JointState.

    If no joint has a name, as in messages of many micro-ROS drivers, their indices are their
    names: b'0', b'1', ...
    """
    _, *names = layout.texts
    if any(names):
        return names
    _, positions = layout.arrays[0]
    return [b'%d' % index for index in range(len(names) or positions)]


def joint_index(layout: MessageLayout, joint: bytes) -> int | None:
    """Find the index of a joint of `joint_names`, b'' for the only one; None if it is missing."""
    names = joint_names(layout)
    if joint:
        return names.index(joint) if joint in names else None
    return 0 if len(names) == 1 else None


def arrays_fit(layout: MessageLayout, joint: bytes) -> bool:
    """Whether it is known which values of a JointState are a joint's.

    Each array is empty or has a value for each of the joints, and the joint is there once.
    """
    names = joint_names(layout)
    return names.count(joint) <= 1 and all(n in {0, len(names)} for _, n in layout.arrays)


def header_stamp(data: bytes) -> int:
    """Return the stamp of any message that begins with a std_msgs/Header, ns; -1 without one."""
    if len(data) < STAMP_OFFSET + STAMP.size:
        return -1
    seconds, nanoseconds = struct.unpack_from('<iI' if data[1] & 1 else '>iI', data, STAMP_OFFSET)
    return int(seconds * SECOND + nanoseconds)


def with_stamp(data: bytes, stamp: int) -> bytes:
    """Replace the stamp, ns, of a message that begins with a std_msgs/Header."""
    order = '<' if data[1] & 1 else '>'
    encoded = struct.pack(f'{order}iI', *divmod(stamp, SECOND))
    return data[: STAMP_BYTES.start] + encoded + data[STAMP_BYTES.stop :]


def joint_state_layout(data: bytes) -> MessageLayout:
    """Find the layout of a sensor_msgs/JointState.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    return _layout(data, (1, 1, 1))  # position, velocity, effort


def pose_array_layout(data: bytes) -> MessageLayout:
    """Find the layout of a geometry_msgs/PoseArray.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    return _layout(data, (7,), named=False)


def _layout(data: bytes, arrays: Sequence[int], *, named: bool = True) -> MessageLayout:
    """Find the layout of names, if any, and of arrays, given by the numbers of each item."""
    reader = _Reader(data)
    reader.string()  # frame_id
    for _ in range(reader.count(4) if named else 0):
        reader.string()
    for numbers in arrays:
        reader.doubles(numbers * reader.count(8 * numbers))
    return reader.layout()


def messages_lost(data: bytes) -> Counter[str]:
    """Count the lost messages by topic, from a rosbag2_interfaces/MessagesLostEvent.

    Raises:
        MalformedMessageError: if it is none.
    """
    reader = _Reader(data, STAMP_OFFSET)
    reader.string()  # the recorder
    for _ in range(reader.count(8)):
        reader.string()
        reader.doubles(2)  # as large as the two uint64: lost in transport, and by the recorder
    layout = reader.layout()
    lost: Counter[str] = Counter()
    for topic, (offset, _) in zip(layout.texts[1:], layout.arrays, strict=True):
        lost[topic.decode(errors='replace')] += sum(
            struct.unpack_from(f'{layout.order}2Q', data, offset)
        )
    return lost


class _Reader:
    """Reads the primitives after a header's stamp and records their positions."""

    def __init__(self, data: bytes, start: int = STAMP_OFFSET + STAMP.size) -> None:
        self._data = data
        self._offset = start
        self._texts: list[bytes] = []
        self._arrays: list[tuple[int, int]] = []
        self._fixed = [(0, 2)]
        if data[:2] not in _ENCAPSULATIONS:
            raise MalformedMessageError('no CDR encapsulation')
        self._order, self._alignment = _ENCAPSULATIONS[data[:2]]

    def count(self, item_size: int) -> int:
        start = self._offset + -self._offset % 4
        end = start + 4
        if end > len(self._data):
            raise MalformedMessageError('the message is cut off')
        (count,) = struct.unpack_from(self._order + 'I', self._data, start)
        if count * item_size > len(self._data) - end:
            raise MalformedMessageError('a sequence is longer than the message')
        self._fixed.append((start, end))
        self._offset = end
        return int(count)

    def string(self) -> None:
        size = self.count(1)
        start, end = self._offset, self._offset + size
        self._texts.append(self._data[start:end].partition(b'\0')[0])
        self._fixed[-1] = (self._fixed[-1][0], end)  # together with its length
        self._offset = end

    def doubles(self, count: int) -> None:
        if count:  # an empty array has no padding
            self._offset += -(self._offset - STAMP_OFFSET) % self._alignment
        self._arrays.append((self._offset, count))
        self._offset += 8 * count
        if self._offset > len(self._data):
            raise MalformedMessageError('the message is cut off')

    def layout(self) -> MessageLayout:
        texts, arrays, fixed = tuple(self._texts), tuple(self._arrays), tuple(self._fixed)
        return MessageLayout(self._order, len(self._data), texts, arrays, fixed)


class Template:
    """A message laid out once; encoding only writes the stamp and the numbers."""

    def __init__(
        self, frame_id: str, names: Sequence[str] | None, *arrays: tuple[int, int, Iterable[int]]
    ) -> None:
        """Lay the message out.

        Args:
            frame_id: frame of the header.
            names: the array of names, if the type has one.
            arrays: for each array its number of items, the float64 of an item, and the places of
                those that `encode` writes; the others are 0.
        """
        self.blank = bytearray(_ENCAPSULATION + bytes(STAMP.size))
        """The message with zeros as stamp and numbers."""
        self.offsets: list[int] = []
        """Positions of the numbers in it."""
        self._named, self._sizes = names is not None, [size for _, size, _ in arrays]
        self._string(frame_id)
        if names is not None:
            self._count(len(names))
            for name in names:
                self._string(name)
        for count, size, places in arrays:
            self._count(count)
            if count:  # an empty array has no padding
                self._pad(8)
                start, item = len(self.blank), 8 * size
                self.offsets += [start + k * item + 8 * n for k in range(count) for n in places]
                self.blank += bytes(count * item)
        self._divide()

    def encode(self, stamp: int, numbers: Sequence[float]) -> bytes:
        """Return the bytes of the message, from the stamp (ns) and the numbers of all arrays."""
        values: Sequence[Any] = numbers
        if self._gaps:
            values = [*numbers]
            for place, gap in self._gaps:
                values.insert(place, gap)
        return self._pack(_ENCAPSULATION, *divmod(stamp, SECOND), self._start, *values)

    def layout(self, data: bytes) -> MessageLayout:
        """Find the layout of a message of the same type.

        Raises:
            MalformedMessageError: if the bytes are anything else.
        """
        return _layout(data, self._sizes, named=self._named)

    def _divide(self) -> None:
        """Divide the message into numbers and the bytes between them, to pack it in one call."""
        end = self.offsets[0] if self.offsets else len(self.blank)
        self._start = bytes(self.blank[STAMP_BYTES.stop : end])
        self._gaps: list[tuple[int, bytes]] = []
        code = f'<{STAMP_OFFSET}siI{len(self._start)}s'
        for place, offset in enumerate(self.offsets):
            gap = bytes(self.blank[end:offset])
            if any(gap):
                self._gaps.append((place + len(self._gaps), gap))
            code += f'{len(gap)}{"s" if any(gap) else "x"}d'
            end = offset + 8
        self._pack = struct.Struct(f'{code}{len(self.blank) - end}x').pack  # counts of 0

    def _count(self, count: int) -> None:
        self._pad(4)
        self.blank += struct.pack('<I', count)

    def _string(self, text: str) -> None:
        encoded = text.encode() + b'\0'
        self._count(len(encoded))
        self.blank += encoded

    def _pad(self, size: int) -> None:
        self.blank += bytes(-(len(self.blank) - STAMP_OFFSET) % size)


class JointStateTemplate(Template):
    """A sensor_msgs/JointState of the given joints, with the arrays that are present."""

    def __init__(self, names: Sequence[str], *, velocity: bool, effort: bool) -> None:
        """Lay the message out: positions, velocities, efforts."""
        self.names, self.velocity, self.effort = names, velocity, effort
        present = True, velocity, effort
        super().__init__('', names, *((len(names) * there, 1, (0,)) for there in present))


class PoseArrayTemplate(Template):
    """A geometry_msgs/PoseArray: per pose x y z and quaternion x y z w."""

    def __init__(self, frame_id: str, poses: int) -> None:
        """Lay the message out for a number of poses."""
        super().__init__(frame_id, None, (poses, 7, range(7)))


class WrenchesTemplate(Template):
    """A sensor_msgs/MultiDOFJointState of planar wrenches: per joint force x y, torque z."""

    def __init__(self, frame_id: str, names: Sequence[str]) -> None:
        """Lay the message out for the joints of these names, without transforms and twists."""
        super().__init__(frame_id, names, (0, 7, ()), (0, 6, ()), (len(names), 6, (0, 1, 5)))
