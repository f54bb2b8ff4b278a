# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings as CSV files: one row a sample, one column a quantity, names in the first row."""

import csv
import math
from array import array
from collections.abc import Callable, Iterable, Mapping
from datetime import UTC, datetime
from fractions import Fraction
from functools import partial
from itertools import chain
from pathlib import Path

import numpy as np

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN, split_turns
from gear_kinematics.measurement.columns import KNOWN_UNITS, Column, Sources, find_columns
from gear_kinematics.measurement.encoder_step import step_of
from gear_kinematics.measurement.recording import (
    Array,
    Encoders,
    Recording,
    RecordingError,
    RotorMotion,
    locked_shaft,
)
from gear_kinematics.wire.cdr import SECOND

_MOST_ROWS = 1_800_000
"""Half an hour at 1 kHz: measuring takes up to 250 bytes a row."""
_LEAST = 1e-30
"""Numbers that are smaller are 0: of none of those that follow, squares and inverses underflow."""
_LATEST = 4_102_444_800.0
"""s since 1970: in 2100."""
_LATE_ROWS = 25
"""Rows in succession that are out of order, at most; after more the clock was set back."""
_HALF_TURN = 180.0
"""Degrees, by which the readings of a single-turn encoder jump at least."""
_FASTEST, _MOST = 1000.0, 0.9
"""rad/s, above which a unit is asked for; share of the samples in motion that are slower."""
_MOST_TWIST = 0.5
"""rad of the output under torque: a shaft that turns further is not locked."""
_LONGEST = 2**16
"""Characters in a line."""
_SHOWN = 800
"""Characters of an error, as those of a file can be many."""


def is_csv(path: Path) -> bool:
    """Return whether a recording is a CSV file, by its name; otherwise it is a bag."""
    return path.suffix.lower() in {'.csv', '.tsv', '.txt'}


def read_csv(path: Path, sources: Sources, ratio: Fraction) -> Recording:
    """Read a CSV file of a gear with a ratio; a row was sampled at one time.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """
    found, data, every = _read(path, sources)
    quantities = np.array([values for role, values in data.items() if role != 'time'])
    usable = np.all(np.abs(quantities) <= LARGEST_ANGLE, axis=0)  # NaN compares false
    if not usable.any():
        names = ', '.join(found[role].name for role in data if role != 'time')
        raise RecordingError(f'{path}: no usable rows: none has numbers in all of {names}')
    remarks = [f'one row of {every} is used: no more are kept in memory'] if every > 1 else []
    if left_out := int(np.count_nonzero(~usable)):
        remarks.append(f'{left_out} rows were left out: no numbers, or too large')
    data['segment'] = np.cumsum(~usable)  # the motion in rows that are left out is unknown
    data = {
        role: np.where(np.abs(rows := values[usable]) < _LEAST, 0.0, rows)
        for role, values in data.items()
    }
    if 'time' in data:
        name, seen = found['time'].name, len(data['time'])
        try:
            stamps, kept, end = _stamps(data['time'], found['time'].unit)
        except RecordingError as error:
            raise RecordingError(f'{path}: the times in {name}: {error}') from error
        data = {role: values[kept] for role, values in data.items()} | {'time': stamps}
        if late := end - len(kept):
            remarks.append(f'the time in {name} is out of order in {late} rows: left out')
        if end < seen:
            what = f'goes back after {end} rows: the others are left out'
            remarks.append(f'the time in {name} {what}')
    for role in ('angle', 'rotor', 'output'):
        if role in data and not found[role].unit:
            _refuse_other_units(path, found[role].name, data[role], data.get('time'))
    if 'torque' in data and found['torque'].on_rotor:
        data['torque'] *= float(ratio)
    encoders = locked = None
    if 'rotor' in data:
        encoders = _encoders(data, sources, ratio)
    else:
        angle = found['angle']
        locked = locked_shaft(
            data['torque'],
            data['angle'],
            step_of(sources.rotor_counts, data['angle']),
            ratio if angle.on_rotor else Fraction(1),
            measured=angle.on_output,
        )
        if (twist := np.ptp(locked.angle)) > _MOST_TWIST:
            raise RecordingError(
                f'{path}: the output turns by {np.degrees(twist):.3g}° under torque: it is not '
                'locked, or the unit is another, which --angle-unit gives'
            )
    return Recording(
        path, path.name, tuple(_described(found)), len(usable), encoders, locked,
        tuple(remarks),
    )  # fmt: skip


def _refuse_other_units(path: Path, name: str, angle: Array, stamps: Array | None) -> None:
    """Raise RecordingError if angles without a unit seem to be none in rad."""
    span, step = np.ptp(angle), np.abs(np.diff(angle))
    cause = ''
    if span > TURN and np.all(angle == np.round(angle)):
        cause = 'whole numbers, such as counts'
    elif _HALF_TURN < np.max(step, initial=0.0) <= span <= 2.0 * _HALF_TURN:
        cause = 'turns of 360, such as degrees'
    elif stamps is not None:
        moved = step[step > 0.0] / np.maximum(np.diff(stamps)[step > 0.0], 1) * SECOND
        if len(moved) and (speed := np.quantile(moved, _MOST)) > _FASTEST:
            cause = f'speeds of {speed:.3g} a second, as in degrees'
    if cause:
        raise RecordingError(f'{path}: {name} has {cause}: give its unit with --angle-unit')


def _stamps(time: Array, unit: str) -> tuple[Array, Array, int]:
    """Stamps, ns, of the rows that are in order, which those are, and the row where they end.

    They end where the clock was set back.

    Raises:
        RecordingError: if they are no times.
    """
    if not np.all(np.abs(time) < _LATEST):  # NaN compares false
        raise RecordingError('no numbers, or too large to be s: name their unit, as in time_ns')
    late = time < np.maximum.accumulate(time)
    edges = np.flatnonzero(np.diff(late, prepend=False, append=False))
    long = edges[::2][edges[1::2] - edges[::2] > _LATE_ROWS]
    end = int(long[0]) if len(long) else len(time)
    kept = np.flatnonzero(~late[:end])
    time = time[kept]
    if time[-1] == time[0]:
        raise RecordingError('they stand still')
    if not unit and np.all(time == np.round(time)):
        raise RecordingError('whole numbers without a unit: name it, as in time_ms or time_s')
    return np.round(time * SECOND).astype(np.int64), kept, end


def _encoders(data: Mapping[str, Array], sources: Sources, ratio: Fraction) -> Encoders:
    rows = np.arange(len(data['rotor']))
    stamp = data.get('time', rows * SECOND)
    effort = data['torque'] / float(ratio) if 'torque' in data else None
    return Encoders(
        RotorMotion(stamp, *split_turns(data['rotor']), effort, data['segment']),
        timed='time' in data,
        before=rows,
        share=np.zeros(len(rows)),
        measured=data['output'],
        rotor_step=step_of(sources.rotor_counts, data['rotor']),
        output_step=step_of(sources.output_counts, data['output']),
    )


def _described(found: Mapping[str, Column]) -> Iterable[str]:
    for role, column in found.items():
        unit = column.unit or {'torque': 'nm', 'time': 's'}.get(role, 'rad, which is assumed')
        side = ''
        if role in {'angle', 'torque'}:
            side = ' of the rotor' if column.on_rotor else ' at the output'
        yield f'{role}{side} from {column.name} in {unit.replace("nm", "N·m")}'


def _read(path: Path, sources: Sources) -> tuple[dict[str, Column], dict[str, Array], int]:
    """The columns that are needed, row by row, in SI units; NaN in empty rows.

    Of long files only one row of many, the third result, so that their memory is bounded.
    """
    if path.exists() and not path.is_file():
        raise RecordingError(f'{path}: not a regular file')
    try:
        with path.open(encoding='utf-8-sig') as file:
            lines = iter(partial(file.readline, _LONGEST), '')
            number, first = next(
                (pair for pair in enumerate(lines, 1) if not _is_remark(pair[1])), (1, '')
            )
            if len(first) == _LONGEST:
                raise ValueError(f'the first row is longer than {_LONGEST} characters')
            delimiter = max(',;\t', key=first.count)
            rows = csv.reader(chain([first], lines), delimiter=delimiter)
            header = [name.strip() for name in next(rows, [])]
            if sum(_is_number(name) for name in header) > len(header) / 2:
                raise ValueError('the first row has numbers: put a row of names above them')
            second = next(rows, [])
            below = _units_below(header, second)
            found = find_columns(header, sources, below) if header else {}
            for column in found.values():
                if header.count(column.name) > 1:
                    raise ValueError(f'more than one column {column.name!r}')
            samples = rows if below or not second else chain([second], rows)
            start = number + (2 if below else 1)
            values, every = _numbers(header, samples, found, start, delimiter)
    except (OSError, UnicodeDecodeError) as error:
        cause = getattr(error, 'strerror', None) or 'not text in UTF-8'
        raise RecordingError(f'{path}: {cause}') from error
    except (csv.Error, ValueError) as error:
        text = str(error)
        if len(text) > _SHOWN:
            text = f'{text[: _SHOWN // 2]} ... {text[-_SHOWN // 2 :]}'
        raise RecordingError(f'{path}: {text}') from error
    if not len(values):
        raise RecordingError(f'{path}: no samples in it')
    columns = enumerate(found.items())
    return found, {r: values[:, place] * column.scale for place, (r, column) in columns}, every


def _is_remark(line: str) -> bool:
    return not line.strip() or line.lower().startswith(('#', '//', 'sep='))


def _units_below(header: list[str], row: list[str]) -> dict[str, str]:
    """The units in a row below the names, by name; none if the row has numbers.

    Raises:
        ValueError: if the row has neither units nor numbers.
    """
    units = {name: text.strip(' []()').lower() for name, text in zip(header, row, strict=False)}
    units = {name: unit for name, unit in units.items() if unit}
    if not units or any(unit[0] in '+-.0123456789' or _is_number(unit) for unit in units.values()):
        return {}
    if not KNOWN_UNITS.intersection(units.values()):
        raise ValueError(f'neither numbers nor known units below the names: {", ".join(row)}')
    return units


def _is_number(text: str) -> bool:
    return not math.isnan(_number(text, '.')) or text.strip().lower() == 'nan'


def _numbers(
    header: list[str],
    rows: Iterable[list[str]],
    found: Mapping[str, Column],
    start: int,
    delimiter: str,
) -> tuple[Array, int]:
    point = '.' if delimiter == ',' else ','
    readers: list[tuple[int, Callable[[str, str], float]]] = [
        (header.index(column.name), _moment if role == 'time' else _number)
        for role, column in found.items()
    ]
    values = array('d')  # a row takes no more memory than its numbers
    width, every, cut = len(readers), 1, 0
    for line, row in enumerate(rows, start):
        if cut:
            raise ValueError(f'line {cut}: too few columns')
        if (line - start) % every:
            continue
        if len(values) >= _MOST_ROWS * width > 0:
            values = array('d', np.frombuffer(values).reshape(-1, width)[::2].tobytes())
            every *= 2
        try:
            values.extend([read(row[at], point) if row else math.nan for at, read in readers])
        except IndexError:
            values.extend([math.nan] * width)
            cut = line  # which only the last may be, where writing was cut off
    return np.frombuffer(values).reshape(-1, max(1, width)), every


def _number(text: str, point: str) -> float:
    try:
        return float(text)
    except ValueError:
        return (
            math.nan
            if point not in text or point == '.'
            else _number(text.replace(point, '.'), '.')
        )


def _moment(text: str, point: str) -> float:
    """A time as a number, or s since 1970 of one in ISO 8601, in UTC unless it says another."""
    if not math.isnan(number := _number(text, point)):
        return number
    try:
        moment = datetime.fromisoformat(text.strip())
    except ValueError:
        return math.nan
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
