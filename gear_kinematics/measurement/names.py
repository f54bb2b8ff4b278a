# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The names of a table's columns: their words and units, and what these mean."""

import re
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import UNITS

_VOCABULARY = {
    'rotor': 'rotor motor mot odrive antrieb moteur motore 电机 馬達 モータ モーター 모터',
    'output': 'output out load gearbox gear shaft link joint abtrieb ausgang sortie uscita salida '
    'saída 输出 输出轴 负载 负载端 关节 輸出 輸出軸 負載 出力 出力軸 負荷 負荷側 출력 출력축 부하',
    'input': 'input eingang entrée ingresso entrada 输入 输入轴 輸入 輸入軸 入力 入力軸 입력',
    'angle': 'position positions pos angle ang encoder enc theta phi θ φ ϕ deflection twist '
    'rotation winkel drehwinkel verdrehwinkel angolo ángulo angulo ângulo posición posizione '
    'posição 位置 角度 转角 扭转角 回転角 ねじれ角 编码器 編碼器 각도 위치 엔코더',
    'torque': 'torque torques tor effort efforts trq tq tau τ drehmoment moment couple coppia '
    '扭矩 力矩 转矩 轉矩 トルク 토크',
    'current': 'current',
    'time': 'time t stamp timestamp timestamps today datetime elapsed zeit uhrzeit messzeit '
    'laufzeit prüfzeit temps tempo tiempo tout xtime ts zeitstempel horodatage heure hora ora '
    'czas tijd tid время 시간 时间 时间戳 時間 x',
    'filling': 'header receive log dynamic measured meas actual act filtered raw field data value '
    'values feedback state states axis angular rotary present sensor abs side in ist host pi ros '
    'system unix epoch tv channel ch fb fbk ave estimate scalars signals date datum utc wall '
    'application main plc prg gvl payload msg message torsional accum do da del',
}
"""Words in names by kind, the likeliest first. The input is the rotor if a quantity is said, too.
The filling may accompany all others; any other word shows a command, a speed or the like."""
_KINDS = {word: kind for kind, words in _VOCABULARY.items() for word in words.split()}
_RANKS = {word: rank for rank, word in enumerate(_KINDS)}
_EITHER = {'shaft', 'joint', 'gearbox', 'gear'}
"""Words for the output that do not mean it beside one for the rotor, as in motor_shaft."""
_SHARES, _OTHERS = '% ‰ percent pct permille', 'a ma v mv mv/v volts adc w n kg g m mm °c min h'
FOREIGN = {*_SHARES.split(), *_OTHERS.split()}
"""Units of quantities other than torque and angle, and words that may be times."""
_CERTAIN = {'time', 'stamp', 'timestamp', 'timestamps', 'zeit', 'zeitstempel'}
"""Words for times that mean them beside unknown words, too, if the numbers rise."""
WANTED = (
    r'target|action|goal|desire|cmd|command|setpoint|demand|(?<![a-z])(ref|des)(?![a-z])|'
    'soll|consigne|目标|目標|指令|목표'
)
"""Words in names of columns of what was commanded, not measured."""
_SPEEDS = {'rpm', 'rps', 'dps', 'cps'}
_OF_ONE = re.compile(r't(_[a-z]+|[mol])( ?[\[(].*)?|.*[a-z][./]t')
"""Names that may be the times of one side, such as t_m, but not T_m, a torque or temperature."""
_NO_UNIT = re.compile(r'-|none|n/a|1|:|utc.*|.*h:m+.*')

_DEG, _KGF, _LBF = UNITS['deg'], 9.80665, 4.4482216152605  # rad, N, N
_SIZES: Mapping[str, Mapping[str, Any]] = {
    'angle': {
        'rad radian radians 弧度': 1.0,
        'mrad millirad milliradian milliradians': 1e-3,
        'deg ° º ˚ degs degree degrees grados gradi degrés graus graden град 度 도': _DEG,
        'rev turn turns revs revolution revolutions rotations umdrehungen umdr 圈 转': TURN,
        'mdeg millideg': 1e-3 * _DEG,
        'cdeg': 1e-2 * _DEG,
        'ddeg': 0.1 * _DEG,
        'mrev': 1e-3 * TURN,
        'urad µrad microrad microradians': 1e-6,
        "arcmin arc-min arcminutes ′ '": _DEG / 60.0,
        'arcsec arc-sec arcseconds ″': _DEG / 3600.0,
        'gon': TURN / 400.0,
        'counts count cnt inc increment increments ticks pulse pulses lsb steps qc 脉冲': None,
    },
    'torque': {
        'N·m nm knmm': 1.0,
        'mN·m mnm nmm': 1e-3,
        'µN·m unm µnm': 1e-6,
        'N·cm ncm cnm': 1e-2,
        'dN·m dnm': 0.1,
        'kN·m knm': 1e3,
        'kg·cm kgcm kgfcm': 1e-2 * _KGF,
        'g·cm gcm gfcm': 1e-5 * _KGF,
        'kg·m kgm kgfm': _KGF,
        'lb·ft lbft ftlb lbfft ftlbf ftlbs': 0.3048 * _LBF,
        'lb·in lbin inlb lbfin inlbf inlbs': 0.0254 * _LBF,
        'oz·in ozin inoz ozfin inozf': 0.0254 / 16.0 * _LBF,
    },
    'time': {
        's sec secs second seconds 秒 초': 1.0,
        'ms msec msecs millis millitm millisecond milliseconds 毫秒': 1e-3,
        'us µs usec usecs µsec micros microseconds': 1e-6,
        'ns nsec nsecs nanosec nanosecs nanoseconds': 1e-9,
        'minutes minute': 60.0,
        'hours hour': 3600.0,
        'days day': 86_400.0,
        '100ns filetime': 1e-7,  # ticks of Windows and .NET
    },
}
"""Sizes of units in rad, N·m or s; the first spelling of each is the usual one."""
ANGLE_UNITS, TORQUE_UNITS, TIME_UNITS = (
    {words.split()[0]: size for words, size in sizes.items()} for sizes in _SIZES.values()
)
_UNITS = {
    word: words.split()[0]
    for sizes in _SIZES.values()
    for words in sizes
    for word in words.split()
}

_IN_BRACKETS = _UNITS | {'rotation': 'rev', 'min': 'minutes', 'h': 'hours', 'с': 's'}
_IN_BRACKETS |= {'tr': 'rev', 'tours': 'rev', 'ink': 'counts', 'inkr': 'counts'}
"""Also units that mean something else as words of a name, as in position_min."""

_DOTS = '-.*·⋅∙•×・'  # between newton and metre
_MEGA = rf'MN(?=[{_DOTS}_ ]?m)', 'meganewton'  # so that MN·m is not read as mN·m
_PLAINER: Mapping[str, Any] = {
    _MEGA[0]: _MEGA[1],
    r'^[%#"\s]+|[#"\s]+$': '',
    r'\{name==': '{',  # of a joint, in paths of Foxglove
    r'\\\w+:\d+$': '',  # device and raster, of INCA
    r'(?i)^(time|zeit) +\d+ - [^[]*': r'\1',  # of catman
    r'(?i)joint[ _]?(states?)': r'\1',  # in names of topics
    r'(?<=\.)(lr|r|f|fb|st)(?=[A-Z][a-z].*(Pos|Ang|Winkel|Enc|Tor|Mom))': '',  # types of a PLC
    r'(?i)[ _]?of[ _]?day(?![a-z])': '',  # which is no unit
    r'(?i)(?<![a-z])(time(?:stamp)?|zeit|elapsed|t)[ _,]+(min|h)$': r'\1 [\2]',
    r'((?i:moment|torque)) M(?![^\W_])': r'\1',  # the symbol, and no motor
    r'^M(?=[ _/\[(]*[mckµ]?N|_[xyz](?![^\W_]))': 'moment',
    r'(?i)[ _]?milli(?=(nm|rad|deg)(?![a-z]))': '_m',
    r'(?i)(rad|deg|°|rev)[ ·.*]?s(\^?-1|⁻¹)': r'\1/s',
    r'(?i)(winkel.*[^a-z])grad(?![a-z])': r'\1deg',  # gradians elsewhere
    r'(?i)[ _]?(deg|rad|rev)[ _]?x1(0{1,3})$': lambda u: f'_{"dcm"[len(u[2]) - 1]}{u[1]}',
    rf'(?i)(?<![a-z])([mcdkµ]?n|k?gf?)[{_DOTS}_ ]([cm]?m)(?![a-z])': r'\1\2',
    rf'(?i)(?<![a-z])(ozf?|lb[fs]?)[{_DOTS}_ ](in|ft)(?![a-z])': r'\1\2',
    rf'(?i)(?<![a-z])(in(?=[{_DOTS}])|ft)[{_DOTS}_ ](ozf?|lb[fs]?)(?![a-z])': r'\1\2',
}
"""Spellings in names, and what is read in their place."""
_BRACKETS = re.compile(r'[\[(]\s*([^\])]*?)\s*[\])]')
_CAMEL = re.compile(r'[A-Z]+(?![a-zµ])|[A-Z]?[^\W\d_A-Z]+|\d+|[°%]')
_SCALED = re.compile(r'(?<![^\W_])(?:\d+\.\d+ ?|\d+)([^\W\d_]+|°)$')
"""A unit with a number, as in rotor_0.1deg, which is not part of the name."""
_SIDES, _QUANTITIES = (
    f'{_VOCABULARY[one]} {_VOCABULARY[other]}'.replace(' ', '|')
    for one, other in (('rotor', 'output'), ('angle', 'torque'))
)
_COMPOUND = re.compile(f'({_SIDES})s?({_QUANTITIES})')
"""Two words without anything between them, as in motorpos and Abtriebswinkel."""


class Meaning(NamedTuple):
    """What the name of a column says."""

    words: tuple[str, ...]  # in lower case, without the unit
    unit: str  # empty if none
    role: str  # time, angle, rotor, output or torque; empty if none
    rank: tuple[int, ...]  # lowest for the likeliest column of a role
    on_rotor: bool  # whether a word means the rotor
    on_output: bool  # whether a word means the output
    unsure: bool  # whether it may be of something else than a role that it has

    @property
    def unknown(self) -> str:
        """The last word if all others are known: it seems to be an unknown unit."""
        *first, last = self.words or ('',)
        seems = first and _KINDS.keys() >= {*first} and last not in _KINDS
        return last if seems and not (last.isdigit() or self.unsure) else ''


@cache
def meaning(name: str) -> Meaning:
    """Return the meaning of a name."""
    words, unit = _words(name)
    kinds = {word: _KINDS.get(word) for word in words}
    rotor = not {'rotor', 'input'}.isdisjoint(kinds.values())
    outputs = {word for word in kinds if kinds[word] == 'output'}
    output = bool(outputs - _EITHER if rotor else outputs)
    role, rank = _role(words, unit, rotor=rotor, output=output)
    if not role and unit in {'', *TIME_UNITS} and _OF_ONE.fullmatch(name):
        role, rank = 'time', (len(_KINDS), len(words))
    known = kinds.keys() <= _KINDS.keys() and (not words or 'time' in kinds.values())
    unsure = role == 'time' and (rotor or output or not known)
    return Meaning(words, unit, role, rank, rotor, output, unsure)


def _role(
    words: Sequence[str], unit: str, *, rotor: bool, output: bool
) -> tuple[str, tuple[int, ...]]:
    """Return the role of a column and its rank."""
    none = '', ()
    keys = [word for word in words if _KINDS.get(word) != 'filling' and not word.isdigit()]
    kinds = {_KINDS.get(word) for word in keys}
    if not keys and unit in TIME_UNITS:  # as of unix_ms
        coarse = TIME_UNITS[unit] > 1.0  # such as the hour beside seconds, or hours of operation
        return 'time', (len(_KINDS) + 1 if coarse or words else 9,)
    if times := [word for word in keys if _KINDS.get(word) == 'time']:
        foreign = unit not in {'', *TIME_UNITS} or not {*_SHARES.split()}.isdisjoint(words)
        certain = not (foreign or _CERTAIN.isdisjoint(times))
        sided = kinds in ({'time', 'rotor'}, {'time', 'output'})  # such as motor_time
        if (sided and (certain or unit in TIME_UNITS)) or (certain and kinds == {'time', None}):
            return 'time', (len(_KINDS), len(words))
        # The stamp of a message is when it was sampled; a log has when it was received.
        first = 0 if keys == ['stamp'] and 'header' in words and not unit else len(words)
        if kinds == {'time'} and (keys != ['x'] or 'value' in words):
            return 'time', (first, _RANKS[keys[0]])
        return none
    if unit in TORQUE_UNITS and 'angle' not in kinds:
        kinds.add('torque')  # as of load_Nm
    torque, quantity = 'torque' in kinds, not kinds.isdisjoint({'angle', 'torque'})
    unclear = (torque and 'angle' in kinds) or (rotor and output and not torque)
    others = None in kinds or ('current' in kinds and not torque)
    of_others = unit in {*FOREIGN, *TIME_UNITS}
    unsaid = kinds == {'input'} or (of_others and not quantity)
    if not keys or others or unclear or unsaid or '/' in unit or unit in _SPEEDS:
        return none
    # A count of turns comes after the angle within a turn, and the state of a motor after both.
    # A torque at the output needs no ratio, and comes before that of the motor.
    unsure = of_others, not quantity and unit in {'', 'rev'}, torque and rotor
    rank = (*unsure, len(words), *(_RANKS[word] for word in keys))
    return 'torque' if torque else 'rotor' if rotor else 'output' if output else 'angle', rank


def usual_unit(text: str) -> str:
    """Return the usual word for a unit, a text in lower case if it is unknown, or nothing."""
    plain = re.sub(r'\s|units?:', '', re.sub(*_MEGA, text).lower().replace('μ', 'µ'))
    plain = re.sub(rf'[{_DOTS}](?=(in|ft|ozf?|lb[fs]?|c?m)$)', '', plain.strip('[]').strip('()'))
    plain = re.sub(rf'n(ewton)?[{_DOTS}_]?([cm]?)m(et(er|re)s?)?(?!\w)', r'n\2m', plain)
    outer, _, inner = plain.partition('(')  # as in "° (Degree)" and "(deg)"
    plain = (outer or inner).strip('()[].')
    return '' if _NO_UNIT.fullmatch(plain) else _IN_BRACKETS.get(plain, plain)


def known_units(cells: Sequence[str], others: Collection[str] = (), fewest: int = 2) -> list[str]:
    """Return the units in a row if the fewest or most are known, or among others; or nothing."""
    units = [usual_unit(cell) for cell in cells]
    if any(re.match(r'[-+]?[\d.]+$', unit) for unit in units):  # such as a row of the least values
        return []
    known = len([unit for unit in units if unit in _UNITS or unit in others])
    return units if known >= fewest or 2 * known > len([*filter(None, units)]) else []


def _words(name: str) -> tuple[tuple[str, ...], str]:
    """Divide a name into words, in lower case, and its unit, in brackets or a known word."""
    for pattern, plain in _PLAINER.items():
        name = re.sub(pattern, plain, name)
    if (scaled := _SCALED.search(name.lower())) and scaled[1] in _UNITS:
        return _words(name[: scaled.start()])[0], scaled[0].replace(' ', '')
    bracketed = _BRACKETS.findall(name.lstrip('['))[::-1]
    others = [one for one in bracketed if not one.isdigit() and one.lower() not in _KINDS]
    unit = next((u for u in map(usual_unit, bracketed) if u in _UNITS), '')
    unit = unit or next(filter(None, map(usual_unit, others)), '')

    def put(found: re.Match[str]) -> str:
        inner = found[1]
        return ' ' if not inner.isdigit() and usual_unit(inner) in {unit, ''} else f' {inner} '

    words: list[str] = []
    for token in re.split(r'[^\w°%‰′″]+|_+', _BRACKETS.sub(put, name)):
        small = token.lower().replace('μ', 'µ')
        words += [small] if small in _UNITS else [w.lower() for w in _CAMEL.findall(token)]
    pairs = ((word, _COMPOUND.fullmatch(word)) for word in words)
    words = [part for word, pair in pairs for part in (pair.groups() if pair else [word])]
    if not unit and words:
        if words[-1] in _UNITS:
            unit = _UNITS[words.pop()]
        elif _UNITS.get(words[0]) in TIME_UNITS:
            unit = _UNITS[words.pop(0)]
    # Drivers name motors m1, m2.
    return tuple('motor' if word == 'm' else word for word in words), unit
