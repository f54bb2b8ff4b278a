# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages that were lost, by the numbers that publishers give them."""


class Losses:
    """Counts the missing messages of a publisher; a number below the last is from a new one."""

    def __init__(self) -> None:
        self.missing = 0
        self.numbered = True  # whether all messages had numbers, which not every middleware gives
        self.next: int | None = None  # number of the next message; None before the first

    def note(self, number: int | None) -> None:
        """Take the number of the next message."""
        if number is None:
            self.numbered = False
            return
        if self.next is not None and number > self.next:
            self.missing += number - self.next
        self.next = number + 1
