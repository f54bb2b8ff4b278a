# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin urdf`: print the URDF or a xacro macro, and write the meshes."""

import argparse
from dataclasses import replace
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.drawing import warn_if_teeth_cannot_mesh
from gear_kinematics.commands.files import write_file
from gear_kinematics.commands.output import complain
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import meshes
from gear_kinematics.parameters.arm import arm_urdf
from gear_kinematics.shape.solids import STL_HEADER, solids, to_stl
from gear_kinematics.shape.urdf import MACRO_PREFIX, as_macro
from gear_kinematics.wire.nearest import listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_config(parser, actuator='print only this actuator of an arm (default: all)')
    output = arguments.group(parser, 'output')
    text = (
        'print a xacro macro that fixes the actuator to a link of a robot; its prefix takes '
        'the place of the parameter frame_prefix'
    )
    output.add_argument('--macro', action='store_true', help=text)
    text = (
        'write the bodies with their teeth to this folder as STL, and refer to them in the '
        'URDF, by the URI of the parameter meshes if it has one; an arm has a folder for each '
        'actuator'
    )
    output.add_argument('--meshes', type=Path, metavar='DIR', help=text)


def run(options: argparse.Namespace) -> ExitCode:
    configs = arguments.load_configs(options)
    if options.macro and len(configs) > 1:
        raise ValueError(
            f'--macro prints one actuator: choose it with --actuator: {listed(configs)}'
        )
    for name, config in configs.items():
        if options.meshes and not config.gear_ratio:
            mechanism, folder = config.mechanism, options.meshes / name
            warn_if_teeth_cannot_mesh(mechanism, config.module)
            _write(mechanism, config.module, folder)
            if config.meshes in {meshes.AUTO, meshes.NONE}:
                configs[name] = replace(config, meshes=folder.resolve().as_uri())
    if options.macro:
        [config] = configs.values()
        joint = (
            repr(config.output_name) if config.actuator else f'prefix + {config.output_joint!r}'
        )
        print(as_macro(replace(config, frame_prefix=MACRO_PREFIX).urdf(), joint), end='')
        return ExitCode.DONE
    text, left_out = arm_urdf(configs)
    if left_out:
        complain(f'without {", ".join(left_out)}: only the ratio of such a gear is known')
    print(text, end='')
    return ExitCode.DONE


def _write(mechanism: Mechanism, module: float, folder: Path) -> None:
    """Write the solids to a folder; raises ValueError if a file there is of another program."""
    files = {
        folder / f'{name}.stl': to_stl(solid) for name, solid in solids(mechanism, module).items()
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path in files:
            if path.exists() and not path.read_bytes().startswith(STL_HEADER):
                raise ValueError(f'{path} was not written by gearkin, and is not replaced')
    except OSError as error:
        raise ValueError(f'{error.filename}: {error.strerror}') from error
    for path, content in files.items():
        write_file(str(path), content)
