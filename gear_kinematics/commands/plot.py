# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin plot`: figures of the mechanism and of its motion."""

import argparse
import math

from gear_kinematics import plotting
from gear_kinematics.bag.trajectory import MOST_TURNS, Trajectory
from gear_kinematics.commands import ExitCode, arguments, bags, drawing
from gear_kinematics.commands.files import check_targets, write_file
from gear_kinematics.commands.reporter import add_paper, image_file
from gear_kinematics.kinematics import RotorPosition, split_turns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.image import ImageFile

_DEGREES = 40.0  # rotor angle at which all parts of the scheme can be seen
_SPEED = 100.0 * math.pi  # rad/s: 3000 rpm
_OF_SOME = {
    'degrees': ('scheme',),
    'speed': ('slides', 'output'),
    'duration': ('roses', 'slides', 'output'),
    'calibration': ('output',),
}
"""Options that not every figure has."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        'figure',
        choices=tuple(_FIGURES),
        help='output: angle and rate of the output shaft; roses: the paths of the centres of the '
        'Oldham couplings; scheme: the bodies of a branch and their centres; slides: slides and '
        'sliding speeds of the Oldham couplings',
    )
    motions = drawing.add_image(parser, '.png, .svg or .pdf')
    motions.add_argument(
        '--degrees',
        type=arguments.finite,
        metavar='DEG',
        help=f'rotor angle of the scheme (default: {_DEGREES:g})',
    )
    motions.add_argument(
        '--speed',
        type=float,
        metavar='RAD/S',
        help='rotor speed of slides and output (default: 3000 rpm, of the output there and back)',
    )
    bags.add_calibration(parser)
    add_paper(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Draw the figure and write its file."""
    for name, figures in _OF_SOME.items():
        if getattr(options, name) is not None and options.figure not in figures:
            raise ValueError(f'--{name} is for {" and ".join(figures)}, not for {options.figure}')
    check_targets(options, {'FILE': options.out})
    file = image_file(options, options.out)
    config = arguments.load_config(options, options.bag)
    write_file(options.out, _FIGURES[options.figure](options, config, file))
    if options.figure == 'scheme' and not options.quiet:
        drawing.warn_if_teeth_cannot_mesh(config.mechanism, config.module)
    return ExitCode.DONE


def _scheme(options: argparse.Namespace, config: NodeParameters, file: ImageFile) -> bytes:
    mechanism = config.mechanism
    if moved := drawing.recording(options, config):
        rotor = RotorPosition(int(moved.turns[0]), float(moved.angle[0]))
    else:
        rotor = split_turns(math.radians(_DEGREES if options.degrees is None else options.degrees))
    return plotting.scheme(mechanism, config.module, file, rotor)


def _roses(options: argparse.Namespace, config: NodeParameters, file: ImageFile) -> bytes:
    mechanism = config.mechanism
    return plotting.roses(mechanism, file, drawing.recording(options, config, 'duration'))


def _slides(options: argparse.Namespace, config: NodeParameters, file: ImageFile) -> bytes:
    mechanism = config.mechanism
    moved = _moved(options, config, turns=1)
    return plotting.slides(mechanism, file, moved, by_angle=not options.bag)


def _output(options: argparse.Namespace, config: NodeParameters, file: ImageFile) -> bytes:
    gear = config.gear  # the ratio is enough
    calibration = bags.load_calibration(options, config, options.bag)
    cycle = min(abs(gear.gear_ratio.numerator), MOST_TURNS)
    if options.bag or options.speed is not None or options.duration is not None:
        moved = _moved(options, config, turns=cycle)
    else:  # a steady motion has nothing to see
        moved = Trajectory.there_and_back(_SPEED, cycle)
    return plotting.output(gear, file, moved, calibration)


_FIGURES = {'output': _output, 'roses': _roses, 'scheme': _scheme, 'slides': _slides}


def _moved(options: argparse.Namespace, config: NodeParameters, turns: int) -> Trajectory:
    if moved := drawing.recording(options, config):
        return moved
    speed = _SPEED if options.speed is None else options.speed
    return Trajectory.at_constant_speed(speed, turns=turns, duration=options.duration)
