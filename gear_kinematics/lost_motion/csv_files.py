"""Recordings as CSV files: one row a sample, one column a quantity, names in the first row."""

import csv
import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear, GearRatio
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, split_turns
from gear_kinematics.lost_motion.encoder_step import UNITS, step_of
from gear_kinematics.lost_motion.motion import Motion
from gear_kinematics.lost_motion.recording import Loading, Recording
from gear_kinematics.state.transmission_error import TransmissionError
from gear_kinematics.wire.topics import OUTPUT_ENCODER

Array = NDArray[np.float64]

_NAMES: Mapping[str, tuple[str, ...]] = {
    'angle': ('position', 'angle', 'deflection', 'twist', 'motor_position'),
    'torque': ('torque', 'effort', 'measured_torque', 'motor_torque'),
    'rotor': ('rotor_position', 'rotor_angle', 'rotor'),
    'output': ('output_position', 'output_angle', OUTPUT_ENCODER, 'output'),
}
"""Names of columns, in upper or lower case, with or without a unit appended."""
_SETS = (('angle', 'torque'), ('rotor', 'output'), ('rotor', 'output', 'torque'))
"""Sets of columns that can be evaluated."""
_UNIT = re.compile(rf'[\s_]*[\[(]?({"|".join(UNITS)})[\])]?$')
_TORQUE_UNIT = re.compile(r'[\s_]*[\[(]?n[·*.]?m[\])]?$')
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
    unit: str | None = None
    """Unit of all angles, a key of UNITS."""
    on_rotor: bool = False
    """Whether angle and torque are the rotor's, not those at the output."""


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
    header, rows = _table(path)
    found = _find(path, header, columns)
    values = _numbers(path, header, rows, list(found.values()))
    unit, why = _unit(path, header, columns, found)
    for column, role in enumerate(found):
        if role != 'torque':
            values[:, column] *= UNITS[unit]
    usable = np.all(np.abs(values) <= LARGEST_ANGLE, axis=1)  # NaN compares false
    data = dict(zip(found, values[usable].T, strict=True))
    left_out = int(np.count_nonzero(~usable))
    remarks = (f'{left_out} rows were left out: not finite, or too large',) if left_out else ()
    ratio = gear.gear_ratio
    loading = motion = None
    if columns.on_rotor and 'torque' in data:
        data['torque'] *= float(ratio)
    if 'rotor' in data:
        motion = _motion(ratio, data, travel, counts, output_counts)
    if 'angle' in data:
        loading = _loading(ratio, data, counts, on_rotor=columns.on_rotor)
    elif motion and 'torque' in data:
        loading = Loading.of_gear(data['torque'], motion)
    return Recording(
        path.name,
        tuple(_described(found, unit, why, on_rotor=columns.on_rotor)),
        len(usable),
        loading,
        motion,
        remarks,
    )


def _table(path: Path) -> tuple[list[str], list[list[str]]]:
    try:
        text = path.read_text('utf-8-sig')
    except (OSError, UnicodeDecodeError) as error:
        cause = getattr(error, 'strerror', None) or 'not text in UTF-8'
        raise CsvError(f'{path}: {cause}') from error
    first = text.partition('\n')[0]
    delimiter = max(',;\t', key=first.count)
    try:
        rows = list(csv.reader(text.splitlines(), delimiter=delimiter))
    except csv.Error as error:
        raise CsvError(f'{path}: {error}') from error
    if len(rows) < 2:  # noqa: PLR2004, names and a sample
        raise CsvError(f'{path}: no samples in it')
    header = [name.strip() for name in rows[0]]
    twice = [name for name, count in Counter(header).items() if count > 1]
    if twice:
        raise CsvError(f'{path}: more than one column {twice[0]!r}')
    return header, rows[1:]


def _find(path: Path, header: Sequence[str], columns: Columns) -> dict[str, str]:
    """The columns to read, by their role."""
    given = {role: name for role in _NAMES if (name := getattr(columns, role))}
    for name in given.values():
        if name not in header:
            raise CsvError(f'{path}: no column {name!r}; there are {", ".join(header)}')
    plain = {_plain(name): name for name in reversed(header)}
    found = {
        role: name
        for role, names in _NAMES.items()
        if (name := given.get(role) or next((plain[n] for n in names if n in plain), None))
    }
    together = [roles for roles in _SETS if found.keys() >= {*roles}]
    if not together:
        raise CsvError(
            f'{path}: neither an angle and a torque nor a rotor and an output among the columns '
            f'{", ".join(header)}; name them with --angle-column, --torque-column, '
            '--rotor-column, --output-column'
        )
    return {role: found[role] for roles in together for role in roles}


def _plain(name: str) -> str:
    """A name without its unit, in the form of `_NAMES`."""
    return _TORQUE_UNIT.sub('', _UNIT.sub('', name.lower())).strip().replace(' ', '_')


def _numbers(
    path: Path, header: Sequence[str], rows: Sequence[Sequence[str]], names: Sequence[str]
) -> Array:
    places = [header.index(name) for name in names]
    values = np.empty((len(rows), len(names)))
    for k, row in enumerate(rows):
        try:
            values[k] = [float(row[place]) for place in places] if row else math.nan
        except (ValueError, IndexError) as error:
            cause = 'too few columns' if isinstance(error, IndexError) else str(error)
            raise CsvError(f'{path}, line {k + 2}: {cause}') from error
    return values


def _unit(
    path: Path, header: Sequence[str], columns: Columns, found: Mapping[str, str]
) -> tuple[str, str]:
    """The unit of the angles, and where it comes from."""
    if columns.unit:
        return columns.unit, 'as given'
    suffixes = [_UNIT.search(name.lower()) for role, name in found.items() if role != 'torque']
    units = sorted({suffix[1] for suffix in suffixes if suffix})
    if len(units) > 1:
        raise CsvError(f'{path}: all angles have to be in one unit, not in {" and ".join(units)}')
    if units:
        return units[0], 'by its name'
    if {name.lower() for name in header} >= _MOTEUS:
        return 'rev', 'as moteus controllers record it'
    return 'rad', 'assumed'


def _described(found: Mapping[str, str], unit: str, why: str, *, on_rotor: bool) -> Iterable[str]:
    side = 'of the rotor' if on_rotor else 'at the output'
    if 'angle' in found:
        yield f'angle {found["angle"]} {side}, {unit} ({why})'
    if 'torque' in found:
        yield f'torque {found["torque"]} {side}, N·m'
    if 'rotor' in found:
        yield f'rotor {found["rotor"]}, output {found["output"]}, {unit} ({why})'


def _loading(
    ratio: GearRatio, data: Mapping[str, Array], counts: int | None, *, on_rotor: bool
) -> Loading:
    angle, step = data['angle'], step_of(counts, data['angle'])
    if on_rotor:
        angle, step = angle / float(ratio), step.scaled(1.0 / float(ratio))
    return Loading(data['torque'], angle, step, measured=False)


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
