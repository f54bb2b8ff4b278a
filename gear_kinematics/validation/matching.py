"""Matches published messages with their input samples by header stamp.

A node publishes in the order of its inputs, so nearly all messages match in long runs; a single
message is looked up only where a run ends. Memory is bounded by a window of samples.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.report.document import counted
from gear_kinematics.validation.diagnosis import UnseenTurns
from gear_kinematics.validation.field_errors import FieldErrors
from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.recorder import NO_INPUT, Completeness, Missing, RecordedInputs
from gear_kinematics.validation.report import TopicReport
from gear_kinematics.validation.series import RecordedField, SeriesRecorder
from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[Any]
Columns = dict[str, Array]
"""Columns of samples (n,): stamp, turns, angle, velocity, effort, stretch; see `RotorSamples`."""

WINDOW = 16_384
"""Samples kept for late messages; even later ones count as extra."""


class Window:
    """The samples with which messages can still be matched; columns by name, (n, ...)."""

    def __init__(self) -> None:
        self.columns: Columns = {}

    def __len__(self) -> int:
        return len(self.columns['stamp']) if self.columns else 0

    def append(self, **columns: Array) -> None:
        """Add samples; one of the columns is `stamp`."""
        old = self.columns
        self.columns = {
            name: np.concatenate([old[name], column]) if old else column
            for name, column in columns.items()
        }

    def rows(self, index: Array | slice) -> Columns:
        """Return some of the samples."""
        return {name: column[index] for name, column in self.columns.items()}

    def drop(self, count: int) -> None:
        """Drop the oldest samples."""
        self.columns = {name: column[count:] for name, column in self.columns.items()}


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

    def match(self, stamps: Array, window: Array) -> Array:
        """Find the sample of each message, as its index in the window or -1, and mark it.

        Args:
            stamps: of messages, (n,), ns.
            window: stamps of the samples, ns.
        """
        index = np.full(len(stamps), -1, np.intp)
        k = 0
        while k < len(stamps):
            length = self._run(stamps[k:], window)
            index[k : k + length] = np.arange(self._next, self._next + length)
            self.matched[self._next : self._next + length] = True
            self._next += length
            k += length
            if k < len(stamps):
                index[k] = self._look_up(stamps[k], window)
                k += 1
        self.compared += int(np.count_nonzero(index >= 0))
        return index

    def drop(self, count: int) -> None:
        """Drop the oldest samples of the window."""
        self.matched = self.matched[count:]
        self._next = max(self._next - count, 0)

    def _run(self, stamps: Array, window: Array) -> int:
        """Number of messages that match the next samples in order."""
        longest = min(len(stamps), len(window) - self._next)
        part = slice(self._next, self._next + longest)
        alike = (stamps[:longest] == window[part]) & ~self.matched[part]
        return longest if alike.all() else int(np.argmin(alike))

    def _look_up(self, stamp: int, window: Array) -> int:
        found = np.flatnonzero((window == stamp) & ~self.matched)
        if not len(found):
            return -1
        # If a stamp occurs again after a restart, take the next sample that has it.
        ahead = found[found >= self._next]
        index = int(ahead[0] if len(ahead) else found[-1])
        self.matched[index] = True
        self._next = max(self._next, index + 1)
        return index


class Faults:
    """Counts the faults of messages themselves, and keeps the first of each."""

    def __init__(self) -> None:
        self._found: dict[str, tuple[int, str]] = {}

    def add(self, fault: str, times: Array, moment: str = 'at stamp') -> None:
        """Add the stamps, or other times as `moment` says, of messages with a fault, ns."""
        if len(times):
            count, first = self._found.get(fault, (0, f'{moment} {times[0]}'))
            self._found[fault] = count + len(times), first

    def sentences(self) -> tuple[str, ...]:
        """Describe each fault."""
        return tuple(
            f'{fault}: {counted(count, "message")}, the first {first}'
            for fault, (count, first) in self._found.items()
        )


class OutputTopic:
    """One output topic: matches its messages, holds back late ones and collects their faults."""

    def __init__(self, unseen: UnseenTurns | None, *errors: FieldErrors) -> None:
        """Start without messages.

        Args:
            unseen: unseen turns, if the rotor has a single-turn encoder.
            errors: of the fields.
        """
        self.errors = errors
        self.series = SeriesRecorder(
            {field.name: RecordedField(field.tolerance, field.parts) for field in errors}
        )
        self.matcher = Matcher()
        self.compared: dict[str, Array] = {}
        """Columns of the last compared batch, for checks and plots."""
        self._unseen = unseen
        self._unrecorded = 0  # messages whose input was not recorded
        self._faults = Faults()
        self._late: tuple[list[bytes], list[int]] = [], []

    def take(
        self, messages: list[bytes], received: list[int], window: Window, inputs: RecordedInputs
    ) -> None:
        """Compare new messages with the samples of the window.

        Args:
            messages: serialised.
            received: times of reception, ns.
            window: the latest samples.
            inputs: the latest inputs, valid or not.
        """
        late = len(self._late[0])
        messages, received = self._late[0] + messages, self._late[1] + received
        stamps, malformed = self._decode(messages)
        self.matcher.see(stamps[late:])
        times = np.array(received, np.int64)
        self._faults.add('malformed', times[malformed], 'received at')
        usable = np.flatnonzero(~malformed)
        index = self.matcher.match(stamps[usable], window.columns['stamp'])
        found = index >= 0
        # A message can be recorded before its input: it waits for one batch.
        unmatched = usable[~found]
        given_up, waiting = unmatched[unmatched < late], unmatched[unmatched >= late].tolist()
        self._late = [messages[row] for row in waiting], [received[row] for row in waiting]
        lacking = inputs.lack(times[given_up], stamps[given_up])
        self._unrecorded += int(np.count_nonzero(lacking))
        self.matcher.extra.add(stamps[given_up[~lacking]])
        self._compare(usable[found], window.rows(index[found]))

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        raise NotImplementedError

    def _compare(self, rows: Array, samples: Columns) -> None:
        raise NotImplementedError

    def report(self, topic: str, missing: Missing) -> TopicReport:
        """Return the report so far.

        Args:
            topic: name of the topic.
            missing: its missing messages.
        """
        matcher = self.matcher
        return TopicReport(
            topic,
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
            faults=self._faults.sentences(),
            left_out=dict(missing.left_out + Counter({NO_INPUT: self._unrecorded})),
        )


class Group(NamedTuple):
    """Outputs that are recorded from the same time on."""

    names: Sequence[str]
    """Of the rotor's topic and those of the outputs."""
    outputs: Sequence[OutputTopic]
    absences: Completeness

    def why_missing(self) -> Iterator[str]:
        """Say why messages may be missing, in sentences."""
        rotor, *names = self.names
        missing = dict(zip(names, self.absences.topics, strict=True))
        for topic, of_topic in missing.items():
            if of_topic.ended_early is not None:
                yield (
                    f'{topic} ends {of_topic.ended_early:.3f} s before {rotor}: '
                    'the node may have ended'
                )
        counts = {topic: of_topic.inputs.count for topic, of_topic in missing.items()}
        lost = [topic for topic, count in counts.items() if count]
        if len(names) == 1 or not lost:
            return
        unanswered = self.absences.unanswered
        if set(counts.values()) == {unanswered}:
            yield (
                f'{counted(unanswered, "message")} of {rotor} without any output: the node did '
                'not receive them, or was blocked'
            )
        elif len(lost) < len(names) and not unanswered:
            whole = [topic for topic in names if topic not in lost]
            lacking = ', '.join(
                f'{counted(counts[topic], "message")} of {topic}' for topic in lost
            )
            yield (
                f'{lacking} missing, but none of {", ".join(whole)}: the node '
                'had the inputs, and the messages were lost on their way to the recording'
            )
