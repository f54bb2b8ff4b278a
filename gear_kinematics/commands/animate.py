# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin animate`: an animation of the mechanism as a GIF or an MP4."""

import argparse
import math
from pathlib import Path

from gear_kinematics import plotting
from gear_kinematics.bag.trajectory import Trajectory
from gear_kinematics.commands import ExitCode, arguments, drawing
from gear_kinematics.commands.files import check_targets, write_file
from gear_kinematics.commands.output import progress
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters

_SPEED = 2.0 * TURN  # rad/s: fast enough for the output, slow enough for the rotor
_FPS = 20
_MOST_FRAMES = 2000
_AMBIGUOUS = 0.5  # turns of the rotor from frame to frame: its direction cannot be seen


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    motions = drawing.add_image(parser, '.gif or .mp4')
    motions.add_argument(
        '--speed',
        type=float,
        default=_SPEED,
        metavar='RAD/S',
        help='rotor speed (default: two turns per second)',
    )
    arguments.group(parser, 'motion').add_argument(
        '--rate', type=arguments.positive, default=1.0, help='playback speed (default: 1)'
    )
    arguments.group(parser, 'output').add_argument(
        '--width',
        type=arguments.between(100, 1920, int),
        default=420,
        metavar='PX',
        help='of the frames (default: %(default)s)',
    )


def run(options: argparse.Namespace) -> ExitCode:
    """Draw the frames, write the file and print its length."""
    path = Path(options.out)
    check_targets(options, {'FILE': options.out})
    plotting.check_animation(path)
    config = arguments.load_config(options, options.bag)
    mechanism, module = config.mechanism, config.module
    frames = _frames(options, config, mechanism.cycle_turns)
    count = len(frames.time)
    with progress('frames', quiet=options.quiet) as bars:
        task = bars.add_task(options.out, total=count)
        content = plotting.animate(
            mechanism,
            module,
            path,
            frames,
            fps=_FPS,
            width=options.width,
            progress=lambda done: bars.update(task, completed=done),
        )
    write_file(options.out, content)
    if options.quiet:
        return ExitCode.DONE
    print(f'{options.out}: {count} frames, {_FPS} per second')
    drawing.warn_if_teeth_cannot_mesh(mechanism, module)
    step = frames.longest_step
    if step > _AMBIGUOUS:
        rate = 0.5 * options.rate * _AMBIGUOUS / step
        text = f'The rotor turns {step:.2g} times from frame to frame'
        print(f'{text}; use --rate {rate:.1g} to see its direction')
    return ExitCode.DONE


def _frames(options: argparse.Namespace, config: NodeParameters, cycle_turns: int) -> Trajectory:
    closed = not (options.bag or options.duration)
    moved = drawing.recording(options, config) or Trajectory.at_constant_speed(
        options.speed, turns=cycle_turns, duration=options.duration
    )
    interval = options.rate / _FPS
    count = math.ceil((moved.time[-1] - moved.time[0]) / interval)
    if count > _MOST_FRAMES:
        raise ValueError(f'{count} frames are more than {_MOST_FRAMES}; reduce --duration')
    return moved.every(interval, closed=closed)
