# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin animate`: an animation of the mechanism as a GIF."""

import argparse
import math
from pathlib import Path

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments, drawing
from gear_kinematics.commands.files import check_targets, write_file
from gear_kinematics.commands.output import progress
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.plotting.trajectory import Trajectory
from gear_kinematics.report.image import check_image

_SPEED = 2.0 * TURN  # rad/s: fast enough for the output, slow enough for the rotor
_FPS = 20
_MOST_FRAMES = 2000  # greatest number, all in memory until the last one is drawn


def add_arguments(parser: argparse.ArgumentParser) -> None:
    drawing.add_image(parser, '.gif')
    arguments.group(parser, 'motion').add_argument(
        '--rate', type=arguments.RATE, default=1.0, help='playback speed (default: 1)'
    )


def run(options: argparse.Namespace) -> ExitCode:
    path = Path(options.out)
    check_targets(options, {'FILE': options.out})
    check_image(path, ['gif'])
    config = arguments.load_config(options, options.bag)
    mechanism, module = config.mechanism, config.module
    frames = _frames(options, config, mechanism.cycle_turns)
    count = len(frames.time)
    with progress('frames', quiet=options.quiet) as bars:
        task = bars.add_task(options.out, total=count)
        content = plotting.animate(
            mechanism,
            module,
            frames,
            fps=_FPS,
            force=drawing.force_at(options, config),
            progress=lambda done: bars.update(task, completed=done),
        )
    write_file(options.out, content)
    if not options.quiet:
        print(f'{options.out}: {count} frames, {_FPS} per second')
        drawing.warn_if_teeth_cannot_mesh(mechanism, module)
    return ExitCode.DONE


def _frames(options: argparse.Namespace, config: NodeParameters, cycle_turns: int) -> Trajectory:
    """Make the frames of the recorded motion, or of a whole cycle."""
    moved = drawing.recording(options, config) or Trajectory.at_constant_speed(_SPEED, cycle_turns)
    interval = options.rate / _FPS
    count = math.ceil((moved.time[-1] - moved.time[0]) / interval)
    if count > _MOST_FRAMES:
        raise ValueError(
            f'{count} frames are more than {_MOST_FRAMES}; reduce --duration or raise --rate'
        )
    return moved.every(interval, closed=not options.bag)
