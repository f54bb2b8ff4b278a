"""The option for a calibration, which several commands have in common."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gear_kinematics.commands import arguments
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import gear_from_mapping

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


def find(options: argparse.Namespace, config: Mapping[str, Any], bag: Path | None) -> Path | None:
    """The given calibration, or that of the parameters, or the one in the bag's folder."""
    if given := options.calibration or config['calibration']:
        return Path(given)
    return arguments.beside(bag, BESIDE) if bag else None


def load(
    options: argparse.Namespace, config: Mapping[str, Any], bag: Path | None
) -> Calibration | None:
    """Load the calibration at `find`.

    Raises:
        ValueError: if it cannot be used for the gear.
    """
    path = find(options, config, bag)
    return Calibration.load(path, gear_from_mapping(config)) if path else None
