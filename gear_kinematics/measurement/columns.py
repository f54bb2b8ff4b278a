"""The columns of a CSV file: what they hold and in which unit, by their names."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import UNITS
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
_BRACKETS = re.compile(r'[\[(]\s*([^\])]*?)\s*[\])]$')
_WORD = re.compile(r'[^\s_/-]+')
_MOTEUS = {'position', 'torque', 'q_current'}
"""Registers of moteus motor controllers, which give positions in revolutions."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Names and contents of columns; one with the name None is found by name."""

    angle: str | None = None
    torque: str | None = None
    rotor: str | None = None
    output: str | None = None
    time: str | None = None
    unit: str | None = None
    """Unit of all angles, one of ANGLE_UNITS; None: by their names, or rad."""
    on_rotor: bool = False
    """Whether angle and torque are the rotor's, unless their names say the output's."""
    rotor_counts: int | None = None
    """Counts per turn of the encoder of the rotor, or of the angle column."""
    output_counts: int | None = None
    """The same of the output's encoder."""


class Column(NamedTuple):
    """A column that is read."""

    name: str
    scale: float
    """Of its numbers, to rad, N·m or s."""
    unit: str
    """As a report tells it; empty where nothing is known."""
    on_rotor: bool


def find_columns(header: Sequence[str], given: Columns) -> dict[str, Column]:
    """Find what can be read: angle and torque, or rotor and output, with torque and time if any.

    Args:
        header: the names in a file.
        given: what is known of them.

    Raises:
        ValueError: if they do not suffice, or a unit is not known.
    """
    named = {role: name for role in _NAMES if (name := getattr(given, role))}
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
        others = {role: name for role, name in found.items() if role not in _ANGULAR}
        found = {'angle': angles[0], **others}
    else:
        unknown = ', '.join(filter(None, (_split(name)[2] for name in header)))
        hint = f'; unknown units: {unknown}; known: {_listed("angle")}' if unknown else ''
        raise ValueError(
            'neither an angle and a torque nor a rotor and an output among the columns '
            f'{", ".join(header)}; name them with --angle-column, --torque-column, '
            f'--rotor-column, --output-column{hint}'
        )
    moteus = {name.lower() for name in header} >= _MOTEUS
    units = [_split(found[role])[1] for role in _ANGULAR if role in found]
    common = next(filter(None, units), 'rev' if moteus else '')
    return {role: _column(role, name, given, common) for role, name in found.items()}


def _column(role: str, name: str, given: Columns, common: str) -> Column:
    plain, unit, unknown = _split(name)
    if unknown:
        raise ValueError(f'{name}: the unit {unknown} is not known; known: {_listed(role)}')
    if role in _ANGULAR:
        unit = given.unit or unit or common
    scale = _UNITS[role].get(unit, 1.0)
    if scale is None:
        encoder = 'output' if role == 'output' else 'rotor'
        counts = getattr(given, f'{encoder}_counts')
        if counts is None:
            raise ValueError(f'{name} has counts: give those per turn with --{encoder}-counts')
        scale, unit = TURN / counts, f'{counts} counts a turn'
    on_rotor = given.on_rotor and plain.partition('_')[0] not in _OUTPUT
    return Column(name, scale, unit, on_rotor)


def _split(name: str) -> tuple[str, str, str]:
    """A name without its unit, in the form of `_NAMES`, the unit, and the unit if it is not known.

    Either may be empty. An unknown unit is in brackets, or ends as a known one.
    """
    text, unit = name.strip().lower(), ''
    if brackets := _BRACKETS.search(text):
        text, unit = text[: brackets.start()], brackets[1]
    words = _WORD.findall(text)
    last = words[-1] if len(words) > 1 else ''
    if not unit and last in _KNOWN_UNITS:
        unit = words.pop()
    told = unit or (last if last.endswith(('rad', 'deg', 'rev', 'nm')) else '')
    return '_'.join(words), unit, '' if told in _KNOWN_UNITS else told


def _listed(role: str) -> str:
    return ', '.join(sorted(_UNITS[role]))
