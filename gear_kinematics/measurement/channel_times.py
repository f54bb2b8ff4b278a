# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Times of channels in the texts of TwinCAT Scope, LabVIEW, Simulink and the like."""

import re
from collections.abc import Sequence
from operator import itemgetter

from gear_kinematics.measurement.cells import weight
from gear_kinematics.measurement.names import known_units, meaning

_CLOCKS = {'name': 'ms', 'x_value': 's', 'x': ''}
"""Words before channels with their own times, and the units of these."""
_FILETIME = re.compile(r'\d{18}')  # times of Windows, since 1601


def with_times(
    rows: Sequence[Sequence[str]], label: Sequence[str], first: str
) -> tuple[list[str], dict[str, str], dict[str, str]] | None:
    """Find names, units and clocks of channels behind times of their own, which some may share.

    The first cell of a row of names, such as Name, is repeated at each column of times. In files
    of TwinCAT Scope, in which all channels may share their times, it need not be.

    Args:
        rows: lines above the numbers.
        label: units of all columns but the first.
        first: the first time.
    """
    scope = any(row[0].lower().startswith('sampletime') for row in rows)
    for row in filter(itemgetter(slice(2, None)), rows):
        key, times = row[0].lower(), [k for k, cell in enumerate(row) if cell == row[0]]
        channels = {k: name for k, name in enumerate(row) if name != row[0]}
        known = key in _CLOCKS or meaning(key).role == 'time'
        apart = len({*channels.values()}) == len(channels)
        if not (known and apart and (times[1:] or (scope and key == 'name'))):
            continue
        unit = _CLOCKS.get(key, meaning(key).unit)
        unit = '100ns' if key == 'name' and _FILETIME.fullmatch(first) else unit
        names = [channels.get(k, f'time of {[*row, ""][k + 1]}') for k in range(len(row))]
        clocks = {name: names[max(t for t in times if t < k)] for k, name in channels.items()}
        below = (one for one in rows if one[0].lower() in {'unit', ''})
        alike = (one for one in below if all(one[t : t + 1] == one[:1] for t in times))
        cells = ([''.join(one[k : k + 1]) for k in channels] for one in (*alike, ['', *label]))
        units = next(filter(None, map(known_units, cells)), [])
        of_channels = named([*channels.values()], units)
        return names, of_channels | dict.fromkeys(clocks.values(), unit), clocks
    return None


def interval_of(rows: Sequence[Sequence[str]]) -> float:
    """Return the interval of the samples, s, that lines of LabVIEW give where it saved no times.

    It is 0 if there is none above 0, or if that of the channels differs.
    """
    cells = {row[0]: {*filter(None, row[1:])} for row in rows if row}
    intervals = cells.get('Delta_X', set())
    if cells.get('X_Dimension') != {'Time'} or len(intervals) != 1:
        return 0.0
    interval = intervals.pop().replace(',', '.')
    return float(interval) if weight(interval, '.') and float(interval) > 0.0 else 0.0


def named(names: Sequence[str], units: Sequence[str]) -> dict[str, str]:
    """Return units by name, without those that are empty."""
    return {name: unit for name, unit in zip(names, units, strict=False) if unit}
