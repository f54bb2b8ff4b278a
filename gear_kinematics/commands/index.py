# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin index`: the pin setting for a wanted turn of a ring gear."""

import argparse
from typing import Any

import numpy as np

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands import pins as pinning
from gear_kinematics.commands.pins import Pins
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import vernier
from gear_kinematics.report.document import (
    Cell,
    Document,
    Figure,
    Layout,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    Tone,
)
from gear_kinematics.shape.angles import arc, arc_seconds


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    pinning.add_turn(parser, required=False)
    arguments.group(parser, pinning.HEADING).add_argument(
        '--neighbours',
        type=arguments.between(0, 1000, int),
        default=3,
        metavar='N',
        help='positions to list on either side (default: 3)',
    )
    arguments.add_mechanism(parser)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Report the setting and its neighbours, and draw it."""
    reporter = Reporter(options, others={'--drawing': options.drawing})
    turn = pinning.ring_turn(options)
    if turn is None and not options.phase_b:
        raise ValueError('give --angle, --degrees or --phase-b')
    pair, ring_teeth = None, options.ring_teeth
    if options.phase_b or not ring_teeth:  # the vernier alone needs no satellite
        pair = arguments.load_config(options).mechanism
        ring_teeth = pair.ring_teeth
    pins = pinning.find(options, ring_teeth, pair, turn or 0.0, options.neighbours)
    drawing = pinning.drawing(options, pins, pins.turned())
    reporter.write(
        Document('gearkin index', (_section(pins, drawing),), _data(pins)),
        [arguments.config_path(options)],
    )
    return ExitCode.DONE


def _data(pins: Pins) -> dict[str, Any]:
    return {
        'ring_teeth': pins.ring_teeth,
        'ring_holes': pins.ring_teeth + 1,
        'chassis_holes': pins.ring_teeth + 2,
        'positions': vernier.distinct_positions(pins.ring_teeth),
        'step': vernier.step(pins.ring_teeth),
        'from': pinning.to_json(pins.start),
        'wanted': {'ring_turn': pins.ring_turn, 'phase': pins.phase},
        'positions_around': [
            {
                'steps': choice.steps,
                'ring_turn': choice.ring_turn,
                'error': choice.error,
                'settings': [*map(pinning.to_json, choice.settings)],
            }
            for choice in pins.choices
        ],
    }


def _section(pins: Pins, drawing: str) -> Section:
    zk = pins.ring_teeth
    count = vernier.distinct_positions(zk)
    facts = Table.of_values(
        Layout.LINES,
        ('holes', f'{zk} teeth, {zk + 1} ring holes, {zk + 2} chassis holes'),
        ('positions', f'{count} positions, one every {arc(vernier.step(zk))}'),
        *pins.holes(),
        *pins.turned(),
    )
    tables = facts, _position_table(pins)
    return Section(
        '',
        tables,
        remarks=(pinning.SENSES,),
        answer=_sentence(pins),
        figure=_figure(pins),
        drawing=drawing,
    )


def _sentence(pins: Pins) -> str:
    choice = pins.nearest
    return (
        f'Pin {choice.settings[0]}: the ring gear turns by {arc(choice.ring_turn)}, '
        f'{arc(abs(choice.error))} {"more" if choice.error > 0.0 else "less"} than wanted.'
    )


def _figure(pins: Pins) -> Figure:
    steps = np.array([choice.steps for choice in pins.choices], np.float64)
    error = np.array([arc_seconds(choice.error) for choice in pins.choices])
    line = Line('position', Pen.FIRST, steps, error, points=True)
    label = 'position, steps from the nearest'
    return Figure((Panel('', label, 'error of the turn [″]', (line,), levels=((0.0, 'wanted'),)),))


def _position_table(pins: Pins) -> Table:
    rows = []
    for choice in pins.choices:
        cells = (
            f'{choice.steps:+}' if choice.steps else '0',
            ' or '.join(str(setting.tooth) for setting in choice.settings),
            str(choice.settings[0].ring_hole),
            ' or '.join(str(setting.chassis_hole) for setting in choice.settings),
            arc(choice.ring_turn),
            f'{arc_seconds(choice.error):+.3f}',
        )
        tone = Tone.PLAIN if choice.steps else Tone.CHOSEN
        rows.append(tuple(Cell(text, tone) for text in cells))
    columns = ('steps', 'tooth', 'ring hole', 'chassis hole', 'turn', 'error [″]')
    return Table(columns, tuple(rows), words=())
