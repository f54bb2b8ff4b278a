"""Matches published messages with their input samples by header stamp.

A node publishes in the order of its inputs, so nearly all messages match in long runs; a single
message is looked up only where a run ends. Memory is bounded by a window of samples.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear, MotionState
from gear_kinematics.report.document import counted
from gear_kinematics.validation.fields import FieldErrors, SeriesRecorder
from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.recorder import NO_INPUT, Missing, RecordedInputs
from gear_kinematics.validation.report import Finding, Lane, TopicReport
from gear_kinematics.validation.task import Tolerances
from gear_kinematics.validation.unseen_turns import UnseenTurns
from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[Any]
Solver = Callable[..., MotionState]

WINDOW = 16_384
"""Samples kept for late messages; even later ones count as extra."""
MALFORMED = 'malformed'
"""The fault of messages that cannot be decoded, and have no stamp."""

SAMPLES = [
    ('stamp', np.int64),
    ('received', np.int64),
    ('turns', np.float64),
    ('angle', np.float64),
    ('velocity', np.float64),
    ('effort', np.float64),
    ('segment', np.int64),
]
"""Columns of the samples with which outputs are compared; see `RotorSamples`."""


class Expectation(NamedTuple):
    """How the outputs are recomputed and judged."""

    gear: Gear
    tolerances: Tolerances
    solver: Solver
    """Recomputes the motion of a mechanism."""
    unseen: UnseenTurns | None
    """Unseen turns, if the rotor has a single-turn encoder."""


class Matcher:
    """Matches the messages of one topic and counts those without a match."""

    def __init__(self) -> None:
        self.messages = 0
        self.compared = 0
        self.extra = Occurrences()
        self.duplicates = 0
        self.out_of_order = Occurrences()
        self.matched = np.zeros(0, bool)
        """Whether each sample of the window has its message."""
        self._next = 0
        self._last_stamp: int | None = None

    def extend(self, count: int) -> None:
        """Add new samples of the window, without messages yet."""
        self.matched = np.concatenate([self.matched, np.zeros(count, bool)])

    def see(self, stamps: Array) -> None:
        """Count new messages by their stamps, ns, and those out of order."""
        self.messages += len(stamps)
        if not len(stamps):
            return
        before = stamps[0] - 1 if self._last_stamp is None else self._last_stamp
        steps = np.diff(stamps, prepend=before)
        self.duplicates += int(np.count_nonzero(steps == 0))
        self.out_of_order.add(stamps[(steps < 0) & (steps >= -CLOCK_RESET)])
        self._last_stamp = int(stamps[-1])

    def match(self, stamps: Array, received: Array, window: Array) -> Array:
        """Find the sample of each message, as its index in the window or -1, and mark it.

        Args:
            stamps: of messages, (n,), ns.
            received: when they were received, (n,), ns.
            window: the samples, with the columns of `SAMPLES`.
        """
        index = np.full(len(stamps), -1, np.intp)
        k = 0
        while k < len(stamps):
            length = self._run(stamps[k:], received[k:], window)
            index[k : k + length] = np.arange(self._next, self._next + length)
            self.matched[self._next : self._next + length] = True
            self._next += length
            k += length
            if k < len(stamps):
                index[k] = self._look_up(stamps[k], received[k], window)
                k += 1
        self.compared += int(np.count_nonzero(index >= 0))
        return index

    def drop(self, count: int) -> None:
        """Drop the oldest samples of the window."""
        self.matched = self.matched[count:]
        self._next = max(self._next - count, 0)

    def _run(self, stamps: Array, received: Array, window: Array) -> int:
        """Number of messages that match the next samples in order."""
        longest = min(len(stamps), len(window) - self._next)
        part = slice(self._next, self._next + longest)
        alike = _alike(stamps[:longest], received[:longest], window[part]) & ~self.matched[part]
        return longest if alike.all() else int(np.argmin(alike))

    def _look_up(self, stamp: int, received: int, window: Array) -> int:
        found = np.flatnonzero(_alike(stamp, received, window) & ~self.matched)
        if not len(found):
            return -1
        # If a stamp occurs again after a restart, take the next sample that has it.
        ahead = found[found >= self._next]
        index = int(ahead[0] if len(ahead) else found[-1])
        self.matched[index] = True
        self._next = max(self._next, index + 1)
        return index


def _alike(stamp: Array | int, received: Array | int, window: Array) -> Array:
    """Whether messages can be those of samples: not of the same stamps after a later restart."""
    return np.asarray((stamp == window['stamp']) & (window['received'] - CLOCK_RESET <= received))


class Faults:
    """Counts messages by their fault, and keeps the first of each."""

    def __init__(self) -> None:
        self._found: dict[str, tuple[int, int]] = {}  # number, first stamp

    def add(self, fault: str, stamps: Array) -> None:
        """Add the stamps of messages with a fault, or for `MALFORMED` when they were received."""
        if len(stamps):
            count, first = self._found.get(fault, (0, int(stamps[0])))
            self._found[fault] = count + len(stamps), first

    def findings(self) -> Iterator[Finding]:
        """Describe each fault."""
        for fault, (count, first) in self._found.items():
            stamp = None if fault == MALFORMED else first
            received = f', the first received at {first}' if stamp is None else ''
            text = f'{fault}: {counted(count, "message")}{received}'
            yield Finding(text, stamp=stamp, when='the first at')


class OutputTopic:
    """One output topic: matches its messages, keeps late ones for a batch, collects faults."""

    missing: Missing
    """Its missing messages, which the `Completeness` of the topics finds."""

    def __init__(self, name: str, expectation: Expectation, *errors: FieldErrors) -> None:
        """Start without messages.

        Args:
            name: of the topic in the recording.
            expectation: of the outputs.
            errors: of the fields.
        """
        self.name = name
        self.errors = errors
        self.series = SeriesRecorder(errors)
        self.matcher = Matcher()
        self.compared: dict[str, Array] = {}
        """Columns of the last compared batch, for the checks."""
        self._gear, self._tolerances, self._solver, self._unseen = expectation
        self._unrecorded = 0  # messages whose input was not recorded
        self._faults = Faults()
        self._late: tuple[list[bytes], list[int]] = [], []

    def take(
        self, messages: list[bytes], received: list[int], window: Array, inputs: RecordedInputs
    ) -> None:
        """Compare new messages with the samples of the window.

        Args:
            messages: serialised.
            received: times of reception, ns.
            window: the latest samples, (n,), with the columns of `SAMPLES`.
            inputs: the latest inputs, valid or not.
        """
        late = len(self._late[0])
        messages, received = self._late[0] + messages, self._late[1] + received
        stamps, malformed = self._decode(messages)
        self.matcher.see(stamps[late:])
        times = np.array(received, np.int64)
        self._faults.add(MALFORMED, times[malformed])
        usable = np.flatnonzero(~malformed)
        index = self.matcher.match(stamps[usable], times[usable], window)
        found = index >= 0
        # A message can be recorded before its input: it waits for one batch.
        unmatched = usable[~found]
        given_up, waiting = unmatched[unmatched < late], unmatched[unmatched >= late].tolist()
        self._late = [messages[row] for row in waiting], [received[row] for row in waiting]
        lacking = inputs.lack(times[given_up], stamps[given_up])
        self._unrecorded += int(np.count_nonzero(lacking))
        self.matcher.extra.add(stamps[given_up[~lacking]])
        self._compare(usable[found], window.take(index[found]))  # faster than by an index

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        """Decode messages for `_compare`; return their stamps and which ones are malformed."""
        raise NotImplementedError

    def _compare(self, rows: Array, samples: Array) -> None:
        """Compare some of the decoded messages with their samples."""
        raise NotImplementedError

    def causes(self) -> Iterator[Finding]:
        """Yield what explains the errors."""
        yield from ()

    def notes(self) -> Iterator[Finding]:
        """Yield what fails nothing."""
        yield from ()

    def report(self) -> TopicReport:
        """Return the report so far."""
        matcher, missing = self.matcher, self.missing
        return TopicReport(
            self.name,
            messages=matcher.messages,
            compared=matcher.compared,
            missing=missing.inputs.count,
            extra=matcher.extra.count,
            duplicates=matcher.duplicates,
            out_of_order=matcher.out_of_order.count,
            fields=tuple(errors.report() for errors in self.errors),
            first_missing=missing.inputs.first,
            first_extra=matcher.extra.first,
            first_out_of_order=matcher.out_of_order.first,
            faults=tuple(self._faults.findings()),
            left_out=dict(missing.left_out + Counter({NO_INPUT: self._unrecorded})),
        )

    def lanes(self, start: int) -> list[Lane]:
        """Return when something happened, with the time 0 at a stamp, ns."""
        events = {
            'missing': self.missing.inputs,
            'extra': self.matcher.extra,
            'out of order': self.matcher.out_of_order,
        }
        for errors in self.errors:
            events[f'{errors.name} not finite'] = errors.non_finite
            events[f'{errors.name} absent'] = errors.absent
        return [
            found.lane(self.name, event, start) for event, found in events.items() if found.count
        ]
