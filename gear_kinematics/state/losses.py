# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages that were lost, by the numbers that publishers give them."""


class Losses:
    """Counts the messages that are missing between those of a topic that came.

    A publisher can come and go unseen, or take another's place, and each counts from 1: a number
    below all others begins a new counting, and any other belongs to the nearest.
    """

    def __init__(self) -> None:
        self.missing = 0
        self.numbered = True
        """Whether all messages had numbers, which not every middleware gives."""
        self.next: list[int] = []
        """The next number in each counting; that of the latest message is the last."""

    def note(self, number: int | None) -> None:
        """Take the number of the next message."""
        if self.next and number == self.next[-1]:
            self.next[-1] += 1
        elif number is None:
            self.numbered = False
        else:
            expected = max((other for other in self.next if other <= number), default=None)
            if expected is not None:
                self.missing += number - expected
                self.next.remove(expected)
            self.next.append(number + 1)
