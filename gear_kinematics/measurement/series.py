# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Series with rows of their own: a row for each value, gaps that were filled, held readings."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from gear_kinematics.measurement.cells import numbers
from gear_kinematics.measurement.columns import likeliest
from gear_kinematics.measurement.encoder_step import find_step
from gear_kinematics.measurement.names import FOREIGN, known_units, meaning
from gear_kinematics.measurement.recording import Array
from gear_kinematics.measurement.second_fractions import fraction_of, in_nanoseconds
from gear_kinematics.measurement.sentences import Observation, Observed

_BY_CHANCE = 0.01
"""Greatest share of the rows with a new value that have two, if gaps were filled."""
_PAIRS = {'rotor': 'output', 'output': 'rotor', 'angle': 'torque', 'torque': 'angle'}
_FEWEST, _STEPS = 20, 1.5
"""Least number of readings that are held; most of them differ by more steps of the encoder. One
that stays the same over rows, but is read anew in each, changes by one step."""
_SAMPLE = 20_000  # readings that show the step
_ANEW = 0.6
"""Share of the readings that are followed by another in the next row, from which on 5 % of any
half of them are: none are held."""
_EVEN = 2.0  # 95 % of the readings are held for no more than this times the usual number of rows
_TINY = 1e-30  # so that an axis at rest is nothing divided by something
_FOOTER, _STEP_BELOW = 6, 3.0
"""Most rows of sums and the like below a table; least step to them, in the largest above."""
_ROUNDED = 0.01  # of a sum, or of what columns span, which rows that were left out change, too
_LATE = 0.5  # share of the motion expected within a hold, below which the axis stands in it


def series_of(
    frame: Any, point: str, key: str, value: str, units: Mapping[str, str]
) -> tuple[dict[str, Any], dict[str, str], dict[str, str]]:
    """Divide a table with a row for each value, or for each joint, which has several values.

    Args:
        frame: the columns as pandas reads them.
        point: the decimal point.
        key: the column that says which series, or which joint, a row is of.
        value: the column of the values; empty if all other columns have some.
        units: units by column; those of a series may be in a column of their own.

    Returns:
        Columns, their units, and the columns of their times, by the name of the series.
    """
    wanted = [one for one in frame[key].unique() if meaning(str(one)).role not in {'', 'time'}]
    # Other topics may be without stamps.
    angles = frame[frame[key].isin(wanted)] if wanted else frame
    filled = frame.columns[2 * angles.count() > len(angles)]  # not the stamps of no headers
    clock = likeliest(filled).get('time')
    unit = units.get(clock) or meaning(clock).unit if clock else ''
    if rest := fraction_of(clock or '', [*frame]):
        seconds, fraction = (numbers(frame[name], point) for name in (clock, rest))
        if (both := in_nanoseconds(seconds, fraction, rest)) is not None:
            frame[clock], unit = both, 'ns'
    others = [name for name in frame if name not in {key, clock, ''} and frame[name].ndim == 1]
    labels = [name for name in others if value and re.fullmatch('(?i)units?|einheit', name)]
    labels = [name for name in labels if known_units(_texts(frame[name]), FOREIGN, fewest=1)]
    columns, clocks, known = {}, dict[str, str](), dict[str, str]()
    for joint, series in frame.groupby(key, sort=False):
        for column in [value] if value else others:
            name = str(joint) if value else f'{joint} {column}'
            columns[name] = numbers(series[column], point)
            known |= {name: units[column]} if column in units and not value else {}
            if said := ' and '.join(text for label in labels for text in _texts(series[label])):
                known[name] = said
            clocks |= {name: f'{clock} of {joint}'} if clock else {}
        if clock:
            columns[own := f'{clock} of {joint}'] = numbers(series[clock], point)
            known[own] = unit
    return columns, known, clocks


def _texts(column: Any) -> list[str]:
    """Return the different texts in a column of pandas."""
    return [*map(str, column.dropna().unique())]


def rows_of(
    series: Mapping[str, Array],
    usable: Mapping[str, Array],
    remarks: list[Observed],
    every: int,
    times: Array | None,
) -> list[tuple[list[str], Array]]:
    """Find which series were sampled together, and in which of their `usable` rows, (n,).

    If they have `times`, each has rows of its own where tables with other times were joined: few
    rows have all, as gaps are empty, or none has two new values, as gaps repeat the last ones.
    So it has where a logger held its readings over several rows: the first of them is used. Last
    rows of sums, means or the like are left out, unless their times go on as before. The series
    have one row in `every` of a file.
    """
    together = np.all([*usable.values()], axis=0)
    last = _footer(np.array([values[together] for values in series.values()], float), every)
    if last and not (times is not None and _goes_on(times[together], last)):
        together[np.flatnonzero(together)[-last:]] = False
    own = {} if times is None else _new(series)
    most = max(map(np.count_nonzero, usable.values()))
    if times is not None and 2 * np.count_nonzero(together) < most:
        own = usable
    else:
        both = {role: values[together] for role, values in series.items() if role in _PAIRS}
        both = {role: values for role, values in both.items() if _PAIRS[role] in both}
        beside = {_PAIRS[role]: values for role, values in both.items()}
        if held := held_readings(both, beside, remarks):
            own = dict.fromkeys(series, together) | {role: together.copy() for role in held}
            for role, rows in held.items():
                own[role][together] = rows
    if own:
        return [([role], usable[role] & rows) for role, rows in own.items()]
    return [([*usable], together)]


def _goes_on(times: Array, last: int) -> bool:
    """Return whether the `last` times follow by steps as those before, unlike sums and means."""
    steps = np.diff(times).astype(float)
    return bool(np.all((steps[-last:] > 0.0) & (steps[-last:] <= steps[:-last].max())))


def _footer(table: Array, every: int) -> int:
    """Return how many of the last of many rows are sums, means or the like of those above.

    The table, (columns, n), has one row in `every` of a file. Such rows begin by a step that is
    larger than all others, but for a last one of sums, which are certain without it unless they
    are 0. They are not all at the place of the first row, to which a motion may return at its end.
    """
    steps = np.abs(np.diff(table))
    jump = _STEP_BELOW * steps[:, :-_FOOTER].max(axis=1, initial=0.0)
    for count in range(min(_FOOTER, table.shape[1] - _FEWEST), 0, -1):
        above, below = table[:, :-count], table[:, -count:]
        jumps = np.any(steps[:, -count] > jump)
        if count > 1 and not jumps:
            continue
        mean, deviation, span = above.mean(axis=1), above.std(axis=1), np.ptp(above, axis=1)
        total, square = every * above.sum(axis=1), np.hypot(mean, deviation)
        known = [total, mean, deviation, square, span, above.min(axis=1), above.max(axis=1)]
        slack = [_ROUNDED * np.abs(total) + (every - 1) * span, *6 * [_ROUNDED * span]]
        off = np.abs(below - np.array(known)[..., np.newaxis])
        fits = (off <= np.array(slack)[..., np.newaxis]).all(axis=1)
        fits[int(every == 1 and total.any()) :] &= jumps
        back = np.abs(below - table[:, :1]) <= _ROUNDED * span[:, np.newaxis]
        if fits.any(axis=0).all() and not back.all():
            return count
    return 0


def held_readings(
    series: Mapping[str, Array], beside: Mapping[str, Array], remarks: list[Observed]
) -> dict[str, Array]:
    """Find series whose readings are held over several rows, and the rows to use, with a remark.

    Args:
        series: angles or torques by role, (n,) each.
        beside: the other one of the gear at the same times, by the role that it is beside. While
            readings are held it moves, unless it is held as well; else one was moved in steps.
        remarks: those on the series are added.
    """
    found = {role: held for role, values in series.items() if (held := _held(values))}
    used = {}
    for role, (every, rows) in found.items():
        at, values = np.flatnonzero(rows), beside[role]
        middle, last = np.minimum((at[:-1] + at[1:]) // 2, at[1:] - 2), at[1:] - 1
        whole, late = np.diff(values[at]), values[last] - values[middle]
        usual = np.abs(whole) <= _EVEN * np.quantile(np.abs(whole), 0.9)  # no wraps
        expected = np.mean((last - middle) / np.diff(at))
        along = late[usual] @ whole[usual] / max(whole[usual] @ whole[usual], _TINY)
        if len(found) > 1 or along >= _LATE * expected:
            remarks.append(Observation.READINGS_HELD(role=role, every=every))
            used[role] = rows
    return used


def _held(values: Array) -> tuple[int, Array] | None:
    """Return over how many rows readings are held, if they are, and the rows with new ones.

    At rest, readings are taken as often as in motion.
    """
    moved = np.abs(np.diff(values, prepend=values[:1]))
    at = np.flatnonzero(moved)
    gaps = np.diff(at, append=len(moved))
    if len(at) < _FEWEST or np.quantile(gaps, _ANEW) == 1.0:  # as usual; the step takes time
        return None
    step = find_step(values[:: len(values) // _SAMPLE + 1]).size
    gaps = gaps[moved[at] > _STEPS * step]
    if len(gaps) < max(_FEWEST, len(at) // 2) or np.quantile(gaps, 0.05) == 1.0:
        return None
    every, usual = int(np.quantile(gaps, 0.95)), np.median(gaps)
    place = np.arange(len(moved))
    since = place - np.maximum.accumulate(np.where(moved, place, 0))
    return (every, since % every == 0) if every <= _EVEN * usual else None


def _new(series: Mapping[str, Array]) -> Mapping[str, Array]:
    """Find the rows of each series, if others repeat their last values there; otherwise none."""
    changed = {role: np.diff(values, prepend=np.nan) != 0.0 for role, values in series.items()}
    rotor, output = (changed.get(role, np.ones(1, bool)) for role in ('rotor', 'output'))
    torque = changed.get('torque', np.zeros(1, bool))  # perhaps beside one of the two
    fewest = _BY_CHANCE * min(np.count_nonzero(rotor), np.count_nonzero(output))
    beside = min(np.count_nonzero(torque & rotor), np.count_nonzero(torque & output))
    if max(np.count_nonzero(rotor & output), beside) > fewest:
        return {}
    rest = ~np.any([*changed.values()], axis=0)
    return {role: rows | rest for role, rows in changed.items()}
