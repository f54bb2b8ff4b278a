# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Decodes and encodes batches of raw messages as arrays.

Messages of the same layout have everything at the same place, so a batch of them is a table of
bytes. A recording has few layouts per topic; more only cost time.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import Any, Self, TypeVar, TypeVarTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.wire.cdr import (
    SECOND,
    STAMP_OFFSET,
    JointStateTemplate,
    MalformedMessageError,
    MessageLayout,
    Template,
    arrays_fit,
    joint_index,
    joint_state_layout,
    pose_array_layout,
)
from gear_kinematics.wire.joint_reader import describe_missing

Array = NDArray[Any]
FIELDS = ('position', 'velocity', 'effort')
_Given = TypeVarTuple('_Given')
_Result = TypeVar('_Result')


def once_for_joints(function: Callable[[*_Given], _Result]) -> Callable[[*_Given], _Result]:
    """Keep the latest result of a function for the other joints of the same messages.

    Arrays are the same if they are one object, whose contents must not change.
    """
    latest: tuple[Any, Any] = (), None

    @wraps(function)
    def look_up(*given: *_Given) -> _Result:
        nonlocal latest
        known, result = latest
        if len(known) != len(given) or not all(map(_is_same, known, given)):
            result = function(*given)
            latest = given, result
        return result  # type: ignore[no-any-return]

    return look_up


def _is_same(one: Any, other: Any) -> bool:
    return one is other or (not isinstance(one, np.ndarray) and bool(one == other))


Table = tuple[Array, MessageLayout, Array]
"""Rows of a batch that have the same layout, the layout, and their bytes, (rows, size)."""


class JointStateBatch(list[bytes]):
    """Messages sensor_msgs/JointState, divided by layout once for readers of several joints."""

    def __init__(self, messages: Sequence[bytes], tables: Sequence[Table] | None = None) -> None:
        """Take messages, and their tables if they are known."""
        super().__init__(messages)
        self.tables = [*_tables(messages, joint_state_layout)] if tables is None else tables

    @cached_property
    def heads(self) -> tuple[Array, Array, Array]:
        """Stamps, ns, whether they have 10⁹ or more nanoseconds, and what is malformed, (n,)."""
        count = len(self)
        stamp, unnormalised = np.zeros(count, np.int64), np.zeros(count, bool)
        malformed = np.ones(count, bool)
        for rows, layout, table in self.tables:
            malformed[rows] = False
            stamp[rows], nanoseconds = _stamps(table, layout)
            unnormalised[rows] = nanoseconds >= SECOND
        stamp.setflags(write=False)
        return stamp, unnormalised, malformed

    @cached_property
    def columns(self) -> list[list[Array]]:
        """The numbers of each table, (joints, rows) for each of FIELDS; none where it is empty.

        Each joint's are contiguous, so that reading all joints passes through the bytes once.
        """
        return [
            [_doubles(table, layout, *array).T.copy() for array in layout.arrays]
            for _, layout, table in self.tables
        ]

    def having(self, joints: Collection[bytes]) -> tuple[Array | None, Self]:
        """Return the rows of messages with any of the joints, or malformed, and these messages.

        None stands for all rows.
        """
        without = [
            rows for rows, layout, _ in self.tables if not {*joints}.intersection(layout.texts[1:])
        ]
        if not without:
            return None, self
        kept = np.ones(len(self), bool)
        kept[np.concatenate(without)] = False
        chosen, place = np.flatnonzero(kept), np.cumsum(kept) - 1
        tables = [
            (place[rows], layout, table) for rows, layout, table in self.tables if kept[rows[0]]
        ]
        return chosen, type(self)([self[row] for row in chosen.tolist()], tables)

    def narrowed(self, joints: Collection[bytes]) -> Self:
        """Return the messages, which have some of the joints, as if they had these alone."""
        tables = list[Table]()
        for rows, layout, table in self.tables:
            frame, *names = layout.texts
            found = [k for k, name in enumerate(names) if name in joints]
            own = slice(found[0], found[0] + len(found))
            arrays = tuple(
                (offset + 8 * own.start, max(min(own.stop, size) - own.start, 0))
                for offset, size in layout.arrays
            )
            part = layout._replace(texts=(frame, *names[own]), arrays=arrays)
            tables.append((rows, part, table))
        return type(self)(self, tables)

    def contents(self) -> Iterator[tuple[Array, tuple[bytes, ...], Array, list[Array]]]:
        """Yield the rows of each table, their joints, stamps, ns, (rows,), and fields, (rows, m).

        The fields are FIELDS; m is 0 where one is empty.
        """
        for (rows, layout, _), columns in zip(self.tables, self.columns, strict=True):
            fields = [field.T for field in columns]
            yield rows, layout.texts[1:], self.heads[0][rows], fields


@dataclass(frozen=True, eq=False, slots=True)
class JointStates:
    """One joint of n messages sensor_msgs/JointState."""

    stamp: Array  # (n,), time of the header, ns
    unnormalised: Array  # (n,): whether the stamp has a second or more of nanoseconds
    malformed: Array  # (n,): whether it is no such message, so that other values mean nothing
    joint_found: Array  # (n,): whether the joint is in the message
    arrays_fit: Array  # (n,): whether each array is empty or as long as `name`
    present: Array  # (n, 3): whether the message has the joint's position, velocity and effort
    values: Array  # (n, 3), by columns: position, velocity, effort; NaN where not present
    missing_joint: str  # joints of the first message without this one, in words; or ''

    def stamped(self, received: Sequence[int]) -> Array:
        """Return the stamps, with the time of reception, ns, in place of a missing one, (n,)."""
        return np.where(self.stamp == 0, np.asarray(received, np.int64), self.stamp)


@dataclass(frozen=True, eq=False, slots=True)
class PoseArrays:
    """n messages geometry_msgs/PoseArray."""

    stamp: Array  # (n,), time of the header, ns
    malformed: Array  # (n,): whether it is no such message, or has another number of poses
    frame_ids: tuple[bytes, ...]  # the frames that occur
    frame: Array  # (n,): index of the frame in `frame_ids`
    poses: Array  # (n, poses, 7), float64: x y z and quaternion x y z w


def decode_joint_states(messages: Sequence[bytes], joint: str) -> JointStates:
    """Decode the values of one joint, which `joint_index` looks up."""
    batch = messages if isinstance(messages, JointStateBatch) else JointStateBatch(messages)
    count = len(batch)
    joint_found, fit = np.zeros((2, count), bool)
    present, values = np.zeros((3, count), bool), np.full((3, count), np.nan)
    without = ''
    for (rows, layout, _), columns in zip(batch.tables, batch.columns, strict=True):
        at: Any = rows if len(rows) < count else slice(None)  # which is faster
        index = joint_index(layout, joint.encode())
        if index is None:
            without = without or describe_missing(joint, batch[rows[0]])
            continue
        joint_found[at], fit[at] = True, arrays_fit(layout, joint.encode())
        for field, numbers in enumerate(columns):
            if index < len(numbers):
                present[field, at] = True
                values[field, at] = numbers[index]
    return JointStates(*batch.heads, joint_found, fit, present.T, values.T, without)


def decode_pose_arrays(messages: Sequence[bytes], count_of_poses: int) -> PoseArrays:
    """Decode messages with a given number of poses."""
    count, numbers = len(messages), 7 * count_of_poses
    stamp, malformed = np.zeros(count, np.int64), np.ones(count, bool)
    frame_ids: list[bytes] = []
    frame, poses = np.zeros(count, np.intp), np.full((count, numbers), np.nan)
    for rows, layout, table in _tables(messages, pose_array_layout):
        offset, size = layout.arrays[0]
        if size != numbers:
            continue
        malformed[rows] = False
        stamp[rows], _ = _stamps(table, layout)
        poses[rows] = _doubles(table, layout, offset, size)
        if layout.texts[0] not in frame_ids:
            frame_ids.append(layout.texts[0])
        frame[rows] = frame_ids.index(layout.texts[0])
    return PoseArrays(
        stamp, malformed, tuple(frame_ids), frame, poses.reshape(count, count_of_poses, 7)
    )


def decode_numbers(
    messages: Sequence[bytes], like: Template, prefix: str
) -> tuple[Array, Array, Array]:
    """Decode messages that match a template, except for a prefix of its texts.

    Returns:
        Stamps, (n,), ns; whether a message does not match, (n,); and the
        numbers that `like.encode` takes, (n, numbers).
    """
    expected, count = like.layout(bytes(like.blank)), len(messages)
    texts = tuple(text and prefix.encode() + text for text in expected.texts)
    sizes = [size for _, size in expected.arrays]
    offsets = [start + 8 * k for start, size in expected.arrays for k in range(size)]
    given = np.isin(offsets, like.offsets)
    stamp, malformed = np.zeros(count, np.int64), np.ones(count, bool)
    numbers = np.full((count, len(like.offsets)), np.nan)
    for rows, layout, table in _tables(messages, like.layout):
        if layout.texts == texts and [size for _, size in layout.arrays] == sizes:
            found = np.hstack([_doubles(table, layout, *array) for array in layout.arrays])
            stamp[rows], _ = _stamps(table, layout)
            malformed[rows], numbers[rows] = found[:, ~given].any(axis=1), found[:, given]
    return stamp, malformed, numbers


def encode(template: Template, stamps: Array, numbers: Sequence[Array | float]) -> list[bytes]:
    """Encode n messages, as `template.encode` does one by one.

    Stamps are (n,), ns; each of the numbers of all arrays is an array (n,) or a constant.
    """
    size = len(template.blank)
    table = np.frombuffer(len(stamps) * template.blank, np.uint8).reshape(len(stamps), size)
    seconds, nanoseconds = np.divmod(stamps, SECOND)
    _columns(table, STAMP_OFFSET, '<i4')[:, 0] = seconds
    _columns(table, STAMP_OFFSET + 4, '<u4')[:, 0] = nanoseconds
    for offset, number in zip(template.offsets, numbers, strict=True):
        _columns(table, offset, '<f8')[:, 0] = number
    data = table.tobytes()
    return [data[start : start + size] for start in range(0, len(data), size)]


def join_joint_states(parts: Sequence[Sequence[bytes]]) -> list[bytes]:
    """Join messages sensor_msgs/JointState of the same stamps into one each.

    A joined message has the joints of all parts in their order. A field that no part has is empty;
    one that some lack is NaN there. Each part has n messages, b'' where it lacks one, and so has
    the result where all parts lack it.
    """
    count = len(parts[0])
    found = [[*JointStateBatch(part).contents()] for part in parts]
    kinds = np.zeros((count, len(parts)), np.intp)
    place = np.zeros_like(kinds)  # of messages in their tables
    for k, tables in enumerate(found):
        for kind, (rows, *_) in enumerate(tables, 1):
            kinds[rows, k], place[rows, k] = kind, np.arange(len(rows))
    joined = [b''] * count
    for kind in np.unique(kinds, axis=0):
        rows = np.flatnonzero((kinds == kind).all(axis=1))
        own = [(found[k][n - 1], place[rows, k]) for k, n in enumerate(kind.tolist()) if n]
        if not own:
            continue
        names = [name.decode() for (_, joints, *_), _ in own for name in joints]
        there = [any(fields[k].shape[1] for (*_, fields), _ in own) for k in range(3)]
        numbers = [
            column
            for k in np.flatnonzero(there)
            for (_, joints, _, fields), at in own
            for column in (fields[k][at].T if fields[k].size else [np.nan] * len(joints))
        ]
        (_, _, stamps, _), at = own[0]
        template = JointStateTemplate(names, velocity=there[1], effort=there[2])
        encoded = encode(template, stamps[at], numbers)
        for row, message in zip(rows.tolist(), encoded, strict=True):
            joined[row] = message
    return joined


def _tables(
    messages: Sequence[bytes], find_layout: Callable[[bytes], MessageLayout]
) -> Iterator[Table]:
    """Yield the tables of messages, without malformed ones."""
    if isinstance(messages, JointStateBatch):
        yield from messages.tables
        return
    sizes = {*map(len, messages)}
    for size in sorted(sizes - {0}):
        rows, chosen = np.arange(len(messages)), messages
        if len(sizes) > 1:
            rows = np.flatnonzero(np.array([*map(len, messages)]) == size)
            chosen = [messages[row] for row in rows.tolist()]
        table = np.frombuffer(b''.join(chosen), np.uint8).reshape(len(rows), size)
        while len(rows):
            try:
                layout = find_layout(table[0].tobytes())
            except MalformedMessageError:
                rows, table = rows[1:], table[1:]
                continue
            if _all_alike(table, layout):
                yield rows, layout, table
                break
            fixed = np.zeros(layout.fixed[-1][1], np.uint8)
            for span in layout.fixed:
                fixed[slice(*span)] = 255
            alike = ~((table[:, : len(fixed)] ^ table[0, : len(fixed)]) & fixed).any(axis=1)
            yield rows[alike], layout, table[alike]
            rows, table = rows[~alike], table[~alike]


def _all_alike(table: Array, layout: MessageLayout) -> bool:
    """Whether messages have the layout of the first one, and the same padding between strings."""
    spans = [layout.fixed[0]]
    for start, end in layout.fixed[1:]:
        before, last = spans[-1]
        if start == last + -last % 4:
            spans[-1] = before, end
        else:
            spans.append((start, end))
    for start, end in spans:
        part = table[:, start:end]
        if end - start in {2, 4}:
            part = part.view(f'u{end - start}')  # one comparison for each message
        if not (part == part[0]).all():
            return False
    return True


def _stamps(table: Array, layout: MessageLayout) -> tuple[Array, Array]:
    """The stamps, ns, and their field `nanosec`."""
    seconds = _columns(table, STAMP_OFFSET, f'{layout.order}i4')[:, 0].astype(np.int64)
    nanoseconds = _columns(table, STAMP_OFFSET + 4, f'{layout.order}u4')[:, 0]
    return seconds * SECOND + nanoseconds, nanoseconds


def _doubles(table: Array, layout: MessageLayout, offset: int, count: int) -> Array:
    return _columns(table, offset, f'{layout.order}f8', count)


def _columns(table: Array, offset: int, dtype: str, count: int = 1) -> Array:
    """The numbers of a type at an offset of each row, (rows, count), to read or write."""
    return table[:, offset : offset + count * np.dtype(dtype).itemsize].view(dtype)
