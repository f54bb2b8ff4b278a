# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Common parts of commands that draw a mechanism: its motion, and whether its teeth mesh."""

import argparse
import math
from pathlib import Path

from gear_kinematics.commands import arguments, bags
from gear_kinematics.commands.files import add_force
from gear_kinematics.commands.output import complain, message_progress
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.plotting.trajectory import Trajectory
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair


def add_image(parser: argparse.ArgumentParser, formats: str) -> None:
    """Add the arguments for a drawing of a mechanism, or of its recorded motion."""
    parser.add_argument('out', metavar='FILE', help=f'image file: {formats}')
    bags.add_rotor(parser)
    recording = arguments.group(parser, 'recording')
    recording.add_argument('--bag', type=Path, metavar='BAG', help='recorded motion of the rotor')
    start, span = arguments.between(0.0, 1e9), arguments.between(1e-6, 1e9)
    text = 'time in the recording to start at'
    recording.add_argument('--start-offset', type=start, metavar='S', help=text)
    text = 'time to show (default: all)'
    recording.add_argument('--duration', type=span, metavar='S', help=text)
    motion = arguments.group(parser, 'motion')
    text = 'torque that the branches give the output; draws the forces on the satellite'
    motion.add_argument('--torque', type=arguments.MAGNITUDE, metavar='N·m', help=text)
    arguments.add_mechanism(parser, sizes=True)
    add_force(parser)
    arguments.add_quiet(parser)


def force_at(options: argparse.Namespace, config: NodeParameters) -> float:
    """Compute F_t on the first branch's satellite, N, at the torque given by the options."""
    if not options.torque:
        return 0.0
    (torque, *_), _ = config.sharing.branches(options.torque)
    return float(torque / config.mechanism.satellite_rolling_radius)


def recording(options: argparse.Namespace, config: NodeParameters) -> Trajectory | None:
    """Read the part of a recorded motion that the options select; None without `--bag`."""
    if not options.bag:
        for name in ('rotor_topic', 'joint', 'start_offset', 'duration'):
            if getattr(options, name) is not None:
                raise ValueError(f'--{name.replace("_", "-")} needs --bag')
        return None
    from gear_kinematics.plotting.recorded import read_trajectory  # noqa: PLC0415, slow

    start = options.start_offset or 0.0
    with (
        bags.naming(options.bag),
        message_progress(options.bag.name, quiet=options.quiet) as report_progress,
    ):
        whole = read_trajectory(options.bag, config, options.rotor_topic, report_progress)
        shown = whole.between(start, start + (options.duration or math.inf))
    if not shown.referenced:
        complain('the turns of the rotor are not known: its angle may be off by whole turns')
    return shown


def warn_if_teeth_cannot_mesh(mechanism: Mechanism, module: float) -> None:
    """Print on stderr why gears are drawn without teeth, if these cannot mesh; module in m."""
    try:
        tooth_pair(mechanism, module)
    except InterferenceError as error:
        complain(f'the gears are drawn as circles: {error}')
