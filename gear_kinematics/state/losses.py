# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Which messages were lost, and who sends them, by the numbers that publishers give them."""

from collections import deque

_UPDATES = 5  # in which two publishers of a joint take turns twice, unless one is very slow


class Losses:
    """Counts the missing messages of a publisher; a number below the last is from a new one."""

    def __init__(self) -> None:
        self.missing = 0
        self.numbered = True  # whether all messages had numbers, which not every middleware gives
        self.next: int | None = None  # number of the next message; None before the first
        self._last = 0  # number of the last message, of whichever publisher

    def note(self, number: int | None) -> bool:
        """Take the number of the next message; return whether it is from a new publisher."""
        if number is None:
            self.numbered = False
            return False
        if self.next is not None and number > self.next:
            self.missing += number - self.next
        last, self._last, self.next = self._last, number, number + 1
        return number < last


class Publishers:
    """Finds whether several publishers send a joint: their numbers do not rise when they mix."""

    def __init__(self) -> None:
        self._last = -1  # number of the last message
        self._changes = deque([0], maxlen=_UPDATES)  # of publishers, between updates

    def note(self, number: int | None) -> None:
        """Take the number of the next message, if it has one."""
        if number is not None:
            self._changes[-1] += number <= self._last
            self._last = number

    def update(self) -> None:
        """Forget what happened before the last updates."""
        self._changes.append(0)

    @property
    def several(self) -> bool:
        """Whether the publisher changed more than once: one that restarts does so once."""
        return sum(self._changes) > 1
