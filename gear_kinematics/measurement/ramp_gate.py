# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Removal of stray readings, saturation and slips from torque ramps, before they are measured.

After a slip, the angle at the same torque differs.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.measurement.recording import Array, Loading
from gear_kinematics.measurement.sentences import NAMED, Observation, Observed
from gear_kinematics.measurement.two_encoders import directions

_FEWEST = 50  # samples
_WINDOW = 5  # samples, whose median one or two stray readings do not affect
_RAMP_STEPS = 25.0  # times the 98 % quantile of steps of medians; noisy torques reach 15
_LEAST_STRAY, _MOST_STRAY = 0.15, 0.1
"""Share of the range by which a stray reading leaves its neighbours, where noisy torques reach
0.09; greatest share of samples that are stray."""
_SLIP_STEPS, _LEAST_SLIP = 6.0, 0.1  # least slip: times the 98 % quantile of steps; share of range
_ALONE = 0.6  # least share that a slip has in the motion around it
_BEYOND = 1.5  # times the greatest step that comes back, as where play is crossed
_TURNED, _BIN = 0.05, 0.05  # shares of the greatest torque: change that is a reversal; bin width
_CAME_BACK, _MOST_SATURATED = 0.02, 0.5
"""Share of the range of the angle by which it comes back, unlike creep; greatest share of samples
that are saturated."""
_FEWEST_LEVELS = 10  # of a torque, of which the greatest is no saturation
_LOOP = 3  # reversals of the torque between which it takes each value in both directions
_MOST_KEPT = 2.0  # times a slip: greatest change of the angle behind it, in either direction
_LOADED = 0.5  # share of the torque beyond which no play is crossed; share of the angle's range


def gated_ramps(ramps: Loading) -> tuple[Loading, tuple[Observed, ...]]:
    """Leave out stray and saturated readings, and all but the longest part between slips.

    The rest is searched again until nothing more is found, as one fault can hide another. The
    ramps that remain are returned with what was left out.
    """
    timed = ramps.timed
    strays, saturated = list[float](), list[float]()
    searches = (_stray, _MOST_STRAY, strays), (_saturated, _MOST_SATURATED, saturated)
    jumps: list[tuple[float, float]] = []
    before = len(ramps.moment) + 1
    while _FEWEST <= len(ramps.moment) < before:
        before = len(ramps.moment)
        for find, most, moments in searches:
            found = find(ramps)
            if np.mean(found) <= most:
                moments.extend(ramps.moment[found].tolist())
                ramps = ramps.chosen(~found)
        if slips := _slips(ramps):
            jumps += [(float(ramps.moment[row]), size) for size, row in slips]
            edges = [0, *(row for _, row in slips), len(ramps.moment)]
            part = max(pairwise(edges), key=lambda part: part[1] - part[0])
            ramps = ramps.chosen(slice(*part))
    faults = [left_out(np.sort(strays), timed=timed)] if strays else []
    if saturated:
        first, count = min(saturated), len(saturated)
        faults.append(Observation.SATURATED(timed=timed, moment=first, count=count))
    faults += jumped(sorted(jumps), timed=timed)
    if jumps:
        faults.append(longest(ramps.moment, timed=timed))
    return ramps, tuple(faults)


def _stray(ramps: Loading) -> NDArray[np.bool_]:
    """Find readings of torque or angle that are far from their neighbours, (n,)."""
    stray = np.zeros(len(ramps.torque), bool)
    for values in (ramps.torque, ramps.angle):
        calm = usual(values)
        most = _RAMP_STEPS * np.quantile(np.abs(np.diff(calm)), 0.98)
        stray |= np.abs(values - calm) > max(most, _LEAST_STRAY * np.ptp(calm))
    return stray


def _saturated(ramps: Loading) -> NDArray[np.bool_]:
    """Find rows at the greatest torque of either sign in which the angle moves there and back."""
    found = np.zeros(len(ramps.torque), bool)
    least = _CAME_BACK * float(np.ptp(ramps.angle))
    for sign, greatest in ((1.0, np.max(ramps.torque)), (-1.0, np.min(ramps.torque))):
        edges = np.flatnonzero(np.diff(ramps.torque == greatest, prepend=False, append=False))
        for begin, end in edges.reshape(-1, 2).tolist():
            angle = sign * ramps.angle[begin:end]
            if np.max(angle) - max(angle[0], angle[-1]) > least:
                found[begin:end] = True
    few = found.any() and len(np.unique(ramps.torque)) < _FEWEST_LEVELS
    return np.zeros_like(found) if few else found


def _slips(ramps: Loading) -> list[tuple[float, int]]:
    """Find steps of the angle after which it differs at equal torques: sizes, rad, and rows.

    Where play is crossed, the angle steps as well, but comes back.
    """
    angle, most = usual(ramps.angle), float(np.max(np.abs(ramps.torque)))
    steps = np.abs(np.diff(angle))
    rows = np.flatnonzero(steps > _SLIP_STEPS * np.quantile(steps, 0.98))
    edges = np.diff(rows, prepend=-_WINDOW - 1, append=len(angle) + _WINDOW) > _WINDOW
    before, after = rows[edges[:-1]], rows[edges[1:]] + 1
    sizes, room = angle[after] - angle[before], np.maximum(after - before, _WINDOW)
    around = angle[np.minimum(after + room, len(steps))] - angle[np.maximum(before - room, 0)]
    # The end of an accelerating motion is no step.
    large = np.abs(sizes) > np.maximum(_LEAST_SLIP * np.ptp(angle), _ALONE * np.abs(around))
    if not large.any():
        return []
    direction = directions(usual(ramps.torque), _TURNED * most)
    known = np.flatnonzero(direction)
    turns = known[1:][np.diff(direction[known]) != 0]
    place = np.round(ramps.torque / (_BIN * most)) + 1j * direction
    found, back = [], 0.0
    for last, row, size in zip(before[large], after[large], sizes[large], strict=True):
        # At least one loop before, and one after.
        begin = [0, *turns[turns <= last]][-_LOOP:][0]
        end = [*turns[turns > row], len(angle)][:_LOOP][-1]
        shifts = shifted(place, angle, slice(begin, last + 1), slice(row, end))
        if not len(shifts):
            rest = np.ptp(np.append(angle[: last + 1], angle[row:] - size))
            loaded = abs(ramps.torque[row]) > _LOADED * most
            shifts = np.array([size * (loaded and abs(size) > _LOADED * rest)])
        low, high = np.quantile(shifts / size, (0.0, 1.0))
        if low > 0.0 and high < _MOST_KEPT and low + high > 1.0:
            found.append((float(size), int(row)))
        else:
            back = max(back, abs(size))
    return [(size, row) for size, row in found if abs(size) > _BEYOND * back]


def shifted(place: Array, angle: Array, before: slice, after: slice) -> Array:
    """Median change of an angle at equal places, rad, for each direction that both parts have.

    The places, (n,), have the direction, 1 or -1, as their imaginary part.
    """
    shared = np.intersect1d(place[before], place[after])
    # Close to the step, both parts have the same places anyway.
    near = place[before.stop - _WINDOW : after.start + _WINDOW]
    shared = np.setdiff1d(shared[shared.imag != 0.0], near)
    was, now = (_medians(place[part], angle[part], shared) for part in (before, after))
    changes = now - was
    parts = (changes[shared.imag == direction] for direction in (-1.0, 1.0))
    return np.array([np.median(part) for part in parts if len(part)])


def _medians(place: Array, angle: Array, places: Array) -> Array:
    """Median of the angles, rad, at each of the given places, all of which occur."""
    order = np.lexsort((angle, place))
    place, angle = place[order], angle[order]
    middle = np.searchsorted(place, places) + np.searchsorted(place, places, 'right')
    medians: Array = 0.5 * (angle[(middle - 1) // 2] + angle[middle // 2])
    return medians


def left_out(moments: Array, *, timed: bool) -> Observed:
    """Say when the readings were that are left out."""
    named = moments[:NAMED].tolist()
    more = len(moments) - len(named)
    return Observation.STRAY(timed=timed, moments=named, more=more, count=len(moments))


def jumped(jumps: Sequence[tuple[float, float]], *, timed: bool) -> Iterator[Observed]:
    """Say when jumps were, and of what size, rad."""
    for moment, size in jumps[:NAMED]:
        yield Observation.JUMPED(timed=timed, moment=moment, angle=size)
    if further := len(jumps[NAMED:]):
        yield Observation.JUMPED_FURTHER(count=further)


def longest(time: Array, *, timed: bool) -> Observed:
    """Say which part of a recording is used."""
    return Observation.LONGEST_PART(timed=timed, first=float(time[0]), last=float(time[-1]))


def usual(values: Array) -> Array:
    """Running median of five values, (n,)."""
    padded = np.pad(values, _WINDOW // 2, 'edge')
    windows = np.lib.stride_tricks.sliding_window_view(padded, _WINDOW)
    return np.asarray(np.median(windows, axis=1))
