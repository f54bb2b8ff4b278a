# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the columns of a table mean: quantities and units by their names, or as they are given."""

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
    'time': ('time', '%time', 't', 'stamp', 'timestamp', 'timestamps'),
}
"""Names of columns without their units, the likeliest first."""
_OF_ROTOR = {*_NAMES['rotor'], *_joined(_ROTOR, _TORQUES)}
"""Names of the rotor's quantities. The current of a motor says a torque of either side."""
_COUNTS = ('counts', 'count', 'cnt', 'inc', 'increments', 'ticks')
ANGLE_UNITS = (*UNITS, 'counts')
"""Units of angle that can be given."""
_ANGULAR = ('angle', 'rotor', 'output')
_OF_ANGLE = {
    **UNITS,
    '°': UNITS['deg'],
    'degree': UNITS['deg'],
    'degrees': UNITS['deg'],
    'radians': 1.0,
    'turns': TURN,
    **dict.fromkeys(_COUNTS),
}
_UNITS: Mapping[str, Mapping[str, float | None]] = {
    **dict.fromkeys(_ANGULAR, _OF_ANGLE),
    'torque': {'nm': 1.0, 'n·m': 1.0, 'n*m': 1.0, 'n.m': 1.0, 'mnm': 1e-3, 'nmm': 1e-3},
    'time': {'s': 1.0, 'sec': 1.0, 'ms': 1e-3, 'us': 1e-6, 'µs': 1e-6, 'ns': 1e-9},
}
"""In SI units; None: counts of an encoder."""
KNOWN_UNITS = {unit for units in _UNITS.values() for unit in units}
_QUALIFIERS = {'measured', 'actual', 'filtered'}
"""Words behind a name that are no units."""
_BRACKETS = re.compile(r'[\[(]\s*([^\])]*?)\s*[\])]')
_WORD = re.compile(r'[^\s_/-]+')
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


def find_columns(
    header: Sequence[str], given: Sources, below: Mapping[str, str]
) -> dict[str, Column]:
    """Find what can be read: angle and torque, or rotor and output, with torque and time if any.

    Args:
        header: the names in a file.
        given: what is known of them.
        below: the units that a second row gives, by name.

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
    units = [
        _split(found[role])[1] or below.get(found[role], '') for role in _ANGULAR if role in found
    ]
    common = next(filter(None, units), 'rev' if moteus else '')
    return {role: _column(role, name, given, common, below) for role, name in found.items()}


def _column(role: str, name: str, given: Sources, common: str, below: Mapping[str, str]) -> Column:
    plain, unit = _split(name)
    unit = unit or below.get(name, '') or _unknown(role, plain)
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
    on_rotor = given.on_rotor or plain in _OF_ROTOR
    return Column(name, scale, unit, on_rotor and not on_output, on_output)


def _unknown(role: str, plain: str) -> str:
    """The last word behind a name that is known: it seems to be a unit."""
    first, _, last = plain.rpartition('_')
    if plain in _NAMES[role] or first not in _NAMES[role]:
        return ''
    return '' if last.isdigit() or last in _QUALIFIERS else last


def _split(name: str) -> tuple[str, str]:
    """A name without its unit, in the form of `_NAMES`, and the unit, in brackets or known."""
    text, unit = name.strip().lower(), ''
    if brackets := _BRACKETS.search(text):
        index = brackets[1] if brackets[1].isdigit() else ''
        text = text.replace(brackets[0], f' {index}')
        unit = '' if index else brackets[1]
    words = _WORD.findall(text)
    if not unit and words and words[-1] in KNOWN_UNITS:
        unit = words.pop()
    return '_'.join(words), unit


def _listed(role: str) -> str:
    return ', '.join(sorted(_UNITS[role]))
