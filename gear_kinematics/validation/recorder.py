# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages that are missing in a recording because of its recorder, not of the node.

A recorder subscribes to one topic after another and loses messages meanwhile: `ros2 bag record`
for about a tenth of a second. Outputs therefore count as missing only once every topic is recorded
and the recorder has settled; an output counts as extra only if its input would have been recorded.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.report.document import counted
from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.report import Finding
from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[np.int64]
Flags = NDArray[np.bool_]

BEFORE = 'before every topic was recorded'
SETTLING = 'while the recorder settled'
AFTER = 'after the last output'
NO_INPUT = 'whose input was not recorded'

_SETTLING_TIME = 1_000_000_000  # ns after which a recorder has settled
_QUIET_TIME = 150_000_000  # ns without a loss after which it has settled earlier
_MAX_END = 500_000_000  # ns by which outputs may end before their inputs
HOLE = 1.5
"""Median periods between inputs; beyond, an input between them was not recorded."""
_SILENCE = 2.5
"""Median periods between inputs; beyond, the recorder lost all topics. It excuses losses, and must
therefore be more than the jitter of a driver."""
_MAX_STAMPS = 32_768  # of inputs
_MAX_RESETS = 64  # of the stamps
_MAX_DELAY = 1_000_000_000  # ns by which the delay of an output may differ from that of inputs
_ALWAYS = -(2**62)  # ns
_APART = 2**40  # ns between the clocks before and after a reset of the stamps


class Inputs(NamedTuple):
    """Inputs in the order of their reception."""

    received: Array
    """(n,), ns."""
    stamp: Array
    """(n,), ns."""
    answered: Flags
    """(n, topics): whether the input has its output."""

    def where(self, chosen: Flags) -> 'Inputs':
        """Select some of them."""
        return Inputs(self.received[chosen], self.stamp[chosen], self.answered[chosen])


class Missing:
    """The missing outputs of one topic."""

    def __init__(self) -> None:
        self.inputs = Occurrences()
        """The stamps of inputs without their output."""
        self.left_out: Counter[str] = Counter()
        """Numbers of missing outputs that are not judged, by cause."""
        self.ended_early: float | None = None
        """s from the last input with an output to the last input, if that is too long."""
        self.last_answered: int | None = None
        """When the last input with an output was received, ns."""
        self._is_open = False  # whether the last judged input has no output

    def update(self, received: Array, stamp: Array, answered: Flags, cause: str = '') -> None:
        """Process inputs, (n,), by whether they are answered; a cause leaves them unjudged."""
        if cause:
            self.left_out[cause] += int(np.count_nonzero(~answered))
        else:
            self.inputs.add(stamp[~answered])
            if len(answered):
                self._is_open = not answered[-1]
        if answered.any():
            self.last_answered = int(received[answered][-1])

    def close(self, received: Array, stamp: Array, answered: Flags, *, strict: bool) -> None:
        """Process the last inputs, of which those after the last output count if `strict`."""
        late = self._is_open and not answered.any()
        end = len(answered) if late or strict else len(np.trim_zeros(answered, 'b'))
        self.update(received[:end], stamp[:end], answered[:end])
        self.update(received[end:], stamp[end:], answered[end:], AFTER)
        if self.last_answered is None:
            self.inputs.count += self.left_out.total()
            self.left_out.clear()
        elif late:
            self.ended_early = (int(received[-1]) - self.last_answered) * 1e-9


class Completeness:
    """Finds missing outputs on topics with the same inputs, recorded from the same time on."""

    def __init__(self, rotor: str, topics: Sequence[str], *, strict: bool) -> None:
        """Start with no input; `strict` judges everything, as if the recorder lost nothing."""
        self.topics = {topic: Missing() for topic in topics}
        self._rotor = rotor
        self._unanswered = Missing()  # inputs without an output on any topic
        self._strict = strict
        self._start = self._settled = _ALWAYS if strict else None
        self._waiting: list[Inputs] = []

    def update(self, inputs: Inputs, begun: Mapping[str, int]) -> None:
        """Process the next inputs; the latest ones wait, as the outputs may end there.

        `begun` has the times from which topics are recorded, ns, by their names.
        """
        if not len(inputs.received):
            return
        names = self._rotor, *self.topics
        if self._start is None and begun.keys() >= set(names):
            self._start = max(begun[name] for name in names)
        start = np.inf if self._start is None else self._start
        before, last = inputs.received < start, inputs.received[-1]
        self._take(inputs.where(before), BEFORE)
        self._waiting.append(inputs.where(~before))
        if last > start + _SETTLING_TIME:
            inputs = self._settle()
            due = inputs.received < last - _MAX_END
            self._take(inputs.where(due))
            self._waiting = [inputs.where(~due)]

    def close(self) -> None:
        """Judge the inputs that are still waiting, after the last input."""
        if not self._waiting:
            return
        received, stamp, answered = self._settle()
        due = received < received[-1:] - _MAX_END
        self._take(Inputs(received, stamp, answered).where(due))
        for topic, own in self._columns(answered[~due]):
            strict = self._strict and topic is not self._unanswered
            topic.close(received[~due], stamp[~due], own, strict=strict)

    def causes(self) -> Iterator[Finding]:
        """Yield why messages may be missing."""
        texts = [
            f'{name} ends {topic.ended_early:.3f} s before {self._rotor}: the node may have ended'
            for name, topic in self.topics.items()
            if topic.ended_early is not None
        ]
        missing = {name: topic.inputs.count for name, topic in self.topics.items()}
        lost = [
            f'{counted(count, "message")} of {name}' for name, count in missing.items() if count
        ]
        complete = [name for name, count in missing.items() if not count]
        unanswered = self._unanswered.inputs.count if self._unanswered.last_answered else 0
        if len(missing) > 1 and lost and not texts and set(missing.values()) == {unanswered}:
            texts.append(
                f'{counted(unanswered, "message")} of {self._rotor} without any output: '
                'the node did not receive them, or was blocked'
            )
        elif lost and complete and not unanswered:
            texts.append(
                f'{", ".join(lost)} missing, but none of {", ".join(complete)}: the node had the '
                'inputs, and the messages were lost on their way to the recording'
            )
        yield from (Finding(text, cause=True, missing=True) for text in texts)

    def _columns(self, answered: Flags) -> Iterator[tuple[Missing, Flags]]:
        """Pair all that is counted with whether inputs have their output."""
        yield from zip(self.topics.values(), answered.T, strict=True)
        yield self._unanswered, np.asarray(answered.any(axis=1))

    def _take(self, inputs: Inputs, cause: str = '') -> None:
        for topic, answered in self._columns(inputs.answered):
            topic.update(inputs.received, inputs.stamp, answered, cause)

    def _settle(self) -> Inputs:
        """Return the waiting inputs that were received after the recorder had settled."""
        inputs = Inputs(*map(np.concatenate, zip(*self._waiting, strict=True)))
        if self._settled is None:
            start = _ALWAYS if self._start is None else self._start
            first = inputs.received <= start + _SETTLING_TIME
            self._settled = _settled(inputs.where(first))
        settled = inputs.received > self._settled
        self._take(inputs.where(~settled), SETTLING)
        return inputs.where(settled)


def _settled(inputs: Inputs) -> int:
    """Time of the last loss in an uninterrupted series from the first input on, ns."""
    received, stamp, answered = inputs
    if len(received) < 2:  # noqa: PLR2004, for a period
        return _ALWAYS
    incomplete = received[~answered.all(axis=1)]
    period = np.diff(stamp)
    silent = np.flatnonzero(period > _SILENCE * np.median(period))
    losses = [(moment, moment) for moment in incomplete.tolist()]
    losses += zip(received[silent].tolist(), received[silent + 1].tolist(), strict=True)
    settled, last = _ALWAYS, int(received[0])
    for begin, end in sorted(losses):
        if begin - last > _QUIET_TIME:
            break
        settled = last = max(last, end)
    return settled


class RecordedInputs:
    """The latest stamps of recorded inputs, to find inputs that were not recorded.

    Where a driver's stamps are reset, as by a bag that is played again and again, the clock of the
    stamps is another one; which one an output has is seen by its age.
    """

    def __init__(self, *, strict: bool) -> None:
        """Start with none; `strict` assumes that every input was recorded."""
        self._strict = strict
        self._ages: list[list[int]] = []
        """Time of reception - stamp of the first and the last input since each reset, ns."""
        self._clock: list[int] = []
        """What is added to the stamps since each reset, ns, so that those of two never mix."""
        self._known = np.zeros(0, np.int64)
        """The latest stamps on that clock."""
        self._complete = True
        self._last = np.zeros(0, np.int64)

    def update(self, received: Array, stamp: Array, rejected: Array) -> None:
        """Add inputs (n,), ns, and the stamps of rejected ones, (m,)."""
        before = self._last if len(self._last) else stamp[:1]
        resets = np.diff(stamp, prepend=before) < -CLOCK_RESET
        self._last = np.append(self._last, stamp)[-1:]
        ages = received - stamp
        added = [self._known]
        for rows in np.split(np.arange(len(stamp)), np.flatnonzero(resets)):
            if len(rows):
                first, last = ages[rows[[0, -1]]].tolist()
                if not self._ages or resets[rows[0]]:
                    self._ages.append([first, last])
                    moved = self._clock[-1] - self._ages[-2][0] if self._clock else 0
                    self._clock.append(first + moved + _APART)
                self._ages[-1][1] = last
            if self._ages:
                added += [stamp[rows] + self._clock[-1], rejected + self._clock[-1]]
        known = np.concatenate(added)
        self._complete = self._complete and len(known) <= _MAX_STAMPS
        self._known = known[-_MAX_STAMPS:]
        del self._ages[:-_MAX_RESETS], self._clock[:-_MAX_RESETS]

    def lack(self, received: Array, stamp: Array) -> Flags:
        """Whether the inputs of outputs (n,), ns, were not recorded."""
        if self._strict or not len(stamp):
            return np.zeros(len(stamp), bool)
        if not self._ages:
            return np.ones(len(stamp), bool)
        age, ages = received - stamp, np.array(self._ages)
        low, high = ages.min(axis=1)[:, None], ages.max(axis=1)[:, None]
        distance = np.abs(age - np.clip(age, low, high))
        stamp = stamp + np.array(self._clock)[np.argmin(distance, axis=0)]
        known = np.unique(self._known)
        after = np.searchsorted(known, stamp)
        bounds = np.concatenate([[known[0]], known, [known[-1]]])
        period = np.diff(known)
        longest = HOLE * float(np.median(period)) if len(period) else np.inf
        gap = bounds[after + 1] - bounds[after]
        in_hole = (gap > longest) & (bounds[after + 1] != stamp)
        in_hole &= (gap < _APART // 2) | (distance.min(axis=0) < _MAX_DELAY)
        too_early = (after == 0) & self._complete & (stamp < known[0])
        too_late = after == len(known)
        return np.asarray(
            in_hole
            | (too_early & (np.abs(age - ages[0, 0]) < _MAX_DELAY))
            | (too_late & (np.abs(age - ages[-1, 1]) < _MAX_DELAY))
        )
