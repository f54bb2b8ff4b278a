# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages that are missing in a recording because of its recorder, not of the node.

A recorder subscribes to one topic after another and loses messages meanwhile: `ros2 bag record`
for about a tenth of a second. Outputs therefore count as missing only once every topic is recorded
and the recorder has settled; an output counts as extra only if its input would have been recorded.
"""

from collections import Counter, deque
from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.fields import Occurrences
from gear_kinematics.validation.report import Finding
from gear_kinematics.wire.batches import once_for_joints
from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[np.int64]
Flags = NDArray[np.bool_]

BEFORE = 'before the recorder settled'
AFTER = 'after the last output'
BACK = 'before the node heard the driver again'
NO_INPUT = 'whose input was not recorded'
LOST = 'that the recorder says that it lost'

_SETTLING_TIME = 1_000_000_000  # ns after which a recorder has settled, or a node hears a driver
_PAUSE, _PERIODS = 500_000_000, 10.0
"""ns, and usual periods, without inputs that a driver needs for a restart."""
_MOST_BACK = 0.1  # of the inputs, that a node can miss so more than once
_QUIET_TIME = 150_000_000  # ns without a loss after which it has settled earlier
_MAX_END = 500_000_000  # ns by which outputs may end before their inputs
HOLE = 1.5  # median periods between inputs; beyond, an input between them was not recorded
_MAX_STAMPS = 32_768  # of inputs, besides those of a batch
_MAX_RESETS = 64  # latest ones, after which an output can come
_APART = 2**40  # ns between the clocks before and after a reset of the stamps
_MAX_DELAY = 10_000_000_000  # ns by which the age of an output may differ from that of inputs
_NEVER = 2**62  # ns


class Missing:
    """The missing outputs of one topic."""

    def __init__(self) -> None:
        self.inputs = Occurrences()  # the stamps of inputs without their output
        self.left_out: Counter[str] = Counter()  # missing outputs that are not judged, by cause
        self.ended_early: float | None = None
        """s from the last input with an output to the last input, if that is too long."""
        self._after = Occurrences()  # inputs after the last one with an output
        self._after_since = 0  # when the first of them was received, ns
        self._missed = Occurrences()  # inputs before the node heard the driver again
        self._restarts = 0  # after which it missed some
        self._judged = 0  # inputs
        self._last_answered: int | None = None  # when it was received, ns

    def update(self, received: Array, stamp: Array, answered: Flags) -> None:
        """Judge inputs, (n,), by whether they have their output."""
        self._judged += len(received)
        end = 0
        if answered.any():
            end = len(answered) - int(np.argmax(answered[::-1]))
            self.judge_after()
            self.inputs.add(stamp[:end][~answered[:end]])
            self._last_answered = int(received[end - 1])
        if not self._after.count and end < len(received):
            self._after_since = int(received[end])
        self._after.add(stamp[end:])

    def judge_after(self, *, back: bool = False) -> None:
        """Judge the inputs after the last output; the driver may just have come `back`."""
        (self._missed if back else self.inputs).add_all(self._after)
        self._restarts += back and self._after.count > 0
        self._after = Occurrences()

    def close(self, last: int, *, strict: bool, lost: int) -> None:
        """Judge the inputs after the last output; the `last` input was received at this time, ns.

        According to the recorder, it `lost` so many messages of the topic.
        """
        late = self._after.count and last - self._after_since > _MAX_END
        if strict or late or self._last_answered is None:
            self.judge_after()
        elif self._after.count:
            self.left_out[AFTER] += self._after.count
        if late and self._last_answered is not None:
            self.ended_early = (last - self._last_answered) * 1e-9
        if self._restarts > 1 and self._missed.count > _MOST_BACK * self._judged:
            self.inputs.add_all(self._missed)
        elif self._missed.count:
            self.left_out[BACK] += self._missed.count
        if not strict and 0 < self.inputs.count <= lost:
            self.left_out[LOST] += self.inputs.count
            self.inputs = Occurrences()


class Completeness:
    """Finds missing outputs on topics with the same inputs, recorded from the same time on."""

    def __init__(self, rotor: str, topics: Mapping[str, Missing], *, strict: bool) -> None:
        """Start with no input; `strict` judges everything, as if the recorder lost nothing."""
        self.topics = topics
        self._rotor = rotor
        self._on_all = Missing()  # inputs without an output on any topic
        self._strict = strict
        self._start = self._settled = -_NEVER if strict else _NEVER
        """When all topics were recorded, and the last loss until the recorder settled, ns."""
        self._last = 0  # when the last input was received, ns
        self._back: int | None = None  # when a driver without an output yet came back, ns
        self._pause = float(_NEVER)  # ns without inputs after which the driver may have restarted

    def update(
        self, received: Array, stamp: Array, answered: Flags, begun: Mapping[str, int]
    ) -> None:
        """Process the next inputs: times of reception in order and stamps, both (n,), ns.

        `answered`, (topics, n), says whether they have their outputs, and `begun` when the
        recording of each topic began, ns.
        """
        periods = np.diff(received, prepend=self._last or received[:1])
        if self._pause == _NEVER and len(periods) > _PERIODS and not self._strict:
            self._pause = max(_PAUSE, _PERIODS * float(np.median(periods)))
        names = {self._rotor, *self.topics}
        if self._start == _NEVER and begun.keys() >= names:
            self._start = self._settled = max(begun[name] for name in names)
        restarts = np.flatnonzero(periods > self._pause).tolist()
        for first, end in pairwise([0, *restarts, len(received)]):
            if first < end:
                given = received[first:end], stamp[first:end], answered[:, first:end]
                self._update(*given, back=first in restarts)

    def _update(self, received: Array, stamp: Array, answered: Flags, *, back: bool) -> None:
        self._last = int(received[-1])
        self._settle(received[~answered.all(axis=0)])
        on_any = np.asarray(answered.any(axis=0))
        rows = [*zip(self.topics.values(), answered, strict=True), (self._on_all, on_any)]
        judged = heard = int(np.count_nonzero(received <= self._settled))
        if back:
            self._back = int(received[0])
            for missing, _ in rows:
                missing.judge_after()
        soon = False
        if self._back is not None and on_any[judged:].any():
            heard += int(np.argmax(on_any[judged:]))
            soon = int(received[heard]) - self._back <= _SETTLING_TIME
            self._back = None
        for missing, has_output in rows:
            missing.left_out[BEFORE] += int(np.count_nonzero(~has_output[:judged]))
            if soon:
                before = slice(judged, heard)
                missing.update(received[before], stamp[before], has_output[before])
                missing.judge_after(back=True)
            rest = slice(heard if soon else judged, None)
            missing.update(received[rest], stamp[rest], has_output[rest])

    def _settle(self, losses: Array) -> None:
        """Add further losses to the uninterrupted series of losses at the start."""
        first = losses[(losses >= self._start) & (losses <= self._start + _SETTLING_TIME)]
        pauses = np.flatnonzero(np.diff(first, prepend=self._settled) > _QUIET_TIME)
        series = first[: pauses[0]] if len(pauses) else first
        self._settled = int(series[-1]) if len(series) else self._settled

    def close(self, lost: Mapping[str, int]) -> None:
        """Judge the inputs after the last outputs; skip what the recorder lost, by topic."""
        counts = [lost.get(name, 0) for name in self.topics]
        for missing, count in zip(
            (*self.topics.values(), self._on_all), (*counts, max(counts)), strict=True
        ):
            missing.close(self._last, strict=self._strict, lost=count)

    def causes(self) -> Iterator[Finding]:
        """Yield why messages may be missing."""
        missing = {name: topic.inputs.count for name, topic in self.topics.items()}
        lost = {name: count for name, count in missing.items() if count}
        complete = [name for name, count in missing.items() if not count]
        on_all, early = self._on_all.inputs.count, False
        for name, topic in self.topics.items():
            if topic.ended_early is not None and not self._strict:
                early = True
                values = {'output': name, 'seconds': topic.ended_early, 'topic': self._rotor}
                yield Finding(FindingCause.ENDED_EARLY, values=values, explains=True)
        if len(missing) > 1 and lost and not early and set(missing.values()) == {on_all}:
            values = {'topic': self._rotor}
            yield Finding(FindingCause.NO_OUTPUT, count=on_all, values=values, explains=True)
        elif lost and complete:
            values = {'lost': lost, 'complete': complete}
            yield Finding(FindingCause.LOST_ON_THE_WAY, values=values, explains=True)


class RecordedInputs:
    """Keeps the latest stamps of recorded inputs, to find inputs that were not recorded.

    Each reset of a driver's stamps, as by a bag that is played in a loop, begins another clock.
    The age of an output, compared with those of inputs, shows which clock its stamp is from. Ages
    change with time where the clock is that of a simulation.
    """

    def __init__(self, *, strict: bool) -> None:
        """Start with none; `strict` assumes that every input was recorded."""
        self._strict = strict
        self._shifts: tuple[int, ...] = ()
        """Moves the stamps of each clock behind those of the earlier ones, ns."""
        self._known = deque[Array]()  # latest moved stamps and ages, (2, n), ns
        self._count = 0  # of these
        self._last: int | None = None

    def update(self, received: Array, stamp: Array, rejected: Array) -> None:
        """Add inputs (n,), ns, and the stamps of rejected ones, (m,)."""
        if len(stamp):
            last, self._last = self._last, int(stamp[-1])
            known, self._shifts = _moved(received, stamp, last, self._shifts)
            self._keep(known)
        if self._known and len(rejected):
            _, age = self._known[-1][:, -1]
            self._keep(np.stack([rejected + self._shifts[-1], np.full_like(rejected, age)]))

    def lack(self, received: Array, stamp: Array) -> Flags:
        """Return whether the inputs of outputs with stamps (n,), ns, were not recorded."""
        if self._strict or not len(stamp):
            return np.zeros(len(stamp), bool)
        if not self._known:
            return np.ones(len(stamp), bool)
        known, ages = np.concatenate(self._known, axis=1)
        known, rows = np.unique(known, return_index=True)
        period = float(np.median(np.diff(known))) if len(known) > 1 else 0.0
        bounds = np.concatenate([[-_NEVER], known, [_NEVER]])
        on_clocks = stamp + np.array(self._shifts[-_MAX_RESETS:])[:, np.newaxis]
        after = np.searchsorted(known, on_clocks)
        hole = bounds[after + 1] - bounds[after]
        later_is_near = 2 * (bounds[after + 1] - on_clocks) < hole
        age = ages[rows[np.clip(after - ~later_is_near, 0, len(known) - 1)]]
        distance = np.abs(received - stamp - age)
        missing = (hole > HOLE * period) & (bounds[after + 1] != on_clocks)
        clock = np.argmin(distance, axis=0), np.arange(len(stamp))
        return np.asarray(missing[clock] & (distance[clock] < _MAX_DELAY))

    def _keep(self, known: Array) -> None:
        self._known.append(known)
        self._count += known.shape[1]
        while self._count - self._known[0].shape[1] >= _MAX_STAMPS:
            self._count -= self._known.popleft().shape[1]


@once_for_joints
def _moved(
    received: Array, stamp: Array, last: int | None, shifts: tuple[int, ...]
) -> tuple[Array, tuple[int, ...]]:
    """Return the moved stamps of inputs and their ages, (2, n), and the shifts of all clocks."""
    before = int(stamp[0]) + 2 * CLOCK_RESET if last is None else last
    begins = np.diff(stamp, prepend=before) < -CLOCK_RESET
    clock, age = len(shifts) + np.cumsum(begins) - 1, received - stamp
    shifts += tuple((age + _APART * clock)[begins].tolist())
    return np.stack([stamp + np.array(shifts)[clock], age]), shifts
