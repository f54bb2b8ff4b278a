# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin index`: the pin setting for a wanted turn of a ring gear."""

import argparse
import math
from typing import Any

import numpy as np

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands import pins as pinning
from gear_kinematics.commands.pins import Pins
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import vernier
from gear_kinematics.report import document as doc
from gear_kinematics.shape.angles import arc, arc_seconds

_NEIGHBOURS = 3  # number of positions listed on either side of the nearest one


def add_arguments(parser: argparse.ArgumentParser) -> None:
    pinning.add_turn(parser, required=False)
    arguments.add_mechanism(parser)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    reporter = Reporter(options)
    if options.degrees is None and not options.phase_b:
        raise ValueError('give --degrees or --phase-b')
    gear = arguments.load_config(options).mechanism
    pins = pinning.find(options, gear, math.radians(options.degrees or 0.0), _NEIGHBOURS)
    zk = gear.ring_teeth
    return reporter.write(
        doc.Document('gearkin index', (_section(pins, zk),), _data(pins, zk)),
        [arguments.config_path(options)],
    )


def _data(pins: Pins, zk: int) -> dict[str, Any]:
    return {
        'ring_teeth': zk,
        'ring_holes': zk + 1,
        'chassis_holes': zk + 2,
        'positions': vernier.distinct_positions(zk),
        'step': vernier.step(zk),
        'wanted': {'ring_turn': pins.ring_turn, 'phase': pins.phase},
        'positions_around': [choice._asdict() for choice in pins.choices],
    }


def _section(pins: Pins, zk: int) -> doc.Section:
    count = vernier.distinct_positions(zk)
    facts = doc.Table.of_values(
        doc.Layout.LINES,
        ('holes', f'{zk} teeth, {zk + 1} ring holes, {zk + 2} chassis holes'),
        ('positions', f'{count} positions, one every {arc(vernier.step(zk))}'),
        *pins.facts(),
    )
    return doc.Section(
        '',
        (facts, _position_table(pins)),
        remarks=(pinning.SENSES,),
        answer=_sentence(pins),
        figure=_figure(pins),
    )


def _sentence(pins: Pins) -> str:
    choice = pins.nearest
    return (
        f'Pin {choice.settings[0]}: the ring gear turns by {arc(choice.ring_turn)}, '
        f'{arc(abs(choice.error))} {"more" if choice.error > 0.0 else "less"} than wanted.'
    )


def _figure(pins: Pins) -> doc.Figure:
    steps = np.array([choice.steps for choice in pins.choices], np.float64)
    error = np.array([arc_seconds(choice.error) for choice in pins.choices])
    line = doc.Line('position', doc.Pen.FIRST, steps, error, points=True)
    label = 'position, steps from the nearest'
    return doc.Figure(
        (doc.Panel('', label, 'error of the turn [″]', (line,), levels=((0.0, 'wanted'),)),)
    )


def _position_table(pins: Pins) -> doc.Table:
    return doc.Table.of_items(
        {
            'steps': lambda choice: f'{choice.steps:+}' if choice.steps else '0',
            'tooth': lambda choice: ' or '.join(str(setting.tooth) for setting in choice.settings),
            'ring hole': lambda choice: str(choice.settings[0].ring_hole),
            'chassis hole': lambda choice: ' or '.join(
                str(setting.chassis_hole) for setting in choice.settings
            ),
            'turn': lambda choice: arc(choice.ring_turn),
            'error [″]': lambda choice: f'{arc_seconds(choice.error):+z.3f}',
        },
        pins.choices,
        words=(),
    )
