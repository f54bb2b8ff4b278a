"""`gearkin preload`: preload of the branches, and the ring turn and pin setting for it."""

import argparse
import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.output import Reporter
from gear_kinematics.kinematics import Mechanism, vernier
from gear_kinematics.kinematics.preload import Preload, braced
from gear_kinematics.kinematics.vernier import PinSetting
from gear_kinematics.report.document import Cell, Document, Layout, Section, Table
from gear_kinematics.shape.angles import arc, arc_seconds

_LOADS = 4
"""Rows of the table on either side of zero load, in addition to the thresholds."""
_NEAT = (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10)
"""Spacings of the loads in the table, times a power of ten."""
_BEYOND = 1.2
"""Least range of table and plot / greater threshold."""
_DECIMALS = 9
"""Most decimals in the table."""


class _Answer(NamedTuple):
    """A preload, and the pin setting for it."""

    mechanism: Mechanism
    names: tuple[str, str]
    """Names of branches A and B."""
    backlash: float
    ring_turn: float
    preload: Preload
    setting: PinSetting
    """The given setting, or the nearest one."""
    pinned_turn: float
    """Ring turn of the setting, rad."""
    pinned: Preload
    """Preload of the setting."""
    max_load: float
    """Range of table and plot, N·m."""

    @property
    def loads(self) -> list[float]:
        """Loads of the table, N·m: evenly spaced, with the thresholds in between."""
        even = np.linspace(-self.max_load, self.max_load, 2 * _LOADS + 1).tolist()
        thresholds = (self.preload.threshold_a, self.preload.threshold_b)
        return sorted({*even, *(load for load in thresholds if abs(load) < self.max_load)})


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.add_mechanism(parser)
    ways = parser.add_mutually_exclusive_group(required=True)
    arguments.add_ring_turn(ways)
    arguments.add_setting(ways, '--setting', 'setting', 'pin setting of the ring gear')
    ways.add_argument(
        '--wanted-preload', type=float, metavar='N·m', help='of both branches without a load'
    )
    ways.add_argument(
        '--wanted-threshold', type=float, metavar='N·m', help='load up to which both are in mesh'
    )
    arguments.add_setting(parser, '--from', 'start', 'initial pin setting (default: 0 0 0)')
    parser.add_argument(
        '--max-load', type=float, metavar='N·m', help='range of table and plot, on either side'
    )
    arguments.add_report_forms(parser)
    arguments.add_stiffness(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Report preload, limits and torque split."""
    reporter = Reporter(options)
    answer = _answer(options)
    a, b = answer.names
    senses = (
        f'Stiffness, turn and load are those of the output, at the arm of branch {b}. A load is '
        f'positive in the direction in which ring gear {a} is turned relative to ring gear {b}.'
    )
    section = Section(
        '',
        (Table.of_values(Layout.LINES, *_facts(answer)), _split_table(answer)),
        remarks=(senses,),
        figure=plotting.torque_split(answer.preload, answer.names, answer.max_load),
    )
    reporter.write(
        Document('gearkin preload', (section,), _data(answer)), [arguments.config_path(options)]
    )
    return ExitCode.DONE


def _answer(options: argparse.Namespace) -> _Answer:
    pair, known = arguments.mechanism(options), arguments.stiffness(options)
    backlash = options.backlash or 0.0
    if known is None:
        raise ValueError('the stiffness of branches and shaft is missing; see --help')
    start = vernier.pin_setting(pair.ring_teeth, *(options.start or (0, 0, 0)))
    if options.setting:
        setting = vernier.pin_setting(pair.ring_teeth, *options.setting)
        turn = pinned_turn = vernier.angle_between(start.turn, setting.turn)
    else:
        if options.wanted_preload is not None:
            turn = Preload.from_torque(known, options.wanted_preload).ring_turn(pair, backlash)
        elif options.wanted_threshold is not None:
            turn = Preload.from_limit(known, options.wanted_threshold).ring_turn(pair, backlash)
        else:
            turn = arguments.ring_turn(options) or 0.0
        turn = arguments.within_a_turn(turn)
        [nearest] = vernier.choices(pair.ring_teeth, turn, start)
        setting, pinned_turn = nearest.settings[0], nearest.ring_turn
    preload, pinned = (
        Preload.from_ring_turn(pair, known, angle, backlash) for angle in (turn, pinned_turn)
    )
    branch_a, branch_b = braced(pair)
    return _Answer(
        pair,
        (branch_a.name, branch_b.name),
        backlash,
        turn,
        preload,
        setting,
        pinned_turn,
        pinned,
        _max_load(options.max_load, preload),
    )


def _max_load(given: float | None, preload: Preload) -> float:
    if given is not None:
        if not 0.0 < given < math.inf:
            raise ValueError(f'--max-load must be finite and greater than 0, not {given}')
        return given
    thresholds = (preload.threshold_a, -preload.threshold_b)
    farthest = max((load for load in thresholds if load < math.inf), default=0.0) or 1.0
    spacing = _BEYOND * farthest / _LOADS
    decade = 10.0 ** math.floor(math.log10(spacing))
    return _LOADS * next(n * decade for n in _NEAT if n * decade >= spacing)


def _data(answer: _Answer) -> dict[str, Any]:
    known, setting = answer.preload.stiffness, answer.setting
    split = answer.preload.split(answer.loads)
    return {
        'ring_teeth': answer.mechanism.ring_teeth,
        'satellite_teeth': answer.mechanism.satellite_teeth,
        'branches': answer.names,
        'stiffness': {
            'branch_a': known.branch_a,
            'branch_b': known.branch_b,
            'shaft': known.shaft,
            'inside': known.both_in_mesh,
            'without_a': known.branch_b_alone,
            'without_b': known.branch_a_alone,
        },
        'backlash': answer.backlash,
        **_figures(answer.ring_turn, answer.preload),
        'setting': {
            'tooth': setting.tooth,
            'ring_hole': setting.ring_hole,
            'chassis_hole': setting.chassis_hole,
            **_figures(answer.pinned_turn, answer.pinned),
        },
        'split': {
            'load': answer.loads,
            **{name: values.tolist() for name, values in split._asdict().items()},
        },
    }


def _figures(turn: float, preload: Preload) -> dict[str, float]:
    return {
        'ring_turn': turn,
        'preload': preload.torque,
        'play': preload.play,
        'limit': preload.limit,
        'threshold_a': preload.threshold_a,
        'threshold_b': preload.threshold_b,
    }


def _facts(answer: _Answer) -> Iterator[tuple[str, str]]:
    preload, (a, b) = answer.preload, answer.names
    known, pair = preload.stiffness, answer.mechanism
    yield 'teeth', f'{pair.ring_teeth} on the ring gears, {pair.satellite_teeth} on the satellites'
    parts = (
        (f'branch {a}', known.branch_a),
        (f'branch {b}', known.branch_b),
        ('shaft', known.shaft),
    )
    yield 'stiffness', ', '.join(f'{name} {_stiffness(value)}' for name, value in parts)
    yield 'ring turn', f'{arc(answer.ring_turn)} = {answer.ring_turn:.6g} rad'
    if answer.backlash:
        yield 'backlash', f'{arc(answer.backlash)} at the output before the turn'
    if preload.torque:
        yield 'preload', f'{preload.torque:.4g} N·m in both branches without a load'
        stiffness = _stiffness(known.both_in_mesh)
        yield 'both mesh', f'while |load| < {preload.limit:.4g} N·m: {stiffness}'
        yield f'branch {a}', _leaving(preload.threshold_a, b, known.branch_b_alone)
        yield f'branch {b}', _leaving(preload.threshold_b, a, known.branch_a_alone)
    else:
        yield 'preload', f'none; a play of {arc(preload.play)} remains'
        yield f'branch {a}', f'carries negative loads alone: {_stiffness(known.branch_a_alone)}'
        yield f'branch {b}', f'carries positive loads alone: {_stiffness(known.branch_b_alone)}'
    pinned = answer.pinned
    if answer.pinned_turn == answer.ring_turn:
        yield 'pin', str(answer.setting)
    else:
        yield 'nearest', str(answer.setting)
        yield 'gives', f'{pinned.torque:.4g} N·m; both mesh while |load| < {pinned.limit:.4g} N·m'


def _leaving(threshold: float, other: str, left: float) -> str:
    if math.isinf(threshold):
        return 'never leaves mesh'
    return f'leaves mesh at {threshold:+.4g} N·m; branch {other} alone: {_stiffness(left)}'


def _stiffness(value: float) -> str:
    return 'rigid' if math.isinf(value) else f'{value:.4g} N·m/rad'


def _split_table(answer: _Answer) -> Table:
    preload, (a, b) = answer.preload, answer.names
    leaving = {}
    if preload.torque:
        leaving[preload.threshold_a] = f'branch {a} leaves mesh'
        leaving[preload.threshold_b] = f'branch {b} leaves mesh'
    decimals = min(max(0, 3 - math.floor(math.log10(answer.max_load))), _DECIMALS)
    split = preload.split(answer.loads)
    rows = []
    for load, *torques, turn in zip(answer.loads, *split, strict=True):
        cells = (round(torque, decimals) + 0.0 for torque in (load, *torques))
        rows.append(
            (
                *(Cell(f'{cell:.{decimals}f}') for cell in cells),
                Cell(f'{arc_seconds(turn):.1f}'),
                Cell(leaving.get(load, '')),
            )
        )
    columns = ('load [N·m]', f'branch {a} [N·m]', f'branch {b} [N·m]', 'output turns [″]', 'mesh')
    return Table(columns, tuple(rows), words=('mesh',))
