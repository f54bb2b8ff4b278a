# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages that were lost, by the numbers that publishers give them."""


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
