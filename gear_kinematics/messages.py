"""The wire format (CDR) of sensor_msgs/JointState and geometry_msgs/PoseArray, without ROS.

Both start with a std_msgs/Header. CDR (XCDR version 1, as ROS 2 writes it): four bytes of
encapsulation, the second of which tells the byte order; then the fields, each aligned to its
size as counted from behind the encapsulation.
"""

import struct
from collections.abc import Sequence
from typing import NamedTuple, Self

_ENCAPSULATION = 4
_SECOND = 1_000_000_000  # ns
_LITTLE_ENDIAN, _BIG_ENDIAN = b'\x00\x01', b'\x00\x00'
_STAMP = struct.Struct('<iI')
_MAX_PADDING = 3  # DDS fills a payload up to a multiple of four bytes


class MalformedMessageError(ValueError):
    """Bytes that are no such message."""


class JointState(NamedTuple):
    """A decoded sensor_msgs/JointState. Names stay bytes: they are only compared."""

    stamp: int
    """ns."""
    names: tuple[bytes, ...]
    position: tuple[float, ...]
    velocity: tuple[float, ...]
    effort: tuple[float, ...]


class PoseArray(NamedTuple):
    """A decoded geometry_msgs/PoseArray."""

    stamp: int
    """ns."""
    frame_id: bytes
    numbers: tuple[float, ...]
    """x y z and quaternion x y z w, pose after pose."""


def decode_joint_state(data: bytes) -> JointState:
    """Decode a sensor_msgs/JointState of either byte order.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    with _Reader(data) as reader:
        stamp = reader.stamp()
        reader.string()  # frame_id
        names = tuple([reader.string() for _ in range(reader.count(4))])
        return JointState(
            stamp, names, reader.double_array(), reader.double_array(), reader.double_array()
        )


def decode_pose_array(data: bytes) -> PoseArray:
    """Decode a geometry_msgs/PoseArray of either byte order.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    with _Reader(data) as reader:
        return PoseArray(reader.stamp(), reader.string(), reader.doubles(7 * reader.count(56)))


class _Reader:
    """Reads CDR primitives one after the other; at the end of `with`, nothing may be left over."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self.offset = _ENCAPSULATION
        if data[:2] == _LITTLE_ENDIAN:
            self._order = '<'
        elif data[:2] == _BIG_ENDIAN:
            self._order = '>'
        else:
            raise MalformedMessageError('no CDR encapsulation')

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: object, _: object) -> None:
        if kind is not None and issubclass(kind, struct.error):
            raise MalformedMessageError('the message is cut off')
        if kind is None and len(self._data) - self.offset > _MAX_PADDING:
            raise MalformedMessageError('bytes are left over')

    def stamp(self) -> int:
        seconds, nanoseconds = struct.unpack_from(self._order + 'iI', self._data, self.offset)
        self.offset += 8
        if nanoseconds >= _SECOND:
            raise MalformedMessageError('a stamp has more than a second of nanoseconds')
        return int(seconds * _SECOND + nanoseconds)

    def count(self, item_size: int) -> int:
        self.offset += -self.offset % 4
        (count,) = struct.unpack_from(self._order + 'I', self._data, self.offset)
        self.offset += 4
        if count * item_size > len(self._data) - self.offset:
            raise MalformedMessageError('a sequence is longer than the message')
        return int(count)

    def string(self) -> bytes:
        size = self.count(1)
        text = self._data[self.offset : self.offset + size]
        self.offset += size
        if not text.endswith(b'\0'):
            raise MalformedMessageError('a string does not end')
        return text[:-1]

    def double_array(self) -> tuple[float, ...]:
        return self.doubles(self.count(8))

    def doubles(self, count: int) -> tuple[float, ...]:
        if count == 0:  # nothing follows, not even the padding
            return ()
        self.offset += -(self.offset - _ENCAPSULATION) % 8
        values = struct.unpack_from(f'{self._order}{count}d', self._data, self.offset)
        self.offset += 8 * count
        return values


class Template:
    """A message laid out once; each encoding only writes the stamp and the numbers into it."""

    def __init__(self, frame_id: str) -> None:
        self._buffer = bytearray(_LITTLE_ENDIAN + bytes(2 + _STAMP.size))
        self._arrays: list[tuple[int, struct.Struct]] = []
        self._string(frame_id)

    def encode(self, stamp: int, *arrays: Sequence[float]) -> bytes:
        """Give the message's bytes.

        Args:
            stamp: ns.
            arrays: the numbers of each array, as many as were laid out.
        """
        _STAMP.pack_into(self._buffer, _ENCAPSULATION, *divmod(stamp, _SECOND))
        for (offset, layout), values in zip(self._arrays, arrays, strict=True):
            layout.pack_into(self._buffer, offset, *values)
        return bytes(self._buffer)

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
            self._arrays.append((len(self._buffer), struct.Struct(f'<{count}d')))
            self._buffer += bytes(8 * count)

    def _pad(self, size: int) -> None:
        self._buffer += bytes(-(len(self._buffer) - _ENCAPSULATION) % size)


class JointStateTemplate(Template):
    """A sensor_msgs/JointState of the given joints: encode(stamp, positions, ...)."""

    def __init__(
        self, names: Sequence[str], *, velocity: bool, effort: bool, position: bool = True
    ) -> None:
        """Lay it out; an array that is not there takes no part in `encode`."""
        super().__init__(frame_id='')
        self._count(len(names))
        for name in names:
            self._string(name)
        for present in (position, velocity, effort):
            count = len(names) if present else 0
            self._count(count)
            self._doubles(count)


class PoseArrayTemplate(Template):
    """A geometry_msgs/PoseArray: encode(stamp, numbers), x y z and quaternion x y z w a pose."""

    def __init__(self, frame_id: str, poses: int) -> None:
        """Lay it out for a number of poses."""
        super().__init__(frame_id)
        self._count(poses)
        self._doubles(7 * poses)
