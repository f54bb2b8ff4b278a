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
from gear_kinematics.measurement.encoder_step import common_divisor
from gear_kinematics.measurement.error_steps import IdealMotion, Steps, impossible_steps
from gear_kinematics.measurement.ramp_gate import jumped, left_out, longest, usual
from gear_kinematics.measurement.recording import Array, Encoders, Recording, RotorMotion
from gear_kinematics.measurement.sentences import NAMED, Observation, Observed
from gear_kinematics.measurement.two_encoders import output_by_rotor
from gear_kinematics.report.document import number

_FEWEST = 50  # samples
_LEAST_TRAVEL = math.radians(3.0)  # of the output, from which on the ratio shows
_LEAST_READING = 1e-5  # rad, of a step of an encoder that matters
_STAYS = 4  # samples in a row that are no stray reading
_DELAY = 0.01  # s, by which either encoder may be late, so that its speed changes later
_ALIKE, _SHORTEST = 16, 1e-6
"""Number of samples in a row that may have the same time; shortest period of samples, s."""
_FROZEN = math.radians(3.0)  # motion of the output by one encoder while the other stands still
_LEAST_SHARE = 0.25  # of samples that are used; if it were less, the ratio is not understood
_CLEAR = 4.0  # times the limit of a step: slips are clear, however short the parts between them
_AROUND, _SAME_PASS, _NEAREST = 60, 25, 5
"""Samples on either side at a similar output angle that are compared with a stray reading, of
which so many around it are of its own pass; number of the nearest ones that decide."""
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
    period = _period(both.seconds)
    spans = np.maximum(np.diff(both.seconds[rows]) / period, 1.0)
    # Where its speed changes, the interpolated rotor is off as if late by a quarter of its period.
    delay = _DELAY + 0.25 * both.interpolated
    motion = IdealMotion(compared.ideal, usual(compared.ideal), spans, delay / period)
    steps = impossible_steps(error, motion)
    if steps and (steps.impossible.any() or steps.spikes.any()):
        # Unlike `output_step`, this is known in an even motion, too.
        reading = common_divisor(np.unique(both.measured), _LEAST_READING)
        steps = impossible_steps(error, motion, reading)
    if not steps:
        return recording
    # A stray reading of the rotor shows in all rows that are interpolated from it.
    shown = 2 * samples / len(both.rotor.stamp) if both.interpolated else 1.0
    stays = math.ceil(_STAYS * max(1.0, shown))
    kept, jumps = _followed(error, rows, steps, compared.period, stays)
    kept = kept[~steps.spikes[kept]]
    kept = np.union1d(kept, _of_gear(steps.leaps, compared.ideal, kept))
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


def _followed(
    error: Array, rows: Array, steps: Steps, period: float, stays: int
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
        reached, beyond = kept[0][::-step][:stays], False
        for begin, end in others:
            near, far = (begin, end - 1) if step > 0 else (end - 1, begin)
            gap = abs(rows[near] - rows[last]) > _STAYS
            # The interpolation mixes some of a stray rotor reading into its neighbours.
            ahead = np.arange(begin, end)[::step]
            level, late = (
                np.median(each[ahead[:stays]]) - np.median(each[reached])
                for each in (error, steps.late)
            )
            place = begin if step > 0 else end
            moved = abs(math.remainder(level, period)) > steps.limit + spread * gap + abs(late)
            if moved or steps.slipped[place - 1]:
                if end - begin < stays and not steps.slipped[place - 1]:
                    continue
                jumps.append(place)
                beyond, reached = True, reached[:0]
            if not beyond:
                kept.append(np.arange(begin, end))
            last = far
            reached = np.concatenate([ahead[::-1], reached])[:stays]
    return np.sort(np.concatenate(kept)), sorted(jumps)


def _of_gear(leaps: Array, ideal: Array, kept: Array) -> Array:
    """Find readings that are not kept, but leap, rad, as others do at the same output angle.

    As at a damaged tooth, most of the nearest ones of other passes leap like them.
    """
    stray = np.setdiff1d(np.arange(kept[0], kept[-1] + 1), kept)
    # A stray reading does not tell its own angle.
    angle = np.remainder(np.interp(np.arange(len(ideal)), kept, ideal[kept]), TURN)
    order = np.argsort(angle)
    places = np.searchsorted(angle[order], angle[stray])[:, np.newaxis]
    others = order[np.clip(places + np.arange(-_AROUND, _AROUND), 0, len(order) - 1)]
    apart = np.abs(angle[others] - angle[stray, np.newaxis])
    apart[np.abs(others - stray[:, np.newaxis]) < _SAME_PASS] = np.inf
    nearest = np.take_along_axis(others, np.argsort(apart, axis=1)[:, :_NEAREST], axis=1)
    left = np.abs(leaps[stray] - np.median(leaps[nearest], axis=1))
    return np.asarray(stray[left < 0.5 * np.abs(leaps[stray])])


def _without(both: Encoders, rotor: Array, kept: Array, stray: Array) -> Encoders:
    """Keep some rows, and the rotor's samples around them that are not stray themselves."""
    measured, time, of_rotor = both.measured, both.seconds, both.rotor.seconds
    bad = np.zeros(len(rotor), bool)
    for row in stray.tolist():
        place = int(np.searchsorted(kept, row))
        early, late = kept[place - 1], kept[place]
        share = (time[row] - time[early]) / max(time[late] - time[early], 1e-9)
        line = measured[early] + share * (measured[late] - measured[early])
        begin, end = both.before[early], min(both.before[late] + 1, len(rotor) - 1)
        seconds = of_rotor[begin : end + 1]
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
        start=both.start + float(of_rotor[good][0]),
    )
