# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin preload`: preload of the branches, and the ring turn and pin setting for it."""

import argparse
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands import pins as pinning
from gear_kinematics.commands.pins import Pins
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.preload import Preload, Stiffness, braced, shaft_stiffness
from gear_kinematics.measurement.preload.file import MeasuredPreload, read_advice
from gear_kinematics.measurement.wording import PERCENT, plain, plus_minus
from gear_kinematics.report.document import Cell, Document, Layout, Section, Table
from gear_kinematics.shape.angles import arc, arc_seconds

_MAX_DECIMALS = 9
"""Of the torques in the table."""


class _Answer(NamedTuple):
    """A preload, and the pins for it."""

    mechanism: Mechanism
    measured: MeasuredPreload | None
    backlash: float
    preload: Preload
    pins: Pins
    pinned: Preload
    """Preload of the nearest setting."""

    @property
    def names(self) -> tuple[str, str]:
        """Names of branches A and B."""
        branch_a, branch_b = braced(self.mechanism)
        return branch_a.name, branch_b.name

    @property
    def max_load(self) -> float:
        """Range of table and plot, N·m."""
        return plotting.load_range(self.preload)

    @property
    def loads(self) -> list[float]:
        """Of the table, N·m."""
        return plotting.loads_to_list(self.preload, self.max_load)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    ways = pinning.add_turn(parser, required=True)
    pinning.add_setting(ways, '--setting', 'setting', 'pin setting of the ring gear')
    ways.add_argument(
        '--wanted-preload',
        type=float,
        metavar='N·m',
        help='of both branches without a load; negative: by turning the other way',
    )
    ways.add_argument(
        '--wanted-threshold', type=float, metavar='N·m', help='load up to which both are in mesh'
    )
    ways.add_argument(
        '--measured',
        type=Path,
        metavar='JSON',
        help='the least turn by measured ramps: from gearkin lost-motion --preloads --json',
    )
    arguments.group(parser, pinning.HEADING).add_argument(
        '--load',
        type=arguments.positive,
        metavar='N·m',
        help='that --measured must be for (default: any)',
    )
    group = parser.add_argument_group(
        'stiffness', 'torsional, at the output; not a parameter of the node'
    )
    for name, unit, text in (
        ('shaft-stiffness', 'N·m/rad', 'between the arms'),
        ('shaft-diameter', 'M', 'of a solid round shaft of steel'),
        ('shaft-length', 'M', 'between the arms'),
        ('backlash', 'RAD', 'play of the output before the turn, which has to close it first'),
    ):
        group.add_argument(f'--{name}', type=float, metavar=unit, help=text)
    group.add_argument(
        '--branch-stiffness',
        type=float,
        nargs='+',
        metavar='N·m/rad',
        help='of both branches, or of A and of B, the one at the output; inf: rigid',
    )
    arguments.add_mechanism(parser)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Report preload, limits, torque split and pins."""
    reporter = Reporter(options, others={'--drawing': options.drawing})
    answer = _answer(options)
    a, b = answer.names
    senses = (
        f'Stiffness, turn and load are those of the output, at the arm of branch {b}. A load is '
        f'positive in the direction in which ring gear {a} is turned relative to ring gear {b}.'
    )
    notes = [*answer.pins.turned(), ('outcome', _outcome(answer.pinned))]
    section = Section(
        '',
        (
            Table.of_values(Layout.LINES, *_facts(answer), *answer.pins.holes(), *notes),
            _split_table(answer),
        ),
        remarks=(senses, pinning.SENSES),
        answer=f'With {answer.pins.nearest.settings[0]} {_outcome(answer.pinned)}.',
        figure=plotting.torque_split(answer.preload, answer.names, answer.max_load),
        drawing=pinning.drawing(options, answer.pins, notes),
    )
    reporter.write(
        Document('gearkin preload', (section,), _data(answer)), [arguments.config_path(options)]
    )
    return ExitCode.DONE


def _answer(options: argparse.Namespace) -> _Answer:
    pair = arguments.load_config(options).mechanism
    braced(pair)  # its error, before others
    stiffness, measured, backlash = _known(options, pair)
    if options.setting:
        pins = pinning.at_setting(options, pair)
    else:
        turn = measured.least.high if measured else _wanted(options, pair, stiffness, backlash)
        pins = pinning.find(options, pair.ring_teeth, pair, turn)
    preload, pinned = (
        Preload.from_ring_turn(pair, stiffness, angle - (pins.phase or 0.0), backlash)
        for angle in (pins.ring_turn, pins.nearest.ring_turn)
    )
    return _Answer(pair, measured, backlash, preload, pins, pinned)


def _known(
    options: argparse.Namespace, pair: Mechanism
) -> tuple[Stiffness, MeasuredPreload | None, float]:
    """The stiffnesses, what was measured, and the backlash, rad."""
    if not options.measured:
        if options.load:
            raise ValueError('--load needs --measured')
        return _stiffness(options), None, options.backlash or 0.0
    given = ('branch_stiffness', 'shaft_stiffness', 'shaft_diameter', 'shaft_length', 'backlash')
    if any(getattr(options, name) is not None for name in given):
        raise ValueError('--measured contains the stiffness and backlash, give no others')
    measured = read_advice(options.measured)
    if options.load and options.load != measured.load:
        made = f'for {measured.load:g} N·m' if measured.load else 'without --load'
        raise ValueError(f'{options.measured}: made {made}, not for {options.load:g} N·m')
    if not math.isclose(measured.scale, pair.ring_teeth / pair.satellite_teeth):
        raise ValueError(f'{options.measured}: measured on a gear with other teeth')
    return measured.preload.stiffness, measured, measured.preload.play


def _stiffness(options: argparse.Namespace) -> Stiffness:
    branches, shaft = options.branch_stiffness, options.shaft_stiffness
    dimensions = [options.shaft_diameter, options.shaft_length]
    if branches is None:
        raise ValueError('--branch-stiffness is missing (inf for rigid branches)')
    if len(branches) > 2:  # noqa: PLR2004, A and B
        raise ValueError(f'--branch-stiffness takes one value or two, not {len(branches)}')
    if shaft is not None and dimensions != [None, None]:
        raise ValueError('--shaft-stiffness and dimensions of the shaft exclude each other')
    if shaft is None:
        if None in dimensions:
            raise ValueError('--shaft-stiffness or --shaft-diameter and --shaft-length is missing')
        shaft = shaft_stiffness(*dimensions)
    return Stiffness(branches[0], branches[-1], shaft)


def _wanted(
    options: argparse.Namespace, pair: Mechanism, stiffness: Stiffness, backlash: float
) -> float:
    """The turn that the options ask for, rad."""
    if options.wanted_preload is not None:
        wanted = Preload.from_torque(stiffness, abs(options.wanted_preload))
        return math.copysign(wanted.ring_turn(pair, backlash), options.wanted_preload)
    if options.wanted_threshold is not None:
        return Preload.from_limit(stiffness, options.wanted_threshold).ring_turn(pair, backlash)
    return pinning.ring_turn(options) or 0.0


def _data(answer: _Answer) -> dict[str, Any]:
    known, pins = answer.preload.stiffness, answer.pins
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
        'measured': plain(answer.measured and answer.measured._asdict()),
        'from': pinning.to_json(pins.start),
        'phase': pins.phase,
        **_figures(pins.ring_turn, answer.preload),
        'setting': {
            **pinning.to_json(pins.nearest.settings[0]),
            **_figures(pins.nearest.ring_turn, answer.pinned),
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


def _outcome(pinned: Preload) -> str:
    if not pinned.torque:
        return f'there is no preload: a play of {arc(pinned.play)} remains'
    return f'the preload is {pinned.torque:.4g} N·m: both branches mesh {_mesh_range(pinned)}'


def _mesh_range(preload: Preload) -> str:
    low, high = sorted((preload.threshold_a, preload.threshold_b))
    return f'for {low:.4g} to {high:.4g} N·m'


def _facts(answer: _Answer) -> Iterator[tuple[str, str]]:
    preload, (a, b) = answer.preload, answer.names
    known, pair = preload.stiffness, answer.mechanism
    yield 'teeth', f'{pair.ring_teeth} on the ring gears, {pair.satellite_teeth} on the satellites'
    parts = (
        (f'branch {a}', known.branch_a),
        (f'branch {b}', known.branch_b),
        ('shaft', known.shaft),
    )
    yield 'stiffness', ', '.join(f'{name} {_in_words(value)}' for name, value in parts)
    if measured := answer.measured:
        least, what = measured.least, 'hysteresis falls no further'
        if measured.load:
            what = f'both branches stay in mesh under {measured.load:g} N·m'
        span = f'{PERCENT}: {arc(least.low)} to {arc(least.high)}, which is wanted'
        yield 'measured', f'{what} from {arc(least.value)} on ({span})'
        if measured.added_friction:
            yield 'added friction', f'{plus_minus(measured.added_friction)} N·m'
    yield 'ring turn', f'{arc(answer.pins.ring_turn)} = {answer.pins.ring_turn:.6g} rad'
    if answer.backlash:
        yield 'backlash', f'{arc(answer.backlash)} at the output before the turn'
    if preload.torque:
        yield 'preload', f'{preload.torque:.4g} N·m in both branches without a load'
        stiffness = _in_words(known.both_in_mesh)
        yield 'both mesh', f'{_mesh_range(preload)}: {stiffness}'
        yield f'branch {a}', _threshold(preload.threshold_a, b, known.branch_b_alone)
        yield f'branch {b}', _threshold(preload.threshold_b, a, known.branch_a_alone)
    else:
        yield 'preload', f'none; a play of {arc(preload.play)} remains'
        yield f'branch {a}', f'carries negative loads alone: {_in_words(known.branch_a_alone)}'
        yield f'branch {b}', f'carries positive loads alone: {_in_words(known.branch_b_alone)}'


def _threshold(threshold: float, other: str, left: float) -> str:
    if math.isinf(threshold):
        return 'never leaves mesh'
    return f'leaves mesh at {threshold:+.4g} N·m; branch {other} alone: {_in_words(left)}'


def _in_words(stiffness: float) -> str:
    return 'rigid' if math.isinf(stiffness) else f'{stiffness:.4g} N·m/rad'


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
