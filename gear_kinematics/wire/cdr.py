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
from collections.abc import Sequence
from typing import Any, NamedTuple

SECOND = 1_000_000_000  # ns
STAMP_OFFSET = 4  # after the encapsulation
STAMP = struct.Struct('<iI')
STAMP_BYTES = slice(STAMP_OFFSET, STAMP_OFFSET + STAMP.size)
"""Where the stamp is in the bytes of a message with a header."""
LATEST = 2**31 * SECOND - 1
"""Latest stamp, ns, whose seconds fit into 32 bits."""
_ENCAPSULATION = b'\x00\x01\x00\x00'  # of what is written here: little endian
_ENCAPSULATIONS = {
    bytes((0, kind + little)): ('><'[little], alignment)
    for kind, alignment in ((0, 8), (2, 8), (6, 4), (8, 4), (10, 4))
    for little in (0, 1)
}
"""Byte order and alignment of float64 by the first two bytes, as Fast CDR defines them."""


class MalformedMessageError(ValueError):
    """Bytes that are not a message of this type."""


class Layout(NamedTuple):
    """Positions in a message; messages of one layout differ only in the stamp and the arrays."""

    order: str
    """Byte order as in `struct`: '<' or '>'."""
    size: int
    """Bytes of the whole message."""
    texts: tuple[bytes, ...]
    """The strings: frame_id, then the names of a JointState."""
    arrays: tuple[tuple[int, int], ...]
    """Offset and count of the float64 of each array."""
    fixed: tuple[tuple[int, int], ...]
    """Spans (start, end) of the bytes that define it: encapsulation, lengths, strings."""


def joint_names(layout: Layout) -> list[bytes]:
    """Names of the joints of a JointState.

    If no joint has a name, as in messages of many micro-ROS drivers, their indices are their
    names: b'0', b'1', ...
    """
    _, *names = layout.texts
    if any(names):
        return names
    _, positions = layout.arrays[0]
    return [b'%d' % index for index in range(len(names) or positions)]


def joint_index(layout: Layout, joint: bytes) -> int | None:
    """Index in the arrays of a joint of `joint_names`, b'' for the only one; None without it."""
    names = joint_names(layout)
    if joint:
        return names.index(joint) if joint in names else None
    return 0 if len(names) == 1 else None


def header_stamp(data: bytes) -> int:
    """Return the stamp of any message that begins with a std_msgs/Header, ns; -1 without one."""
    if len(data) < STAMP_OFFSET + STAMP.size:
        return -1
    seconds, nanoseconds = struct.unpack_from('<iI' if data[1] & 1 else '>iI', data, STAMP_OFFSET)
    return int(seconds * SECOND + nanoseconds)


def joint_state_layout(data: bytes) -> Layout:
    """Find the layout of a sensor_msgs/JointState.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    return _layout_of_joints(data, (1, 1, 1))  # position, velocity, effort


def pose_array_layout(data: bytes) -> Layout:
    """Find the layout of a geometry_msgs/PoseArray.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    reader = _Reader(data)
    reader.string()  # frame_id
    reader.doubles(7 * reader.count(56))
    return reader.layout()


def wrenches_layout(data: bytes) -> Layout:
    """Find the layout of a sensor_msgs/MultiDOFJointState: transforms, twists and wrenches.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    return _layout_of_joints(data, (7, 6, 6))


def _layout_of_joints(data: bytes, arrays: Sequence[int]) -> Layout:
    """Find the layout of names and of arrays, given by the numbers of each item."""
    reader = _Reader(data)
    reader.string()  # frame_id
    for _ in range(reader.count(4)):
        reader.string()
    for numbers in arrays:
        reader.doubles(numbers * reader.count(8 * numbers))
    return reader.layout()


class _Reader:
    """Reads the primitives after a header's stamp and records their positions."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._offset = STAMP_OFFSET + STAMP.size
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

    def layout(self) -> Layout:
        texts, arrays, fixed = tuple(self._texts), tuple(self._arrays), tuple(self._fixed)
        return Layout(self._order, len(self._data), texts, arrays, fixed)


class Template:
    """A message laid out once; encoding only writes the stamp and the numbers."""

    def __init__(self, frame_id: str) -> None:
        self._buffer = bytearray(_ENCAPSULATION + bytes(STAMP.size))
        self.arrays: list[tuple[int, int]] = []
        """Offset and count of the float64 of each array."""
        self._string(frame_id)

    def encode(self, stamp: int, *arrays: Sequence[float]) -> bytes:
        """Return the bytes of the message, from the stamp (ns) and the numbers of each array."""
        values: list[Any] = [_ENCAPSULATION, *divmod(stamp, SECOND)]
        for text, array in zip(self._texts, arrays, strict=True):
            values.append(text)
            values += array
        return self._pack(*values, self._end)

    def _finish(self) -> None:
        """Divide the message into numbers and the bytes between them, to pack it in one call."""
        code, end = f'<{STAMP_OFFSET}siI', STAMP_BYTES.stop
        self._texts = []
        for offset, count in self.arrays:
            code += f'{offset - end}s{count}d'
            self._texts.append(bytes(self._buffer[end:offset]))
            end = offset + 8 * count
        self._end = bytes(self._buffer[end:])
        self._pack = struct.Struct(f'{code}{len(self._end)}s').pack

    def _count(self, count: int) -> None:
        self._pad(4)
        self._buffer += struct.pack('<I', count)

    def _string(self, text: str) -> None:
        encoded = text.encode() + b'\0'
        self._count(len(encoded))
        self._buffer += encoded

    def _doubles(self, count: int) -> None:
        if count:
            self._pad(8)
            self.arrays.append((len(self._buffer), count))
            self._buffer += bytes(8 * count)

    def _pad(self, size: int) -> None:
        self._buffer += bytes(-(len(self._buffer) - STAMP_OFFSET) % size)


class JointStateTemplate(Template):
    """A sensor_msgs/JointState of the given joints: encode(stamp, positions, ...)."""

    def __init__(self, names: Sequence[str], *, velocity: bool, effort: bool) -> None:
        """Lay the message out; `encode` takes only the arrays that are present."""
        super().__init__(frame_id='')
        self._count(len(names))
        for name in names:
            self._string(name)
        for present in (True, velocity, effort):
            count = len(names) if present else 0
            self._count(count)
            self._doubles(count)
        self._finish()


class PoseArrayTemplate(Template):
    """A geometry_msgs/PoseArray: encode(stamp, numbers), per pose x y z and quaternion x y z w."""

    def __init__(self, frame_id: str, poses: int) -> None:
        """Lay the message out for a number of poses."""
        super().__init__(frame_id)
        self._count(poses)
        self._doubles(7 * poses)
        self._finish()


class WrenchesTemplate(Template):
    """A sensor_msgs/MultiDOFJointState with a wrench for each joint, and nothing else.

    encode(stamp, numbers): per joint the force x y z, N, and the torque x y z, N·m.
    """

    def __init__(self, frame_id: str, names: Sequence[str]) -> None:
        """Lay the message out for the joints of these names."""
        super().__init__(frame_id)
        self._count(len(names))
        for name in names:
            self._string(name)
        for count in (0, 0, len(names)):  # transforms, twists, wrenches
            self._count(count)
        self._doubles(6 * len(names))
        self._finish()
