# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Decodes serialised messages for the independent comparison by `struct`; times and pairs them."""

import math
import struct
from typing import Any

_AGAIN = 1_000_000_000  # ns after which a stamp that comes again is of another start of the driver
_UNKNOWN = 10**18  # ns, longer than any gap

State = tuple[int, float, float, float]  # stamp, ns, position, velocity, effort; NaN for absent
Waiting = tuple[int, int, Any]  # stamp and time of reception, ns, and the content of a message
Known = dict[int, list[tuple[int, Any]]]  # by stamp, in order: time of reception, ns, and content


class IndependentMessage:
    """Reads a serialised message from its start."""

    def __init__(self, data: bytes) -> None:
        self._data, self._order, self._at = data, '<' if data[1] & 1 else '>', 4
        (seconds,), (nanoseconds,) = self._take('i'), self._take('I')
        self.stamp = int(1_000_000_000 * seconds + nanoseconds)
        self._text()

    def _take(self, code: str, count: int = 1) -> tuple[Any, ...]:
        size = struct.calcsize(code)
        self._at += -(self._at - 4) % size
        values = struct.unpack_from(f'{self._order}{count}{code}', self._data, self._at)
        self._at += size * count
        return values

    def _text(self) -> str:
        (size,) = self._take('I')
        self._at += size
        return self._data[self._at - size : self._at].rstrip(b'\0').decode()

    def array(self, size: int = 1) -> tuple[Any, ...]:
        """Read an array, of items of so many float64."""
        (count,) = self._take('I')
        return self._take('d', size * count) if count else ()

    def joints(self) -> tuple[list[str], list[tuple[float, ...]]]:
        """Read the names and the arrays of a JointState."""
        return [self._text() for _ in range(self._take('I')[0])], [self.array() for _ in range(3)]

    def joint(self, name: str) -> State:
        """Read a JointState, and select a joint by name, by index, or '' as the only one."""
        names, arrays = self.joints()
        index = names.index(name) if name in names else int(name or len(names) - 1)
        position, *others = (a[index] if index < len(a) else math.nan for a in arrays)
        velocity, effort = (value if math.isfinite(value) else math.nan for value in others)
        return self.stamp, position, velocity, effort


class InputTime:
    """Adds up the time between inputs by their stamps, ns, also where a clock was set back."""

    def __init__(self) -> None:
        self._time = self._stamp = self._latest = 0
        self._fell = False  # whether the last stamp was older than the one before it

    def at(self, stamp: int) -> int:
        """Return the time of the next input, long after the last if a clock began anew."""
        if stamp < self._latest - _AGAIN:
            self._time, self._stamp, self._latest = self._time + _UNKNOWN, stamp, stamp
        late = self._fell and stamp >= self._latest  # the input before, alone
        rise = max(0, stamp - (self._latest if late else self._stamp))
        # A clock that was set back does not show the time before, which is about as long.
        self._time += 2 * rise if self._fell and not late else rise
        self._fell = stamp < self._stamp
        self._stamp, self._latest = stamp, max(stamp, self._latest)
        return self._time


def paired(waiting: list[Waiting], known: Known) -> list[tuple[int, int, Any, Any]]:
    """Add what is known of their stamps to what waits, in order; others go on waiting."""
    pairs, left = [], []
    for each in waiting:
        stamp, received, _ = each
        rows = known.get(stamp, [])
        while len(rows) > 1:  # the first may be from before a restart, and without an answer
            (before, _), (after, _) = rows[:2]
            if after - before <= _AGAIN or received - before < after - received:
                break
            rows.pop(0)
        if rows:
            pairs.append((*each, rows.pop(0)[1]))
        else:
            left.append(each)
    waiting[:] = left
    return pairs
