"""`gearkin plot`: figures of the mechanism and of its motion."""

import argparse
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.arguments import (
    add_branch,
    add_mechanism,
    add_recording,
    add_sizes,
    branch,
    node_parameters,
    recording,
)
from gear_kinematics.commands.output import tell_of_circles, write_file
from gear_kinematics.kinematics import Mechanism, RotorPosition, split_turns
from gear_kinematics.state.trajectory import Trajectory

Config = Mapping[str, Any]

HELP = 'figures: kinematic scheme, roses, slides, output over time'
_DEGREES = 40.0  # where every part of the scheme can be seen
_SPEED = 100.0 * math.pi  # rad/s: 3000 rpm


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say which arguments the command takes."""
    figures = parser.add_subparsers(title='figures', required=True, metavar='FIGURE')

    def add(name: str, text: str, draw: Callable[..., bytes], **options: Any) -> Any:
        figure = figures.add_parser(name, help=text, description=text)
        figure.add_argument('out', metavar='FILE', help='.png, .svg, .pdf ...')
        add_mechanism(figure)
        add_sizes(figure)
        ways = figure.add_mutually_exclusive_group()
        add_recording(figure, ways, **options)
        figure.set_defaults(draw=draw)
        return figure, ways

    scheme, ways = add(
        'scheme', 'the bodies of a branch and their centres', _scheme, lasting=False
    )
    add_branch(scheme)
    ways.add_argument('--angle', type=float, metavar='RAD', help='of the rotor')
    ways.add_argument('--degrees', type=float, metavar='DEG', help='the same (default: 40)')
    add('roses', 'the paths of the centres of the Oldham couplings', _roses)
    for name, text, draw in (
        ('slides', 'slides and sliding speeds of the Oldham couplings', _slides),
        ('output', 'angle and rate of the output shaft', _output),
    ):
        _, ways = add(name, text, draw)
        ways.add_argument(
            '--speed', type=float, metavar='RAD/S', help='of the rotor (default: 3000 rpm)'
        )


def run(options: argparse.Namespace) -> ExitCode:
    """Draw the figure and write its file."""
    config = node_parameters(options)
    pair = Mechanism.from_mapping(config)
    write_file(options.out, options.draw(options, config, pair, Path(options.out)))
    if options.draw is _scheme:
        tell_of_circles(pair, config['module'])
    return ExitCode.DONE


def _scheme(options: argparse.Namespace, config: Config, pair: Mechanism, path: Path) -> bytes:
    rotor = _rotor(options, config)
    return plotting.scheme(pair, config['module'], path, rotor, branch(options, pair))


def _rotor(options: argparse.Namespace, config: Config) -> RotorPosition:
    if moved := recording(options, config):
        return RotorPosition(int(moved.turns[0]), float(moved.angle[0]))
    degrees = _DEGREES if options.degrees is None else options.degrees
    angle = float(math.radians(degrees) if options.angle is None else options.angle)
    if not math.isfinite(angle):
        raise ValueError(f'an angle of the rotor is finite, not {angle}')
    return split_turns(angle)


def _roses(options: argparse.Namespace, config: Config, pair: Mechanism, path: Path) -> bytes:
    return plotting.roses(pair, path, recording(options, config, 'duration'))


def _slides(options: argparse.Namespace, config: Config, pair: Mechanism, path: Path) -> bytes:
    return plotting.slides(pair, path, _moved(options, config, turns=1), by_angle=not options.bag)


def _output(options: argparse.Namespace, config: Config, pair: Mechanism, path: Path) -> bytes:
    return plotting.output(pair, path, _moved(options, config, turns=pair.cycle_turns))


def _moved(options: argparse.Namespace, config: Config, turns: int) -> Trajectory:
    if moved := recording(options, config):
        return moved
    speed = _SPEED if options.speed is None else options.speed
    return Trajectory.at_constant_speed(speed, turns=turns, duration=options.duration)
