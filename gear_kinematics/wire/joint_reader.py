# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads one joint from sensor_msgs/JointState messages; defines the causes of rejection."""

import math
import struct
from collections.abc import Callable, Iterable, Sequence
from enum import StrEnum
from functools import partial
from operator import itemgetter
from typing import Any

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE
from gear_kinematics.wire.cdr import (
    LATEST,
    SECOND,
    STAMP_OFFSET,
    MalformedMessageError,
    MessageLayout,
    arrays_fit,
    joint_index,
    joint_names,
    joint_state_layout,
)
from gear_kinematics.wire.nearest import among, listed

CLOCK_RESET = 1_000_000_000  # ns; a stamp that is older by more shows a clock that was set back

GREATEST = 1e280
"""Greatest velocity or effort; beyond, it counts as not finite, as results could be infinite: a
gear ratio multiplies it by up to 2^53, and the slope of a calibration by up to 1e6."""
_MAX_KEPT = 65_536  # bytes: layouts of larger messages are not kept
_MOST_LAYOUTS = 64  # kept; an arm has at most a driver for each joint


JointValues = tuple[int, bool, float, float | None, float | None]
"""Stamp (ns, 0 if absent), whether it has a second or more of nanoseconds, position, velocity and
effort; None for a value that is absent or not finite."""
_Unpack = Callable[[bytes], tuple[Any, ...]]


class Rejection(StrEnum):
    """The cause for which a message has no output."""

    MALFORMED = 'not a JointState'
    STAMP_OUT_OF_RANGE = 'stamp out of range'
    JOINT_MISSING = 'joint missing'
    ARRAY_SIZES = 'array sizes'
    POSITION_MISSING = 'position missing'
    POSITION_NOT_FINITE = 'position not finite'
    POSITION_TOO_LARGE = 'position too large'
    OUT_OF_ORDER = 'out of order'
    IMPLAUSIBLE = 'implausible'


class RejectedInputError(ValueError):
    """A message without an output; the text is the cause, which is counted."""

    def __init__(self, cause: Rejection, describe: Callable[[], str] = str) -> None:
        """Note the cause, and a function that returns further details."""
        super().__init__(cause)
        self._describe = describe

    @property
    def detail(self) -> str:
        """The joints of the message, if the wanted one is missing, or its sizes; otherwise ''."""
        return self._describe()


JointMessage = bytes | JointValues | RejectedInputError
"""A serialised sensor_msgs/JointState, or what a joint's reader reads from it or raises."""


def describe_missing(joint: str, data: bytes) -> str:
    """List the joints of a JointState without the wanted one; '' stands for the only one."""
    names = joints_of(data)
    if not joint:
        there = f'more than one joint in it; there are: {listed(names)}'
        return there if names else 'no joint in it'
    return f'no joint {joint!r} in it{among(joint, names)}'


def describe_sizes(joint: bytes, data: bytes) -> str:
    """Say how often a JointState names a joint, or which of its arrays has another length."""
    layout = joint_state_layout(data)
    names = joint_names(layout)
    if names.count(joint) > 1:
        return f'it names {joint.decode(errors="backslashreplace")!r} {names.count(joint)} times'
    counts = zip(('position', 'velocity', 'effort'), layout.arrays, strict=True)
    wrong = [f'{count} in {field}' for field, (_, count) in counts if count not in {0, len(names)}]
    return f'{len(names)} in name, but {" and ".join(wrong)}'


def joints_of(data: bytes) -> list[str]:
    """Names of the joints in a serialised sensor_msgs/JointState, safe to print.

    Raises:
        MalformedMessageError: if the bytes are anything else.
    """
    raw = joint_names(joint_state_layout(data))
    names = [name.decode(errors='backslashreplace') for name in raw]
    return [name if name.isprintable() else ascii(name)[1:-1] for name in names]


def _missing(joint: bytes, data: bytes) -> RejectedInputError:
    name = joint.decode(errors='backslashreplace')
    return RejectedInputError(Rejection.JOINT_MISSING, partial(describe_missing, name, data))


class JointReader:
    """Reads a joint from one message after another.

    The messages of a driver all have the same layout. The last layout is kept as two structs: of
    the bytes that define it, with which each message is compared, and of the joint's numbers. A
    message that differs is parsed again.
    """

    _size = -1  # of the messages whose layout is known

    def __init__(self, joint: str) -> None:
        """Read the joint of a name, or an index if no joint has a name; '' for the only one."""
        self._joint = joint.encode()

    def read(self, data: JointMessage) -> JointValues:
        """Read a message, or return or raise what was read from it.

        Raises:
            RejectedInputError: if it has no usable position of the joint.
        """
        if not isinstance(data, bytes):
            if isinstance(data, RejectedInputError):
                raise data
            return data
        try:
            if len(data) != self._size or self._fixed_of(data) != self._fixed:
                self._learn(data)
        except MalformedMessageError as error:
            raise RejectedInputError(Rejection.MALFORMED) from error
        return self._take(self._numbers_of(data), data)

    def _learn(self, data: bytes) -> None:
        """Keep the layout of a message for the next ones."""
        layout = joint_state_layout(data)
        self._fixed_of = _definition(layout)
        self._fixed = self._fixed_of(data)
        joint = _Joint(layout, self._joint)
        offsets = joint.present
        unpack, pick = _numbers(layout, offsets), joint.pick_from(offsets)
        complete = len(offsets) == len(joint.offsets)
        self._numbers_of = unpack if complete else lambda data: pick((*unpack(data), None))
        self._take = joint.take
        self._size = layout.size if layout.size <= _MAX_KEPT else -1


class JointsReader:
    """Reads several joints from one message after another, as `JointReader` reads one.

    The layouts of a few drivers are kept, and each message is compared with them once.
    """

    def __init__(self, joints: Iterable[str]) -> None:
        """Read the joints of these names or indices."""
        self._joints = [joint.encode() for joint in joints]
        self._layouts: dict[int, list[_JointsLayout]] = {}
        self.there: set[str] = set()
        """Names of the joints in messages of the layouts that are kept, safe to print."""

    def read(self, data: bytes) -> Sequence[JointValues | RejectedInputError | None]:
        """Read a message: for each joint its values, why it has none, or None if it is missing.

        All are rejected if all are missing.

        Raises:
            RejectedInputError: if the message is none.
        """
        for layout in self._layouts.get(len(data), ()):
            if layout.fixed_of(data) == layout.fixed:
                break
        else:
            layout = self._learn(data)
        if not layout.any_there:
            return [_missing(joint, data) for joint in self._joints]
        numbers = (*layout.unpack(data), None)
        found: list[JointValues | RejectedInputError | None] = []
        for joint in layout.joints:
            try:
                found.append(joint and joint[1](joint[0](numbers), data))
            except RejectedInputError as rejection:
                found.append(rejection)
        return found

    def _learn(self, data: bytes) -> '_JointsLayout':
        """Keep the layout of a message for the next ones."""
        try:
            layout = joint_state_layout(data)
        except MalformedMessageError as error:
            raise RejectedInputError(Rejection.MALFORMED) from error
        learnt = _JointsLayout(layout, self._joints, data)
        if layout.size <= _MAX_KEPT:
            if sum(map(len, self._layouts.values())) >= _MOST_LAYOUTS:
                self._layouts.clear()
                self.there.clear()
            self.there.update(joints_of(data))
            self._layouts.setdefault(layout.size, []).append(learnt)
        return learnt


class _JointsLayout:
    """Several joints in the messages of one layout, whose numbers are unpacked in one call."""

    def __init__(self, layout: MessageLayout, joints: Iterable[bytes], data: bytes) -> None:
        self.fixed_of = _definition(layout)
        self.fixed = self.fixed_of(data)
        found = [_Joint(layout, joint) for joint in joints]
        offsets = sorted({offset for each in found for offset in each.present})
        self.unpack = _numbers(layout, offsets)
        self.joints = [
            None if each.missing else (each.pick_from(offsets), each.take) for each in found
        ]
        self.any_there = any(self.joints)


class _Joint:
    """A joint in the messages of one layout."""

    def __init__(self, layout: MessageLayout, joint: bytes) -> None:
        self._joint = joint
        index = joint_index(layout, joint)
        self._fits = arrays_fit(layout, joint)
        self.offsets = [
            offset + 8 * index if self._fits and index is not None and count else None
            for offset, count in layout.arrays
        ]
        """Those of its position, velocity and effort; None for one that is absent."""
        self.present = [offset for offset in self.offsets if offset is not None]
        self.missing = index is None

    def pick_from(self, offsets: Sequence[int]) -> Callable[[Sequence[Any]], tuple[Any, ...]]:
        """Make a function that takes the joint's numbers out of all, and None behind them."""
        # The stamp, which is two numbers, comes first.
        places = [-1 if each is None else 2 + offsets.index(each) for each in self.offsets]
        return itemgetter(0, 1, *places)

    def take(self, numbers: Sequence[Any], data: bytes) -> JointValues:
        """Check the numbers of a message; raises RejectedInputError if it has no position."""
        seconds, nanoseconds, position, velocity, effort = numbers
        stamp = seconds * SECOND + nanoseconds
        if stamp > LATEST:
            raise RejectedInputError(Rejection.STAMP_OUT_OF_RANGE)
        if position is None:
            if self.missing:
                raise _missing(self._joint, data)
            if self._fits:
                raise RejectedInputError(Rejection.POSITION_MISSING)
            sizes = partial(describe_sizes, self._joint, data)
            raise RejectedInputError(Rejection.ARRAY_SIZES, sizes)
        if not -LARGEST_ANGLE <= position <= LARGEST_ANGLE:  # NaN compares false
            if math.isfinite(position):
                raise RejectedInputError(Rejection.POSITION_TOO_LARGE)
            raise RejectedInputError(Rejection.POSITION_NOT_FINITE)
        if velocity is not None and not -GREATEST <= velocity <= GREATEST:
            velocity = None
        if effort is not None and not -GREATEST <= effort <= GREATEST:
            effort = None
        return stamp, nanoseconds >= SECOND, position, velocity, effort


def _numbers(layout: MessageLayout, offsets: Iterable[int]) -> _Unpack:
    """Make a function that takes the stamp and the float64 at offsets out of a message."""
    return _unpacker(layout, [(STAMP_OFFSET, 'iI'), *((offset, 'd') for offset in offsets)])


def _definition(layout: MessageLayout) -> _Unpack:
    """Make a function that takes the bytes that define a layout out of a message."""
    return _unpacker(layout, [(start, f'{end - start}s') for start, end in layout.fixed])


def _unpacker(layout: MessageLayout, items: Iterable[tuple[int, str]]) -> _Unpack:
    """Make a function that takes items, given by offset and format, out of a message."""
    code, end = layout.order, 0
    for offset, item in items:
        code += f'{offset - end}x{item}'
        end = offset + struct.calcsize(layout.order + item)
    return struct.Struct(f'{code}{layout.size - end}x').unpack
