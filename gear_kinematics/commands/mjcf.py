# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin mjcf`: write the gear as a model of MuJoCo."""

import argparse
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.drawing import warn_if_teeth_cannot_mesh
from gear_kinematics.commands.files import add_force, check_targets, write_text
from gear_kinematics.commands.output import complain
from gear_kinematics.parameters import meshes
from gear_kinematics.report.mark import MARK
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.measured import measured
from gear_kinematics.twin.mjcf import mjcf
from gear_kinematics.twin.parameters import NODE, default_config


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_config(parser, NODE, 'simulated_actuator.yaml of the package')
    gear = arguments.group(parser, 'gear')
    text = 'calibration with the kinematic errors (default: the parameter calibration)'
    gear.add_argument('--calibration', type=Path, metavar='FILE', help=text)
    gear.add_argument(
        '--measured',
        type=Path,
        action='append',
        default=[],
        metavar='REPORT.json',
        help='take stiffness and preload from a report of gearkin preload, or springs and '
        'friction from one of gearkin lost-motion (repeat the option for both)',
    )
    text = 'write softer loops for MuJoCo Warp: they add 0.04 %% to the compliance, not 0.0001 %%'
    gear.add_argument('--single-precision', action='store_true', help=text)
    arguments.group(parser, 'output').add_argument(
        '-o', '--output', default='-', metavar='FILE', help='model to write (default: stdout)'
    )
    add_force(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Write the model; with MuJoCo installed, it is checked by loading it."""
    check_targets(options, {'--output': options.output})
    config = options.config or default_config()
    gear = TwinGear.load(config, options.node, options.calibration, options.actuator)
    gear, notes = measured(gear, options.measured)
    if notes:
        complain(f'not in the reports: {"; ".join(notes)}')
    text = mjcf(
        _shown(gear),
        [f'It was {MARK}.', *(f'Not measured: {note}.' for note in notes)],
        single_precision=options.single_precision,
    )
    if find_spec('mujoco'):
        from gear_kinematics.twin.mujoco_model import check  # noqa: PLC0415, an extra

        check(text)
    write_text(options.output, text)
    return ExitCode.DONE


def _shown(gear: TwinGear) -> TwinGear:
    """Return the gear, without meshes if they cannot be made, which is reported on stderr."""
    parameters = gear.parameters
    if parameters.meshes == meshes.NONE:
        return gear
    warn_if_teeth_cannot_mesh(parameters.mechanism, parameters.module)
    if find_spec('mapbox_earcut'):
        return gear
    complain("without teeth: mapbox_earcut is not installed: pip install 'gear_kinematics[twin]'")
    return replace(gear, parameters=replace(parameters, meshes=meshes.NONE))
