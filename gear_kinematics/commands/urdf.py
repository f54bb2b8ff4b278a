"""`gearkin urdf`: print the URDF."""

import argparse

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.shape.urdf import urdf

HELP = 'print the URDF'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.add_config(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Print the URDF."""
    config = arguments.load_config(options)
    names = {name: config[name] for name in ('module', 'output_joint', 'frame_prefix')}
    print(urdf(Mechanism.from_mapping(config), **names), end='')
    return ExitCode.DONE
