# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Removal of readings of two encoders that cannot both be true, before anything is fitted.

The error, the output less the rotor over their ratio, changes little between samples. Where it
leaves and comes back, the readings between are left out. Where it stays away, as after a slip, the
recording is divided, and the longest part is used.
"""

import math
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.ramp_gate import jumped, left_out, longest, shifted, usual
from gear_kinematics.measurement.recording import Array, Encoders, Recording, RotorMotion
from gear_kinematics.measurement.sentences import NAMED, Observation, Observed
from gear_kinematics.measurement.two_encoders import directions, output_by_rotor
from gear_kinematics.report.document import number

_FEWEST = 50  # samples
_LEAST_TRAVEL = math.radians(3.0)  # of the output, from which on the ratio shows
_STEPS = 12.0  # times the 98 % quantile of steps of the error: beyond the error of any gear
_LEAST_STEP = math.radians(0.25)
_SPIKE, _LEAST_SPIKE, _WINDOW = 20.0, math.radians(0.02), 5
"""Times the 90 % quantile of the distance from the medians of neighbours, and least distance, rad,
that shows a stray reading; number of these neighbours on either side."""
_STAYS = 4  # samples in a row that are no stray reading
_REVERSAL = 4  # samples around a reversal in which the output may lag
_DELAY = 0.01  # s, by which either encoder may be late, so that its speed changes later
_ALIKE, _SHORTEST = 16, 1e-6
"""Number of samples in a row that may have the same time; shortest period of samples, s."""
_MOST_LOST = math.radians(5.0)  # lost motion of a usable gear, at most
_LIKELY, _TRIED, _MOST_OF = 4.0, 8, 0.6
"""Times that quantile from which on a step may be a slip; number of such steps that are tried;
share of the step that stays."""
_LEAST_SLIP = math.radians(0.08)
_PLACE = math.radians(2.0)  # width of the bins of output angles at which errors are compared
_FROZEN = math.radians(3.0)  # motion of the output by one encoder while the other stands still
_LEAST_SHARE = 0.25  # of samples that are used; if it were less, the ratio is not understood
_CLEAR = 4.0  # times the limit of a step: slips are clear, however short the parts between them
_MOST_FAULTS = 0.02  # of the steps: more show a unit or a range that is not understood
_RANGE = 0.9  # share of its travel by which the rotor steps where its encoder wraps
NO_ENCODER = 2e-6
"""rad, peak to peak, 0.4 arc seconds: no gear with an encoder at its output deviates by less."""


class _Compared(NamedTuple):
    """The error in the m rows in which both shafts moved or both stood; (m,), rad."""

    rows: Array  # indices of these rows among the n rows of the recording
    frozen: NDArray[np.bool_]  # (n,): rows in which one shaft stood still while the other moved
    rotor: Array
    ideal: Array  # output angle that the rotor implies
    error: Array  # measured minus ideal output angle, without wraps
    path: Array  # output angle that each sample of the rotor implies
    period: float  # change of the error where an encoder wraps


class _Steps(NamedTuple):
    """Steps of the error that no gear can make, (m - 1,)."""

    impossible: NDArray[np.bool_]
    slipped: NDArray[np.bool_]  # those of them that are permanent, however small
    limit: float  # greatest step of a gear, rad
    spikes: NDArray[np.bool_]  # (m,): stray readings that are no such steps


def gated(recording: Recording) -> Recording:
    """Leave out readings that contradict each other, and say when they were.

    If there are none, or the output hardly moves, the recording itself is returned.
    """
    both = recording.encoders
    if both is None or len(both.measured) < _FEWEST or not (compared := _compared(both)):
        return recording
    rows, error, rotor, samples = compared.rows, compared.error, compared.rotor, len(both.measured)
    line = np.polynomial.Polynomial.fit(rotor, error, 1)
    if (rest := float(np.ptp(error - line(rotor)))) < NO_ENCODER:
        fault = Observation.COMPUTED(deviation=rest)
        return replace(recording, faults=(*recording.faults, fault))
    if not (steps := _steps(error, compared.ideal, _DELAY / _period(both.seconds))):
        return recording
    # A stray reading of the rotor shows in all rows that are interpolated from it.
    shown = 2 * samples / len(both.rotor.stamp) if both.interpolated else 1.0
    stays = math.ceil(_STAYS * max(1.0, shown))
    kept, jumps = _followed(error, rows, steps, compared.period, stays)
    kept = kept[~steps.spikes[kept]]
    at, path = np.array(jumps, int), compared.path
    around = (path[a : b + 2] for a, b in both.before[rows[np.array([at - 1, at])]].T.tolist())
    if any(np.ptp(each) > _RANGE * np.ptp(path) for each in around):
        return recording  # the range of the encoder is not a turn
    sizes = error[at] - error[at - 1]
    clear = len(at) and np.abs(sizes).min() > _CLEAR * steps.limit
    least = _FEWEST if clear else _LEAST_SHARE * samples
    if len(kept) == samples or len(kept) < least:
        return recording
    kept = rows[kept]
    stray = np.setdiff1d(np.arange(kept[0], kept[-1] + 1), kept)
    time = both.moment
    found = []
    isolated = stray[~compared.frozen[stray]]
    if len(isolated):
        found.append(left_out(time[isolated], timed=both.timed))
    if len(still := np.flatnonzero(compared.frozen)):
        found.append(_stood_still(time, still, timed=both.timed))
    moments = zip(time[rows[at]].tolist(), sizes.tolist(), strict=True)
    found += jumped([*moments], timed=both.timed)
    if kept[0] or kept[-1] + 1 < samples:
        found.append(longest(time[kept], timed=both.timed))
    encoders = _without(both, compared.path, kept, stray)
    return replace(recording, encoders=encoders, faults=(*recording.faults, *found))


def _period(seconds: Array) -> float:
    """Return the usual time between samples, s, of which some can have the same time."""
    usual = np.median(seconds[_ALIKE:] - seconds[:-_ALIKE]) / _ALIKE
    return max(float(usual), _SHORTEST)


def _compared(both: Encoders) -> _Compared | None:
    """Compare both encoders by the ratio that they show; None if they show none."""
    turned = both.rotor.turned
    wraps = np.ptp(turned) <= TURN  # the encoder may count only within a turn
    turned = np.unwrap(turned) if wraps else turned
    rotor, output = both.at_measured(turned), np.unwrap(both.measured)
    slope = output_by_rotor(rotor, output)
    if np.array_equal(both.measured, np.round(both.measured)):  # counts in an unknown unit
        return None
    if slope is None or abs(slope) * np.ptp(rotor) < _LEAST_TRAVEL:
        return None
    ideal = slope * rotor
    frozen = _frozen(both.measured, usual(ideal)) | _frozen(ideal, usual(output))
    rows = np.flatnonzero(~frozen)
    if len(rows) < _FEWEST:
        return None
    error = (both.measured - ideal)[rows]
    periods = (TURN, abs(slope) * TURN) if wraps else (TURN,)
    for period in periods:
        error -= period * np.cumsum(np.round(np.diff(error, prepend=error[0]) / period))
    return _Compared(rows, frozen, rotor[rows], ideal[rows], error, slope * turned, periods[-1])


def _steps(error: Array, ideal: Array, delay: float) -> _Steps | None:
    """Find the steps of the error that no gear can make; None if there are too many.

    The error and the ideal output angle, (n,) each, are in rad, a delay in samples.
    """
    level, moved = usual(error), np.diff(ideal)
    calm = np.diff(level)
    fastest = float(np.quantile(np.abs(np.diff(usual(ideal))), 0.98))
    usually = float(np.quantile(np.abs(calm), 0.98))
    limit = max(_STEPS * usually, _LEAST_STEP)
    lost = _lost_motion(calm, moved, fastest)
    if np.mean((np.abs(calm) > limit) & ~lost) > _MOST_FAULTS:
        return None
    steps = np.diff(error)
    # Lost motion lasts until the next reversal; what comes back at once is a stray reading.
    most = min(1.1 * float(np.max(np.abs(calm), where=lost, initial=0.0)), _MOST_LOST)
    lost = _lost_motion(steps, moved, fastest) & (np.abs(steps) <= most)
    reverses, _ = _reversals(moved, _REVERSAL + math.ceil(delay))
    rows = np.flatnonzero(reverses & (np.abs(steps) > limit) & ~lost)
    lost[rows] = np.abs(steps[rows]) <= _delayed(ideal, rows, delay)
    slipped = _slipped(level, ideal, usually, reverses)
    spikes = _spikes(error, ideal, reverses, delay)
    return _Steps(((np.abs(steps) > limit) & ~lost) | slipped, slipped, limit, spikes)


def _stood_still(time: Array, still: Array, *, timed: bool) -> Observed:
    times = np.split(time[still], 1 + np.flatnonzero(np.diff(still) > 1))
    unit = ' s' if timed else ''
    spans = [f'{number(each[0], 6)} to {number(each[-1], 6)}{unit}' for each in times]
    more = len(spans[NAMED:])
    return Observation.STOOD_STILL(spans=spans[:NAMED], more=more, count=len(still))


def _frozen(still: Array, other: Array) -> NDArray[np.bool_]:
    """Find the rows in which one shaft stands still while the other one moves far, (n,)."""
    ends = np.flatnonzero(np.diff(still, prepend=np.nan, append=np.nan))
    found = np.zeros(len(still), bool)
    (long,) = np.nonzero(np.diff(ends) >= _STAYS)
    for begin, end in zip(ends[long].tolist(), ends[long + 1].tolist(), strict=True):
        if np.ptp(other[begin:end]) > _FROZEN:
            found[begin:end] = True
    return found


def _lost_motion(steps: Array, ideal: Array, fastest: float) -> NDArray[np.bool_]:
    """Find the steps of the error, rad, by which the output lags at a reversal of the rotor."""
    moved = np.abs(ideal)
    # Where a sample is missing at the reversal, the motion there and back is one step.
    moved[1:-1] = np.maximum(moved[1:-1], np.minimum(moved[:-2], moved[2:]))
    most = np.minimum(moved, fastest)
    reverses, after = _reversals(ideal, _REVERSAL)
    lag = -steps * np.where(after, np.sign(after), np.sign(ideal))
    lost: NDArray[np.bool_] = reverses & (lag > 0.0) & (lag <= 1.1 * most)
    return lost


def _reversals(ideal: Array, around: int) -> tuple[NDArray[np.bool_], Array]:
    """Find steps of the ideal output angle, rad, with a reversal in so many samples around.

    A recording may begin and end with one. Also returns the sum of the signs of as many steps from
    each one on.
    """
    signs = np.concatenate([np.zeros(around), np.sign(ideal), np.zeros(around)])
    sums = np.convolve(signs, np.ones(around), 'valid')
    before, after = sums[: len(ideal)], sums[around : around + len(ideal)]
    reverses: NDArray[np.bool_] = before * after <= 0.0
    reverses[:around] = reverses[-around:] = True
    return reverses, after


def _delayed(ideal: Array, rows: Array, delay: float) -> Array:
    """Greatest change of the error, rad, around rows by a delay, in samples, of an encoder."""
    around = _REVERSAL + math.ceil(delay)
    speeds = np.pad(np.diff(usual(ideal)), around)
    near = np.lib.stride_tricks.sliding_window_view(speeds, 2 * around + 1)
    return np.asarray(1.1 * delay * np.ptp(near[rows], axis=1))


def _slipped(
    error: Array, ideal: Array, usually: float, reverses: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Find steps of the error after which it differs at all angles, in both directions, (n - 1,).

    The error, without stray readings, and the ideal output angle are (n,), rad; `usually` is the
    98 % quantile of the steps, rad; `reverses`, (n - 1,), says which are close to a reversal.
    """
    steps = np.diff(error)
    found = np.zeros(len(steps), bool)
    likely = np.flatnonzero(np.abs(steps) > max(_LIKELY * usually, _LEAST_SLIP))
    if not len(likely):
        return found
    way = directions(ideal, _PLACE)
    place = np.round(ideal / _PLACE) + 1j * way
    for row in likely[np.argsort(-np.abs(steps[likely]))][:_TRIED].tolist():
        shifts = shifted(place, error, slice(0, row + 1), slice(row + 1, len(error)))
        shares = shifts / steps[row]
        if not len(shares) and way[row] == way[row + 1] != 0:
            # What the gear does at an angle, it does there on the way back, too.
            there = np.abs(ideal - ideal[row]) < _PLACE
            passes = [_rise(error, ideal - ideal[row], there & (way == w)) for w in (-1, 1)]
            shares = np.diff(passes) / steps[row]
        # In one direction alone, a delay changes the error with the speed, too.
        enough = len(shares) >= (2 if reverses[row] else 1)
        found[row] = enough and shares.min() > _MOST_OF and shares.max() < 1.0 / _MOST_OF
    return found


def _rise(error: Array, beyond: Array, rows: NDArray[np.bool_]) -> float:
    """Return the median change of the error in `rows` as the angle passes 0, rad, or NaN."""
    parts = [error[rows & side] for side in (beyond <= 0.0, beyond > 0.0)]
    low, high = (float(np.median(part)) if len(part) else math.nan for part in parts)
    return high - low


def _followed(
    error: Array, rows: Array, steps: _Steps, period: float, stays: int
) -> tuple[Array, list[int]]:
    """Follow the error from its longest part without an impossible step, in both directions.

    It jumps where it `stays` elsewhere for so many rows. After a gap, the error may also have
    changed by its range in that part. Returns the indices that are reached, without stray
    readings, and those before which the error jumps for good.
    """
    edges = [0, *(1 + np.flatnonzero(steps.impossible)).tolist(), len(error)]
    parts = list(pairwise(edges))
    longest = max(range(len(parts)), key=lambda k: parts[k][1] - parts[k][0])
    kept, jumps = [np.arange(*parts[longest])], []
    spread = float(np.ptp(error[kept[0]]))
    for step, others in ((1, parts[longest + 1 :]), (-1, parts[:longest][::-1])):
        last = parts[longest][1] - 1 if step > 0 else parts[longest][0]
        reached, beyond = error[slice(*parts[longest])][::-step][:stays], False
        for begin, end in others:
            near, far = (begin, end - 1) if step > 0 else (end - 1, begin)
            gap = abs(rows[near] - rows[last]) > _STAYS
            # The interpolation mixes some of a stray rotor reading into its neighbours.
            level = np.median(error[begin:end][::step][:stays])
            place = begin if step > 0 else end
            off = abs(math.remainder(level - np.median(reached), period))
            moved = off > steps.limit + spread * gap
            if moved or steps.slipped[place - 1]:
                if end - begin < stays and not steps.slipped[place - 1]:
                    continue
                jumps.append(place)
                beyond, reached = True, reached[:0]
            if not beyond:
                kept.append(np.arange(begin, end))
            last = far
            reached = np.concatenate([error[begin:end][::-step], reached])[:stays]
    return np.sort(np.concatenate(kept)), sorted(jumps)


def _spikes(
    error: Array, ideal: Array, reverses: NDArray[np.bool_], delay: float
) -> NDArray[np.bool_]:
    """Find readings that leave the five before and the five after, however slow the motion, (n,).

    They leave both to the same side, unlike those in which play is crossed, and by more than a
    delay explains. At a reversal, play and a delay together do the same.
    """
    level, far = usual(error), _WINDOW // 2 + 1
    level = np.pad(level, far, 'edge')
    before, after = error - level[: -2 * far], error - level[2 * far :]
    off = np.minimum(np.abs(before), np.abs(after)) * ~np.append(reverses, True)
    most = max(_SPIKE * float(np.quantile(off, 0.9)), _LEAST_SPIKE)
    found: NDArray[np.bool_] = (off > most) & (before * after > 0.0)
    rows = np.flatnonzero(found)
    found[rows] = off[rows] > most + _delayed(ideal, rows, delay)
    return found


def _without(both: Encoders, rotor: Array, kept: Array, stray: Array) -> Encoders:
    """Keep some rows, and the rotor's samples around them that are not stray themselves."""
    measured = both.measured
    bad = np.zeros(len(rotor), bool)
    for row in stray.tolist():
        place = int(np.searchsorted(kept, row))
        early, late = kept[place - 1], kept[place]
        share = (both.seconds[row] - both.seconds[early]) / max(
            both.seconds[late] - both.seconds[early], 1e-9
        )
        line = measured[early] + share * (measured[late] - measured[early])
        begin, end = both.before[early], min(both.before[late] + 1, len(rotor) - 1)
        seconds = both.rotor.seconds[begin : end + 1]
        path = np.interp(seconds, seconds[[0, -1]], rotor[[begin, end]])
        off = np.abs(rotor[begin : end + 1] - path)
        if off.max() > abs(math.remainder(measured[row] - line, TURN)):
            bad[begin : end + 1] |= off > 0.5 * off.max()
    good = ~bad
    first, last = both.before[kept[0]], min(both.before[kept[-1]] + 1, len(rotor) - 1)
    good[:first] = good[last + 1 :] = False
    after = np.minimum(both.before + 1, len(rotor) - 1)
    kept = kept[good[both.before[kept]] & (good[after[kept]] | (both.share[kept] == 0.0))]
    places = np.cumsum(good) - 1
    return replace(
        both,
        rotor=RotorMotion._make(each[good] for each in both.rotor),
        before=places[both.before[kept]],
        share=both.share[kept],
        measured=measured[kept],
        start=both.start + float(both.rotor.seconds[good][0]),
    )
