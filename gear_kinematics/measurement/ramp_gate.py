# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A gate before the figures of torque ramps: stray readings, a saturated sensor, and slips.

After a slip, the angle at the same torque is another one.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from gear_kinematics.measurement.recording import Array, Loading
from gear_kinematics.measurement.two_encoders import directions
from gear_kinematics.report.document import counted, number

NAMED = 3
"""Faults of a kind that are named with their moments."""
_FEWEST = 50  # samples
_WINDOW = 5  # samples in whose median a stray reading, or two, do not show
_RAMP_STEPS = 25.0  # times the step that 98 % of medians have; noisy torques have up to 15
_LEAST_STRAY, _MOST_STRAY = 0.15, 0.1  # of their range, where those have up to 0.09; of samples
_SLIP_STEPS, _LEAST_SLIP = 6.0, 0.1  # a slip: steps that 98 % have, and share of the range
_ALONE = 0.6  # of the motion around it, as much before and after
_BEYOND = 1.5  # times the greatest step that comes back, where play is crossed
_TURNED, _BIN = 0.05, 0.05  # of the greatest torque: after which it has turned; alike
_CAME_BACK, _MOST_SATURATED = 0.02, 0.5  # of the range of the angle: no creep; of samples
_LOOP = 3  # reversals of the torque between which it takes each value both ways
_MOST_KEPT = 2.0  # times a step, by which either way has another angle behind it
_LOADED = 0.5  # of the torque, where no play is crossed; and of the range of the angle


def gated_ramps(ramps: Loading) -> tuple[Loading, tuple[str, ...]]:
    """Leave out readings that leave both neighbours and come back, and all before or after a slip.

    Returns:
        The longest part without a slip, and what was left out, in clauses.
    """
    if len(ramps.torque) < _FEWEST:
        return ramps, ()
    faults, time = [], ramps.moments
    at, unit = ('at', ' s') if ramps.seconds is not None else ('at sample', '')
    stray = np.zeros(len(time), bool)
    for values in (ramps.torque, ramps.angle):
        calm = usual(values)
        most = _RAMP_STEPS * np.quantile(np.abs(np.diff(calm)), 0.98)
        stray |= np.abs(values - calm) > max(most, _LEAST_STRAY * np.ptp(calm))
    if stray.any() and np.mean(stray) <= _MOST_STRAY:
        faults.append(left_out(time[stray], at, unit))
        ramps, time = ramps.chosen(~stray), time[~stray]
    cut = _saturated(ramps)
    if cut.any() and np.mean(cut) <= _MOST_SATURATED:
        faults.append(
            f'the torque sensor is saturated, first {at} {number(time[cut][0], 6)}{unit}: '
            f'{np.count_nonzero(cut)} readings left out, in which the angle comes and goes'
        )
        ramps, time = ramps.chosen(~cut), time[~cut]
    slips = _slips(ramps)
    faults += jumped([(size, float(time[row])) for size, row in slips], at, unit)
    if slips:
        edges = [0, *(row for _, row in slips), len(time)]
        first, end = max(pairwise(edges), key=lambda part: part[1] - part[0])
        ramps = ramps.chosen(slice(first, end))
        faults.append(longest(time[first], time[end - 1], unit))
    return ramps, tuple(faults)


def _saturated(ramps: Loading) -> NDArray[np.bool_]:
    """Find rows of the greatest torque of a sign, (n,), over which the angle comes and goes."""
    found = np.zeros(len(ramps.torque), bool)
    least = _CAME_BACK * float(np.ptp(ramps.angle))
    for sign, greatest in ((1.0, np.max(ramps.torque)), (-1.0, np.min(ramps.torque))):
        edges = np.flatnonzero(np.diff(ramps.torque == greatest, prepend=False, append=False))
        for begin, end in edges.reshape(-1, 2).tolist():
            angle = sign * ramps.angle[begin:end]
            if np.max(angle) - max(angle[0], angle[-1]) > least:
                found[begin:end] = True
    return found


def _slips(ramps: Loading) -> list[tuple[float, int]]:
    """Find steps of the angle that stay, at equal torques: their sizes, rad, and rows.

    Where play is crossed the angle steps, too, but comes back.
    """
    angle, most = usual(ramps.angle), float(np.max(np.abs(ramps.torque)))
    steps = np.abs(np.diff(angle))
    rows = np.flatnonzero(steps > _SLIP_STEPS * np.quantile(steps, 0.98))
    edges = np.diff(rows, prepend=-_WINDOW - 1, append=len(angle) + _WINDOW) > _WINDOW
    before, after = rows[edges[:-1]], rows[edges[1:]] + 1
    sizes, room = angle[after] - angle[before], np.maximum(after - before, _WINDOW)
    around = angle[np.minimum(after + room, len(steps))] - angle[np.maximum(before - room, 0)]
    # The end of a faster and faster motion is no step.
    large = np.abs(sizes) > np.maximum(_LEAST_SLIP * np.ptp(angle), _ALONE * np.abs(around))
    if not large.any():
        return []
    way = directions(usual(ramps.torque), _TURNED * most)
    known = np.flatnonzero(way)
    turns = known[1:][np.diff(way[known]) != 0]
    place = np.round(ramps.torque / (_BIN * most)) + 1j * way
    found, back = [], 0.0
    for last, row, size in zip(before[large], after[large], sizes[large], strict=True):
        # At least a loop before and a loop behind.
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
    """Median change of an angle at equal places, rad, for each way that both slices share."""
    shared = np.intersect1d(place[before], place[after])
    # Just around the step, they have the same places by themselves.
    near = place[before.stop - _WINDOW : after.start + _WINDOW]
    shared = np.setdiff1d(shared[shared.imag != 0.0], near)
    levels = [
        [np.median(angle[part][place[part] == each]) for part in (before, after)]
        for each in shared.tolist()
    ]
    changes = np.diff(levels).ravel()
    ways = (changes[shared.imag == way] for way in (-1.0, 1.0))
    return np.array([np.median(way) for way in ways if len(way)])


def left_out(moments: Array, at: str, unit: str) -> str:
    """Say which readings were left out."""
    named = ', '.join(number(moment, 6) for moment in moments[:NAMED])
    more = f' and {len(moments) - NAMED} more' if len(moments) > NAMED else ''
    what = 'reading that contradicts' if len(moments) == 1 else 'readings that contradict'
    return f'{len(moments)} {what} both neighbours left out, {at} {named}{unit}{more}'


def jumped(jumps: Sequence[tuple[float, float]], at: str, unit: str) -> Iterator[str]:
    """Say by how much, rad, and when the output has jumped."""
    for size, moment in jumps[:NAMED]:
        jump = f'the output jumps by {number(math.degrees(size))}° against the rotor'
        when = f'{at} {number(moment, 6)}{unit}'
        yield f'{jump} {when} (a slip, or an encoder that jumped)'
    if further := len(jumps[NAMED:]):
        yield f'{counted(further, "further jump")} of the output against the rotor'


def longest(first: float, last: float, unit: str) -> str:
    """Say which part of a recording is used."""
    span = f'{number(first, 6)} to {number(last, 6)}{unit}'
    return f'only the longest part without a fault is used, {span}'


def usual(values: Array) -> Array:
    """Values (n,) without stray ones."""
    windows = sliding_window_view(np.pad(values, _WINDOW // 2, 'edge'), _WINDOW)
    medians: Array = np.median(windows, axis=1)
    return medians
