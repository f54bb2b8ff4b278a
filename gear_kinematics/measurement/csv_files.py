"""Recordings as CSV files: one row a sample, one column a quantity, names in the first row."""

import csv
import math
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import chain
from pathlib import Path

import numpy as np

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, split_turns
from gear_kinematics.measurement.clock import (
    ClockError,
    before_set_back,
    dates_of,
    times_of_rows,
    unit_since_1970,
)
from gear_kinematics.measurement.columns import Column, Columns, find_columns
from gear_kinematics.measurement.encoder_step import step_of
from gear_kinematics.measurement.recording import (
    Array,
    Encoders,
    Loading,
    Recording,
    RecordingError,
    RotorMotion,
)
from gear_kinematics.wire.cdr import SECOND


class CsvError(RecordingError):
    """A CSV file that cannot be used; the text is one line that names it and the cause."""


def is_csv(path: Path) -> bool:
    """Return whether a recording is a CSV file, by its name; otherwise it is a bag."""
    return path.suffix.lower() in {'.csv', '.tsv', '.txt'}


def read_csv(path: Path, columns: Columns, ratio: Fraction) -> Recording:
    """Read a CSV file; all quantities of a row were sampled at one time.

    Args:
        path: of the file.
        columns: what is known of them.
        ratio: of the gear, to the output.

    Raises:
        CsvError: if it cannot be read, or has no such columns.
    """
    found, data = _read(path, columns)
    values, usable = np.array([v for r, v in data.items() if r != 'time']), None
    usable = np.all(np.abs(values) <= LARGEST_ANGLE, axis=0)  # NaN compares false
    rows = len(usable)
    remarks = []
    if left_out := rows - int(np.count_nonzero(usable)):
        remarks.append(f'{left_out} rows were left out: not finite, or too large')
    segment = np.cumsum(~usable)[usable]  # the motion in rows that are left out is unknown
    data = {role: column[usable] for role, column in data.items()}
    if not usable.any():
        raise CsvError(f'{path}: no usable rows')
    start = None
    if 'time' in data:
        column = found['time']
        scale = 1.0 if column.unit else unit_since_1970(float(data['time'][0])) or 1.0
        raw = data.pop('time') * scale
        start = float(raw[0]) if unit_since_1970(float(raw[0])) else None
        kept = before_set_back(raw)
        try:
            if 2 * kept < len(raw):
                raise ClockError('they go back')
            data['time'] = times_of_rows(raw[:kept])
        except ClockError as error:
            if columns.time:
                raise CsvError(f'{path}: the times in {columns.time}: {error}') from error
            remarks.append(f'the times in {column.name} are not used: {error}')
            kept = len(raw)
        if kept < len(raw):
            remarks.append(
                f'the time in {column.name} goes back after {kept} rows: the others are left out'
            )
            data = {role: values[:kept] for role, values in data.items()}
            segment = segment[:kept]
    if 'torque' in data and found['torque'].on_rotor:
        data['torque'] = data['torque'] * float(ratio)
    return Recording(
        path,
        path.name,
        tuple(_described(found)),
        rows,
        dates_of(path, start),
        _encoders(data, columns, ratio, segment) if 'rotor' in data else None,
        _locked(data, columns, found, ratio) if 'angle' in data else None,
        tuple(remarks),
    )


def _encoders(
    data: Mapping[str, Array], columns: Columns, ratio: Fraction, segment: Array
) -> Encoders:
    turns, angle = split_turns(data['rotor'])
    count, time = len(turns), data.get('time')
    stamp = np.round((np.arange(count) if time is None else time) * SECOND).astype(np.int64)
    effort = data['torque'] / float(ratio) if 'torque' in data else None
    return Encoders(
        RotorMotion(stamp, turns, angle, effort, segment),
        timed=time is not None,
        before=np.arange(count),
        share=np.zeros(count),
        measured=data['output'],
        rotor_step=step_of(columns.rotor_counts, data['rotor']),
        output_step=step_of(columns.output_counts, data['output']),
    )


def _locked(
    data: Mapping[str, Array], columns: Columns, found: Mapping[str, Column], ratio: Fraction
) -> Loading:
    angle, step = data['angle'], step_of(columns.rotor_counts, data['angle'])
    if found['angle'].on_rotor:
        angle, step = angle / float(ratio), step.scaled(float(1 / ratio))
    return Loading(data['torque'], angle, step, measured=False, time=data.get('time'))


def _described(found: Mapping[str, Column]) -> Iterable[str]:
    for role, column in found.items():
        unit = column.unit or {'torque': 'N·m', 'time': 's'}.get(role, 'rad (assumed)')
        side = ''
        if role in {'angle', 'torque'}:
            side = ' of the rotor' if column.on_rotor else ' at the output'
        yield f'{role} {column.name}{side}, {unit}'


def _read(path: Path, columns: Columns) -> tuple[dict[str, Column], dict[str, Array]]:
    """The columns that are needed, row by row, in SI units; NaN in empty rows."""
    try:
        with path.open(encoding='utf-8-sig') as file:
            first = file.readline()
            rows = csv.reader(chain([first], file), delimiter=max(',;\t', key=first.count))
            header = [name.strip() for name in next(rows)]
            twice = [name for name, count in Counter(header).items() if count > 1]
            if twice:
                raise CsvError(f'{path}: more than one column {twice[0]!r}')
            found = find_columns(header, columns) if header else {}
            values = _numbers(header, rows, found)
    except (OSError, UnicodeDecodeError) as error:
        cause = getattr(error, 'strerror', None) or 'not text in UTF-8'
        raise CsvError(f'{path}: {cause}') from error
    except CsvError:
        raise
    except (csv.Error, ValueError) as error:
        raise CsvError(f'{path}: {error}') from error
    if not len(values):
        raise CsvError(f'{path}: no samples in it')
    scales = [column.scale for column in found.values()]
    return found, dict(zip(found, values.T * np.array(scales)[:, None], strict=True))


def _numbers(header: list[str], rows: Iterable[list[str]], found: Mapping[str, Column]) -> Array:
    readers = [
        (header.index(column.name), _number_or_nan if role == 'time' else float)
        for role, column in found.items()
    ]
    values = array('d')  # a row takes no more memory than its numbers
    nothing = len(readers) * [math.nan]
    for line, row in enumerate(rows, start=2):
        try:
            values.extend([read(row[place]) for place, read in readers] if row else nothing)
        except IndexError as error:
            raise ValueError(f'line {line}: too few columns') from error
        except ValueError as error:
            raise ValueError(f'line {line}: {error}') from error
    return np.frombuffer(values).reshape(-1, max(1, len(readers)))


def _number_or_nan(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
