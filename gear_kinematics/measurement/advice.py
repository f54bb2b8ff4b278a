# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Advice for a table with unknown columns or units: a command line that works."""

import re
import shlex
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, filterfalse, islice, permutations, product
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.measurement.columns import Column, ColumnsError, Sources, option
from gear_kinematics.measurement.dialects import TableFile
from gear_kinematics.measurement.names import (
    ANGLE_UNITS,
    FOREIGN,
    TIME_UNITS,
    TORQUE_UNITS,
    WANTED,
    meaning,
    usual_unit,
)
from gear_kinematics.measurement.recording import Array

_TRIED, _FEWEST, _ROWS = 12, 10, 10_000
"""Number of columns and examples that are tried; least and most rows that are compared."""
_FIRST = 4  # number of columns among which the times are
_ALIKE, _COPIED = 0.3, 1.0 - 1e-6
"""Least correlation of the steps of both encoders; that of one angle in two units."""
_LISTED = 600  # characters of the list of columns
_NO_ANGLE = re.compile(
    r'(?i)torq|effort|force|curr|(?<!tra)vel(?!_mapper)|speed|rpm|/ ?s(ec)?\b|temp|time|stamp|'
    r'control|elec|phase|tau|index|valid|cell|strain(?!t|ed)|acc(?!um)|dot|err|volt|power|^t$|'
    r'^[ftm][xyz]|(?<![a-z])(mm|[µu]m|inch|q[wxyz])(?![a-z])|'
    rf'^i_?[qd](?![a-z])|{WANTED}|fehler|geschwind|drehzahl|vitesse|[误誤]差|速度|[转轉]速'
)
"""Words in names of columns that are not proposed as angles."""
_LIKELY = re.compile(
    r'(?i)pos|\bq|_q|ang(?!e)|enc(?!y)|theta|winkel|rotation|'
    r'(rad|deg|rev|inc|cnt|counts)(?![a-z]|_(s|per)(?![a-z]))|'
    'accum|lage|geber|codeur|угол|角|位置|编码|編碼|エンコーダ|'
    r'(motor|rotor|input|joint|link|output)$'
)
"""Words in names of columns that are proposed first."""
_NO_NAME = re.compile(r'(?i)(.*\[|(data|ch|channel|column|signal|var|axis|joint|j)[ _]?)?\d+\]?')
"""Names of columns that only count them, or elements of a matrix, or joints."""
_WORD = re.compile(r'(?i)(?!nan|null|none|inf)[^\W\d]')  # in columns of states or names
_TORQUE = re.compile(r'(?i)torq|effort|moment(?!um)|tau|load|n[·.* -]?m\b|^[tm][xyz]$')
"""Words in names of columns that are proposed as torques."""


def advice(
    error: ColumnsError,
    path: Path,
    table: TableFile,
    sources: Sources,
    read: Callable[[Sources], object],
) -> str:
    """Return an error with a command line that works, if any, and the columns if it needs them.

    `read` raises ValueError if the table cannot be read with what is given.
    """
    text = str(error)
    examples: Iterable[Mapping[str, str]] = [error.example]
    if not error.example:
        examples = islice(_examples(table), _TRIED)
        columns = (f'{name} ({table.first.get(name, "")})' for name in table.names if name)
        if len(listed := ', '.join(columns)) > _LISTED:
            listed = f'{listed[: _LISTED // 2]} ... {listed[-_LISTED // 2 :]}'
        text += f' among the columns {listed}; name them with their units'
    for example in examples:
        if complete := _completed(example, sources, read):
            options = {option(field): value for field, value in complete.items()}
            assumed = [
                value.rpartition('[')[2].rstrip(']')
                for value in complete.values()
                if value not in table.names
            ]
            if assumed:
                text += f', with the right values in place of {", ".join(dict.fromkeys(assumed))}'
            command = sources.command or shlex.join(['gearkin', 'lost-motion', str(path)])
            words = [*_without(options, command), *chain(*options.items())]
            return f'{text}, for example: {shlex.join(words)}'
    if error.example or '--' in str(error):
        return str(error)
    return f'{text}, by {", ".join(map(option, ("angle", "torque", "rotor", "output")))}'


def _without(options: Container[str], command: str) -> Iterator[str]:
    """Yield the words of a command line but for some options with their values."""
    words = iter(shlex.split(command))
    for word in words:
        name, given, _ = word.partition('=')
        if name not in options:
            yield word
        elif not given:
            next(words, None)


def rising(table: TableFile) -> dict[str, str]:
    """Return the first of the columns whose numbers only rise, as those of times do, if any."""
    return next(({'time': name} for name, _ in _rising(table, table.names[:_FIRST])), {})


def no_times(table: TableFile, found: Mapping[str, Column]) -> str:
    """Say that no times were found, and which other column may have them, as its numbers rise."""
    used = {column.name for column in found.values()}
    names = [name for name in table.names if name not in used]
    for name, values in islice(_rising(table, names[:_FIRST]), 1):
        if np.any(np.diff(values.astype(float)) != 1.0):  # no numbers of rows
            return f'no times (perhaps --time-column={shlex.quote(name)})'
    return 'no times'


def _rising(table: TableFile, names: Iterable[str]) -> Iterator[tuple[str, Any]]:
    """Yield those of some columns whose numbers only rise, with the numbers, (n,)."""
    for name in filter(None, names):
        try:
            values = np.asarray(table.load([name])[0][name])
        except ValueError:  # of a column that need not be read
            continue
        several = values.dtype.kind in 'iufM' and len(values) > 1
        changes = np.count_nonzero(values[1:] != values[:-1]) if several else 0
        if changes >= min(2, len(values) - 1) > 0 and np.all(values[1:] >= values[:-1]):
            yield name, values


def _loaded(table: TableFile, names: Sequence[str]) -> dict[str, Array]:
    """Load columns, but for those that say no role and cannot be read, such as notes like 1-2."""
    try:
        return table.load(names)[0]
    except ValueError:
        if names[1:]:
            return {k: v for name in names for k, v in _loaded(table, [name]).items()}
        if meaning(names[0]).role:  # its cause says more than any advice
            raise
        return {}


def _completed(
    example: Mapping[str, str], sources: Sources, read: Callable[[Sources], object]
) -> dict[str, str]:
    """Add what else is missing to an example of `Sources`; empty if the table stays unreadable."""
    complete: dict[str, str] = {}
    while example.items() - complete.items():
        complete |= example
        given: dict[str, Any] = {k: int(v) if 'counts' in k else v for k, v in complete.items()}
        try:
            read(replace(sources, **given, as_recorded=False))
        except ColumnsError as error:
            example = error.example
        except ValueError:
            break
        else:
            return complete
    return {}


def _examples(table: TableFile) -> Iterator[Mapping[str, str]]:
    """Yield columns that may be both encoders or angle and torque, the likeliest first."""
    names = [
        name
        for name in filter(None, table.names)
        if list(table.names).count(name) == 1
        and meaning(name).role != 'time'
        and not _WORD.match(table.first.get(name, ''))
    ]
    units = {name: usual_unit(table.units.get(name, '')) or meaning(name).unit for name in names}
    others = {*FOREIGN, *TORQUE_UNITS, *TIME_UNITS}
    angles = [
        name
        for name in filterfalse(_NO_ANGLE.search, names)
        if units[name] in ANGLE_UNITS
        or (units[name] not in others and '/' not in units[name] and _LIKELY.search(name))
        or _NO_NAME.fullmatch(name)
    ]
    torques = [
        name
        for name in filterfalse(re.compile(f'(?i){WANTED}').search, names)
        if units[name] in TORQUE_UNITS or (_TORQUE.search(name) and units[name] not in FOREIGN)
    ]
    # Of columns without names, the first that only rises has times, unless there are but two.
    nameless = {*filter(_NO_NAME.fullmatch, angles)}
    if nameless and (rises := rising(table).get('time')) in nameless:
        left = [name for name in angles if name != rises]
        if left[1:] or len([*_rising(table, left)]) < len(left):
            angles = left
    likely = [name for name in angles if units[name] in ANGLE_UNITS or _LIKELY.search(name)]
    raw = _loaded(table, (likely if len(likely) > 1 else angles)[:_TRIED])
    raw = {name: array.astype(float) for name, array in raw.items() if array.dtype.kind in 'iuf'}
    pairs = [*_alike(raw, {name: ANGLE_UNITS.get(unit) or 0.0 for name, unit in units.items()})]
    yield from ({'rotor': rotor, 'output': output} for sure, rotor, output in pairs if sure)
    # Those of the same actuator share most words; of the axes of a sensor, one is loaded.
    words = {name: {*meaning(name).words} for name in names}
    loads = {
        name: -np.ptp(np.nan_to_num(array)) * TORQUE_UNITS.get(units[name], 1.0)
        for name, array in _loaded(table, torques[:_TRIED]).items()
        if array.dtype.kind in 'iuf' and len(array)
    }
    both = sorted(
        product(likely, loads),
        key=lambda pair: (-len(words[pair[0]] & words[pair[1]]), loads[pair[1]]),
    )
    yield from ({'angle': angle, 'torque': torque} for angle, torque in both if angle != torque)
    yield from ({'rotor': rotor, 'output': output} for sure, rotor, output in pairs if not sure)


def _alike(
    columns: Mapping[str, Array], sizes: Mapping[str, float]
) -> Iterator[tuple[bool, str, str]]:
    """Yield the pairs of columns that move alike, the likeliest first, as rotor and output.

    The rotor is the faster, unless the names say the opposite: where an output wraps, its steps
    are large. `sizes` are those of their units, 0 where unknown: then both are taken to have the
    same unit. A pair is sure if both move much alike and their names do not contradict that. Of
    those that move nearly as alike, the likeliest share the most words, such as those of one
    joint, and say the most sides of the gear. Letters are no words: c1 and c2 are no joint.
    """
    pairs = {}
    for rotor, output in permutations(columns, 2):
        if len(columns[rotor]) != len(columns[output]):
            continue
        pair = np.array([columns[rotor], columns[output]])[:, :_ROWS]
        pair = np.diff(pair[:, np.isfinite(pair).all(axis=0)])
        if sizes[rotor] and sizes[output]:
            pair *= [[sizes[rotor]], [sizes[output]]]
        if pair.shape[1] > _FEWEST and (spread := np.std(pair, axis=1))[0] > spread[1] > 0.0:
            likeness = abs(np.corrcoef(pair)[0, 1])
            fast, slow = meaning(rotor), meaning(output)
            named = not (fast.on_output or slow.on_rotor)
            shared = [w for w in {*fast.words} & {*slow.words} if w.isdigit() or w[1:]]
            said = fast.on_rotor + slow.on_output, slow.on_rotor + fast.on_output
            if likeness > _COPIED:
                likeness = 0.0  # comes last
            sure = named and likeness > _ALIKE
            pair_of = (output, rotor) if said[1] > said[0] else (rotor, output)
            pairs[sure, round(likeness, 1), len(shared) + max(said), likeness] = pair_of
    for key in sorted(pairs, reverse=True)[:_FEWEST]:
        yield key[0], *pairs[key]
