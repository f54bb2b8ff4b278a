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
_SILENCE = 2.5  # median periods between inputs; beyond, the recorder lost all topics
_MAX_STAMPS = 32_768  # of inputs, since a reset
_MAX_PASSES = 64  # between resets
_MAX_DELAY = 1_000_000_000  # ns by which the delay of an output may differ from that of inputs
_ALWAYS = -(2**62)  # ns


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
        self._unjudged = Occurrences()
        self._last_answered: int | None = None  # received, ns
        self._tail = Occurrences()
        self._tail_received: int | None = None  # ns, of its first

    def update(self, received: Array, stamp: Array, answered: Flags, cause: str = '') -> None:
        """Process the next inputs.

        Args:
            received: (n,), ns.
            stamp: (n,), ns.
            answered: (n,): whether they have an output on this topic.
            cause: reason not to judge them, or an empty text.
        """
        with_output = np.flatnonzero(answered)
        if cause:
            self.left_out[cause] += len(answered) - len(with_output)
            self._unjudged.add(stamp[~answered])
        else:
            end = int(with_output[-1]) + 1 if len(with_output) else 0
            if end:  # those after the last output are missing only if another one follows
                self._count_tail()
            self.inputs.add(stamp[:end][~answered[:end]])
            if not self._tail.count and end < len(stamp):
                self._tail_received = int(received[end])
            self._tail.add(stamp[end:])
        if len(with_output):
            self._last_answered = int(received[with_output[-1]])

    def close(self, last_received: int | None, *, strict: bool) -> None:
        """Judge the inputs after the last output.

        Args:
            last_received: time of reception of the last input, ns.
            strict: whether all their outputs count as missing.
        """
        if self._last_answered is None or last_received is None:
            self._count_tail()
            self.inputs.add_all(self._unjudged)
            self.left_out.clear()
            return
        late = self._tail_received is not None and last_received - self._tail_received > _MAX_END
        if late:
            self.ended_early = (last_received - self._last_answered) * 1e-9
        if late or strict:
            self._count_tail()
        else:
            self.left_out[AFTER] += self._tail.count

    def _count_tail(self) -> None:
        self.inputs.add_all(self._tail)
        self._tail, self._tail_received = Occurrences(), None


class Completeness:
    """Finds missing outputs on topics with the same inputs, recorded from the same time on."""

    def __init__(self, rotor: str, topics: Sequence[str], *, strict: bool) -> None:
        """Start with no input.

        Args:
            rotor: name of the rotor's topic.
            topics: names of the output topics.
            strict: whether to judge everything, as if the recorder lost nothing.
        """
        self.topics = {topic: Missing() for topic in topics}
        self._rotor = rotor
        self._unanswered = Missing()  # inputs without an output on any topic
        self._strict = strict
        self._start = _ALWAYS if strict else None
        self._first: list[Inputs] = []  # until the recorder has certainly settled
        self._last_received: int | None = None

    def begin(self, begun: Mapping[str, int]) -> None:
        """Take the times from which topics are recorded, ns, by their names."""
        names = self._rotor, *self.topics
        if self._start is None and begun.keys() >= set(names):
            self._start = max(begun[name] for name in names)

    def update(self, inputs: Inputs) -> None:
        """Process the next inputs."""
        received = inputs.received
        if not len(received):
            return
        self._last_received = int(received[-1])
        if self._start is None:
            self._take(inputs, cause=BEFORE)
            return
        before, settled = received < self._start, received > self._start + _SETTLING_TIME
        self._take(inputs.where(before), cause=BEFORE)
        self._first.append(inputs.where(~(before | settled)))
        if settled.any():
            self._settle()
            self._take(inputs.where(settled))

    def close(self) -> None:
        """Judge the inputs that are still waiting, after the last input."""
        self._settle()
        for topic in self.topics.values():
            topic.close(self._last_received, strict=self._strict)

    def causes(self) -> Iterator[Finding]:
        """Yield why messages may be missing."""
        for name, topic in self.topics.items():
            if topic.ended_early is not None:
                yield Finding(
                    f'{name} ends {topic.ended_early:.3f} s before {self._rotor}: '
                    'the node may have ended',
                    cause=True,
                    missing=True,
                )
        missing = {name: topic.inputs.count for name, topic in self.topics.items()}
        lost = [
            f'{counted(count, "message")} of {name}' for name, count in missing.items() if count
        ]
        complete = [name for name, count in missing.items() if not count]
        if len(missing) == 1 or not lost:
            return
        unanswered = self._unanswered.inputs.count
        if set(missing.values()) == {unanswered}:
            yield Finding(
                f'{counted(unanswered, "message")} of {self._rotor} without any output: '
                'the node did not receive them, or was blocked',
                cause=True,
                missing=True,
            )
        elif complete and not unanswered:
            yield Finding(
                f'{", ".join(lost)} missing, but none of {", ".join(complete)}: the node had the '
                'inputs, and the messages were lost on their way to the recording',
                cause=True,
                missing=True,
            )

    def _take(self, inputs: Inputs, cause: str = '') -> None:
        if not cause:
            self._unanswered.update(
                inputs.received, inputs.stamp, np.asarray(inputs.answered.any(axis=1))
            )
        for topic, answered in zip(self.topics.values(), inputs.answered.T, strict=True):
            topic.update(inputs.received, inputs.stamp, answered, cause)

    def _settle(self) -> None:
        """Find the time at which the recorder had settled, and judge the waiting inputs."""
        if not self._first:
            return
        inputs = Inputs(*map(np.concatenate, zip(*self._first, strict=True)))
        self._first.clear()
        settled = inputs.received > _settled(inputs)
        self._take(inputs.where(~settled), cause=SETTLING)
        self._take(inputs.where(settled))


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

    A driver whose stamps are reset, as a bag that is played again and again, begins anew: what was
    recorded before tells nothing of what was recorded of the same stamps after.
    """

    def __init__(self, *, strict: bool) -> None:
        """Start with none.

        Args:
            strict: whether to assume that every input was recorded.
        """
        self._strict = strict
        self._passes = [_Pass()]

    def update(self, received: Array, stamp: Array, rejected: Array) -> None:
        """Add inputs (n,), ns, and the stamps of rejected ones, (m,)."""
        before = self._passes[-1].last[1] if len(self._passes[-1].last) else stamp[:1]
        resets = np.flatnonzero(np.diff(stamp, prepend=before) < -CLOCK_RESET)
        for number, rows in enumerate(np.split(np.arange(len(stamp)), resets)):
            if number:
                self._passes.append(_Pass())
            self._passes[-1].add(received[rows], stamp[rows], rejected)
        del self._passes[:-_MAX_PASSES]

    def lack(self, received: Array, stamp: Array) -> Flags:
        """Whether the inputs of outputs (n,), ns, were not recorded."""
        lacking = np.zeros(len(stamp), bool)
        if self._strict or not len(stamp):
            return lacking
        nearest = np.argmin([one.distance(received, stamp) for one in self._passes], axis=0)
        for number in np.unique(nearest):
            rows = nearest == number
            lacking[rows] = self._passes[number].lack(received[rows], stamp[rows])
        return lacking


class _Pass:
    """The latest inputs since a reset of their stamps."""

    def __init__(self) -> None:
        self._stamps = np.zeros(0, np.int64)
        self._complete = True
        self._first = self.last = np.zeros(0, np.int64)
        """Time of reception and stamp, ns; empty without a valid input."""

    def add(self, received: Array, stamp: Array, rejected: Array) -> None:
        """Add inputs (n,), ns, and the stamps of rejected ones, (m,)."""
        if len(stamp):
            self.last = np.array([received[-1], stamp[-1]])
            if not len(self._first):
                self._first = np.array([received[0], stamp[0]])
        stamps = np.concatenate([self._stamps, stamp, rejected])
        self._complete = self._complete and len(stamps) <= _MAX_STAMPS
        self._stamps = stamps[-_MAX_STAMPS:]

    def distance(self, received: Array, stamp: Array) -> Array:
        """How far outputs (n,), ns, are from this pass in their delay and time of reception."""
        if not len(self._first):
            return np.zeros(len(stamp), np.int64)
        least, greatest = sorted((self._age(self._first), self._age(self.last)))
        age = received - stamp
        times = np.clip(received, self._first[0], self.last[0])
        return np.asarray(np.abs(age - np.clip(age, least, greatest)) + np.abs(received - times))

    def lack(self, received: Array, stamp: Array) -> Flags:
        """Whether the inputs of outputs (n,), ns, were not recorded."""
        if not len(self._first):
            return np.ones(len(stamp), bool)
        known = np.unique(self._stamps)
        after = np.searchsorted(known, stamp)
        bounds = np.concatenate([[known[0]], known, [known[-1]]])
        period = np.diff(known)
        longest = HOLE * float(np.median(period)) if len(period) else np.inf
        in_hole = (bounds[after + 1] - bounds[after] > longest) & (bounds[after + 1] != stamp)
        age = received - stamp
        too_early = (after == 0) & self._complete & (stamp < known[0])
        too_late = after == len(known)
        return np.asarray(
            in_hole
            | (too_early & (np.abs(age - self._age(self._first)) < _MAX_DELAY))
            | (too_late & (np.abs(age - self._age(self.last)) < _MAX_DELAY))
        )

    @staticmethod
    def _age(moment: Array) -> int:
        return int(moment[0] - moment[1])
