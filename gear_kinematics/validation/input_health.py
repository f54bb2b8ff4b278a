# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Rate, gaps and speed of the rotor topic, and the checks of its contents."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.rotor_samples import RotorSamples
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.report import Finding, Gap, InputReport
from gear_kinematics.wire.batches import Array, once_for_joints
from gear_kinematics.wire.cdr import SECOND

_MIN_GAP = 5.0  # median periods
_LEAST_TIME = 0.5  # median periods; the least time that a step is taken to need
_MAX_LISTED = 10  # listed gaps
_FRACTION = 1e-3  # s; longest time within a second of nanoseconds that are µs
MANY_REPEATED = 0.25  # share of all stamps, which drivers do not reach by repeating a few


class InputHealth:
    """Collects statistics of the samples, batch by batch."""

    def __init__(self, max_speed: float) -> None:
        """Start without samples; the rotor can turn at `max_speed`, rad/s."""
        self._max_speed = max_speed
        self._first_stamp: int | None = None
        self._last: tuple[int, float] | None = None  # stamp, ns, and angle, rad
        self._duration = 0.0
        self._period = 0.0  # median period of the first batch, s
        self._gaps = 0
        self._longest: list[Gap] = []
        self._overspeed = 0
        self._fastest = 0.0
        self.outside: Fact | None = None  # the first output angle outside of its range

    def update(self, samples: RotorSamples) -> None:
        """Add the next samples."""
        stamp, rotor_angle = samples.stamp, samples.rotor_angle
        if not len(stamp):
            return
        if self._first_stamp is None:
            self._first_stamp = int(stamp[0])
        last_stamp, last_angle = self._last or (stamp[0], rotor_angle[0])
        self._last = int(stamp[-1]), float(rotor_angle[-1])
        forward, period, duration = _periods(stamp, int(last_stamp))
        turned = np.diff(rotor_angle, prepend=last_angle)[forward]
        if not len(period):
            return
        self._duration += duration
        self._period = self._period or float(np.median(period))
        # After a stamp that is late, little time seems to pass until the next one.
        speed = np.abs(turned) / np.maximum(period, _LEAST_TIME * self._period)
        self._fastest = max(self._fastest, float(speed.max()))
        self._overspeed += int(np.count_nonzero(speed > self._max_speed))
        stamp, long = stamp[forward], np.flatnonzero(period > _MIN_GAP * self._period)
        self._gaps += len(long)
        gaps = [Gap(int(stamp[k]), float(period[k]), float(turned[k])) for k in long]
        self._longest = sorted(self._longest + gaps, key=lambda gap: -gap.seconds)[:_MAX_LISTED]

    def report(self, rotor_input: RotorInput, topic: str) -> InputReport:
        """Report on everything so far."""
        # Times of reception show no speeds, because of bursts, and jumps are no motion.
        timed = 2 * rotor_input.zero_stamps <= rotor_input.received
        timed &= not rotor_input.plausibility.jumped
        lost, counted = rotor_input.why_lost, {Condition.GAP, Condition.TURNED_TOO_FAR}
        return InputReport(
            topic=topic,
            joint=rotor_input.parameters.rotor_joint,
            messages=rotor_input.received,
            of_others=rotor_input.of_others,
            valid=rotor_input.received - rotor_input.of_others - rotor_input.rejected.total(),
            rejected=dict(rotor_input.rejected),
            duplicates=rotor_input.duplicates,
            zero_stamps=rotor_input.zero_stamps,
            unnormalised_stamps=rotor_input.unnormalised_stamps,
            resets=rotor_input.resets,
            first_stamp=self._first_stamp,
            rate=1.0 / self._period if self._period else 0.0,
            duration=self._duration,
            gaps=self._gaps,
            jumps=rotor_input.turns.unknown_gaps,
            overspeed=self._overspeed * timed,
            max_speed=self._fastest * timed,
            longest_gaps=tuple(self._longest),
            referenced=not (rotor_input.turns.unknown_gaps or rotor_input.plausibility.jumped),
            jumped='' if lost and lost.condition in counted else str(lost or ''),
            velocity_is=str(rotor_input.velocity_field.in_recording or ''),
            set_back=str(rotor_input.disorder.fault or ''),
            beyond_limits=str(rotor_input.plausibility.beyond_limits or ''),
            outside=str(self.outside or ''),
            effort_is=str(rotor_input.effort_field.doubt or ''),
        )


@once_for_joints
def _periods(
    stamp: NDArray[np.int64], before: int
) -> tuple[NDArray[np.bool_] | slice, Array, float]:
    """Return which stamps are later than the one before, by how much, s, and the sum of that."""
    period = np.diff(stamp, prepend=before) / SECOND
    forward = period > 0.0  # neither a duplicate nor a restart
    if forward.all():
        return slice(None), period, float(period.sum())
    return forward, period[forward], float(period[forward].sum())


def _repeats_stamps(rotor: InputReport) -> Iterator[Finding]:
    """Yield that too many stamps repeat to match outputs with inputs by them."""
    if rotor.duplicates > MANY_REPEATED * rotor.valid:
        yield Finding(FindingCause.REPEATED_STAMPS, values={'rotor': rotor})


def _short_seconds(rotor: InputReport) -> Iterator[Finding]:
    """Yield that stamps stand near each whole second, as if their nanoseconds were µs or ms."""
    whole = sum(1.0 - _FRACTION < gap.seconds <= 1.0 for gap in rotor.longest_gaps)
    fast = rotor.rate * rotor.duration > rotor.valid / (2.0 * _FRACTION)
    if fast and 1 < whole >= min(_MAX_LISTED, int(rotor.duration)):
        yield Finding(FindingCause.SHORT_SECONDS, values={'rotor': rotor})


def _rejected(rotor: InputReport) -> Iterator[Finding]:
    if rejected := sum(rotor.rejected.values()):
        mostly = 2 * rejected > rotor.messages - rotor.of_others
        causes = ', '.join(f'{cause} {count}' for cause, count in rotor.rejected.items())
        values = {'rotor': rotor, 'rejected': rejected, 'causes': causes}
        cause = FindingCause.MOSTLY_REJECTED if mostly else FindingCause.REJECTED
        yield Finding(cause, values=values, fails=mostly)


def _counted(rotor: InputReport) -> Iterator[Finding]:
    """Yield the counts and texts of the report that are not 0 or empty."""
    for name in _NOTED:
        if noted := getattr(rotor, name):
            count = noted if isinstance(noted, int) else 0
            yield Finding(FindingCause[name.upper()], count=count, values={'rotor': rotor})


_NOTED = (
    'jumped',
    'jumps',
    'outside',
    'effort_is',
    'velocity_is',
    'beyond_limits',
    'set_back',
    'of_others',
    'zero_stamps',
)
"""Fields of `InputReport` that are noted; their causes have the same names."""

CHECKS: Sequence[Callable[[InputReport], Iterator[Finding]]] = (
    _repeats_stamps,
    _short_seconds,
    _rejected,
    _counted,
)
"""Checks of the contents of the rotor topic."""
