# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Steps of the error, the output less the rotor over their ratio, that no gear can make."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.measurement.ramp_gate import shifted, usual
from gear_kinematics.measurement.recording import Array
from gear_kinematics.measurement.two_encoders import directions

_STEPS = 12.0  # times the 98 % quantile of steps of the error: beyond the error of any gear
_LEAST_STEP = math.radians(0.25)
_SPIKE, _LEAST_SPIKE, _WINDOW = 20.0, math.radians(0.02), 5
"""Times the 90 % quantile of the distance from the medians of neighbours, and least distance, rad,
that shows a stray reading; number of these neighbours on either side."""
_REVERSAL = 4  # samples around a reversal in which the output may lag
_DELAYED = 1.1  # times the greatest change of the error that a delay explains
_MOST_LOST = math.radians(5.0)  # lost motion of a usable gear, at most
_LIKELY, _TRIED = 4.0, 8
"""Times that quantile from which on a step may be a slip; number of such steps that are tried."""
_MOST_OF, _DOUBTFUL = 0.6, 0.8  # shares of a slip that stay; the latter if it may be a delay
_LEAST_SLIP = math.radians(0.08)
_PLACE = math.radians(2.0)  # width of the bins of output angles at which errors are compared
_READINGS = 1.5  # times the step between readings: the error steps by one, and by noise
_MOST_FAULTS = 0.02  # of the steps: more show a unit or a range that is not understood


class Steps(NamedTuple):
    """Steps of the error that no gear can make, (m - 1,)."""

    impossible: NDArray[np.bool_]
    slipped: NDArray[np.bool_]  # those of them that are permanent, however small
    limit: float  # greatest step of a gear, rad
    late: Array  # (m,), rad: change of the error by a late encoder
    spikes: NDArray[np.bool_]  # (m,): stray readings that are no such steps
    leaps: Array  # (m,), rad: by how far readings leave those before and after, to the same side


class IdealMotion(NamedTuple):
    """The ideal motion of the output in m samples."""

    ideal: Array  # (m,), rad
    calm: Array  # (m,), rad: its running median, without stray readings
    spans: Array  # (m - 1,): times between the samples, in usual periods, at least 1
    delay: float  # usual periods by which either encoder may be late

    def late_at(self, rows: Array, spans: Array | int) -> Array:
        """Return the greatest change of the error by a delay around rows, within spans, rad."""
        around = _REVERSAL + math.ceil(self.delay)
        speeds = np.pad(np.diff(self.calm), around)
        near = np.lib.stride_tricks.sliding_window_view(speeds, 2 * around + 1)[rows]
        return np.asarray(_DELAYED * np.minimum(self.delay, spans) * np.ptp(near, axis=1))

    def reversals(self, around: int) -> tuple[NDArray[np.bool_], Array]:
        """Find the steps with a reversal in so many samples around, (m - 1,).

        A recording may begin and end with one. Also returns the sum of the signs of as many steps
        from each one on.
        """
        signs = np.pad(np.sign(np.diff(self.ideal)), around)
        sums = np.convolve(signs, np.ones(around), 'valid')
        before, after = sums[: -around - 1], sums[around:-1]
        reverses: NDArray[np.bool_] = before * after <= 0.0
        reverses[:around] = reverses[-around:] = True
        return reverses, after

    def lost(self) -> tuple[Array, Array]:
        """Return by how far the output may lag in steps after a reversal, rad, and directions.

        The directions, (m - 1,), are those of the motion there, and 0 elsewhere.
        """
        moved = np.diff(self.ideal)
        near, after = self.reversals(_REVERSAL)
        near |= directions(self.ideal, _MOST_LOST)[1:] == 0
        ways = np.where(near, np.sign(np.where(after, after, moved)), 0.0)
        # A stray reading of the rotor moves further than the rotor usually, and than it around.
        path = np.pad(self.calm, _WINDOW, 'edge')
        paces = np.abs(path[_WINDOW:] - path[:-_WINDOW]) / _WINDOW
        fastest = np.maximum(paces[: len(moved)], paces[_WINDOW + 1 :])
        fastest = np.maximum(fastest, np.quantile(np.abs(np.diff(self.calm)), 0.98))
        # Where it turns back within a step, as where samples are lost, it has moved further.
        moved[1:-1][moved[:-2] * moved[2:] <= 0.0] = math.inf
        return 1.1 * np.minimum(np.abs(moved), self.spans * fastest), ways


def impossible_steps(error: Array, motion: IdealMotion, reading: float = 0.0) -> Steps | None:
    """Find the steps of the error, (m,), rad, that no gear makes; None if there are too many.

    A `reading` is the step between readings of the error, rad: it shows in few samples where the
    shafts turn by nearly whole steps in each period.
    """
    least = _READINGS * reading
    level = usual(error)
    calm, steps = np.diff(level), np.diff(error)
    usually = float(np.quantile(np.abs(calm), 0.98))
    limit = max(_STEPS * usually, _LEAST_STEP, least)
    lag, ways = motion.lost()
    lost, lags = (((each := -own * ways) > 0.0) & (each <= lag) for own in (calm, steps))
    if np.mean((np.abs(calm) > limit) & ~lost) > _MOST_FAULTS:
        return None
    # Lost motion lasts until the next reversal; what comes back at once is a stray reading.
    most = min(1.1 * float(np.max(np.abs(calm), where=lost, initial=0.0)), _MOST_LOST)
    beyond = (np.abs(steps) > limit) & ~(lags & (np.abs(steps) <= most))
    reverses, _ = motion.reversals(_REVERSAL + math.ceil(motion.delay))
    rows = np.flatnonzero(reverses & beyond)
    beyond[rows] = np.abs(steps[rows]) > limit + motion.late_at(rows, motion.spans[rows])
    slipped = _slipped(level, max(_LIKELY * usually, _LEAST_SLIP, least), reverses, motion)
    late = _DELAYED * motion.delay * np.gradient(motion.calm)
    return Steps(
        beyond | slipped, slipped, limit, late, *_spikes(error, level, least, reverses, motion)
    )


def _slipped(
    error: Array, least: float, reverses: NDArray[np.bool_], motion: IdealMotion
) -> NDArray[np.bool_]:
    """Find steps of the error after which it differs at all angles, in both directions, (m - 1,).

    The error, without stray readings, is (m,), rad; slips are more than `least`, rad; `reverses`,
    (m - 1,), says which steps are close to a reversal.
    """
    steps, ideal = np.diff(error), motion.ideal
    found = np.zeros(len(steps), bool)
    likely = np.flatnonzero(np.abs(steps) > least)
    if not len(likely):
        return found
    likely = likely[np.argsort(-np.abs(steps[likely]))][:_TRIED]
    late = np.abs(steps[likely]) <= motion.late_at(likely, motion.spans[likely])
    needed, kept = 1 + (reverses[likely] | late), np.where(late, _DOUBTFUL, _MOST_OF)
    way = directions(ideal, _PLACE)
    place = np.round(ideal / _PLACE) + 1j * way
    for row, ways, share in zip(likely.tolist(), needed, kept, strict=True):
        shifts = shifted(place, error, slice(0, row + 1), slice(row + 1, len(error)))
        shares = shifts / steps[row]
        if not len(shares) and way[row] == way[row + 1] != 0:
            # What the gear does at an angle, it does there on the way back, too.
            there = np.abs(ideal - ideal[row]) < _PLACE
            passes = [_rise(error, ideal - ideal[row], there & (way == w)) for w in (-1, 1)]
            shares = np.diff(passes) / steps[row]
        # A delay changes the error with the speed, too, but hardly alike in both directions.
        enough = len(shares) >= ways
        found[row] = enough and shares.min() > share and shares.max() < 1.0 / share
    return found


def _rise(error: Array, beyond: Array, rows: NDArray[np.bool_]) -> float:
    """Return the median change of the error in `rows` as the angle passes 0, rad, or NaN."""
    parts = [error[rows & side] for side in (beyond <= 0.0, beyond > 0.0)]
    low, high = (float(np.median(part)) if len(part) else math.nan for part in parts)
    return high - low


def _spikes(
    error: Array, level: Array, least: float, reverses: NDArray[np.bool_], motion: IdealMotion
) -> tuple[NDArray[np.bool_], Array]:
    """Find readings that leave the five before and the five after, however slow the motion, (m,).

    They leave both to the same side, unlike those in which play is crossed, and by more than a
    delay explains. At a reversal, play and a delay together do the same. Also returns by how far
    all readings leave both, (m,), rad. The `level` of the error is its running median, (m,), rad.
    """
    far = _WINDOW // 2 + 1
    level = np.pad(level, far, 'edge')
    before, after = error - level[: -2 * far], error - level[2 * far :]
    off = np.minimum(np.abs(before), np.abs(after))
    leaps = np.where(before * after > 0.0, np.copysign(off, before), 0.0)
    off *= ~np.append(reverses, True)
    most = max(_SPIKE * float(np.quantile(off, 0.9)), _LEAST_SPIKE, least)
    found: NDArray[np.bool_] = (off > most) & (leaps != 0.0)
    rows = np.flatnonzero(found)
    found[rows] = off[rows] > most + motion.late_at(rows, _WINDOW)
    return found, leaps
