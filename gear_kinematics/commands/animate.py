"""`gearkin animate`: the mechanism moving, as a GIF or an MP4."""

import argparse
import math
from collections.abc import Mapping
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
    positive,
    recording,
)
from gear_kinematics.commands.output import progress, tell_of_circles, write_file
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state.trajectory import Trajectory

HELP = 'the mechanism moving, as a GIF or an MP4'
_SPEED = 2.0 * TURN  # rad/s: fast enough to see the output turn, slow enough to see the rotor
_BOUNDS = {'width': (100, 1920), 'fps': (1, 50)}
_MOST_FRAMES = 2000
_UNSEEN = 0.5  # turns of the rotor from frame to frame, which could be either way


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say which arguments the command takes."""
    parser.add_argument('out', metavar='FILE', help='.gif or .mp4')
    add_mechanism(parser)
    add_sizes(parser)
    ways = parser.add_mutually_exclusive_group()
    add_recording(parser, ways)
    ways.add_argument(
        '--speed',
        type=float,
        default=_SPEED,
        metavar='RAD/S',
        help='of the rotor (default: two turns in a second)',
    )
    parser.add_argument(
        '--rate', type=positive, default=1.0, help='time of the motion per time of the animation'
    )
    parser.add_argument(
        '--fps', type=int, default=20, help='frames in a second (default: %(default)s)'
    )
    parser.add_argument(
        '--width', type=int, default=420, metavar='PX', help='(default: %(default)s)'
    )
    add_branch(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Draw the frames, write the file and say how long it is."""
    config = node_parameters(options)
    pair, of_teeth = Mechanism.from_mapping(config), config['module']
    for name, (low, high) in _BOUNDS.items():
        if not low <= (given := getattr(options, name)) <= high:
            raise ValueError(f'--{name} must be between {low} and {high}, not {given}')
    frames = _frames(options, config, pair.cycle_turns)
    count = len(frames.time)
    with progress('frames') as bars:
        task = bars.add_task(options.out, total=count)
        content = plotting.animate(
            pair,
            of_teeth,
            Path(options.out),
            frames,
            fps=options.fps,
            width=options.width,
            branch=branch(options, pair),
            progress=lambda done: bars.update(task, completed=done),
        )
    write_file(options.out, content)
    print(f'{options.out}: {count} frames, {options.fps} in a second')
    tell_of_circles(pair, of_teeth)
    step = frames.longest_step
    if step > _UNSEEN:
        rate = 0.5 * options.rate * _UNSEEN / step
        print(f'The rotor turns {step:.2g} times from frame to frame; --rate {rate:.1g} shows it')
    return ExitCode.DONE


def _frames(
    options: argparse.Namespace, config: Mapping[str, Any], cycle_turns: int
) -> Trajectory:
    closed = not (options.bag or options.duration)
    moved = recording(options, config) or Trajectory.at_constant_speed(
        options.speed, turns=cycle_turns, duration=options.duration
    )
    interval = options.rate / options.fps
    count = math.ceil((moved.time[-1] - moved.time[0]) / interval)
    if count > _MOST_FRAMES:
        raise ValueError(f'{count} frames are more than {_MOST_FRAMES}: shorten it by --duration')
    return moved.every(interval, closed=closed)
