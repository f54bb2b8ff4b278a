# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings as CSV files: one row a sample, one column a quantity, names in the first row."""

import csv
import math
import re
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from itertools import chain, product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN, split_turns
from gear_kinematics.measurement.encoder_step import UNITS, step_of
from gear_kinematics.measurement.recording import (
    Array,
    Encoders,
    Recording,
    RecordingError,
    RotorMotion,
    locked_shaft,
)
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.nearest import among
from gear_kinematics.wire.topics import OUTPUT_ENCODER

_ROTOR, _OUTPUT = ('rotor', 'motor', 'odrive'), ('output', 'load', 'shaft', 'link')
"""Words for either side of the gear."""
_ANGLES = ('position', 'pos', 'angle', 'encoder', 'enc')
_ENCODERS = ('', *_ANGLES, 'encoder_position', 'encoder_pos')
_TORQUES = ('torque', 'effort')


def _joined(*words: Sequence[str]) -> tuple[str, ...]:
    return tuple('_'.join(filter(None, several)) for several in product(*words))


_NAMES: Mapping[str, tuple[str, ...]] = {
    'angle': (*_joined(('', 'encoder', 'enc'), _ANGLES), 'deflection', 'twist'),
    'torque': _joined(('', 'measured', 'output', 'load', 'motor', 'motor_current'), _TORQUES),
    'rotor': _joined(_ROTOR, _ENCODERS),
    'output': (*_joined(_OUTPUT, _ENCODERS), OUTPUT_ENCODER),
    'time': ('time', 't', 'stamp', 'timestamp'),
}
"""Names of columns without their units, the likeliest first."""
_COUNTS = ('counts', 'count', 'cnt', 'inc', 'increments', 'ticks')
ANGLE_UNITS = (*UNITS, 'counts')
"""Units of angle that can be given."""
_ANGULAR = ('angle', 'rotor', 'output')
_OF_ANGLE = {**UNITS, '°': UNITS['deg'], 'turns': TURN, **dict.fromkeys(_COUNTS)}
_UNITS: Mapping[str, Mapping[str, float | None]] = {
    **dict.fromkeys(_ANGULAR, _OF_ANGLE),
    'torque': {'nm': 1.0, 'n·m': 1.0, 'n*m': 1.0, 'n.m': 1.0, 'mnm': 1e-3},
    'time': {'s': 1.0, 'sec': 1.0, 'ms': 1e-3, 'us': 1e-6, 'µs': 1e-6, 'ns': 1e-9},
}
"""In SI units; None: counts of an encoder."""
_KNOWN_UNITS = {unit for units in _UNITS.values() for unit in units}
_BRACKETS = re.compile(r'[\[(]\s*([^\])]*?)\s*[\])]')
_WORD = re.compile(r'[^\s_/-]+')
_MOST_ROWS = 1_800_000
"""Half an hour at 1 kHz: measuring takes up to 250 bytes a row."""
_LEAST = 1e-30
"""Numbers that are smaller are 0: of none of those that follow, squares and inverses underflow."""
_LATEST = 4_102_444_800.0
"""s since 1970: in 2100."""
_LONGEST = 2**16
"""Characters in a line."""
_SHOWN = 800
"""Characters of an error, as those of a file can be many."""
_MOTEUS = {'position', 'torque', 'q_current'}
"""Registers of moteus motor controllers, which give positions in revolutions."""


@dataclass(frozen=True, slots=True)
class Sources:
    """Columns of a CSV file and topics of a bag; those that are None are found by their names."""

    angle: str | None = None
    torque: str | None = None
    rotor: str | None = None
    output: str | None = None
    unit: str | None = None
    """Unit of all angles, one of ANGLE_UNITS; None: by their names, or rad."""
    on_rotor: bool = False
    """Whether angle and torque are the rotor's, unless their names say the output's."""
    rotor_counts: int | None = None
    """Counts per turn of the encoder of the rotor, or of the angle column."""
    output_counts: int | None = None
    """The same of the output's encoder."""
    raw_counts: bool = False
    """Whether counts stay what they are, where those per turn are not given."""
    rotor_topic: str | None = None
    encoder_topic: str | None = None


class Column(NamedTuple):
    """A column that is read."""

    name: str
    scale: float
    """Of its numbers, to rad, N·m or s."""
    unit: str
    """For the report; empty where nothing is known."""
    on_rotor: bool
    on_output: bool
    """Whether its name says so."""


def find_columns(header: Sequence[str], given: Sources) -> dict[str, Column]:
    """Find what can be read: angle and torque, or rotor and output, with torque and time if any.

    Args:
        header: the names in a file.
        given: what is known of them.

    Raises:
        ValueError: if they do not suffice, or a unit is not known.
    """
    named = {role: name for role in _NAMES if (name := getattr(given, role, None))}
    for name in named.values():
        if name not in header:
            raise ValueError(f'no column {name!r}{among(name, header, most=len(header))}')
    known = {_split(name)[0]: name for name in reversed(header)}
    found = {
        role: name
        for role, names in _NAMES.items()
        if (name := named.get(role) or next((known[n] for n in names if n in known), None))
    }
    if {'rotor', 'output'} <= found.keys() and 'angle' not in named:
        found.pop('angle', None)
    elif 'torque' in found and (angles := [found[role] for role in _ANGULAR if role in found]):
        found = {'angle': angles[0], 'torque': found['torque']}
    else:
        raise ValueError(
            'neither an angle and a torque nor a rotor and an output among the columns '
            f'{", ".join(header)}; name them with --angle-column, --torque-column, '
            f'--rotor-column, --output-column; units: {_listed("angle")}, {_listed("torque")}'
        )
    moteus = {name.lower() for name in header} >= _MOTEUS
    units = [_split(found[role])[1] for role in _ANGULAR if role in found]
    common = next(filter(None, units), 'rev' if moteus else '')
    return {role: _column(role, name, given, common) for role, name in found.items()}


def _column(role: str, name: str, given: Sources, common: str) -> Column:
    plain, unit = _split(name)
    if unit and unit not in _UNITS[role] and not (given.unit and role in _ANGULAR):
        raise ValueError(f'{name}: the unit {unit} is not known; known: {_listed(role)}')
    if role in _ANGULAR:
        unit = given.unit or unit or common
    scale = _UNITS[role].get(unit, 1.0)
    if scale is None:
        encoder = 'output' if role == 'output' else 'rotor'
        counts = getattr(given, f'{encoder}_counts')
        if counts is None and not given.raw_counts:
            raise ValueError(f'{name} has counts: give those per turn with --{encoder}-counts')
        scale = TURN / counts if counts else 1.0
        unit = f'{counts} counts a turn' if counts else 'counts'
    on_output = plain.partition('_')[0] in _OUTPUT
    return Column(name, scale, unit, given.on_rotor and not on_output, on_output)


def _split(name: str) -> tuple[str, str]:
    """A name without its unit, in the form of `_NAMES`, and the unit, in brackets or known."""
    text, unit = name.strip().lower(), ''
    if brackets := _BRACKETS.search(text):
        text, unit = text.replace(brackets[0], ' '), brackets[1]
    words = _WORD.findall(text)
    if not unit and words and words[-1] in _KNOWN_UNITS:
        unit = words.pop()
    return '_'.join(words), unit


def _listed(role: str) -> str:
    return ', '.join(sorted(_UNITS[role]))


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
        raise RecordingError(f'{path}: no usable rows')
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
            data['time'] = _stamps(data['time'])
        except RecordingError as error:
            del data['time']
            remarks.append(f'the times in {name} are not used: {error}')
        else:
            kept = len(data['time'])
            data = {role: values[:kept] for role, values in data.items()}
            if kept < seen:
                what = f'goes back after {kept} rows: the others are left out'
                remarks.append(f'the time in {name} {what}')
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
    return Recording(
        path, path.name, tuple(_described(found)), len(usable), encoders, locked,
        tuple(remarks),
    )  # fmt: skip


def _stamps(time: Array) -> Array:
    """Stamps, ns, of the rows before the clock was set back, by their times in s.

    Raises:
        RecordingError: if they are no times.
    """
    if not np.all(np.abs(time) < _LATEST):  # NaN compares false
        raise RecordingError('no numbers, or too large to be s: name their unit, as in time_ns')
    back = np.flatnonzero(np.diff(time) < 0.0)
    time = time[: back[0] + 1] if len(back) else time
    if time[-1] == time[0]:
        raise RecordingError('they stand still')
    return np.round(time * SECOND).astype(np.int64)


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
            first, lines = file.readline(_LONGEST), iter(partial(file.readline, _LONGEST), '')
            if len(first) == _LONGEST:
                raise ValueError(f'the first row is longer than {_LONGEST} characters')
            rows = csv.reader(chain([first], lines), delimiter=max(',;\t', key=first.count))
            header = [name.strip() for name in next(rows)]
            for name, count in Counter(header).items():
                if count > 1:
                    raise ValueError(f'more than one column {name!r}')
            found = find_columns(header, sources) if header else {}
            values, every = _numbers(header, rows, found)
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


def _numbers(
    header: list[str], rows: Iterable[list[str]], found: Mapping[str, Column]
) -> tuple[Array, int]:
    places = [header.index(column.name) for column in found.values()]
    values = array('d')  # a row takes no more memory than its numbers
    width, every = len(places), 1
    for line, row in enumerate(rows, start=2):
        if (line - 2) % every:
            continue
        if len(values) >= _MOST_ROWS * width > 0:
            values = array('d', np.frombuffer(values).reshape(-1, width)[::2].tobytes())
            every *= 2
        try:
            values.extend(_number(row[place]) if row else math.nan for place in places)
        except IndexError as error:
            raise ValueError(f'line {line}: too few columns') from error
    return np.frombuffer(values).reshape(-1, max(1, width)), every


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
