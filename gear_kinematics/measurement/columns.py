# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The columns of a table that are read: quantities and units, by their names or as given."""

import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from typing import NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import UNITS
from gear_kinematics.measurement.names import (
    ANGLE_UNITS,
    FOREIGN,
    TIME_UNITS,
    TORQUE_UNITS,
    WANTED,
    meaning,
    usual_unit,
)
from gear_kinematics.measurement.second_fractions import fraction_of
from gear_kinematics.wire.nearest import among

GIVEN_UNITS = (*UNITS, 'counts')  # units of angle that users can give
ANGULAR = ('angle', 'rotor', 'output')
ROLES = {
    'time': TIME_UNITS,
    **dict.fromkeys(ANGULAR, ANGLE_UNITS),
    'torque': TORQUE_UNITS,
    'output_time': TIME_UNITS,
}
"""Units of the columns by role."""
_COUNTS = '4096'  # counts a turn, as an example
_REVOLUTIONS = re.compile(r'(?i)servo_stats.*position|pos_estimate|pos_rel|pos_abs')
"""Names with which moteus and ODrive motor controllers give positions in revolutions."""
_NUMBERED = re.compile(r'(\W*\d+|_[a-z]|(?<=^t)[mol])(?=( ?[\[(].*)?$)')
"""Ends of time.1, as pandas repeats a name, of time_a, and of tm, before any unit."""
_MOTEUS = {'position', 'torque', 'q_current'}
_NOT_MEASURED = re.compile(rf'(?i){WANTED}|err|planned|refer|simul|model')
"""Words in the path of tags whose values are no measured angles."""
_POSITION = re.compile(r'(?i)pos|ang(?!e)|encod|winkel|theta|(rad|deg|rev|counts?)\b')
"""Words of which the tag of an angle has one, as Temperature.Motor does not."""
DATES = ('date',), ('datum',)
"""Words of columns that have the times if no other has, but perhaps the day alone."""


@dataclass(frozen=True, slots=True)
class Sources:
    """Columns of a table and topics of a bag; None for those to be found by their names."""

    angle: str | None = None
    torque: str | None = None
    rotor: str | None = None
    output: str | None = None
    time: str | None = None
    output_time: str | None = None  # of the output's encoder, if it has times of its own
    unit: str | None = None  # of all angles, one of GIVEN_UNITS; None: by their names, or rad
    on_rotor: bool = False  # whether angle and torque are the rotor's, unless named otherwise
    of_rotor: bool = False  # the same where nothing says that the angle is the output's
    rotor_counts: int | None = None  # per turn of the encoder of the rotor, or of the angle column
    output_counts: int | None = None  # per turn of the output's encoder
    as_recorded: bool = False  # whether to keep wraps, unknown counts and rotor messages
    needs_times: bool = False
    rotor_topic: str | None = None
    encoder_topic: str | None = None
    command: str = ''  # the command line so far, to which advice adds options


class Column(NamedTuple):
    """A column that is read."""

    name: str
    scale: float  # factor from its numbers to rad, N·m or s
    unit: str  # empty where nothing is known
    on_rotor: bool
    on_output: bool  # whether its name, or the user, says so
    assumed: bool = False  # whether the unit is that of a maker whose file it seems to be


class ColumnsError(ValueError):
    """Columns or units are unknown, which further `Sources` would name."""

    def __init__(self, text: str, give: str = '', **example: str) -> None:
        """Say the cause, and what to `give`, by an example of the missing fields of `Sources`."""
        for field, value in example.items() if give else ():
            one = f'as in {option(field)} {shlex.quote(value)}'
            text += f': give {give} {one if field in ROLES else f"with {option(field)}"}'
        super().__init__(text)
        self.example = example


def option(field: str) -> str:
    """Return the option for a field of `Sources`."""
    name = {'unit': 'angle-unit'}.get(field, field.replace('_', '-'))
    return f'--{name}-column' if field in ROLES else f'--{name}'


def find_columns(
    header: Sequence[str],
    given: Sources,
    below: Mapping[str, str],
    clocks: Mapping[str, str],
    first: Mapping[str, str],
) -> dict[str, Column]:
    """Find angle and torque, or rotor and output, with torque and time if there are any.

    Args:
        header: names of all columns.
        given: names and units that the user gives; a name may end with its unit in brackets.
        below: units that the file gives elsewhere than in the names, by name.
        clocks: columns of times, by the names of columns that have their own.
        first: first values by name; times are rather where there is one.

    Raises:
        ColumnsError: if too few columns are found, or a unit is unknown.
        ValueError: if a name is unknown or occurs more than once.
    """
    units = {name: meaning(name).unit for name in header}
    units |= {
        name: usual_unit(unit) and meaning(f'{name} [{unit}]').unit  # Grad of a Winkel
        for name, unit in below.items()
    }
    named = {}
    for role in ROLES:
        if name := getattr(given, role):
            plain, bracket, unit = name.rpartition('[')
            if name not in header and (plain := plain.rstrip()) in header and bracket:
                name, units[plain] = plain, usual_unit(unit)
            if name not in header:
                raise ValueError(f'no column {name!r}{among(name, header, most=len(header))}')
            named[role] = name
    others = [name for name in header if name != named.get('output_time')]
    filled = [name for name in others if first.get(name, name) or meaning(name).role != 'time']
    dates = (name for name in others if meaning(name).words in DATES)
    found, side = dict(zip(['time'], dates, strict=False)), 'angle'
    found |= likeliest(others) | likeliest(filled) | named
    if {'rotor', 'output'} <= found.keys() and 'angle' not in named:
        found.pop('angle', None)
    elif 'torque' in found and (sides := [role for role in ANGULAR if role in found]):
        side = next((role for role in sides if role in named), sides[0])
        found = {'angle': found[side]} | {r: found[r] for r in found if r in {'torque', 'time'}}
        side = side if side in named else 'angle'
    elif (short := _without_path(header)) and not named:
        texts = [{short[k]: one[k] for k in one.keys() & short} for one in (below, clocks, first)]
        texts[1] = {name: short.get(clock, clock) for name, clock in texts[1].items()}
        columns = find_columns([*short.values()], given, *texts).items()
        full = {last: name for name, last in short.items()}
        return {role: column._replace(name=full[column.name]) for role, column in columns}
    else:
        known = ', '.join((*GIVEN_UNITS, *TORQUE_UNITS))
        raise ColumnsError(
            f'neither an angle and a torque nor a rotor and an output (known units: {known})'
        )
    if own := [clocks[found[role]] for role in found if role != 'time' and found[role] in clocks]:
        found['time'] = own[0]
    if repeated := [name for name in found.values() if list(header).count(name) > 1]:
        raise ValueError(f'more than one column {repeated[0]!r}: rename all but one of them')
    angles = [found[role] for role in ANGULAR if role in found]
    if given.of_rotor and not (side == 'output' or meaning(found.get('angle', '')).on_output):
        given = replace(given, on_rotor=True)
    for name in filter(_REVOLUTIONS.search, angles):
        units[name] = units[name] or 'rev'
    usual = 'rev' if {name.lower() for name in header} >= _MOTEUS else ''
    return {
        role: _column(
            side if role == 'angle' else role, found[role], units[found[role]], given, usual
        )
        for role in ROLES
        if role in found
    }


def _without_path(names: Sequence[str]) -> dict[str, str]:
    """Return names without the path that all but times begin with, as tags of a PLC do, if any.

    Those of other quantities than angles and torques keep it, so that they stay unknown.
    """
    values = [name for name in names if name and meaning(name).role != 'time']
    alike = takewhile(lambda letters: len({*letters}) == 1, zip(*values, strict=False))
    path = re.sub(r'[^/.;|:\]]*$', '', ''.join(letters[0] for letters in alike))[:-1]
    rests = {name: name.removeprefix(path) for name in names}
    short = {
        name: rest if _POSITION.search(name) or meaning(rest).role == 'torque' else name
        for name, rest in rests.items()
    }
    plain = [*short.values()]
    sure = plain != [*names] and len({*plain}) == len(names) and not _NOT_MEASURED.search(path)
    return short if sure else {}


def own_clocks(names: Sequence[str], columns: Mapping[str, Column]) -> dict[str, str]:
    """Find the columns of times, by role, that columns of values may have of their own.

    It is that of the same side of the gear, or the last one before the values; where two times are
    numbered, but not one each before the values, the order of both is the same.
    """
    times = {name: meaning(name) for name in names if meaning(name).role == 'time'}
    rests = {fraction_of(name, names) for name in times}
    times = {name: says for name, says in times.items() if name not in rests}
    found = {}
    for role, column in columns.items():
        side = meaning(column.name)[4:6]
        same = [one for one, says in times.items() if says[4:6] == side and any(side)]
        before = [*filter(times.get, names[: names.index(column.name)])]
        sure = [one for one in before if not meaning(_NUMBERED.sub('', one)).unsure]
        if same or sure:
            found[role] = (same or sure)[-1]
    if len({*found.values()}) < 2:  # noqa: PLR2004, both have the same, or one has none
        plain = {one: _NUMBERED.sub('', one) for one in times}
        alike = [one for one in times if plain[one] == next(iter(plain.values()))]
        roles = {column.name: role for role, column in columns.items() if role != 'torque'}
        sides = [roles[name] for name in names if name in roles]
        if len(alike) == len(sides):
            found |= dict(zip(sides, alike, strict=True))
    return found


def likeliest(header: Sequence[str]) -> dict[str, str]:
    """Return the likeliest column for each role, unless others are as likely."""
    found = {}
    outs = any('out' in meaning(name).words for name in header)
    for role in ROLES:
        names = [name for name in header if meaning(name).role == role]
        if outs and role != 'time':  # then torque_in is not torque in some unit
            names = [name for name in names if 'in' not in meaning(name).words]
        least = min((meaning(name).rank for name in names), default=())
        alike = [name for name in dict.fromkeys(names) if meaning(name).rank == least]
        if len(alike) == 1 or (role == 'time' and alike):  # not if position[0] and position[1]
            found[role] = min(alike, key='T'.__eq__)  # rather t
    return found


def _column(role: str, name: str, unit: str, given: Sources, usual: str) -> Column:
    """Return a column with its unit, for an angle the usual one, or empty if nothing is known."""
    says, units = meaning(name), ROLES[role]
    own = unit = unit or says.unknown
    if role in {'time', 'output_time'} and unit == 'counts':  # ticks, whose size sampling shows
        unit = ''
    such = f'{name} [{next(iter(units))}]'
    if role in ANGULAR:
        own = given.unit or unit
        unit = own or usual
    if unit and unit not in units:
        known = ', '.join(units)
        letter = role in ANGULAR and unit == says.unknown  # as of pos_a
        if (unit in FOREIGN and not letter) or any(unit in others for others in ROLES.values()):
            raise ValueError(f'{name} is in {unit}: convert it to one of {known}')
        cause = f'{name}: the unit {unit} is not known; known: {known}'
        raise ColumnsError(cause, 'it', **{role: such})
    scale = units.get(unit, 1.0)
    if scale is None:
        encoder = 'output' if role == 'output' else 'rotor'
        counts = getattr(given, f'{encoder}_counts')
        if counts is None and not given.as_recorded:
            example = {f'{encoder}_counts': _COUNTS}
            raise ColumnsError(f'{name} has counts', 'those per turn', **example)
        scale = TURN / counts if counts else 1.0
        unit = f'{counts} counts a turn' if counts else 'counts'
    on_output = role == 'output' or (says.on_output and role != 'rotor')
    # The current of a motor says a torque of either side.
    on_rotor = given.on_rotor or (says.on_rotor and 'current' not in says.words)
    on_rotor = role == 'rotor' or (on_rotor and not on_output)
    return Column(name, scale, unit, on_rotor, on_output, unit != '' and not own)


def assumed_unit(role: str, column: Column) -> str:
    """Return the unit that is assumed for a column; empty if its unit is known."""
    usual = column.unit or {'torque': 'N·m'}.get(role, 'rad')
    return usual if column.assumed or not column.unit else ''


def described(role: str, column: Column) -> str:
    """Describe a column by its unit, and by the side of the gear where it was measured."""
    assumed = assumed_unit(role, column)
    unit = f'{assumed}, assumed' if assumed else column.unit
    side = ' of the rotor' if column.on_rotor else ' at the output'
    side = side if role in {'angle', 'torque'} else ''
    return f'{role}{side} [{unit}] from {column.name}'
