# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A recording of a gear, whatever its file format: angles under torque, and both encoders."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import TopicMessages
from gear_kinematics.kinematics.rotor_turns import TURN, split_turns
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

MOST_MESSAGES = 500_000  # of the rotor that are examined; they take about 200 bytes each
_SPEED_WINDOW = 0.02  # s, over which the speed is averaged
_MOST_TWIST = 0.35  # rad of the output under torque; a shaft that turns further is not locked
_RANKED = 100_000  # samples whose ranks are compared
_YIELDS, _READINGS = 0.5, 3
"""Share of the output's motion that a held rotor moves by less than, unlike one that drives it;
most readings of an encoder that shows little but its steps, which may be coarser."""


class RecordingError(ValueError):
    """A recording that cannot be used; the text gives the cause in one line."""


class RotorMotion(NamedTuple):
    """The rotor's samples in the order of time, (n,) each."""

    stamp: Array  #: ns; if time was not recorded, one second a sample
    turns: Array
    angle: Array  #: rad: the rotor angle φ2 is 2π turns + angle
    effort: Array  #: N·m; NaN where it was not recorded
    segment: Array  #: number that changes where the motion before is unknown

    @classmethod
    def of(
        cls, stamp: Array, angle: Array, effort: Array | None = None, segment: Array | None = None
    ) -> Self:
        """Make a motion of angles that may be beyond a turn, rad."""
        effort = np.full(len(stamp), np.nan) if effort is None else effort
        segment = np.zeros(len(stamp), np.int64) if segment is None else segment
        return cls(stamp, *split_turns(angle), effort, segment)

    @property
    def seconds(self) -> Array:
        """Times since the first sample, s, or sample numbers."""
        return np.asarray((self.stamp - self.stamp[0]) / SECOND)

    @property
    def turned(self) -> Array:
        """Rotor angle counted from the whole turns of the first sample, rad."""
        return np.asarray((self.turns - self.turns[0]) * TURN + self.angle)


@dataclass(frozen=True, eq=False, slots=True)
class Loading:
    """Angles under torque in the order of sampling, (n,) each."""

    torque: Array  #: N·m, at the output
    angle: Array  #: rad, at the output: the twist of the gear from an arbitrary zero
    moment: Array  #: s since the first sample, or numbers of the samples from 1 if not `timed`
    timed: bool  #: whether time was recorded
    angle_step: Step  #: rad at the output, between readings of the angle
    measured: bool  #: whether an encoder measured the output; otherwise it is taken to be locked

    @property
    def not_locked(self) -> str:
        """What shows that the shaft turns freely; empty if it may be locked."""
        # A few readings may be stray.
        if np.ptp(np.quantile(self.angle, (0.01, 0.99))) <= _MOST_TWIST:
            return ''
        turned = np.degrees(np.ptp(self.angle))
        return f'the output turns by {turned:.3g}° under torque: it is not locked'

    @property
    def opposed(self) -> bool:
        """Whether the angle falls where the torque grows, by ranks, as readings may be stray."""
        some = slice(None, None, max(1, len(self.torque) // _RANKED))
        both = self.torque[some], self.angle[some]
        torque, angle = (np.unique(values, return_inverse=True)[1] for values in both)
        return bool(torque @ (angle - angle.mean()) < 0.0)

    def chosen(self, rows: Array | slice) -> Self:
        """Return the samples of some rows."""
        moment = self.moment[rows]
        return replace(self, torque=self.torque[rows], angle=self.angle[rows], moment=moment)


def locked_shaft(
    torque: Array,
    angle: Array,
    step: Step,
    ratio: Fraction,
    stamp: Array | None,
    *,
    measured: bool,
) -> Loading:
    """Return angles of one shaft under torque; the other shaft is taken to be locked.

    The torque is that at the output, N·m. The angles, rad, are those of the rotor, or of the
    output with a ratio of 1. The stamps are in ns; None if time was not recorded.
    """
    moment = np.arange(1.0, len(torque) + 1.0) if stamp is None else (stamp - stamp[0]) / SECOND
    angle, step = angle / float(ratio), step.scaled(float(1 / ratio))
    return Loading(torque, angle, moment, stamp is not None, step, measured)


@dataclass(frozen=True, eq=False)
class Encoders:
    """Measured output angles, and the motion of the rotor around each of them."""

    rotor: RotorMotion
    timed: bool  #: whether stamps are times
    before: Array  #: (n,): index of the last rotor sample before each measured angle
    share: Array  #: (n,): how far it is from there to the next rotor sample, 0 to 1
    measured: Array  #: (n,), rad
    rotor_step: Step  #: rad of the rotor, between readings of its encoder
    output_step: Step  #: rad, between readings of the output's encoder
    unmatched: Mapping[str, int] = field(default_factory=dict)  #: numbers left out, by cause
    start: float = 0.0  #: of the rotor's samples in the recording, s or samples, if it was divided

    @property
    def duration(self) -> float:
        """Time between the first and the last sample, s; 0 if not recorded."""
        return float(self.rotor.seconds[-1]) if self.timed else 0.0

    @property
    def seconds(self) -> Array:
        """Times of the measured angles since the first rotor sample, s, or sample numbers."""
        return self.at_measured(self.rotor.seconds)

    @property
    def moment(self) -> Array:
        """Times in the recording, or sample numbers that count from 1, as reports give them."""
        return self.start + self.seconds + (not self.timed)

    @property
    def _after(self) -> Array:
        """(n,): index of the next rotor sample, or of the last one."""
        return np.asarray(np.minimum(self.before + 1, len(self.rotor.stamp) - 1))

    @property
    def interpolated(self) -> float:
        """Time between the rotor's samples, s; 0 if one belongs to every measured angle."""
        if not self.timed or not (self.share * (1.0 - self.share)).any():
            return 0.0
        return float(np.median(np.diff(self.rotor.stamp))) / SECOND

    def wound_up(self, ratio: Fraction) -> bool:
        """Return whether the output only winds up under torque, as the rotor is locked or held."""
        turned, output = np.ptp(self.at_measured(self.rotor.turned)), np.ptp(self.measured)
        if max(turned, output) > _MOST_TWIST or self.torque(ratio) is None:
            return False
        stepped = len(np.unique(self.rotor.turned)) <= _READINGS
        moved = turned / abs(float(ratio)) if stepped else turned
        return bool(moved < _YIELDS * output)

    def at_measured(self, values: Array) -> Array:
        """Interpolate a quantity of the rotor to the measured angles."""
        before = values[self.before]
        return np.asarray(before + self.share * (values[self._after] - before))

    @cached_property
    def bend(self) -> Array:
        """Rotor angle at the measured angles beyond the line between two samples, (n,), rad.

        It is that of the cubic through the four nearest samples, and 0 where these do not belong
        to one motion, or are so uneven in time that steps of the encoder would be magnified.
        """
        rotor, seconds = self.rotor, self.rotor.seconds
        first = np.clip(self.before - 1, 0, max(len(seconds) - 4, 0))
        at = np.minimum(first + np.arange(4)[:, np.newaxis], len(seconds) - 1)
        spans = np.diff(seconds[at], axis=0)
        sound = (first == self.before - 1) & (rotor.segment[at[0]] == rotor.segment[at[3]])
        sound &= (spans[1] > 0.0) & (np.minimum(spans[0], spans[2]) >= 0.25 * spans[1])
        spans = np.where(sound, spans, 1.0)
        speeds = np.diff(rotor.turned[at], axis=0) / spans
        # Half of the accelerations before and after, which the cubic weights by the time.
        early, late = np.diff(speeds, axis=0) / (spans[:-1] + spans[1:])
        weight = (spans[0] + self.share * spans[1]) / spans.sum(axis=0)
        half = early + weight * (late - early)
        bend = -self.share * (1.0 - self.share) * spans[1] ** 2 * half
        # Less than this may come from rounding the four samples alone, and would add noise.
        sound &= np.abs(bend) > self.rotor_step.size / 8.0
        return np.where(sound, bend, 0.0)

    def position(self) -> tuple[Array, Array]:
        """Rotor angle at the measured angles: whole turns, and the remainder, rad."""
        turns, angle = self.rotor.turns[self.before], self.rotor.angle[self.before]
        step = (self.rotor.turns[self._after] - turns) * TURN
        step += self.rotor.angle[self._after] - angle
        rest = angle + self.share * step + self.bend
        wraps = np.round(rest / TURN)
        return turns + wraps, rest - TURN * wraps

    def ideal(self, ratio: Fraction) -> Array:
        """Ideal output angle at the rotor samples, rad, as `RotorMotion.turned` counts it."""
        return self.rotor.turned * (ratio.denominator / ratio.numerator)

    def error_step(self, ratio: Fraction) -> Step:
        """Step between readings of the error, rad."""
        return self.rotor_step.scaled(float(1 / ratio)).joined(self.output_step)

    def error(self, ratio: Fraction) -> Array:
        """Measured minus ideal output angle, rad, without jumps; its zero is arbitrary."""
        error = self.measured - self.at_measured(self.ideal(ratio))
        jumps = np.round(np.diff(error, prepend=error[0]) / TURN)
        return error - TURN * np.cumsum(jumps)

    def speed(self, ratio: Fraction) -> Array:
        """Speed of the output at the measured angles, rad/s, or rad a sample without times."""
        time, at = self.rotor.seconds, self.seconds
        # The window includes at least the rotor samples on both sides.
        early = np.clip(at - 0.5 * _SPEED_WINDOW, time[0], time[self.before])
        late = np.clip(at + 0.5 * _SPEED_WINDOW, time[self._after], time[-1])
        ideal = self.ideal(ratio)
        travel = np.interp(late, time, ideal) - np.interp(early, time, ideal)
        return np.asarray(travel / np.maximum(late - early, 1.0 / SECOND))

    def torque(self, ratio: Fraction) -> Array | None:
        """Torque at the output at the measured angles, N·m; None if it is not known throughout."""
        effort = self.rotor.effort
        return float(ratio) * self.at_measured(effort) if np.isfinite(effort).all() else None

    def earlier(self, delay: float) -> Self:
        """Return the angles as if measured earlier by a delay, s or samples."""
        stamp = self.rotor.stamp[0] + np.round((self.seconds - delay) * SECOND).astype(np.int64)
        before, share, kept = match(self.rotor.stamp, stamp)
        return replace(self, before=before, share=share, measured=self.measured[kept])

    def chosen(self, rows: Array | slice) -> Self:
        """Return the measured angles of some rows, with all of the rotor's motion."""
        return replace(
            self, before=self.before[rows], share=self.share[rows], measured=self.measured[rows]
        )

    def starts(self, max_gap: int | None) -> Array:
        """Indices of the rotor samples before which the motion is unknown, including the first.

        It is also unknown in gaps of more than `max_gap`, ns, unless that is None.
        """
        unknown = np.diff(self.rotor.segment) != 0
        if max_gap is not None and self.timed:
            unknown |= np.diff(self.rotor.stamp) > max_gap
        return np.append(0, 1 + np.flatnonzero(unknown))


def match(
    rotor: Array, measured: Array, max_gap: float = np.inf
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Find the rotor samples around each measured angle by their stamps, ns; the rotor's in order.

    Returns `before` and `share` of the angles between rotor samples at most `max_gap` apart, ns;
    and which angles these are.
    """
    before = np.searchsorted(rotor, measured, side='right') - 1
    inside = (before >= 0) & (measured <= rotor[-1])
    before = np.clip(before, 0, max(len(rotor) - 2, 0))
    step = rotor[np.minimum(before + 1, len(rotor) - 1)] - rotor[before]
    inside &= step <= max_gap
    before, step = before[inside], np.maximum(step[inside], 1)
    return before, (measured[inside] - rotor[before]) / step, inside


@dataclass(frozen=True, eq=False)
class Recording:
    """Contents of a recording: angles under torque, both encoders, or all of these."""

    path: Path
    name: str
    columns: tuple[str, ...]  #: descriptions of the data that were read
    rows: int  #: number of samples read
    encoders: Encoders | None = None
    locked: Loading | None = None  #: angles under torque without an encoder at the output
    remarks: tuple[Observed, ...] = ()  #: what was left out or assumed
    damage: str | None = None  #: damage at which reading ended
    faults: tuple[Observed, ...] = ()  #: what cannot be true, such as a slip, and when it was
    rotor_messages: TopicMessages | None = None  #: first messages of a bag read as recorded

    @property
    def both(self) -> Encoders:
        """Both encoders; RecordingError if they were not recorded."""
        if self.encoders is None:
            raise RecordingError(
                f'{self.path}: not both a rotor and an output among the columns; name them with '
                '--rotor-column and --output-column'
            )
        return self.encoders

    @property
    def computed(self) -> Observed | None:
        """The fault that the output was computed from the rotor, if it shows."""
        return next((f for f in self.faults if f.what is Observation.COMPUTED), None)

    @property
    def sentences(self) -> list[str]:
        """Sentences on faults, on what was left out or assumed, and on damage."""
        damage = [f'{self.damage}; what is before it is used'] if self.damage else []
        return [f'{clause}.' for clause in (*self.faults, *self.remarks, *damage)]

    def loading(self, ratio: Fraction) -> Loading | None:
        """Torque and twist, of the gear if the output was measured, otherwise of the drive."""
        both = self.encoders
        if both is None:
            return self.locked
        torque, twist = float(ratio) * both.at_measured(both.rotor.effort), -both.error(ratio)
        if both.wound_up(ratio) and np.cov(torque, twist)[0, 1] < 0.0:
            twist = -twist  # the torque is that of the load, against the gear's
        known, step = np.isfinite(torque), both.error_step(ratio)
        found = Loading(torque, twist, both.moment, both.timed, step, measured=True)
        return found.chosen(known) if known.any() else None

    @cached_property
    def sha256(self) -> str:
        """Hash of the file, or of all files in the folder in the order of their names."""
        total = hashlib.sha256()
        files = sorted(self.path.rglob('*')) if self.path.is_dir() else [self.path]
        for file in filter(Path.is_file, files):
            with file.open('rb') as content:
                hashlib.file_digest(content, lambda: total)
        return total.hexdigest()
