# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The range of an encoder whose positions repeat, and units of positions that are not rad."""

import math

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.recording import Array
from gear_kinematics.report.document import counted

_UNCLEAR = 0.3, 0.7  # steps, in ranges, that may be a motion or a wrap
_MOST_UNCLEAR = 0.05  # number of unclear steps, as in gaps, per wrap; with more, there is no wrap
_GAP = 1.5  # usual times between samples
MOST_SPAN = 1.001  #: ranges that wrapped positions span at most, with noise and rounding
_EQUAL = 0.02  # share by which the range that steps show may be wrong, as the speed changes
_AROUND = 8  # samples before and after a wrap in which the motion goes on
_LEAST_MOTION = 1e-3  # ranges in these samples; with less, the shaft rests
_SPREADS, _ACCURACY = 6.0, 1e-6  # standard uncertainties, or share, within which a range is round
_REGISTER = 2**32  # counts after which a register of 32 bits repeats, read as unsigned
_DECIMALS, _BY_CHANCE = 3, 0.05
"""Most decimals of a round range; probability below which it is no coincidence."""
_TURNS = {'degrees': 360.0, 'turns': 1.0}  # a turn in units that may be taken for rad
_SAME_COUNTS = 0.02
"""Share by which the counts per turn that wraps show may differ from a power of two, as the speed
changes; 4000 differs from 4096 by 0.023."""
_MIN_LEVELS, _ROUNDING = 4, 1e-5
"""Number of different whole numbers that show counts, as fewer may be chance; and their rounding
error, for counts up to 10^10 that were divided into turns and a remainder."""
_MIN_BITS, _POWER = 6, 1e-4
"""Recognition of an encoder with 2^n steps per turn: least n, and greatest distance of n from a
whole number. A step in another unit looks like one by chance with a probability of 4e-4."""


def count_wraps(
    values: Array, turn: float, error: float = 1.0, seconds: Array | None = None
) -> int:
    """Count the wraps of positions in the order of time, (n,); `error` is a share of the turn.

    With times, steps in gaps do not count against wraps, because any motion is possible there.
    """
    size = np.abs(np.diff(values)) / turn
    low, high = _UNCLEAR
    wraps = np.flatnonzero(size >= high)
    unclear = (size > low) & (size < high)
    if len(wraps) and seconds is not None:
        spans = np.diff(seconds)
        unclear &= spans < _GAP * np.median(spans)
    if not len(wraps) or np.count_nonzero(unclear) > _MOST_UNCLEAR * len(wraps):
        return 0
    motion = np.abs(size - np.round(size))[np.maximum(wraps - 1, 0)]  # goes on in the wrap
    same = abs(float(np.median(size[wraps] + motion)) - 1.0) < error
    return len(wraps) if same and np.ptp(values) <= MOST_SPAN * turn else 0


def unwrapped(values: Array, seconds: Array, step: Step, period: float = 0.0) -> Array:
    """Unwrap positions by a known period, or by the range that `find_range` finds."""
    if not period or np.ptp(values) > MOST_SPAN * period:
        period, _ = find_range(values, seconds, step)
    return np.unwrap(values, period=period) if period else values


def signed(values: Array, count: float) -> Array:
    """Restore the sign of positions, (n,), that pass from 0 to the greatest value of a register.

    `count` is one count of the encoder in their unit.
    """
    period = _REGISTER * count
    passed = np.unwrap(values, period=period)
    return passed - period * (values[0] >= 0.5 * period and np.any(passed != values))


def find_range(values: Array, seconds: Array, step: Step) -> tuple[float, int]:
    """Find the angle after which positions, (n,), rad, at times, s, repeat.

    Returns the range, rad, and the number of wraps that show it; 0 and 0 if they do not repeat.
    """
    if wraps := count_wraps(values, TURN, seconds=seconds):
        return TURN, wraps
    steps = np.diff(values)
    edges = np.flatnonzero(np.abs(steps) > 0.5 * np.ptp(values)).tolist()
    sizes, goes_on = [], 0
    for before, edge, after in zip([-1, *edges], edges, [*edges[1:], len(steps)], strict=False):
        near = slice(max(before + 1, edge - _AROUND), min(after, edge + _AROUND) + 1)
        size, moves = _step_back(values[near], seconds[near], edge - near.start)
        sizes.append(size)
        goes_on += moves
    size = float(np.median(sizes)) if sizes else 0.0
    counted = count_wraps(values, size, _EQUAL, seconds) if size else 0
    if counted <= 1 or 2 * goes_on <= len(edges):
        return 0.0, 0
    spread = 1.5 * float(np.median(np.abs(np.subtract(sizes, size)))) / math.sqrt(len(sizes))
    tolerance = max(0.5 * step.size, _ACCURACY * size, _SPREADS * spread)
    for scale in (TURN, *(10.0**-k for k in range(_DECIMALS + 1))):
        whole = scale * round(size / scale)
        if abs(size - whole) <= tolerance <= 0.5 * _BY_CHANCE * scale:
            return whole if scale == TURN else round(whole, _DECIMALS), counted
    return step.size * round(size / step.size) if step.seen else size, counted


def _step_back(values: Array, seconds: Array, edge: int) -> tuple[float, bool]:
    """Find by how much the positions step at an edge, beyond the motion there, rad.

    Also returns whether the motion before and after is opposed to the step. A servo that is
    sampled slowly steps as well, but rests before and after.
    """
    behind = np.arange(len(values)) > edge
    time = seconds - seconds[edge]
    degree = min(3, len(values) - edge - 2, edge)
    powers = (time / (np.ptp(time) or 1.0)) ** np.arange(degree + 1)[:, np.newaxis]
    (size, *_), *_ = np.linalg.lstsq(np.vstack([behind, powers]).T, values, rcond=None)
    travel = values[edge] - values[0], values[-1] - values[edge + 1]
    return abs(float(size)), max(np.array(travel) * np.sign(size)) < -_LEAST_MOTION * abs(size)


def other_unit(values: Array, step: Step) -> str:
    """Return the unit of positions if it is not rad, with the evidence and what to do; or ''."""
    rounded, units = np.round(values), dict(_TURNS)
    whole = np.abs(values - rounded).max() < _ROUNDING and len(np.unique(rounded)) >= _MIN_LEVELS
    if whole:
        units['counts'] = 2.0 ** math.ceil(math.log2(np.ptp(values) + 1.0))
    for unit, turn in units.items():
        bits = math.log2(turn / step.size) if step.seen and not whole else 0.0
        if wraps := count_wraps(values, turn, _SAME_COUNTS if unit == 'counts' else 1.0):
            many = ' if these are a turn' if unit == 'counts' else ''
            shown = f'{unit} ({counted(wraps, "wrap")} at {turn:g})'
            return f'{shown}: multiply by {TURN / turn:.9g}{many}'
        if round(bits) >= _MIN_BITS and abs(bits - round(bits)) < _POWER:
            return f'{unit} (steps of 1/2^{round(bits)} turn): multiply by {TURN / turn:.9g}'
    return 'counts (whole numbers), of which a turn has an unknown number' if whole else ''
