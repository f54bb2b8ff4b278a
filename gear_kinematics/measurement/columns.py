# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The meaning of a table's columns: quantities and units, by their names or as given."""

import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import UNITS
from gear_kinematics.wire.nearest import among

_ROTOR = ('rotor', 'motor', 'mot', 'odrive', 'antrieb', 'moteur', 'motore')
_OUTPUT = (
    'output', 'out', 'load', 'shaft', 'link', 'joint', 'abtrieb', 'sortie', 'uscita', 'salida',
)  # fmt: skip
"""Words for the two sides of the gear, the likeliest first."""
_ANGLE = (
    'position', 'positions', 'pos', 'angle', 'encoder', 'enc', 'theta', 'deflection', 'twist',
    'winkel', 'drehwinkel', 'angolo', 'ángulo', 'angulo',
)  # fmt: skip
_STAMP = ('stamp', 'timestamp', 'timestamps')
_TORQUE = (
    'torque', 'torques', 'effort', 'efforts', 'trq', 'drehmoment', 'moment', 'couple', 'coppia',
)  # fmt: skip
_KNOWN_WORDS = (*_ROTOR, *_OUTPUT, *_ANGLE, *_TORQUE, 'current')
_TIME = (
    'time', 't', *_STAMP, 'today', 'datetime', 'elapsed', 'zeit', 'uhrzeit', 'temps', 'tempo',
    'tiempo', 'tout', 'xtime', 'ts', 'zeitstempel', 'horodatage', 'x',
)  # fmt: skip
_FILLING = {
    'header', 'receive', 'log', 'measured', 'actual', 'act', 'filtered', 'raw', 'field', 'data',
    'value', 'values', 'feedback', 'state', 'states', 'axis', 'present', 'sensor', 'abs', 'side',
    'in', 'ist', 'host', 'pi', 'ros', 'system', 'unix', 'epoch', 'fb', 'fbk', 'ave', 'estimate',
    'scalars', 'date', 'datum', 'utc', 'wall',
}  # fmt: skip
"""Words that may accompany the others; any other word shows a command, a speed or the like."""
_COUNTS = ('counts', 'count', 'cnt', 'inc', 'increments', 'ticks', 'pulse', 'pulses')
_NANOSECONDS = ('ns', 'nsec', 'nsecs', 'nanosec', 'nanosecs', 'nanoseconds')
ANGLE_UNITS = (*UNITS, 'counts')  # units of angle that users can give
_ANGULAR = ('angle', 'rotor', 'output')
_OF_ANGLE = {
    **UNITS,
    **dict.fromkeys(('°', 'degree', 'degrees'), UNITS['deg']),
    'mdeg': UNITS['deg'] / 1000.0,
    'cdeg': UNITS['deg'] / 100.0,
    'ddeg': UNITS['deg'] / 10.0,
    'mrev': TURN / 1000.0,
    **dict.fromkeys(('urad', 'µrad'), 1e-6),
    **dict.fromkeys(('arcmin', '′'), UNITS['deg'] / 60.0),
    **dict.fromkeys(('arcsec', '″'), UNITS['deg'] / 3600.0),
    **dict.fromkeys(('radian', 'radians'), 1.0),
    **dict.fromkeys(('turn', 'turns', 'revs', 'revolution', 'revolutions'), TURN),
    **dict.fromkeys(_COUNTS),
}
_UNITS: Mapping[str, Mapping[str, float | None]] = {
    **dict.fromkeys(_ANGULAR, _OF_ANGLE),
    'torque': {
        **dict.fromkeys(('nm', 'n·m'), 1.0),
        **dict.fromkeys(('mnm', 'nmm'), 1e-3),
        'ncm': 1e-2,
        'knm': 1e3,
        **dict.fromkeys(('kgcm', 'kgfcm'), 0.0980665),
        **dict.fromkeys(('lbft', 'ftlb', 'lbfft'), 1.3558179483),
        **dict.fromkeys(('lbin', 'inlb', 'lbfin'), 0.1129848290),
    },
    'time': {
        **dict.fromkeys(('s', 'sec', 'secs', 'second', 'seconds'), 1.0),
        **dict.fromkeys(('ms', 'msec', 'millis', 'milliseconds'), 1e-3),
        **dict.fromkeys(('us', 'µs', 'usec', 'micros', 'microseconds'), 1e-6),
        **dict.fromkeys(_NANOSECONDS, 1e-9),
        **dict.fromkeys(('day', 'days'), 86_400.0),
    },
}
"""Units by role, in SI units, the usual word of each first; None stands for counts."""
TIME_UNITS: Mapping[str, Any] = _UNITS['time']
_KNOWN = {unit for units in _UNITS.values() for unit in units}
_NO_UNIT = {'-', 'none', 'n/a', '1', ':'}
_SPEEDS = {'rpm', 'rps', 'dps', 'cps'}
_SCALED = re.compile(r'(?<![^\W_])(?:\d+\.\d+ ?|\d+)([^\W\d_]+|°)$')
"""A unit with a number, as in rotor_0.1deg, which is not part of the name."""
_TENTHS = re.compile(r'(?i)[ _]?(deg|rad|rev)[ _]?x1(0{1,3})$')
_COMPOUND = re.compile(f'({"|".join(_ROTOR + _OUTPUT)})s?({"|".join(_ANGLE + _TORQUE)})')
"""Two words without anything between them, as in motorpos and Abtriebswinkel."""
_OF_CATMAN = re.compile(r'(?i)^(time|zeit) +\d+ - [^[]*')
_BRACKETS = re.compile(r'[\[(]\s*([^\])]*?)\s*[\])]')
_CAMEL = re.compile(r'[A-Z]+(?![a-zµ])|[A-Z]?[^\W\d_A-Z]+|\d+|°')
_MOTEUS = {'position', 'torque', 'q_current'}
_REVOLUTIONS = re.compile(r'(?i)servo_stats.*position|pos_estimate|pos_rel|pos_abs')
"""Names with which moteus and ODrive motor controllers give positions in revolutions."""


@dataclass(frozen=True, slots=True)
class Sources:
    """Columns of a table and topics of a bag; None for those to be found by their names."""

    angle: str | None = None
    torque: str | None = None
    rotor: str | None = None
    output: str | None = None
    time: str | None = None
    unit: str | None = None  # of all angles, one of ANGLE_UNITS; None: by their names, or rad
    on_rotor: bool = False  # whether angle and torque are the rotor's, unless named otherwise
    rotor_counts: int | None = None  # per turn of the encoder of the rotor, or of the angle column
    output_counts: int | None = None  # per turn of the output's encoder
    as_recorded: bool = False  # whether to keep wraps, unknown counts and rotor messages
    rotor_topic: str | None = None
    encoder_topic: str | None = None
    command: str = 'gearkin lost-motion'  # command before the recording, for advice


class Column(NamedTuple):
    """A column that is read."""

    name: str
    scale: float  # factor from its numbers to rad, N·m or s
    unit: str  # empty where nothing is known
    on_rotor: bool
    on_output: bool  # whether its name says so
    borrowed: bool = False  # whether its unit is that of the other angle


class ColumnsError(ValueError):
    """Too few columns for a measurement."""


def find_columns(
    header: Sequence[str], given: Sources, below: Mapping[str, str], clocks: Mapping[str, str]
) -> dict[str, Column]:
    """Find angle and torque, or rotor and output, with torque and time if there are any.

    Args:
        header: names of all columns.
        given: names and units that the user gives; a name may end with its unit in brackets.
        below: units that the file gives elsewhere than in the names, by name.
        clocks: columns of times, by the names of columns that have their own.

    Raises:
        ColumnsError: if too few columns are found.
        ValueError: if a name or a unit is unknown, or a name occurs more than once.
    """
    named = {}
    below = {k: '=' * unit.startswith('=') + _unit(unit.lstrip('=')) for k, unit in below.items()}
    for role in ('time', *_ANGULAR, 'torque'):
        if name := getattr(given, role):
            plain, bracket, unit = name.rpartition('[')
            if name not in header and (plain := plain.rstrip()) in header and bracket:
                name, below[plain] = plain, f'={_unit(unit)}'
            if name not in header:
                raise ValueError(f'no column {name!r}{among(name, header, most=len(header))}')
            named[role] = name
    ranks: dict[str, list[tuple[tuple[int, ...], int, str]]] = {}
    for place, name in enumerate(header):
        role, rank = _role(name)
        ranks.setdefault(role, []).append((rank, place, name))
    found = {}
    for role, those in ranks.items():
        rank, _, name = min(those)
        alike = {other for same, _, other in those if same == rank}
        if role and (len(alike) == 1 or role == 'time'):  # not if position[0] and position[1]
            found[role] = name
    found |= named
    if {'rotor', 'output'} <= found.keys() and 'angle' not in named:
        found.pop('angle', None)
    elif 'torque' in found and (angles := [found[role] for role in _ANGULAR if role in found]):
        found = {'angle': angles[0]} | {r: found[r] for r in found if r in {'torque', 'time'}}
    else:
        known = f'known units: {", ".join((*ANGLE_UNITS, *_usual("torque")))}'
        raise ColumnsError(f'neither an angle and a torque nor a rotor and an output ({known})')
    if own := [clocks[name] for name in found.values() if name in clocks]:
        found['time'] = own[0]
    if repeated := [name for name in found.values() if list(header).count(name) > 1]:
        raise ValueError(f'more than one column {repeated[0]!r}')
    angles = [found[role] for role in _ANGULAR if role in found]
    for name in angles:
        if not (below.get(name) or _split(name)[1]) and _REVOLUTIONS.search(name):
            below[name] = 'rev'
    units = [below.get(name, '').strip('=') or _split(name)[1] for name in angles]
    moteus = {name.lower() for name in header} >= _MOTEUS
    common = next(filter(None, units), 'rev' if moteus else '')
    order = ('time', *_ANGULAR, 'torque')
    return {
        role: _column(role, found[role], given, common, below) for role in order if role in found
    }


def described(role: str, column: Column) -> str:
    """Describe a column by its unit, and by the side of the gear where it was measured."""
    unit = column.unit + ', assumed' * column.borrowed
    unit = unit or {'torque': 'N·m, assumed'}.get(role, 'rad, assumed')
    side = ' of the rotor' if column.on_rotor else ' at the output'
    side = side if role in {'angle', 'torque'} else ''
    return f'{role}{side} [{unit.replace("nm", "N·m")}] from {column.name}'


def known_units(cells: Sequence[str]) -> list[str]:
    """Return the units in the cells of a row if most of them are known, otherwise nothing."""
    units = [_unit(cell) for cell in cells]
    known = len([unit for unit in units if unit in _KNOWN])
    return units if 2 * known > len([*filter(None, units)]) else []


def _usual(role: str) -> list[str]:
    """The usual words for the units of a quantity."""
    words: dict[float | None, str] = {}
    for unit, size in _UNITS[role].items():
        words.setdefault(size, unit)
    return [*words.values()]


def _column(role: str, name: str, given: Sources, common: str, below: Mapping[str, str]) -> Column:
    (words, unit), own = _split(name), ''
    elsewhere = below.get(name, '')
    unit = elsewhere[1:] if elsewhere[:1] == '=' else unit or elsewhere or _unknown(role, words)
    if unit and unit not in _UNITS[role] and not (given.unit and role in _ANGULAR):
        usual = _usual(role)
        raise ValueError(
            f'{name}: the unit {unit} is not known; known: {", ".join(usual)}; give it, as in '
            f'--{role}-column {shlex.quote(f"{name} [{usual[0]}]")}'
        )
    if role in _ANGULAR:
        own, unit = given.unit or unit, given.unit or unit or common
        if not unit and not _role(name)[0]:
            raise ValueError(
                f'{name} does not say that it is an angle: give its unit with --angle-unit, or as '
                f'in {shlex.quote(f"{name} [rad]")}'
            )
    scale = _UNITS[role].get(unit, 1.0)
    if scale is None:
        encoder = 'output' if role == 'output' else 'rotor'
        counts = getattr(given, f'{encoder}_counts')
        if counts is None and not given.as_recorded:
            raise ValueError(f'{name} has counts: give those per turn with --{encoder}-counts')
        scale = TURN / counts if counts else 1.0
        unit = f'{counts} counts a turn' if counts else 'counts'
    elif unit:
        unit = next(one for one, size in _UNITS[role].items() if size == scale)
    on_rotor, on_output = _sides(words)
    # The current of a motor says a torque of either side.
    on_rotor = given.on_rotor or (on_rotor and 'current' not in words)
    borrowed = role in _ANGULAR and bool(unit) and not own
    return Column(name, scale, unit, on_rotor and not on_output, on_output, borrowed)


def sides(name: str) -> tuple[bool, bool]:
    """Return whether a name says the rotor, and whether it says the output."""
    return _sides(_split(name)[0])


def _sides(words: Sequence[str]) -> tuple[bool, bool]:
    return not {*words}.isdisjoint(_ROTOR), not {*words}.isdisjoint(_OUTPUT)


def may_be_angle(name: str) -> bool:
    """Return whether the unit in a name, if any, is one of angles."""
    return _split(name)[1] in {'', *_OF_ANGLE}


def _role(name: str) -> tuple[str, tuple[int, ...]]:
    """Return the role of a column by its name, if any, and its rank, lowest for the likeliest."""
    words, unit = _split(name)
    keys = [word for word in words if word not in _FILLING and not word.isdigit()]
    if not words and unit in _UNITS['time']:
        return 'time', (9,)
    if keys and {*keys} <= {*_TIME} and (keys != ['x'] or 'value' in words):
        # The stamp of a message is when it was sampled; a log has when it was received.
        first = 0 if keys == ['stamp'] and 'header' in words and not unit else len(words)
        return 'time', (first, _TIME.index(keys[0]))
    shafts = [one for one, said in zip(('rotor', 'output'), _sides(words), strict=True) if said]
    kinds = [one for one, those in (('torque', _TORQUE), ('angle', _ANGLE)) if {*keys} & {*those}]
    if unit in _UNITS['torque'] and not kinds:
        kinds = ['torque']  # as of load_Nm
    unclear = len(kinds) > 1 or (len(shafts) > 1 and 'torque' not in kinds and 'joint' not in keys)
    if not keys or not {*keys} <= {*_KNOWN_WORDS} or '/' in unit or unit in _SPEEDS or unclear:
        return '', ()
    if 'current' in keys and 'torque' not in kinds:
        return '', ()
    counted = not kinds and unit in {'turn', 'turns'}  # beside the angle within a turn
    rank = (counted, len(words), *map(_KNOWN_WORDS.index, keys))
    return 'torque' if 'torque' in kinds else (*shafts, 'angle')[0], rank


def _unknown(role: str, words: Sequence[str]) -> str:
    """Return the last word if all others are known: it seems to be an unknown unit."""
    *first, last = words or ('',)
    known = {*(_TIME if role == 'time' else _KNOWN_WORDS), *_FILLING}
    seems = first and known.issuperset(first) and last not in known and not last.isdigit()
    return last if seems else ''


def _unit(text: str) -> str:
    """Normalise a unit to the spelling of `_UNITS`."""
    plain = re.sub(r'\s|units?:', '', text.lower().replace('μ', 'µ')).strip('[]')
    plain = re.sub(r'[-.*·⋅](?=(in|ft|lbf?|cm)$)', '', plain.strip('()'))
    plain = re.sub(r'n(ewton)?[-_.*·⋅]?([cm]?)m(et(er|re)s?)?(?!\w)', r'n\2m', plain)
    outer, _, inner = plain.partition('(')  # as in "° (Degree)" and "(deg)"
    plain = (outer or inner).strip('()[].')
    return '' if plain in _NO_UNIT else plain


def _split(name: str) -> tuple[tuple[str, ...], str]:
    """Divide a name into words, in lower case, and its unit, in brackets or a known word."""
    text = name.strip().strip('%#"').replace('{name==', '{')  # of a joint, in paths of Foxglove
    text = re.sub(r'\\\w+:\d+$', '', text)  # device and raster, of INCA
    text = _OF_CATMAN.sub(r'\1', text)
    text = _TENTHS.sub(lambda found: f'_{"dcm"[len(found[2]) - 1]}{found[1]}', text)
    text = re.sub(r'(?i)(?<![a-z])([mk]?n)[-_.*·⋅](m?m)(?![a-z])', r'\1\2', text)
    if (scaled := _SCALED.search(text.lower())) and scaled[1] in _KNOWN:
        return _split(text[: scaled.start()])[0], scaled[0].replace(' ', '')
    bracketed = _BRACKETS.findall(text)[::-1]
    others = [one for one in bracketed if not one.isdigit() and one.lower() not in _KNOWN_WORDS]
    unit = next((u for u in map(_unit, bracketed) if u in _KNOWN), '')
    unit = unit or next(filter(None, map(_unit, others)), '')

    def put(found: re.Match[str]) -> str:
        inner = found[1]
        return ' ' if not inner.isdigit() and _unit(inner) in {unit, ''} else f' {inner} '

    text = _BRACKETS.sub(put, text)
    words: list[str] = []
    for token in re.split(r'[\s_/.:,-]+', text):
        small = token.lower().replace('μ', 'µ')
        words += [small] if small in _KNOWN else [w.lower() for w in _CAMEL.findall(token)]
    pairs = ((word, _COMPOUND.fullmatch(word)) for word in words)
    words = [part for word, pair in pairs for part in (pair.groups() if pair else [word])]
    for at in (-1, 0):
        if not unit and words and words[at] in _KNOWN and (len(words) > 1 or at == -1):
            if at == 0 and words[0] not in _UNITS['time']:
                continue
            unit = words.pop(at)
    if 'joint' in words and {'state', 'states'} & {*words}:
        words.remove('joint')  # part of the name of a topic
    if 'm' in words:  # drivers name motors m1, m2
        words = ['motor' if word == 'm' else word for word in words]
    return tuple(words), unit


def time_among(names: Sequence[str]) -> tuple[str, str]:
    """Return the column of times and its unit, as far as the names tell."""
    times = [(_role(name)[1], name) for name in names if _role(name)[0] == 'time']
    name = min(times, default=('', ''))[1]
    return name, _split(name)[1]


def nanoseconds_of(name: str, names: Sequence[str]) -> str | None:
    """Return the column of nanoseconds that belongs to a column of whole seconds, as in ROS."""
    words, unit = _split(name)
    others = {_split(one)[0]: one for one in names if _split(one)[1] in _NANOSECONDS}
    return others.get(words) if TIME_UNITS.get(unit) == TIME_UNITS['s'] else None
