"""Recordings as CSV files: one row a sample, one column a quantity, names in the first row."""

import csv
import math
import re
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear, GearRatio
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, split_turns
from gear_kinematics.lost_motion.recorded.clock import ClockError, times_of_rows, unit_since_1970
from gear_kinematics.lost_motion.recorded.encoder_step import UNITS, step_of
from gear_kinematics.lost_motion.recorded.motion import Motion
from gear_kinematics.lost_motion.recorded.recording import Loading, Recording
from gear_kinematics.state.transmission_error import TransmissionError
from gear_kinematics.wire.nearest import among
from gear_kinematics.wire.topics import OUTPUT_ENCODER

Array = NDArray[np.float64]

_NAMES: Mapping[str, tuple[str, ...]] = {
    'angle': ('position', 'angle', 'deflection', 'twist', 'motor_position'),
    'torque': ('torque', 'effort', 'measured_torque', 'motor_torque'),
    'rotor': ('rotor_position', 'rotor_angle', 'rotor'),
    'output': ('output_position', 'output_angle', OUTPUT_ENCODER, 'output'),
    'time': ('time', 't', 'stamp', 'timestamp'),
}
"""Names of columns, in upper or lower case, with or without a unit appended."""
_ANGLES = ('angle', 'rotor', 'output')
ENCODERS = (('rotor', 'output'), ('rotor', 'output', 'torque'), ('rotor', 'output', 'time'))
"""Sets of columns of recordings with an encoder at rotor and output."""
_SETS = (('angle', 'torque'), *ENCODERS[:2])
"""Sets of columns that can be evaluated for lost motion."""
_TIME_UNITS = {'s': 1.0, 'ms': 1e-3, 'us': 1e-6, 'µs': 1e-6, 'ns': 1e-9}
"""s."""
_UNIT = re.compile(rf'[\s_]*[\[(]?({"|".join(UNITS)})[\])]?$')
_TORQUE_UNIT = re.compile(r'[\s_]*[\[(]?n[·*.]?m[\])]?$')
_TIME_UNIT = re.compile(r'[\s_]*(?:_|[\[(])(s|ms|us|µs|ns)[\])]?$')
_MOTEUS = {'position', 'torque', 'q_current'}
"""Registers of moteus motor controllers, which give positions in revolutions."""


class CsvError(ValueError):
    """A CSV file that cannot be used; the text is one line that names it and the cause."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Names and contents of columns; a column with the name None is found by `_NAMES`."""

    angle: str | None = None
    torque: str | None = None
    rotor: str | None = None
    output: str | None = None
    time: str | None = None
    unit: str | None = None
    """Unit of all angles, a key of UNITS."""
    on_rotor: bool = False
    """Whether angle and torque are the rotor's, not those at the output."""


def is_csv(path: Path) -> bool:
    """Return whether a recording is a CSV file, by its name; otherwise it is a bag."""
    return path.suffix.lower() in {'.csv', '.tsv', '.txt'}


def read_csv(
    path: Path,
    gear: Gear,
    columns: Columns,
    travel: float,
    counts: int | None = None,
    output_counts: int | None = None,
) -> Recording:
    """Read a CSV file.

    Args:
        path: of the file.
        gear: gives the gear ratio.
        columns: the columns to read.
        travel: rad of the output after a reversal, until the new direction counts.
        counts: steps per turn of the encoder of the angle or rotor column.
        output_counts: steps per turn of the output's encoder.

    Raises:
        CsvError: if it cannot be read, or has no such columns.
    """
    table = read_columns(path, columns, _SETS, optional=('time',))
    found, values = table.found, table.values
    needed = [column for column, role in enumerate(found) if role != 'time']
    usable = np.all(np.abs(values[:, needed]) <= LARGEST_ANGLE, axis=1)  # NaN compares false
    data = dict(zip(found, values[usable].T, strict=True))
    left_out = int(np.count_nonzero(~usable))
    remarks = [f'{left_out} rows were left out: not finite, or too large'] if left_out else []
    ratio = gear.gear_ratio
    loading = motion = time = None
    if 'time' in data and 'torque' in data and usable.any():
        try:
            time = times_of_rows(data['time'])
        except ClockError as error:
            if columns.time:
                raise CsvError(f'{path}: the times in {columns.time}: {error}') from error
            remarks.append(f'The times in {found["time"]} are not used: {error}.')
    if columns.on_rotor and 'torque' in data:
        data['torque'] *= float(ratio)
    if 'rotor' in data:
        motion = _motion(ratio, data, travel, counts, output_counts)
    if 'angle' in data:
        loading = _loading(ratio, data, counts, time, on_rotor=columns.on_rotor)
    elif motion and 'torque' in data:
        loading = Loading.of_gear(data['torque'], motion, time)
    return Recording(
        path.name,
        tuple(_described(table, on_rotor=columns.on_rotor)),
        len(usable),
        loading,
        motion,
        tuple(remarks),
    )


class Table(NamedTuple):
    """Columns of a file."""

    found: Mapping[str, str]
    """Their names, by what they hold."""
    values: Array
    """(rows, columns), rad, N·m and s; NaN in empty rows."""
    unit: str
    """Of the angles."""
    why: str
    """Where the unit comes from."""


def read_columns(
    path: Path,
    columns: Columns,
    sets: Sequence[tuple[str, ...]],
    optional: Sequence[str] = (),
) -> Table:
    """Read the columns of a CSV file that are needed, row by row.

    Args:
        path: of the file.
        columns: names that are known.
        sets: of columns that can be used together.
        optional: columns that are read where they exist; NaN where they contain no number.

    Raises:
        CsvError: if it cannot be read, or has none of the sets.
    """
    try:
        with path.open(encoding='utf-8-sig') as file:
            first = file.readline()
            rows = csv.reader(chain([first], file), delimiter=max(',;\t', key=first.count))
            header = [name.strip() for name in next(rows)]
            found = _find(path, header, columns, sets, optional) if header else {}
            lenient = [role in optional for role in found]
            values = _numbers(path, header, rows, list(found.values()), lenient)
    except (OSError, UnicodeDecodeError) as error:
        cause = getattr(error, 'strerror', None) or 'not text in UTF-8'
        raise CsvError(f'{path}: {cause}') from error
    except csv.Error as error:
        raise CsvError(f'{path}: {error}') from error
    if not len(values):
        raise CsvError(f'{path}: no samples in it')
    unit, why = _unit(path, header, columns, found)
    for column, (role, name) in enumerate(found.items()):
        if role in _ANGLES:
            values[:, column] *= UNITS[unit]
        elif role == 'time':
            suffix = _TIME_UNIT.search(name.lower())
            values[:, column] *= (
                _TIME_UNITS[suffix[1]] if suffix else unit_since_1970(values[0, column]) or 1.0
            )
    return Table(found, values, unit, why)


def _find(
    path: Path,
    header: Sequence[str],
    columns: Columns,
    sets: Sequence[tuple[str, ...]],
    optional: Sequence[str],
) -> dict[str, str]:
    """The columns to read, by their role."""
    twice = [name for name, count in Counter(header).items() if count > 1]
    if twice:
        raise CsvError(f'{path}: more than one column {twice[0]!r}')
    given = {role: name for role in _NAMES if (name := getattr(columns, role))}
    for name in given.values():
        if name not in header:
            raise CsvError(f'{path}: no column {name!r}{among(name, header, most=len(header))}')
    plain = {_plain(name): name for name in reversed(header)}
    found = {
        role: name
        for role, names in _NAMES.items()
        if (name := given.get(role) or next((plain[n] for n in names if n in plain), None))
    }
    together = [roles for roles in sets if found.keys() >= {*roles}]
    if not together:
        pairs = dict.fromkeys(' and '.join(map(_with_article, roles[:2])) for roles in sets)
        lacking = 'neither' if len(pairs) > 1 else 'not both'
        options = ', '.join(f'--{role}-column' for role in _NAMES if any(role in s for s in sets))
        raise CsvError(
            f'{path}: {lacking} {" nor ".join(pairs)} among the columns '
            f'{", ".join(header)}; name them with {options}'
        )
    more = tuple(role for role in optional if role in found)
    return {role: found[role] for roles in (*together, more) for role in roles}


def _with_article(role: str) -> str:
    return f'{"an" if role[0] in "aeiou" else "a"} {role}'


def _plain(name: str) -> str:
    """A name without its unit, in the form of `_NAMES`."""
    plain = name.lower()
    for unit in (_UNIT, _TORQUE_UNIT, _TIME_UNIT):
        plain = unit.sub('', plain)
    return plain.strip().replace(' ', '_')


def _numbers(
    path: Path,
    header: Sequence[str],
    rows: Iterable[Sequence[str]],
    names: Sequence[str],
    lenient: Sequence[bool],
) -> Array:
    readers = [
        (header.index(name), _number_or_nan if optional else float)
        for name, optional in zip(names, lenient, strict=True)
    ]
    values = array('d')  # a row takes no more memory than its numbers
    nothing = len(readers) * [math.nan]
    for line, row in enumerate(rows, start=2):
        try:
            values.extend([read(row[place]) for place, read in readers] if row else nothing)
        except (ValueError, IndexError) as error:
            cause = 'too few columns' if isinstance(error, IndexError) else str(error)
            raise CsvError(f'{path}, line {line}: {cause}') from error
    return np.frombuffer(values).reshape(-1, max(1, len(readers)))


def _number_or_nan(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _unit(
    path: Path, header: Sequence[str], columns: Columns, found: Mapping[str, str]
) -> tuple[str, str]:
    """The unit of the angles, and where it comes from."""
    if columns.unit:
        return columns.unit, 'as given'
    suffixes = [_UNIT.search(name.lower()) for role, name in found.items() if role in _ANGLES]
    units = sorted({suffix[1] for suffix in suffixes if suffix})
    if len(units) > 1:
        raise CsvError(f'{path}: all angles have to be in one unit, not in {" and ".join(units)}')
    if units:
        return units[0], 'by its name'
    if {name.lower() for name in header} >= _MOTEUS:
        return 'rev', 'as moteus controllers record it'
    return 'rad', 'assumed'


def _described(table: Table, *, on_rotor: bool) -> Iterable[str]:
    found, _, unit, why = table
    side = 'of the rotor' if on_rotor else 'at the output'
    if 'angle' in found:
        yield f'angle {found["angle"]} {side}, {unit} ({why})'
    if 'torque' in found:
        yield f'torque {found["torque"]} {side}, N·m'
    if 'rotor' in found:
        yield f'rotor {found["rotor"]}, output {found["output"]}, {unit} ({why})'
    if 'time' in found:
        yield f'time {found["time"]}'


def _loading(
    ratio: GearRatio,
    data: Mapping[str, Array],
    counts: int | None,
    time: Array | None,
    *,
    on_rotor: bool,
) -> Loading:
    angle, step = data['angle'], step_of(counts, data['angle'])
    if on_rotor:
        angle, step = angle / float(ratio), step.scaled(1.0 / float(ratio))
    return Loading(data['torque'], angle, step, measured=False, time=time)


def _motion(
    ratio: GearRatio,
    data: Mapping[str, Array],
    travel: float,
    counts: int | None,
    output_counts: int | None,
) -> Motion:
    """Compare rotor and output row by row; a row was sampled at one time."""
    turns, angle = ratio.output_angle(*split_turns(data['rotor']), np)
    row = np.arange(len(angle))
    return Motion.from_angles(
        TransmissionError(max_gap=1, travel=travel),
        (row, turns, angle),
        (row, data['output']),
        step_of(counts, data['rotor']).scaled(1.0 / float(ratio)),
        step_of(output_counts, data['output']),
        in_rows=True,
    )
