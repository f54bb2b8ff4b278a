# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Distinguishes a clock that was set back from late messages, and judges the pace of stamps."""

from itertools import pairwise

import numpy as np

from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.wire.batches import Array, once_for_joints
from gear_kinematics.wire.cdr import SECOND

_CLOCK_STEP = 20_000_000  # ns: clocks are slewed by less, and messages are late by less
_CLOSE = 25  # messages, in which a bag that is looped begins at most once
ALTERNATING = 3  # resets of the clock so close to each other: as many are no chance
FASTEST = 100.0  # times the clock: faster than any playback
_FEWEST, _LEAST = 10, 100_000_000  # stamps, and ns, that tell their pace; no burst takes as long
_EVEN = 1.5  # times the usual one: time until a reading that directly follows

Late = tuple[int, float, float | None, float | None]  # ns, rad, rad/s, N·m or other units


class Disorder:
    """Collects the readings that are older than the last sample, the first of each stamp."""

    def __init__(self) -> None:
        self.readings: list[Late] = []
        self.close_resets = 0  # resets of the clock that directly follow another one
        self._reset = -_CLOSE  # number of the message of the last one
        self.step: Fact | None = None  # the clock's last step back
        self._too_fast: Fact | None = None

    @property
    def clock_fault(self) -> Fact | None:
        """Stamps of two clocks, or of another unit, or else the clock's last step back.

        The unit is known of batches only.
        """
        if self.close_resets < ALTERNATING:
            return self._too_fast or self.step
        return Condition.CLOCKS_ALTERNATE(count=self.close_resets)

    def add(self, reading: Late) -> None:
        """Note a reading that is older than the last sample."""
        if not self.readings or reading[0] != self.readings[-1][0]:
            self.readings.append(reading)

    def compare(self, stamps: Array, received: Array) -> None:
        """See whether stamps rise faster than times of reception, (n,), ns, bursts apart."""
        time = np.ptp(received) if len(received) >= _FEWEST else 0
        if time >= _LEAST and (pace := np.ptp(stamps) / time) > FASTEST:
            usual, clock = (float(np.median(np.diff(each))) for each in (stamps, received))
            if (pace := min(float(pace), usual / max(clock, 1.0))) > FASTEST:
                self._too_fast = Condition.STAMPS_TOO_FAST(factor=pace)

    def note_reset(self, number: int, last: int, stamp: int) -> None:
        """Note that the message of a number reset the clock, from the last stamp to its own."""
        self.close_resets += number - self._reset < _CLOSE
        self._reset = number
        self._note_step(last, stamp)

    def set_back(self, last: int, stamp: int) -> tuple[int, list[Late]]:
        """Return by how much the clock was set back between two samples, ns, and what came since.

        It was set back if several messages in a row, in order, were older than the last sample.
        The first of them is taken to be as long after that sample as the second after the first.
        No readings are returned if the new sample does not directly follow them: they can have
        been late, and those between came before them.
        """
        readings, self.readings = self.readings, []
        stamps = [*(earlier for earlier, *_ in readings), stamp]
        *spans, latest = (b - a for a, b in pairwise(stamps))
        if not spans or min(*spans, latest) <= 0:
            return 0, []
        if last - stamps[0] > _CLOCK_STEP:
            self._note_step(last, stamps[0])
        even = latest <= _EVEN * sorted(spans)[len(spans) // 2]
        return last - stamps[0] + stamps[1] - stamps[0], readings if even else []

    def _note_step(self, last: int, stamp: int) -> None:
        size, at = (last - stamp) / SECOND, last / SECOND
        self.step = Condition.CLOCK_SET_BACK(size=size, time=at)


@once_for_joints
def order(stamps: Array) -> tuple[bool, int]:
    """Return whether stamps never fall and none is 0, and how many repeat the one before."""
    steps = np.diff(stamps)
    return bool((steps >= 0).all() and stamps.all()), int(np.count_nonzero(steps == 0))


@once_for_joints
def spaced(stamps: Array, due: int, span: int) -> Array:
    """Return rows at least a span apart, ns, as early as possible, the first not before `due`."""
    rows, row = list[int](), -1
    while (row := row + 1 + int(stamps[row + 1 :].searchsorted(due))) < len(stamps):
        rows.append(row)
        due = int(stamps[row]) + span
    return np.array(rows, np.intp)
