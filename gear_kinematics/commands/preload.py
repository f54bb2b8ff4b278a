# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin preload`: preload of the branches, and the ring turn and pin setting for it."""

import argparse
import math
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands import pins as pinning
from gear_kinematics.commands.output import message_progress
from gear_kinematics.commands.pins import Pins
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.loads import TorqueSharing
from gear_kinematics.kinematics.preload import Preload, Stiffness, braced
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.loads.recorded import LoadTask, read_loads
from gear_kinematics.report.document import Document, Layout, Section, Table
from gear_kinematics.shape.angles import arc


class _Answer(NamedTuple):
    """A preload, and the pins for it."""

    mechanism: Mechanism
    names: tuple[str, str]  # torques of branches A and B
    backlash: float
    preload: Preload
    pins: Pins
    pinned: Preload  # preload of the nearest setting


def add_arguments(parser: argparse.ArgumentParser) -> None:
    turns = pinning.add_turn(parser, required=True)
    turns.add_argument(
        '--setting',
        type=int,
        nargs=3,
        metavar=('TOOTH', 'RING_HOLE', 'CHASSIS_HOLE'),
        help='pin setting of the ring gear',
    )
    for name, text in (
        ('preload', 'torque in both branches without load; negative: turn in the other direction'),
        ('threshold', 'load up to which both branches stay in mesh'),
    ):
        turns.add_argument(f'--wanted-{name}', type=arguments.MAGNITUDE, metavar='N·m', help=text)
    text = 'recording of loads under which both branches have to stay in mesh'
    turns.add_argument('--from', dest='recording', type=Path, metavar='RECORDING', help=text)
    turn = arguments.group(parser, 'turn of a ring gear')
    text = 'safety factor of the least preload for a recording (default: %(default)g)'
    turn.add_argument(
        '--margin', type=arguments.between(0.01, 100.0), default=1.2, metavar='FACTOR', help=text
    )
    group = parser.add_argument_group('stiffness', 'torsional, at the output')
    group.add_argument(
        '--branch-stiffness',
        type=arguments.between(1e-3),
        nargs='+',
        required=True,
        metavar='N·m/rad',
        help='stiffness of both branches, or of A and then of B, whose arm is at the output; '
        'inf: rigid',
    )
    group.add_argument(
        '--shaft-stiffness',
        type=arguments.between(1e-3),
        required=True,
        metavar='N·m/rad',
        help='stiffness of the shaft between the arms',
    )
    text = 'play of the output before the ring is turned, which the turn has to close first'
    group.add_argument('--backlash', type=float, default=0.0, metavar='RAD', help=text)
    arguments.add_mechanism(parser)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    reporter = Reporter(options)
    answer = _answer(options)
    a, b = answer.names
    senses = (
        f'Stiffness, turn and load are those of the output, at the arm of branch {b}. A load is '
        f'positive in the direction in which ring gear {a} is turned relative to ring gear {b}.'
    )
    facts = [*_facts(answer), *answer.pins.facts(), ('outcome', _outcome(answer.pinned))]
    section = Section(
        '',
        (Table.of_values(Layout.LINES, *facts),),
        remarks=(senses, pinning.SENSES),
        answer=f'With {answer.pins.nearest.settings[0]} {_outcome(answer.pinned)}.',
        figure=plotting.torque_split(answer.preload, answer.names),
    )
    return reporter.write(
        Document('gearkin preload', (section,), _data(answer)), [arguments.config_path(options)]
    )


def _answer(options: argparse.Namespace) -> _Answer:
    pair = arguments.load_config(options).mechanism
    a, b = braced(pair)  # its error, before others
    branches, backlash = options.branch_stiffness, options.backlash
    if len(branches) > 2:  # noqa: PLR2004, A and B
        raise ValueError(f'--branch-stiffness takes one value or two, not {len(branches)}')
    if backlash >= (pitch := TURN / pair.satellite_teeth):
        limit = f'less than a tooth pitch, {pitch:.3g} rad at the output'
        raise ValueError(f'--backlash must be {limit}, not {backlash:g}')
    stiffness = Stiffness(branches[0], branches[-1], options.shaft_stiffness)
    if options.setting:
        pins = pinning.at_setting(options, pair)
    else:
        pins = pinning.find(options, pair, _wanted(options, pair, stiffness))
    preload, pinned = (
        Preload.from_ring_turn(pair, stiffness, angle - (pins.phase or 0.0), backlash)
        for angle in (pins.ring_turn, pins.nearest.ring_turn)
    )
    TorqueSharing(pair, preload)  # raises the error of a preload that no gear takes
    return _Answer(pair, (a.name, b.name), backlash, preload, pins, pinned)


def _wanted(options: argparse.Namespace, pair: Mechanism, stiffness: Stiffness) -> float:
    """Determine the turn given by the options, rad."""
    sign = 1.0
    if options.wanted_preload is not None:
        sign = options.wanted_preload
        preload = Preload.from_torque(stiffness, abs(options.wanted_preload))
    elif options.wanted_threshold is not None:
        preload = Preload.from_limit(stiffness, options.wanted_threshold)
    elif options.recording:
        config = arguments.load_config(options, options.recording)
        sign = math.copysign(1.0, config.preload)
        with message_progress(options.recording.name, quiet=options.quiet) as report_progress:
            loads = read_loads(LoadTask(options.recording, config), report_progress)
        needed = -float(np.min(Preload(stiffness, 0.0).margin(-sign * loads.torque)))
        preload = Preload.from_torque(stiffness, options.margin * needed)
    else:
        return math.radians(options.degrees)
    return math.copysign(preload.ring_turn(pair, options.backlash), sign)


def _data(answer: _Answer) -> dict[str, Any]:
    known, pins = answer.preload.stiffness, answer.pins
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
        'phase': pins.phase,
        **_figures(pins.ring_turn, answer.preload),
        'setting': {
            **asdict(pins.nearest.settings[0]),
            **_figures(pins.nearest.ring_turn, answer.pinned),
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
    known = preload.stiffness
    parts = (
        (f'branch {a}', known.branch_a),
        (f'branch {b}', known.branch_b),
        ('shaft', known.shaft),
    )
    yield 'stiffness', ', '.join(f'{name} {_in_words(value)}' for name, value in parts)
    if answer.backlash:
        yield 'backlash', f'{arc(answer.backlash)} at the output before the turn'
    if preload.torque:
        force = preload.torque / answer.mechanism.satellite_rolling_radius
        price = f', and {force:.4g} N at each mesh and cam'
        yield 'preload', f'{preload.torque:.4g} N·m in both branches without a load{price}'
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
