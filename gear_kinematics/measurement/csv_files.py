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
from gear_kinematics.measurement.clock import ClockError, dates_of, times_of_rows, unit_since_1970
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


def is_csv(path: Path) -> bool:
    """Return whether a recording is a CSV file, by its name; otherwise it is a bag."""
    return path.suffix.lower() in {'.csv', '.tsv', '.txt'}


def read_csv(path: Path, columns: Columns, ratio: Fraction) -> Recording:
    """Read a CSV file of a gear with a ratio; a row was sampled at one time.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """
    found, data = _read(path, columns)
    quantities = np.array([values for role, values in data.items() if role != 'time'])
    usable = np.all(np.abs(quantities) <= LARGEST_ANGLE, axis=0)  # NaN compares false
    if not usable.any():
        raise RecordingError(f'{path}: no usable rows')
    remarks = []
    if left_out := int(np.count_nonzero(~usable)):
        remarks.append(f'{left_out} rows were left out: not finite, or too large')
    data['segment'] = np.cumsum(~usable)  # the motion in rows that are left out is unknown
    data = {role: values[usable] for role, values in data.items()}
    start = None
    if 'time' in data:
        name, time = found['time'].name, data.pop('time')
        if not found['time'].unit:
            time *= unit_since_1970(time[0]) or 1.0
        start = float(time[0]) if unit_since_1970(time[0]) else None
        try:
            data['time'] = times_of_rows(time)
        except ClockError as error:
            if columns.time:
                raise RecordingError(f'{path}: the times in {name}: {error}') from error
            remarks.append(f'the times in {name} are not used: {error}')
        else:
            if (kept := len(data['time'])) < len(time):
                remarks.append(
                    f'the time in {name} goes back after {kept} rows: the others are left out'
                )
                data = {role: values[:kept] for role, values in data.items()}
    if 'torque' in data and found['torque'].on_rotor:
        data['torque'] *= float(ratio)
    encoders = locked = None
    if 'rotor' in data:
        encoders = _encoders(data, columns, ratio)
    else:
        locked = _locked(data, columns, ratio if found['angle'].on_rotor else Fraction(1))
    return Recording(
        path, path.name, tuple(_described(found)), len(usable), dates_of(path, start),
        encoders, locked, tuple(remarks),
    )  # fmt: skip


def _encoders(data: Mapping[str, Array], columns: Columns, ratio: Fraction) -> Encoders:
    rows, time = np.arange(len(data['rotor'])), data.get('time')
    stamp = np.round((rows if time is None else time) * SECOND).astype(np.int64)
    effort = data['torque'] / float(ratio) if 'torque' in data else None
    return Encoders(
        RotorMotion(stamp, *split_turns(data['rotor']), effort, data['segment']),
        timed=time is not None,
        before=rows,
        share=np.zeros(len(rows)),
        measured=data['output'],
        rotor_step=step_of(columns.rotor_counts, data['rotor']),
        output_step=step_of(columns.output_counts, data['output']),
    )


def _locked(data: Mapping[str, Array], columns: Columns, ratio: Fraction) -> Loading:
    """Angle and torque in one column each; the ratio is that of the angle to the output."""
    angle = data['angle']
    step = step_of(columns.rotor_counts, angle).scaled(float(1 / ratio))
    time = data.get('time')
    return Loading(data['torque'], angle / float(ratio), step, measured=False, time=time)


def _described(found: Mapping[str, Column]) -> Iterable[str]:
    for role, column in found.items():
        unit = column.unit or {'torque': 'nm', 'time': 's'}.get(role, 'rad, which is assumed')
        side = ''
        if role in {'angle', 'torque'}:
            side = ' of the rotor' if column.on_rotor else ' at the output'
        yield f'{role}{side} from {column.name} in {unit.replace("nm", "N·m")}'


def _read(path: Path, columns: Columns) -> tuple[dict[str, Column], dict[str, Array]]:
    """The columns that are needed, row by row, in SI units; NaN in empty rows."""
    try:
        with path.open(encoding='utf-8-sig') as file:
            first = file.readline()
            rows = csv.reader(chain([first], file), delimiter=max(',;\t', key=first.count))
            header = [name.strip() for name in next(rows)]
            for name, count in Counter(header).items():
                if count > 1:
                    raise ValueError(f'more than one column {name!r}')
            found = find_columns(header, columns) if header else {}
            values = _numbers(header, rows, found)
    except (OSError, UnicodeDecodeError) as error:
        cause = getattr(error, 'strerror', None) or 'not text in UTF-8'
        raise RecordingError(f'{path}: {cause}') from error
    except (csv.Error, ValueError) as error:
        raise RecordingError(f'{path}: {error}') from error
    if not len(values):
        raise RecordingError(f'{path}: no samples in it')
    return found, {
        role: values[:, place] * column.scale for place, (role, column) in enumerate(found.items())
    }


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
        except (IndexError, ValueError) as error:
            cause = 'too few columns' if isinstance(error, IndexError) else error
            raise ValueError(f'line {line}: {cause}') from error
    return np.frombuffer(values).reshape(-1, max(1, len(readers)))


def _number_or_nan(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
