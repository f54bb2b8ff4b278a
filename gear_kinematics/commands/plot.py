# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin plot`: figures of the mechanism and of its motion."""

import argparse
import math
from pathlib import Path

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments, drawing
from gear_kinematics.commands.files import check_targets, write_file
from gear_kinematics.kinematics import split_turns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.image import check_image, to_image

_DEGREES = 40.0  # rotor angle at which all parts of the scheme can be seen
_SPEED = 100.0 * math.pi  # rad/s: 3000 rpm
_FIGURES = ('output', 'roses', 'scheme', 'slides')
_OF_ONE = {'degrees': 'scheme', 'torque': 'scheme', 'speed': 'slides', 'bag': 'output'}
"""Options that apply to only one of the figures."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    text = (
        'output: angle and rate of the output shaft in a recording; roses: the paths of the '
        'centres of the Oldham couplings; scheme: the bodies of a branch and their centres; '
        'slides: slides and sliding speeds of the Oldham couplings'
    )
    parser.add_argument('figure', choices=_FIGURES, help=text)
    drawing.add_image(parser, '.png, .svg or .pdf')
    motion = arguments.group(parser, 'motion')
    for name, unit, text in (
        ('degrees', 'DEG', f'rotor angle in the figure scheme (default: {_DEGREES:g})'),
        ('speed', 'RAD/S', 'rotor speed in the figure slides (default: 3000 rpm)'),
    ):
        motion.add_argument(f'--{name}', type=arguments.MAGNITUDE, metavar=unit, help=text)


def run(options: argparse.Namespace) -> ExitCode:
    for name, figure in _OF_ONE.items():
        if getattr(options, name) is not None and options.figure != figure:
            raise ValueError(f'--{name} is for {figure}, not for {options.figure}')
    path = Path(options.out)
    check_targets(options, {'FILE': options.out})
    check_image(path)
    config = arguments.load_config(options, options.bag)
    write_file(options.out, _draw(options, config, path))
    if options.figure == 'scheme' and not options.quiet:
        drawing.warn_if_teeth_cannot_mesh(config.mechanism, config.module)
    return ExitCode.DONE


def _draw(options: argparse.Namespace, config: NodeParameters, path: Path) -> bytes:
    moved = drawing.recording(options, config)
    match options.figure:
        case 'output':
            if not moved:
                raise ValueError('output needs --bag and the recording, such as --bag logs/monday')
            figure = plotting.output(config.gear, moved)  # the ratio is enough
        case 'roses':
            figure = plotting.roses(config.mechanism)
        case 'slides':
            speed = _SPEED if options.speed is None else options.speed
            figure = plotting.slides(config.mechanism, speed)
        case _:
            degrees = _DEGREES if options.degrees is None else options.degrees
            rotor = split_turns(math.radians(degrees))
            force = drawing.force_at(options, config)
            return plotting.scheme(config.mechanism, config.module, path, rotor, force)
    return to_image(figure, path)
