# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Which messages were lost, and who sends them, by the numbers that publishers give them."""

from collections import deque

_UPDATES = 5  # in which two publishers of a joint take turns often, unless one is very slow


class Losses:
    """Counts the missing messages of a topic that has one publisher."""

    def __init__(self) -> None:
        self.missing = 0
        self.numbered = True  # whether all messages had numbers, which not every middleware gives
        self.next: int | None = None  # number of the next message; None before the first

    def note(self, number: int | None) -> None:
        """Take the number of the next message, if it has one."""
        if number is None:
            self.numbered = False
            return
        if self.next is not None and number > self.next:
            self.missing += number - self.next
        self.next = number + 1


class Publishers:
    """Finds whether a joint has another publisher, or several, whose numbers fall as they mix."""

    def __init__(self) -> None:
        self._last = -1  # number of the last message
        self._passed = False  # whether one jumped past the greatest since they fell
        self._greatest = deque([-1], maxlen=_UPDATES)  # before numbers fell, between updates
        self._returns = deque([0], maxlen=_UPDATES)  # of a former publisher, between updates

    def note(self, number: int | None) -> bool:
        """Take the number of the next message, if any; return whether a publisher is new."""
        if number is None:
            return False
        last, self._last = self._last, number
        if number == last + 1:
            return False
        greatest = max(self._greatest)
        if number > last:
            self._passed |= last < greatest < number
            return False
        # A former one went on, then: those of one that restarts rise little by little.
        returned = self._passed or 0 <= greatest < number == last
        self._passed = False
        self._returns[-1] += returned
        self._greatest[-1] = max(self._greatest[-1], last)
        return not (returned or self.several)

    def update(self) -> None:
        """Forget what happened before the last updates."""
        self._greatest.append(-1)
        self._returns.append(0)

    @property
    def several(self) -> bool:
        """Whether publishers take turns: one that is replaced does not return."""
        return sum(self._returns) > 1
