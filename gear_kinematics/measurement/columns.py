"""The columns of a CSV file: what they hold and in which unit, by their names."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import UNITS
from gear_kinematics.wire.nearest import among, listed
from gear_kinematics.wire.topics import OUTPUT_ENCODER

_ROTOR, _OUTPUT = ('rotor', 'motor', 'odrive'), ('output', 'load', 'shaft', 'link')
"""Words for either side of the gear."""
_ANGLES = ('position', 'pos', 'angle', 'encoder', 'enc')
_TORQUES = ('torque', 'effort')


def _joined(*words: Sequence[str]) -> tuple[str, ...]:
    return tuple('_'.join(filter(None, several)) for several in product(*words))


_NAMES: Mapping[str, tuple[str, ...]] = {
    'angle': (*_joined(('', 'encoder', 'enc'), _ANGLES), 'deflection', 'twist'),
    'torque': (*_joined(('', 'measured', 'output', 'load', 'motor', 'motor_current'), _TORQUES),),
    'rotor': _joined(_ROTOR, ('', *_ANGLES, 'encoder_position', 'encoder_pos')),
    'output': (
        *_joined(_OUTPUT, ('', *_ANGLES, 'encoder_position', 'encoder_pos')),
        OUTPUT_ENCODER,
    ),
    'time': ('time', 't', 'stamp', 'timestamp'),
}
"""Names of columns without their units, the likeliest first."""
_COUNTS = ('counts', 'count', 'cnt', 'inc', 'increments', 'ticks')
ANGLE_UNITS = (*UNITS, 'counts')
"""Units of angle that can be given."""
_UNITS: Mapping[str, Mapping[str, float | None]] = {
    'angle': {**UNITS, '°': UNITS['deg'], 'turns': TURN, **dict.fromkeys(_COUNTS)},
    'torque': {'nm': 1.0, 'n·m': 1.0, 'n*m': 1.0, 'n.m': 1.0, 'mnm': 1e-3},
    'time': {'s': 1.0, 'sec': 1.0, 'ms': 1e-3, 'us': 1e-6, 'µs': 1e-6, 'ns': 1e-9},
}
"""In SI units; None: counts of an encoder."""
_KINDS = {
    'angle': 'angle',
    'rotor': 'angle',
    'output': 'angle',
    'torque': 'torque',
    'time': 'time',
}
_BRACKETS = re.compile(r'\s*[\[(]\s*([^\])]*?)\s*[\])]$')
_SEPARATORS = re.compile(r'[\s_/-]+')
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
    known = {plain: name for name in reversed(header) if (plain := _split(name)[0])}
    found = {
        role: name
        for role, names in _NAMES.items()
        if (name := named.get(role) or next((known[n] for n in names if n in known), None))
    }
    if {'rotor', 'output'} <= found.keys() and 'angle' not in named:
        found.pop('angle', None)
    elif 'torque' in found and (angle := _single(found)):
        found = {'angle': angle, **{r: found[r] for r in ('torque', 'time') if r in found}}
    else:
        unknown = [text for name in header if (text := _unknown_unit(name))]
        hint = f'; unknown units: {", ".join(unknown)}; known: {_listed()}' if unknown else ''
        raise ValueError(
            'neither an angle and a torque nor a rotor and an output among the columns '
            f'{", ".join(header)}; name them with --angle-column, --torque-column, '
            f'--rotor-column, --output-column{hint}'
        )
    moteus = {name.lower() for name in header} >= _MOTEUS
    angles = [_split(found[role])[1] for role in found if _KINDS[role] == 'angle']
    common = given.unit or next(filter(None, angles), 'rev' if moteus else '')
    return {role: _column(role, name, given, common) for role, name in found.items()}


def _single(found: Mapping[str, str]) -> str | None:
    """The only angle of torque ramps, on whichever side."""
    return next((found[role] for role in ('angle', 'rotor', 'output') if role in found), None)


def _column(role: str, name: str, given: Columns, common: str) -> Column:
    kind = _KINDS[role]
    plain, unit = _split(name)
    if text := _unknown_unit(name):
        raise ValueError(f'{name}: the unit {text} is not known; known: {_listed(kind)}')
    if kind == 'angle':
        unit = given.unit or unit or common
    scale = _UNITS[kind].get(unit, 1.0) if unit else 1.0
    if scale is None:
        per_turn = given.output_counts if role == 'output' else given.rotor_counts
        if per_turn is None:
            option = '--output-counts' if role == 'output' else '--rotor-counts'
            raise ValueError(f'{name} has counts: give those per turn with {option}')
        scale, unit = TURN / per_turn, f'{per_turn} counts a turn'
    side = plain.partition('_')[0]
    return Column(name, scale, unit, given.on_rotor and side not in _OUTPUT)


def _split(name: str) -> tuple[str, str]:
    """A name without its unit, in the form of `_NAMES`, and the unit, which may be empty."""
    text, unit = name.strip().lower(), ''
    if brackets := _BRACKETS.search(text):
        text, unit = text[: brackets.start()], brackets[1]
    words = [word for word in _SEPARATORS.split(text) if word]
    if not unit and len(words) > 1 and any(words[-1] in units for units in _UNITS.values()):
        unit = words.pop()
    return '_'.join(words), unit


def _unknown_unit(name: str) -> str:
    """What stands in a name as an unknown unit: in brackets, or as if it were a known one."""
    plain, unit = _split(name)
    known = {text for units in _UNITS.values() for text in units}
    if unit:
        return '' if unit in known else unit
    _, _, last = plain.rpartition('_')
    like = last not in known and last.endswith(('rad', 'deg', 'rev', 'grad', 'nm'))
    return last if like and last != plain else ''


def _listed(kind: str = 'angle') -> str:
    return listed(list(_UNITS[kind]), most=len(_UNITS[kind]))
