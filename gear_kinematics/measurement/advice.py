# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Advice where the columns of a table are not found: a command line that works."""

import re
import shlex
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import filterfalse, permutations
from pathlib import Path

import numpy as np

from gear_kinematics.measurement.columns import Sources, may_be_angle, sides
from gear_kinematics.measurement.dialects import TableFile
from gear_kinematics.measurement.recording import Array

_TRIED, _FEWEST, _ROWS = 12, 10, 10_000
"""Number of columns that are tried for an example; least and most rows that are compared."""
_NO_ANGLE = re.compile(
    r'(?i)torq|effort|force|curr|vel(?!_mapper)|speed|rpm|/ ?s|temp|time|stamp|target|goal|cmd|'
    r'elec|^t$'
)
"""Words in names of columns that are not proposed as angles."""
_LIKELY = re.compile(r'(?i)pos|ang|enc|theta|winkel|(rad|deg|rev|inc|cnt|counts)\b')
"""Words in names of columns that are proposed first."""
_COUNTS = '--rotor-counts', '4096', '--output-counts', '4096'  # an example for whole numbers


def advise(
    path: Path, table: TableFile, sources: Sources, try_to_read: Callable[[Sources], object]
) -> str:
    """List the columns with their first values, and end with a command line that works, if any.

    `try_to_read` raises ValueError if the table cannot be read with columns that are named.
    """
    names = [name for name in table.names if name]
    listed = ', '.join(f'{name} ({table.first.get(name, "")})' for name in names)
    text = f'among the columns {listed}; name them'
    angles = filter(may_be_angle, filterfalse(_NO_ANGLE.search, names))
    single = [name for name in angles if names.count(name) == 1]
    likely = [*filter(_LIKELY.search, single)]
    raw, _ = table.load((likely if len(likely) > 1 else single)[:_TRIED])
    raw = {name: array.astype(float) for name, array in raw.items() if array.dtype.kind in 'iuf'}
    for rotor, output in _alike(raw):
        words = ['--rotor-column', rotor, '--output-column', output]
        try:
            try_to_read(replace(sources, rotor=rotor, output=output, as_recorded=False))
        except ValueError as error:
            if not (option := re.search('--angle-unit|-counts', str(error))):
                continue
            fractions = np.concatenate([raw[rotor], raw[output]]) % 1.0
            unit = ['deg'] if np.any(fractions > 0.0) else ['counts', *_COUNTS]
            words += _COUNTS if option[0] == '-counts' else ['--angle-unit', *unit]
        command = shlex.join([*sources.command.split(), str(path), *words])
        counts = f' and their counts per turn in place of {_COUNTS[1]}' * (_COUNTS[1] in words)
        return f'{text} with their units{counts}, for example: {command}'
    return f'{text} with --angle-column, --torque-column, --rotor-column, --output-column'


def _alike(columns: Mapping[str, Array]) -> Iterator[tuple[str, str]]:
    """Yield the pairs of columns that move alike, the likeliest first, and in each the faster."""
    pairs = {}
    for rotor, output in permutations(columns, 2):
        if len(columns[rotor]) != len(columns[output]) or sides(rotor)[1] or sides(output)[0]:
            continue
        pair = np.array([columns[rotor], columns[output]])[:, :_ROWS]
        pair = np.diff(pair[:, np.isfinite(pair).all(axis=0)])
        if pair.shape[1] > _FEWEST and (spread := np.std(pair, axis=1))[0] > spread[1] > 0.0:
            pairs[abs(np.corrcoef(pair)[0, 1])] = rotor, output
    yield from (pairs[likeness] for likeness in sorted(pairs, reverse=True)[:_FEWEST])
