# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The times in a table: their unit, and the rows that are in order."""

import math
from bisect import bisect_right
from collections.abc import Collection, Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.columns import DATES, Column, ColumnsError
from gear_kinematics.measurement.names import ANGLE_UNITS, TIME_UNITS, meaning
from gear_kinematics.measurement.recording import Array
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.report.document import number
from gear_kinematics.wire.cdr import SECOND

_DATES = 978_307_200.0, 4_102_444_800.0  # s since 1970: the years 2001 and 2100
_EPOCHS = {
    **dict.fromkeys(('s', 'ms', 'us', 'ns'), (0,)),
    '100ns': (621_355_968_000_000_000, 116_444_736_000_000_000, 0),
    'days': (719_529, 25_569, 0),
}
"""Times in 1970 by unit, also those of .NET and Windows, of MATLAB and workbooks."""
_LEAST_STEP = dict.fromkeys(_EPOCHS, 1e-6) | dict.fromkeys(('ms', 'us', 'ns'), 5e-5)
_MOST_STEP = 1.0
"""Likely intervals between samples, s: least for times in a unit, and greatest."""
_SHORTEST_STEP = 5e-7  # s between rows that no bench falls below
_UNREADABLE = 0.01  # greatest share of times that cannot be read
_RISING = 0.5  # least share of all steps forward that remains at the end of doubtful times
_UNORDERED = 0.25  # least share of steps back in rows that are in another order than that of time
_LATE_ROWS = 25  # most successive rows out of order; more show a clock that was set back
_FEWEST_AGAIN, _LONGEST_STEP = 2, 1.5
"""Least number of rows that repeat times after a clock was set back; their greatest step, in usual
steps."""
_SAME_SPAN = 0.02  # decades by which times of equal length differ, in units of their own
_DAY = 86_400 * SECOND
FASTEST, MOST = 1000.0, 0.9
"""Speed that hardly any rotor exceeds, rad/s; share of the samples in motion that are slower."""
_IMPOSSIBLE = 10.0 * FASTEST  # speed that no rotor of a servo exceeds, rad/s


def with_unit(clock: Column, times: Array, angle: Array, role: str) -> Column:
    """Return the clock with the unit that the sampling shows; ColumnsError if it shows none."""
    if times.dtype.kind == 'M':
        return clock._replace(unit='date')
    known = np.isfinite(times) & np.isfinite(angle)
    times, angle = times[known].astype(float), angle[known]
    order = _by_time(times)
    times, angle = times[order], angle[order]
    later = np.diff(times) > 0.0
    if not later.any():
        cause = 'they stand still' if known.any() else 'no numbers nor ISO 8601'
        raise ValueError(f'the times in {clock.name}: {cause}; give another with --time-column')
    steps = np.diff(times)[later]
    step = float(np.median(steps))
    minutes = np.abs(steps - step - 40.0) < 0.5 * step  # from 59 to 100
    if step <= _MOST_STEP and minutes.any() and np.all(times % 100.0 < 60.0):  # noqa: PLR2004, s
        raise ValueError(f'the times in {clock.name} are hours, minutes and seconds: add colons')
    speed = float(np.quantile(np.abs(np.diff(angle)[later]) / steps, MOST))
    if role == 'angle':  # a locked shaft, whose times only give the order
        speed = 0.0
    within = [u for u in _EPOCHS if _LEAST_STEP[u] <= step * TIME_UNITS[u] <= _MOST_STEP]
    dated = {
        unit
        for unit in within
        for epoch in _EPOCHS[unit][:2]
        if _DATES[0] < (times[0] - epoch) * TIME_UNITS[unit] < _DATES[1]
    }
    likely = [unit for unit in within if _EPOCHS[unit] == (0,)]
    if len(likely) > 1:
        likely = [unit for unit in likely if speed <= FASTEST * TIME_UNITS[unit]]
    likely = [unit for unit in within if unit in dated] or likely
    ticks = meaning(clock.name).unit == 'counts' or np.all(steps == 1.0)  # or numbers of rows
    if (role == 'rotor' and (len(likely) != 1 or (ticks and not dated))) or (
        clock.name.lower() == 'temps' and times[0] > _LATE_ROWS * step
    ):
        cause = f'the times in {clock.name}: steps of {step:.6g} do not tell their unit'
        raise ColumnsError(cause, 'it', time=f'{clock.name} [ms]')
    unit = likely[0] if likely else 's'
    return clock._replace(unit=unit, scale=TIME_UNITS[unit])


def check_steps(clock: Column, times: Array, angle: Array, unit: str, role: str) -> None:
    """Raise ColumnsError if times seem to be in another unit, by the angle in a role, rad.

    Whole s or ms beside a rotor may be in a finer unit, and all below s in a coarser one. An angle
    without a `unit` may be in degrees, or in counts, whose unit is asked for elsewhere.
    """
    if times.dtype.kind == 'M' or (clock.scale >= 1.0 and role != 'rotor'):  # dates are sure
        return
    known = np.isfinite(times) & np.isfinite(angle)
    if np.count_nonzero(known) <= 1:
        return
    times, angle = times[known].astype(float), angle[known]
    steps, turned = np.abs(np.diff([times, angle]))
    step, mean = float(np.median(steps)), float(np.mean(steps))
    units = {'s': ('ms', 'us', 'ns'), 'ms': ('us', 'ns')}.get(clock.unit, ())
    finer = next((u for u in units if step * TIME_UNITS[u] <= _MOST_STEP), '')
    if finer and role == 'rotor' and step * clock.scale > _MOST_STEP and not np.any(times % 1.0):
        slowed = turned / np.maximum(steps * TIME_UNITS[finer], TIME_UNITS[finer])
        if np.quantile(slowed, MOST) <= FASTEST:
            cause = f'the times in {clock.name} are {step * clock.scale:.6g} s apart'
            cause += f', as if they were {finer}'
            raise ColumnsError(cause, 'their unit', time=f'{clock.name} [{finer}]')
    if clock.scale >= 1.0:
        return
    size = 1.0 if unit else 1.0 / ANGLE_UNITS['deg']
    # A shaft at rest may be read on either side of the end of a turn.
    turn = np.quantile(np.minimum(turned, np.abs(turned - size * TURN)), MOST)
    fast = mean * clock.scale * _IMPOSSIBLE * size < turn and (unit or np.any(angle % 1.0))
    if mean > 0.0 and (fast or mean * clock.scale < _SHORTEST_STEP):
        likely = (u for u in ('us', 'ms') if mean * TIME_UNITS[u] >= _LEAST_STEP[u])
        slow = (u for u in likely if turn <= FASTEST * mean * TIME_UNITS[u])
        cause = f'the times in {clock.name} are {mean * clock.scale:.6g} s apart'
        cause += f', in which the shaft would turn by {turn:.3g} rad' * bool(fast)
        raise ColumnsError(cause, 'their unit', time=f'{clock.name} [{next(slow, "s")}]')


def are_apart(usual: Array, other: Array) -> bool:
    """Return whether times, (n,), are of the same zero, but more than a row apart."""
    known = (usual == usual) & (other == other)  # noqa: PLR0124, as NaN is not equal to itself
    apart, usual = np.abs(other - usual)[known], usual[known]
    if len(usual) <= 1:
        return False
    step = np.median(np.abs(np.diff(usual)))
    return bool(np.any((apart > step) & (apart < np.ptp(usual))))


def check_units(rotor: Array, output: Array) -> None:
    """Raise ValueError if the stamps of both encoders, ns, are a power of 1000 apart in length."""
    spans = [float(np.ptp(stamp)) / SECOND for stamp in (rotor, output)]
    decades = abs(math.log10(spans[0] / spans[1])) if min(spans) else 0.0
    if decades > 1.0 and abs(math.remainder(decades, 3.0)) < _SAME_SPAN:
        raise ValueError(
            f'the times of the rotor span {number(spans[0])} s, those of the output '
            f'{number(spans[1])} s, as in another unit: convert one of them'
        )


def are_no_times(name: str, unit: str, times: Array) -> bool:
    """Return whether numbers of a name that may say something else do not rise as times do.

    They are called T, t_m, or temps (French for times), or have a further word, as cycle_time has.
    A date may be that of the day alone, and durations that are mostly the same may begin with 0.
    """
    steps, says = np.diff(times.astype(float)), meaning(name)
    date = says.words in DATES
    if date and times.dtype.kind == 'M' and not np.any(times.astype('M8[ns]').astype('i8') % _DAY):
        return True
    if (name.lower() == 'temps' and not unit) or (says.unsure and 't' in says.words):
        return not np.all(steps > 0.0)
    rise, least = np.sum(steps), _RISING * np.sum(steps, where=steps > 0.0)
    still = 2 * np.count_nonzero(steps) <= len(steps)
    durations = says.unsure and still and 2.0 * np.max(steps, initial=0.0) >= rise
    unsure = says.unsure or date
    return bool(durations or (unsure and rise <= least) or (name == 'T' and rise < least))


def stamps(
    clock: Column | None,
    times: Array | None,
    kept: Array,
    columns: Collection[Array],
    remarks: list[Observed],
    faults: list[Observed],
    *,
    alone: bool,
) -> tuple[Array, Array]:
    """Return stamps, ns, of the kept rows that are in order, and the indices of these rows.

    Rows that repeat both the times and all columns of the one before are left out.

    Where a clock was set back, the stamps go on if there are no other rows (`alone`), and end
    otherwise. ValueError if the times cannot be read.
    """
    rows = np.flatnonzero(kept)
    if clock is None or times is None:
        return rows * SECOND, rows
    rows = _once(rows, times, columns, remarks)
    times = times[rows]
    if times.dtype.kind == 'M':
        readable = ~np.isnat(times)
        stamp = times.astype('datetime64[ns]').astype(np.int64)
    else:
        last = np.max(times, where=times == times, initial=0)  # noqa: PLR0124, no NaN
        epochs = _EPOCHS.get(clock.unit, (0,))
        times = times - next(epoch for epoch in epochs if epoch <= last or not epoch)
        readable = np.abs(times * clock.scale) < _DATES[1]  # NaN compares false
        factor = clock.scale * SECOND
        exact = times.dtype.kind in 'iu'  # with more digits than floating point has
        seconds = times * round(factor) if exact else np.where(readable, times, 0.0) * factor
        stamp = np.round(seconds).astype(np.int64)
    if np.mean(~readable) > _UNREADABLE:
        cause = f'the times in {clock.name}: no numbers nor ISO 8601'
        if times.dtype.kind == 'M' or np.mean(np.isnan(times)) > _UNREADABLE:
            raise ValueError(f'{cause}; give another with --time-column')
        raise ColumnsError(f'{cause}, or too large', 'their unit', time=f'{clock.name} [ns]')
    if lost := np.count_nonzero(~readable):
        remarks.append(Observation.NO_TIMES(rows=lost, column=clock.name))
    by_time = _by_time(stamp[readable])
    rows, stamp = rows[readable][by_time], stamp[readable][by_time]
    if stamp.min() >= 0 and stamp.max() < _DAY:  # times of the day begin again at midnight
        stamp = stamp + _DAY * np.cumsum(np.diff(stamp, prepend=stamp[0]) < -0.5 * _DAY)
    for before, size in _restore(stamp) if alone else ():
        after = (before - stamp[0]) / SECOND
        faults.append(Observation.SET_BACK_AFTER(size=size / SECOND, seconds=after))
    order, end = _order(stamp)
    if late := end - len(order):
        remarks.append(Observation.TIMES_OUT_OF_ORDER(rows=late, column=clock.name))
    if end < len(stamp):
        faults.append(Observation.TIMES_GO_BACK(rows=end, column=clock.name))
    if stamp[order[-1]] == stamp[order[0]] and len(order) > 1:
        raise ValueError(f'the times in {clock.name}: they stand still')
    stamp, rows = stamp[order], rows[order]
    new = np.flatnonzero(np.diff(stamp, prepend=stamp[0] - 1))
    if 2 * len(new) < len(stamp):
        remarks.append(Observation.SAME_TIMES(rows=len(stamp), times=len(new), column=clock.name))
    if 1 < len(new) < len(stamp):
        counts, steps = np.diff(new, append=len(stamp)), np.diff(stamp[new])
        steps = np.minimum(np.append(steps, np.median(steps)), np.median(steps))
        places = np.arange(len(stamp)) - np.repeat(new, counts)
        stamp = stamp + (np.repeat(steps / counts, counts) * places).astype(np.int64)
    return stamp, rows


def _once(rows: Array, times: Array, columns: Collection[Array], remarks: list[Observed]) -> Array:
    """Leave out rows that a logger wrote again.

    Times with so few digits that different rows share them are no sign of such rows.
    """
    same = [one[rows[1:]] == one[rows[:-1]] for one in (times, *columns)]
    once = np.delete(rows, 1 + np.flatnonzero(np.all(same, axis=0)))
    if len(once) == len(rows) or np.any(times[once[1:]] == times[once[:-1]]):
        return rows
    remarks.append(Observation.ROWS_AGAIN(rows=len(rows) - len(once)))
    return once


def _by_time(times: Array) -> Array | slice:
    """Return the order of rows by time where they are in reverse, or sorted by something else."""
    steps = np.diff(times)
    if np.count_nonzero(steps < 0) <= _UNORDERED * np.count_nonzero(steps):
        return slice(None)
    return slice(None, None, -1) if np.all(steps <= 0) else np.argsort(times, kind='stable')


def _restore(stamp: Array) -> Iterator[tuple[int, int]]:
    """Make stamps, ns, go on where the clock was set back; yield the last before, and the size.

    Rows that were written late are few, or time jumps forward after them; before those with a time
    of the future, it jumps forward, too.
    """
    steps = np.diff(stamp)
    usual = np.median(steps[steps > 0]) if np.any(steps > 0) else 0
    for k, end in pairwise([*(1 + np.flatnonzero(steps < 0)).tolist(), len(stamp)]):
        before, again = stamp[k - 1], stamp[k:end]
        first = int(np.argmax(stamp[:k] > stamp[k]))
        if first and stamp[first] - stamp[first - 1] > _LONGEST_STEP * usual:
            continue
        passed = np.flatnonzero(again > before)
        rise = np.diff(again[: passed[0] + 1 if len(passed) else len(again)])
        if len(rise) >= _FEWEST_AGAIN and rise.min() >= 0 and rise.max() <= _LONGEST_STEP * usual:
            size = int(before + usual - stamp[k])
            stamp[k:] += size
            yield before, size


def _order(stamp: Array) -> tuple[Array, int]:
    """Find the rows that are in order, and the row where the clock was set back.

    As few rows as possible are left out, whether they are late or early.
    """
    late = stamp < np.maximum.accumulate(stamp)
    early = stamp > np.minimum.accumulate(stamp[::-1])[::-1]
    edges = np.flatnonzero(np.diff(late | early, prepend=False, append=False)).tolist()
    kept = np.ones(len(stamp), bool)
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        kept[begin:end] = _longest(stamp[begin:end].tolist())
        gone = np.flatnonzero(np.diff(~kept[begin:end], prepend=False, append=False))
        if np.max(gone[1::2] - gone[::2]) > _LATE_ROWS:
            first = begin + int(np.argmax(late[begin:end]))
            kept[begin:first] = True
            return np.flatnonzero(kept[:first]), first
    return np.flatnonzero(kept), len(stamp)


def _longest(values: list[int]) -> NDArray[np.bool_]:
    """Find the longest non-decreasing selection of values."""
    ends, places, before = list[int](), list[int](), list[int]()
    for k, value in enumerate(values):
        length = bisect_right(ends, value)
        ends[length : length + 1], places[length : length + 1] = [value], [k]
        before.append(places[length - 1] if length else -1)
    chosen = np.zeros(len(values), bool)
    k = places[-1]
    while k >= 0:
        chosen[k] = True
        k = before[k]
    return chosen
