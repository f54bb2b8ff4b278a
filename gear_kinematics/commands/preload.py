"""`gearkin preload`: preload of the branches, and the ring turn and pin setting for it."""

import argparse
import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments, bracing
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import Mechanism, vernier
from gear_kinematics.kinematics.preload import Preload, braced
from gear_kinematics.kinematics.vernier import PinSetting
from gear_kinematics.report.document import Cell, Document, Layout, Section, Table
from gear_kinematics.shape.angles import arc, arc_seconds

_MAX_DECIMALS = 9
"""Of the torques in the table."""


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
    loads: list[float]
    """Of the table, N·m."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.add_mechanism(parser)
    ways = parser.add_mutually_exclusive_group(required=True)
    bracing.add_ring_turn(ways)
    bracing.add_setting(ways, '--setting', 'setting', 'pin setting of the ring gear')
    ways.add_argument(
        '--wanted-preload', type=float, metavar='N·m', help='of both branches without a load'
    )
    ways.add_argument(
        '--wanted-threshold', type=float, metavar='N·m', help='load up to which both are in mesh'
    )
    bracing.add_setting(parser, '--from', 'start', 'initial pin setting (default: 0 0 0)')
    parser.add_argument(
        '--max-load', type=float, metavar='N·m', help='range of table and plot, on either side'
    )
    add_report_forms(parser)
    bracing.add_stiffness(parser)


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
    pair, stiffness = arguments.load_config(options).mechanism, bracing.stiffness(options)
    backlash = options.backlash or 0.0
    if stiffness is None:
        raise ValueError('the stiffness of branches and shaft is missing; see --help')
    start = vernier.pin_setting(pair.ring_teeth, *(options.start or (0, 0, 0)))
    if options.setting:
        setting = vernier.pin_setting(pair.ring_teeth, *options.setting)
        turn = pinned_turn = vernier.angle_between(start.turn, setting.turn)
    else:
        wanted = None
        if options.wanted_preload is not None:
            wanted = Preload.from_torque(stiffness, options.wanted_preload)
        elif options.wanted_threshold is not None:
            wanted = Preload.from_limit(stiffness, options.wanted_threshold)
        turn = wanted.ring_turn(pair, backlash) if wanted else bracing.ring_turn(options) or 0.0
        turn = bracing.within_a_turn(turn)
        [nearest] = vernier.choices(pair.ring_teeth, turn, start)
        setting, pinned_turn = nearest.settings[0], nearest.ring_turn
    preload, pinned = (
        Preload.from_ring_turn(pair, stiffness, angle, backlash) for angle in (turn, pinned_turn)
    )
    branch_a, branch_b = braced(pair)
    max_load = plotting.load_range(preload) if options.max_load is None else options.max_load
    if not 0.0 < max_load < math.inf:
        raise ValueError(f'--max-load must be finite and greater than 0, not {max_load}')
    return _Answer(
        pair,
        (branch_a.name, branch_b.name),
        backlash,
        turn,
        preload,
        setting,
        pinned_turn,
        pinned,
        max_load,
        plotting.loads_to_list(preload, max_load),
    )


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
        yield f'branch {a}', _threshold(preload.threshold_a, b, known.branch_b_alone)
        yield f'branch {b}', _threshold(preload.threshold_b, a, known.branch_a_alone)
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


def _threshold(threshold: float, other: str, left: float) -> str:
    if math.isinf(threshold):
        return 'never leaves mesh'
    return f'leaves mesh at {threshold:+.4g} N·m; branch {other} alone: {_stiffness(left)}'


def _stiffness(value: float) -> str:
    return 'rigid' if math.isinf(value) else f'{value:.4g} N·m/rad'


def _split_table(answer: _Answer) -> Table:
    preload, (a, b) = answer.preload, answer.names
    marks = plotting.leaving_mesh(preload, answer.names)
    decimals = min(max(0, 3 - math.floor(math.log10(answer.max_load))), _MAX_DECIMALS)
    split = preload.split(answer.loads)
    rows = []
    for load, *torques, turn in zip(answer.loads, *split, strict=True):
        cells = (round(torque, decimals) + 0.0 for torque in (load, *torques))
        rows.append(
            (
                *(Cell(f'{cell:.{decimals}f}') for cell in cells),
                Cell(f'{arc_seconds(turn):.1f}'),
                Cell(marks.get(load, '')),
            )
        )
    columns = ('load [N·m]', f'branch {a} [N·m]', f'branch {b} [N·m]', 'output turns [″]', 'mesh')
    return Table(columns, tuple(rows), words=('mesh',))
