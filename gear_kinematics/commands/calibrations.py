"""The option for a calibration, which several commands have in common."""

import argparse
from pathlib import Path

from gear_kinematics.commands import arguments
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters

BESIDE = 'calibration.yaml'
"""Name of the file beside a bag."""


def add_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for a calibration of the gear."""
    parser.add_argument(
        '--calibration',
        type=Path,
        metavar='FILE',
        help='calibration of the gear (default: the parameter `calibration`, or else '
        f'{BESIDE} beside the bag)',
    )


def find(options: argparse.Namespace, config: NodeParameters, bag: Path | None) -> Path | None:
    """The given calibration, or that of the parameters, or the one in the bag's folder."""
    if given := options.calibration or config.calibration:
        return Path(given)
    return arguments.beside(bag, BESIDE) if bag else None


def load(
    options: argparse.Namespace, config: NodeParameters, bag: Path | None
) -> Calibration | None:
    """Load the calibration at `find`.

    Raises:
        ValueError: if it cannot be used for the gear, or the parameters describe none.
    """
    gear, path = config.gear, find(options, config, bag)
    return Calibration.load(path, gear) if path else None
