# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The transmission error of a recording over the output angle: accuracy and lost motion."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.measurement.recording import Array, Encoders, RecordingError
from gear_kinematics.measurement.two_encoders import STEP, EncoderFit, directions
from gear_kinematics.statistics.uncertainty import Component, Estimate, resolution

_CROSSED = 1.2  # times the lost motion: travel after a reversal in which it is certainly crossed
_MIN_SHARE = 0.5  # share of the longest run from which on other runs count as its repeats


@dataclass(frozen=True, eq=False, slots=True)
class TransmissionFigures:
    """Results of a recording of both encoders; angles in rad."""

    travel: float  #: range of the output angle
    offset: float  #: the mean error: the offset of the encoders' zeros
    forward: Estimate | None  #: accuracy: peak-to-peak error of forward runs without a reversal
    backward: Estimate | None
    reversals: Estimate | None  #: error backward minus forward at the same angles, if any
    lost_motion: Estimate | None  #: the same without the delay; None if inseparable from it
    delay: Estimate | None  #: of the output's stamps, s or rows, removed if clear; None if unknown
    error: Array  #: (n,), measured minus ideal
    angle: Array  #: (n,), ideal, of the output
    direction: NDArray[np.int8]  #: (n,): 1, -1, or 0 if unknown


class _Motion:
    """The transmission error along the runs between reversals."""

    def __init__(self, encoders: Encoders, ratio: Fraction, travel: float) -> None:
        ideal = encoders.ideal(ratio)
        self.angle = encoders.at_measured(ideal)
        self.error = encoders.error(ratio)
        known = directions(ideal, travel, set(encoders.starts(None).tolist()))
        after = known[np.minimum(encoders.before + (encoders.share > 0.0), len(known) - 1)]
        self.direction = np.where(known[encoders.before] == after, after, 0).astype(np.int8)

    def runs(self) -> Iterator[tuple[int, Array]]:
        """Yield the direction of each run between reversals, and its rows."""
        known = np.flatnonzero(self.direction)
        signs = self.direction[known]
        for rows in np.split(known, np.flatnonzero(np.diff(signs)) + 1):
            if len(rows) > 1:
                yield int(self.direction[rows[0]]), rows

    def fits(self, encoders: Encoders, ratio: Fraction) -> list[EncoderFit]:
        """Fit both encoders, also with a delay if separable; no fit if too few samples move."""
        time = encoders.seconds * (1.0 if encoders.timed else STEP)
        angles = self.angle * float(ratio), self.angle + self.error, time, self.direction
        try:
            fit = EncoderFit(*angles, float(1 / ratio))
            return [fit, fit.refined().refined()] if fit.tells_delay else [fit]
        except RecordingError:
            return []

    def accuracy(self, sign: int, reading: Component) -> Estimate | None:
        """Estimate the peak-to-peak error of the longest run in a direction and of its repeats."""
        runs = [rows for direction, rows in self.runs() if direction == sign]
        sizes = [(np.ptp(self.angle[rows]), float(np.ptp(self.error[rows]))) for rows in runs]
        least = _MIN_SHARE * max(sizes)[0] if sizes else 0.0
        values = [error for travel, error in sizes if travel >= least]
        return Estimate.of_mean(values, reading) if values else None


def transmission_figures(
    encoders: Encoders, ratio: Fraction, travel: float
) -> TransmissionFigures:
    """Compute the figures of a recording; a clear delay is removed first.

    A new direction counts from a `travel` of the output, rad, after the reversal, or later where
    more than that is lost on reversals.
    """
    both = Component(math.sqrt(2.0) * resolution(encoders.error_step(ratio).size))
    motion = _Motion(encoders, ratio, travel)
    pairs = sum(1 for _ in motion.runs()) // 2
    difference = lost_motion = delay = even = None
    if pairs and (fits := motion.fits(encoders, ratio)):
        difference = replace(fits[0].lost_motion(both, delay=False), repeats=pairs)
        for fit in fits[1:]:
            delay = replace(fit.delay(1.0 if encoders.timed else 1.0 / STEP), repeats=pairs)
            lost_motion, even = (fit.lost_motion(both, delay=True, even=e) for e in (False, True))
            if not delay.clear:  # there may be no delay
                off = abs(lost_motion.value - difference.value) / math.sqrt(3.0)
                lost_motion = fit.lost_motion(both, Component(off), delay=True)
            lost_motion = replace(lost_motion, repeats=pairs)
    lost = even or difference  # until play is crossed, it seems to vary
    if lost and travel < lost.value < math.inf:
        further = transmission_figures(encoders, ratio, _CROSSED * lost.value)
        if further.reversals:
            return further
    if delay and delay.clear:
        # The error is proportional to the delay only while the speed hardly changes within it.
        motion = _Motion(encoders.earlier(delay.value), ratio, travel)
    forward, backward = (motion.accuracy(sign, both) for sign in (1, -1))
    error = max(one.value if one else 0.0 for one in (forward, backward))
    return TransmissionFigures(
        float(np.ptp(motion.angle)),
        float(np.mean(motion.error)),
        forward,
        backward,
        _meaningful(difference, error),
        _meaningful(lost_motion, error),
        delay,
        motion.error,
        motion.angle,
        motion.direction,
    )


def _meaningful(lost: Estimate | None, error: float) -> Estimate | None:
    """Return what is lost on reversals, unless its ± exceeds both it and the error."""
    beyond = lost and math.inf > lost.expanded > max(abs(lost.value), error)
    return None if beyond else lost
