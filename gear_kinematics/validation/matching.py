# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Matches published messages with their input samples by header stamp.

A node publishes in the order of its inputs, so nearly all messages match in long runs; a single
message is looked up only where a run ends. Memory is bounded by a window of samples.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics import Gear, Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.count_changes import CountChanges
from gear_kinematics.validation.fields import (
    Array,
    FieldErrors,
    FieldSamples,
    Occurrences,
    SeriesRecorder,
    Window,
    as_slice,
)
from gear_kinematics.validation.recorder import NO_INPUT, Missing, RecordedInputs
from gear_kinematics.validation.report import Finding, TopicReport
from gear_kinematics.validation.task import Tolerances
from gear_kinematics.wire.batches import JointStateBatch, once_for_joints
from gear_kinematics.wire.cdr import MessageLayout
from gear_kinematics.wire.joint_reader import CLOCK_RESET

WINDOW = 16_384  # samples kept for late messages; even later ones count as extra

SAMPLES = [
    ('number', np.int64),
    ('turns_known', np.bool_),
    ('velocity_open', np.bool_),
    ('effort_open', np.bool_),
    ('referenced', np.bool_),
    *((name, np.int64) for name in ('stamp', 'received', 'segment')),
    *((name, np.float64) for name in ('turns', 'angle', 'velocity', 'effort')),
]
"""Columns of the samples with which outputs are compared: the number in the order of reception;
whether the turns are known, from an output if they can change unseen; whether the velocity, or an
effort of 0, can count or not, by what the node received before the recording; and those of
`RotorSamples`."""


class Expectation(NamedTuple):
    """Rules by which the outputs are recomputed and judged."""

    gear: Gear
    tolerances: Tolerances
    changes: CountChanges  # changes of the rotor's count that the outputs show

    def tolerance(self, unit: str) -> float:
        """Return the tolerance of errors in a unit: a force acts at the eccentricity as lever."""
        if unit == 'm/s':
            return self.tolerances.velocity
        if unit == 'N' and isinstance(self.gear, Mechanism):
            return self.tolerances.effort / self.gear.eccentricity
        return self.tolerances.of(unit)


class Matcher:
    """Matches the messages of one topic and counts those without a match."""

    def __init__(self) -> None:
        self.messages = 0
        self.compared = 0
        self.extra = Occurrences()
        self.duplicates = 0
        self.out_of_order = Occurrences()
        self.matched = np.zeros(0, bool)  # whether each sample of the window has its message
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
        duplicates, out_of_order = _disorder(stamps, int(before))
        self.duplicates += duplicates
        self.out_of_order.add(out_of_order)
        self._last_stamp = int(stamps[-1])

    def match(self, stamps: Array, received: Array, window: Window) -> Array:
        """Find the sample of each message, (n,), as its index in the window or -1, and mark it."""
        index = np.full(len(stamps), -1, np.intp)
        resets = np.flatnonzero(np.diff(window['stamp']) < -CLOCK_RESET) + 1
        k = 0
        while k < len(stamps):
            longest = min(len(stamps) - k, len(window) - self._next)
            ahead = slice(self._next, self._next + longest)
            alike = _alike(stamps[k : k + longest], received[k : k + longest], window, ahead)
            alike &= ~self.matched[ahead]
            run = longest if alike.all() else int(np.argmin(alike))
            if run and _of_later_clock(stamps[k], received[k], self._next, window, resets):
                run = 0
            self.matched[self._next : self._next + run] = True
            index[k : k + run] = np.arange(self._next, self._next + run)
            self._next += run
            k += run
            if k < len(stamps):
                index[k] = self._look_up(stamps[k], received[k], window, resets)
                k += 1
        self.compared += int(np.count_nonzero(index >= 0))
        return index

    def drop(self, count: int) -> None:
        """Drop the oldest samples of the window."""
        self.matched = self.matched[count:]
        self._next = max(self._next - count, 0)

    def _look_up(self, stamp: int, received: int, window: Window, resets: Array) -> int:
        alike = np.flatnonzero(_alike(stamp, received, window) & ~self.matched)
        ahead = int(alike.searchsorted(self._next))
        # If a stamp occurs again after a restart, take the next sample that has it.
        for index in (*alike[ahead:].tolist(), *alike[:ahead][::-1].tolist()):
            if not _of_later_clock(stamp, received, index, window, resets):
                self.matched[index] = True
                self._next = max(self._next, index + 1)
                return int(index)
        return -1


@once_for_joints
def _disorder(stamps: Array, before: int) -> tuple[int, Array]:
    """Return how many stamps repeat the one before, and those that are out of order."""
    steps = np.diff(stamps, prepend=before)
    disordered = stamps[(steps < 0) & (steps >= -CLOCK_RESET)]
    return int(np.count_nonzero(steps == 0)), disordered


def _alike(
    stamp: Array | int, received: Array | int, window: Window, rows: slice = slice(None)
) -> Array:
    """Return whether messages can answer samples, not the same stamps after a later restart."""
    in_time = window['received'][rows] - CLOCK_RESET <= received
    return np.asarray((stamp == window['stamp'][rows]) & in_time)


def _of_later_clock(stamp: int, received: int, row: int, window: Window, resets: Array) -> bool:
    """Return whether a message answers an input, perhaps unrecorded, after a sample's next reset.

    Its time of reception is then nearer to when that input must have been received.
    """
    after = resets[np.searchsorted(resets, row, 'right') :]
    if not len(after):
        return False
    nearest = after[0] + np.argmin(np.abs(window['stamp'][after[0] :] - stamp))
    due = window['received'][nearest] - (window['stamp'][nearest] - stamp)
    return bool(abs(received - due) < abs(received - window['received'][row]))


def rotor_angle(samples: Window) -> Array:
    """Return the rotor angle of samples, (n,), rad."""
    return np.asarray(TURN * samples['turns'] + samples['angle'])


class OutputTopic:
    """An output topic: matches its messages, keeps late ones for a batch, and collects faults.

    Its subclasses decode the messages of a type or topic, and compare their fields.
    """

    layout: Callable[[bytes], MessageLayout]
    """Returns the layout of a message, of which the last text is the label."""
    joints: Sequence[bytes] = ()
    """The joints in its messages, if they can be among those of the other actuators of an arm."""

    def __init__(
        self, name: str, label: str, expectation: Expectation, units: Mapping[str, str]
    ) -> None:
        """Start without messages, which name a joint or frame, the `label`.

        The expectation says how to judge them; `units` are those of the compared fields, by name.
        """
        self.name, self.label = name, label
        self.errors = tuple(
            FieldErrors(field, unit, expectation.tolerance(unit)) for field, unit in units.items()
        )
        self.series = SeriesRecorder(self.errors)
        self.matcher = Matcher()
        self.missing = Missing()
        self._gear, self._tolerances, self._changes = expectation
        self._wrong = 0
        self._latest_wrong = Occurrences()  # since the latest right output
        self._until_right = 0, 0  # wrong ones before the first right one, and its stamp, ns
        self._right: tuple[float, ...] = ()  # rotor angles of the first and latest right one, rad
        self._wrong_without_velocity = 0  # besides, if velocities were expected
        self._without_velocity: Array | bool = False  # messages of the latest batch, (n,)
        self._unrecorded = 0  # messages whose input was not recorded
        self._malformed = Occurrences()  # by times of reception, as they have no stamp
        self._faults: defaultdict[tuple[FindingCause, str], Occurrences] = defaultdict(Occurrences)
        """Faults by what is wrong, and the name of the joint or the frame."""
        self.late = list[bytes]()  # messages that wait for their inputs
        self._late_received = np.zeros(0, np.int64)
        self.unstamped = False  # whether the node gave its own time to inputs without a stamp
        self.shared = False  # whether messages have joints of several actuators, NaN if absent
        self._own = False  # whether a message had one of the joints

    def take(
        self,
        messages: list[bytes],
        received: Sequence[int],
        window: Window,
        inputs: RecordedInputs,
    ) -> None:
        """Compare new messages, received at times in ns, with the latest samples, (n,)."""
        times = np.asarray(received, np.int64)
        if late := len(self.late):
            messages = self.late + messages
            times = np.concatenate([self._late_received, times])
        if self.joints:
            if not isinstance(messages, JointStateBatch):
                messages = JointStateBatch(messages)
            having, own = messages.having(self.joints)
            self._own = self._own or self.shared or len(own) > 0
            if having is not None and not self._own:
                # Before the first, those of an input's stamp can be outputs under another name.
                having = np.flatnonzero(np.isin(messages.heads[0], window['stamp']))
                own = JointStateBatch([messages[row] for row in having.tolist()])
            if having is not None:
                messages, times = own, times[having]
                late = int(np.count_nonzero(having < late))
        stamps, malformed = self._decode(messages)
        self.matcher.see(stamps[late:] if late else stamps)
        usable = np.flatnonzero(~malformed)
        if self.unstamped:
            self._adopt_stamps(stamps, usable, window)
        index = self.matcher.match(stamps[usable], times[usable], window)
        self._malformed.add(times[malformed])
        found = index >= 0
        # A message can be recorded before its input: it waits for one batch.
        unmatched = usable[~found]
        given_up, waiting = unmatched[unmatched < late], unmatched[unmatched >= late]
        self.late = [messages[row] for row in waiting.tolist()]
        self._late_received = times[waiting]
        lacking = inputs.lack(times[given_up], stamps[given_up])
        self._unrecorded += int(np.count_nonzero(lacking))
        self.matcher.extra.add(stamps[given_up[~lacking]])
        rows, at = usable[found], index[found]
        self._adopt_fields(rows, at, window)
        samples = window.take(as_slice(at))
        self._changes.move(samples)
        fields = self._compare(rows, samples)
        angle = rotor_angle(samples)
        wrong = np.zeros(len(samples), bool)
        for errors, field in zip(self.errors, fields, strict=True):
            wrong |= errors.update(field, samples['stamp'], angle)
        if len(right := np.flatnonzero(~wrong)):
            self._latest_wrong = Occurrences()
            if not self._right:
                stamp = int(samples['stamp'][right[0]])
                self._until_right = self._wrong + int(right[0]), stamp
            first, latest = angle[right[[0, -1]]].tolist()
            self._right = self._right[0] if self._right else first, latest
        self._wrong += int(np.count_nonzero(wrong))
        self._latest_wrong.add(samples['stamp'][right[-1] + 1 if len(right) else 0 :])
        self._wrong_without_velocity += int(np.count_nonzero(self._without_velocity & ~wrong))
        self.series.update(samples['stamp'], angle, *fields)

    def _adopt_stamps(self, stamps: Array, usable: Array, window: Window) -> None:
        """Give samples without a stamp the stamp of their output, if it can be found."""

    def _adopt_fields(self, rows: Array, at: Array, window: Window) -> None:
        """Decide by messages, (n,), whether open fields of their samples count."""

    def answered(self, samples: Window) -> Array:
        """Return which of the oldest samples have their message, or need none, (n,)."""
        return self.matcher.matched[: len(samples)]

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        """Decode messages for `_compare`; return their stamps and which ones are malformed."""
        raise NotImplementedError

    def _compare(self, rows: Array, samples: Window) -> Sequence[FieldSamples]:
        """Compare decoded messages with their samples; return the fields of `errors`."""
        raise NotImplementedError

    def causes(self) -> Iterator[Finding]:
        """Yield what explains the errors."""
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
            wrong=self._wrong,
            first_missing=missing.inputs.first,
            first_extra=matcher.extra.first,
            first_out_of_order=matcher.out_of_order.first,
            faults=tuple(self._found_faults()),
            left_out=dict(missing.left_out + Counter({NO_INPUT: self._unrecorded})),
        )

    def _found_faults(self) -> Iterator[Finding]:
        if count := self._malformed.count:
            received = {'received': self._malformed.first}
            yield Finding(FindingCause.MALFORMED, count=count, values=received)
        for (cause, name), found in self._faults.items():
            if found.count:
                values = {'name': name, 'expected': self.label}
                yield Finding(cause, stamp=found.first, count=found.count, values=values)
