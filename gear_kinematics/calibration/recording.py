"""The encoders of rotor and output as they were recorded, whatever the file format."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

MOST = 400_000
"""Measured angles that are used, of all recordings; more would only take time."""
_SPEED_WINDOW = 0.02
"""s, over which the speed is averaged."""
_SEED = 13


class RecordingError(ValueError):
    """Recordings that cannot be calibrated from; the text is one line on the cause."""


class RotorMotion(NamedTuple):
    """The rotor's samples in the order of time, (n,) each."""

    stamp: Array
    """ns; the number of the sample if time was not recorded."""
    turns: Array
    angle: Array
    """rad: the rotor angle φ2 is 2π turns + angle."""
    effort: Array | None = None
    """N·m; None if it was not recorded throughout."""
    stretch: Array | None = None
    """Number that changes where the motion before a sample is unknown; None: nowhere."""


@dataclass(frozen=True, eq=False, slots=True)
class Recording:
    """Measured output angles, each with the motion of the rotor up to it."""

    name: str
    sha256: str
    rotor: RotorMotion
    timed: bool
    """Whether stamps are times."""
    separate: bool
    """Whether rotor and output have their own stamps, so that these can be late."""
    before: Array
    """(n,): index of the last rotor sample before each measured angle."""
    share: Array
    """(n,): share of the way from there to the next rotor sample."""
    measured: Array
    """(n,), rad, without jumps by whole turns against the rotor."""
    remarks: tuple[str, ...] = ()
    """Sentences about what was left out."""

    @property
    def duration(self) -> float:
        """Time between the first and the last sample, s; 0 if not recorded."""
        stamp = self.rotor.stamp
        return float(stamp[-1] - stamp[0]) / SECOND if self.timed else 0.0

    @property
    def seconds(self) -> Array:
        """Times of the measured angles from the first rotor sample, s, or sample numbers."""
        seconds = (self.rotor.stamp - self.rotor.stamp[0]) / (SECOND if self.timed else 1)
        return self.at_measured(seconds)

    def at_measured(self, values: Array) -> Array:
        """Interpolate a quantity of the rotor to the measured angles."""
        following = np.minimum(self.before + 1, len(values) - 1)
        step = values[following] - values[self.before]
        interpolated: Array = values[self.before] + self.share * step
        return interpolated

    def position(self) -> tuple[Array, Array]:
        """Rotor angle at the measured angles: whole turns and the rest, rad."""
        _, turns, angle, *_ = self.rotor
        following = np.minimum(self.before + 1, len(turns) - 1)
        step = (turns[following] - turns[self.before]) * TURN
        step += angle[following] - angle[self.before]
        rest = angle[self.before] + self.share * step
        wraps = np.round(rest / TURN)
        return turns[self.before] + wraps, rest - TURN * wraps

    def ideal(self, ratio: Fraction) -> Array:
        """Ideal output angle of the rotor samples, rad, from the whole turns of the first one."""
        turns = self.rotor.turns - self.rotor.turns[0]
        output: Array = (turns * TURN + self.rotor.angle) * (ratio.denominator / ratio.numerator)
        return output

    def error(self, ratio: Fraction) -> Array:
        """Measured minus ideal output angle, rad, without jumps; its zero is arbitrary."""
        error = self.measured - self.at_measured(self.ideal(ratio))
        jumps = np.round(np.diff(error, prepend=error[0]) / TURN)
        return error - TURN * np.cumsum(jumps)

    def speed(self, ratio: Fraction) -> Array:
        """Speed of the output at the measured angles, rad/s; NaN if time was not recorded."""
        if not self.timed:
            return np.full(len(self.measured), np.nan)
        ideal = self.ideal(ratio)
        stamp = (self.rotor.stamp - self.rotor.stamp[0]) / SECOND
        at = self.seconds
        early = np.maximum(at - 0.5 * _SPEED_WINDOW, stamp[0])
        late = np.minimum(at + 0.5 * _SPEED_WINDOW, stamp[-1])
        # No less than the rotor's own samples on both sides.
        early = np.minimum(early, stamp[self.before])
        late = np.maximum(late, stamp[np.minimum(self.before + 1, len(stamp) - 1)])
        travel = np.interp(late, stamp, ideal) - np.interp(early, stamp, ideal)
        speed: Array = travel / np.maximum(late - early, 1.0 / SECOND)
        return speed

    def torque(self, ratio: Fraction) -> Array | None:
        """Torque at the output, N·m, at the measured angles; None if it was not recorded."""
        effort = self.rotor.effort
        return None if effort is None else float(ratio) * self.at_measured(effort)

    def earlier(self, delay: float) -> Self:
        """Return the recording with measured angles that were sampled earlier by a delay, s."""
        stamp = self.rotor.stamp[0] + np.round((self.seconds - delay) * SECOND).astype(np.int64)
        before, share, measured = match(self.rotor, (stamp, self.measured))
        return replace(self, before=before, share=share, measured=measured)

    def starts(self, max_gap: int | None) -> Array:
        """Indices of the rotor samples before which the motion is unknown, the first included.

        Args:
            max_gap: ns between rotor samples beyond which motion was missed.
        """
        unknown = np.zeros(len(self.rotor.turns), bool)
        unknown[0] = True
        if self.rotor.stretch is not None:
            unknown[1:] |= np.diff(self.rotor.stretch) != 0
        if max_gap is not None and self.timed:
            step = np.diff(self.rotor.stamp)
            unknown[1:] |= (step > max_gap) | (step < 0)
        return np.flatnonzero(unknown)


def match(
    rotor: RotorMotion, measured: tuple[Array, Array], max_gap: float = np.inf
) -> tuple[Array, Array, Array]:
    """Find the rotor samples around each measured angle.

    Args:
        rotor: in the order of its stamps.
        measured: stamps, ns, and angles, rad.
        max_gap: ns between rotor samples beyond which nothing is interpolated.

    Returns:
        `before`, `share` and `measured` of a `Recording`, for the angles that can be compared.

    Raises:
        RecordingError: if none can.
    """
    stamps, angles = measured
    before = np.searchsorted(rotor.stamp, stamps, side='right') - 1
    last = len(rotor.stamp) - 1
    inside = (before >= 0) & (stamps <= rotor.stamp[-1]) & np.isfinite(angles)
    before = np.clip(before, 0, max(last - 1, 0))
    step = rotor.stamp[np.minimum(before + 1, last)] - rotor.stamp[before]
    inside &= step <= max_gap
    if not inside.any():
        raise RecordingError('no output angle was measured between two samples of the rotor')
    before, step = before[inside], np.maximum(step[inside], 1)
    share = (stamps[inside] - rotor.stamp[before]) / step
    return before, share, angles[inside]


def spread(count: int, most: int = MOST) -> Array:
    """Choose some of many samples: one of each group of successive ones, at random.

    Even steps could hide an order.

    Args:
        count: of the samples.
        most: greatest number of samples to choose.

    Returns:
        Their indices, rising.
    """
    group = max(1, -(-count // most))
    starts = np.arange(0, count - group + 1, group)
    rows: Array = starts + np.random.default_rng(_SEED).integers(0, group, len(starts))
    return rows


def thinned(recordings: Sequence[Recording]) -> list[Recording]:
    """Leave out measured angles if there are very many; the rotor's motion stays as it is."""
    total = sum(len(recording.measured) for recording in recordings)
    if total <= MOST:
        return list(recordings)
    kept = []
    for recording in recordings:
        count = len(recording.measured)
        rows = spread(count, max(1, MOST * count // total))
        kept.append(
            replace(
                recording,
                before=recording.before[rows],
                share=recording.share[rows],
                measured=recording.measured[rows],
            )
        )
    return kept
