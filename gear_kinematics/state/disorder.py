# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds what is wrong with the order of readings: set-back clocks, late ones, two in turn."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from gear_kinematics.state.reach import FLOOR
from gear_kinematics.state.rotor_samples import RotorSamples
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.wire.batches import Array, once_for_joints
from gear_kinematics.wire.cdr import SECOND

_CLOCK_STEP = 20_000_000  # ns: clocks are slewed by less, and messages are late by less
_CLOSE = 25  # messages, in which a bag that is looped begins at most once
ALTERNATING = 3  # resets of the clock so close to each other: as many are no chance
FASTEST = 100.0  # times the clock: faster than any playback
_FEWEST, _LEAST = 10, 100_000_000  # stamps, and ns, that tell their pace; no burst takes as long
_EVEN = 1.5  # times the usual one: time until a reading that directly follows

_ROUNDING = 1e-9  # rad
_FEWEST_TURNABOUTS, _AMONG = 20, 100
"""More turnabouts than these within so many readings show two motions."""

Late = tuple[int, float, float | None, float | None]  # ns, rad, rad/s, N·m or other units


@dataclass
class Alternation:
    """Finds two motions in turn, as of two drivers: each goes on, and the other is far away."""

    _former: float = math.nan  # the last two doubted readings, rad
    _latest: float = math.nan
    _doubted: int = 0
    _going_on: int = 0  # doubted readings that are near one of the two before
    _seen: bool = field(default=False, repr=False)  # among believed ones, of batches only
    taken_back: int = 0  # believed readings that the next ones showed to be wrong
    _last: tuple[float, int] = 0.0, 0  # of them: by how much it was, rad, and its stamp, ns

    def doubt(self, position: float, last: float, wrapped: Callable[[float], float]) -> None:
        """Note a doubted reading and the one before it; `wrapped` takes turns from differences."""
        near, nearer, away = (
            abs(wrapped(position - other)) for other in (self._former, self._latest, last)
        )
        self._doubted += 1
        self._going_on += 4.0 * near < away or 4.0 * nearer < away
        self._former, self._latest = self._latest, position

    def take_back(self, angle: float, stamp: int) -> None:
        """Note a believed reading with a stamp, ns, that was wrong by about an angle, rad."""
        self.taken_back += 1
        self._last = angle, stamp

    def wrong(self, count: int) -> Fact | None:
        """Return that so many believed readings, up to the last one, were wrong; None for 0."""
        angle, stamp = self._last
        found = Condition.TAKEN_BACK(count=count, angle=angle, time=stamp / SECOND)
        return found if count else None

    def note(self, stamps: Array, positions: Array, acceleration: float) -> None:
        """Note believed readings (n,), ns and rad, with the limit of the rotor, rad/s²."""
        steps = np.diff(positions)
        if np.count_nonzero(steps[1:] * steps[:-1] < 0.0) <= _FEWEST_TURNABOUTS:
            return
        out, back = np.minimum(abs(steps[1:]), abs(steps[:-1])), steps[1:] + steps[:-1]
        time = (stamps[2:] - stamps[:-2]) / (2.0 * SECOND)
        # A rotor can turn about within a quarter of the last angle, and an encoder by a few steps.
        step = np.min(abs(back), initial=math.inf, where=abs(back) > _ROUNDING)
        far = out > np.maximum(max(3.5 * step, 3.0 * FLOOR), 2.0 * acceleration * time * time)
        far &= time > 0.0  # repeated stamps show no time
        rows = np.flatnonzero(far & (4.0 * abs(back) < out))
        if (rows[_FEWEST_TURNABOUTS:] - rows[:-_FEWEST_TURNABOUTS] < _AMONG).any():
            self._seen = True

    @property
    def fact(self) -> Fact | None:
        """That there are two motions in turn; None if none is seen."""
        rejected = self._going_on > max(_FEWEST_TURNABOUTS, 0.5 * self._doubted)
        return Condition.TWO_MOTIONS() if self._seen or rejected else None


class Disorder:
    """Collects the readings that are older than the last sample, the first of each stamp."""

    def __init__(self, alternation: Alternation) -> None:
        """Take what finds two motions in turn."""
        self._alternation = alternation
        self.readings: list[Late] = []
        self.close_resets = 0  # resets of the clock that directly follow another one
        self._reset = -_CLOSE  # number of the message of the last one
        self.step: Fact | None = None  # the clock's last step back
        self._too_fast: Fact | None = None

    @property
    def fault(self) -> Fact | None:
        """Two motions, stamps of two clocks, or of another unit, wrong readings, or a set clock.

        The unit is known of batches only.
        """
        if two := self._alternation.fact:
            return two
        if self.close_resets < ALTERNATING:
            wrong = self._alternation.wrong(self._alternation.taken_back)
            return self._too_fast or wrong or self.step
        return Condition.CLOCKS_ALTERNATE(count=self.close_resets)

    def add(self, reading: Late) -> None:
        """Note a reading that is older than the last sample."""
        if not self.readings or reading[0] != self.readings[-1][0]:
            self.readings.append(reading)

    def compare(self, samples: RotorSamples, acceleration: float) -> None:
        """Look for stamps that rise faster than times of reception, bursts apart, and turnabouts.

        The limit of the rotor's acceleration is in rad/s².
        """
        stamps, received = samples.stamp, samples.received
        self._alternation.note(stamps, samples.rotor_angle, acceleration)
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


def sums_between(
    values: Array, given: Array, rows: Array, carried: float
) -> tuple[list[float], list[int]]:
    """Return the sums of values before the first row, between rows, and behind, and their counts.

    Values, (n,), are added one by one in their order, the first ones to what is carried. Only
    those `given`, (n,), are counted. Without values, the first sum is what is carried.
    """
    starts, ends = np.append(0, rows + 1), np.append(rows, len(values))
    sizes, sums = ends - starts, np.zeros(len(starts))
    values[:1] += carried
    for size in np.unique(sizes[sizes > 0]).tolist():
        alike = np.flatnonzero(sizes == size)
        places = starts[alike, np.newaxis] + np.arange(size)
        sums[alike] = values[places].cumsum(axis=1)[:, -1] + 0.0  # none is -0.0, as from 0 on
    if not sizes[0]:
        sums[0] = carried
    counts = np.append(0, given.cumsum())
    return sums.tolist(), (counts[ends] - counts[starts]).tolist()
