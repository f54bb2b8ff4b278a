"""`gearkin plot`: figures of the mechanism and of its motion."""

import argparse
import math
from collections.abc import Callable
from typing import Any

from gear_kinematics import plotting
from gear_kinematics.bag.trajectory import MOST_TURNS, Trajectory
from gear_kinematics.commands import ExitCode, arguments, bags, drawing
from gear_kinematics.commands.files import check_targets, write_file
from gear_kinematics.commands.paper_size import add_paper, image_file
from gear_kinematics.kinematics import (
    Gear,
    Mechanism,
    RotorPosition,
    split_turns,
)
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.image import ImageFile

_DEGREES = 40.0  # rotor angle at which all parts of the scheme can be seen
_SPEED = 100.0 * math.pi  # rad/s: 3000 rpm


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    figures = parser.add_subparsers(title='figures', required=True, metavar='FIGURE')

    def add(name: str, text: str, draw: Callable[..., bytes], **options: Any) -> Any:
        figure = figures.add_parser(name, help=text, description=text)
        motions = drawing.add_image(figure, '.png, .svg, .pdf ...', **options)
        add_paper(figure)
        figure.set_defaults(draw=draw)
        return figure, motions

    scheme, motions = add(
        'scheme', 'the bodies of a branch and their centres', _scheme, lasting=False
    )
    drawing.add_branch(scheme)
    motions.add_argument('--angle', type=float, metavar='RAD', help='rotor angle')
    motions.add_argument(
        '--degrees', type=float, metavar='DEG', help='rotor angle in degrees (default: 40)'
    )
    add('roses', 'the paths of the centres of the Oldham couplings', _roses)
    _, of_slides = add('slides', 'slides and sliding speeds of the Oldham couplings', _slides)
    output, of_output = add('output', 'angle and rate of the output shaft', _output)
    bags.add_calibration(output)
    for motions in (of_slides, of_output):
        motions.add_argument(
            '--speed', type=float, metavar='RAD/S', help='rotor speed (default: 3000 rpm)'
        )


def run(options: argparse.Namespace) -> ExitCode:
    """Draw the figure and write its file."""
    check_targets(options, {'FILE': options.out})
    file = image_file(options, options.out)
    config = arguments.load_config(options, options.bag)
    # The output needs no more than the ratio.
    gear = config.gear if options.draw is _output else config.mechanism
    write_file(options.out, options.draw(options, config, gear, file))
    if options.draw is _scheme and isinstance(gear, Mechanism) and not options.quiet:
        drawing.warn_if_teeth_cannot_mesh(gear, config.module)
    return ExitCode.DONE


def _scheme(
    options: argparse.Namespace, config: NodeParameters, mechanism: Mechanism, file: ImageFile
) -> bytes:
    branch = drawing.branch(options, mechanism)
    rotor = _rotor(options, config)
    return plotting.scheme(mechanism, config.module, file, rotor, branch)


def _rotor(options: argparse.Namespace, config: NodeParameters) -> RotorPosition:
    if moved := bags.recording(options, config):
        return RotorPosition(int(moved.turns[0]), float(moved.angle[0]))
    degrees = _DEGREES if options.degrees is None else options.degrees
    angle = float(math.radians(degrees) if options.angle is None else options.angle)
    if not math.isfinite(angle):
        raise ValueError(f'the rotor angle must be finite, not {angle}')
    return split_turns(angle)


def _roses(
    options: argparse.Namespace, config: NodeParameters, mechanism: Mechanism, file: ImageFile
) -> bytes:
    moved = bags.recording(options, config, 'duration')
    return plotting.roses(mechanism, file, moved)


def _slides(
    options: argparse.Namespace, config: NodeParameters, mechanism: Mechanism, file: ImageFile
) -> bytes:
    moved = _moved(options, config, turns=1)
    return plotting.slides(mechanism, file, moved, by_angle=not options.bag)


def _output(
    options: argparse.Namespace, config: NodeParameters, gear: Gear, file: ImageFile
) -> bytes:
    calibration = bags.load_calibration(options, config, options.bag)
    cycle = min(abs(gear.gear_ratio.numerator), MOST_TURNS)
    moved = _moved(options, config, turns=cycle)
    return plotting.output(gear, file, moved, calibration)


def _moved(options: argparse.Namespace, config: NodeParameters, turns: int) -> Trajectory:
    if moved := bags.recording(options, config):
        return moved
    speed = _SPEED if options.speed is None else options.speed
    return Trajectory.at_constant_speed(speed, turns=turns, duration=options.duration)
