"""The options for bracing two branches by a turn of a ring gear: `index` and `preload`."""

import argparse
import math

from gear_kinematics.kinematics.preload import STEEL_SHEAR_MODULUS, Stiffness, shaft_stiffness
from gear_kinematics.kinematics.rotor_turns import TURN


def add_ring_turn(ways: argparse._ActionsContainer) -> None:
    """Add the options for a turn of the ring gear, in rad or in degrees."""
    ways.add_argument('--angle', type=float, metavar='RAD', help='turn of the ring gear')
    ways.add_argument('--degrees', type=float, metavar='DEG', help='the same in degrees')


def ring_turn(options: argparse.Namespace) -> float | None:
    """The turn of the ring gear given by the options, rad, if any."""
    if options.degrees is not None:
        return math.radians(options.degrees)
    return None if options.angle is None else float(options.angle)


def within_a_turn(angle: float) -> float:
    """Check the turn of a ring gear, rad.

    Raises:
        ValueError: if it is more than a whole turn in either direction.
    """
    if not abs(angle) <= TURN:
        raise ValueError(f'a ring gear is turned by at most a whole turn, not by {angle:g} rad')
    return angle


def add_setting(parser: argparse._ActionsContainer, option: str, name: str, text: str) -> None:
    """Add an option for a pin setting, stored as `name`."""
    holes = ('TOOTH', 'RING_HOLE', 'CHASSIS_HOLE')
    parser.add_argument(option, dest=name, type=int, nargs=3, metavar=holes, help=text)


def add_stiffness(parser: argparse.ArgumentParser) -> None:
    """Add the options for the stiffnesses of branches and shaft, and for the backlash."""
    group = parser.add_argument_group(
        'stiffness', 'torsional, at the output; not a parameter of the node'
    )
    group.add_argument(
        '--branch-stiffness',
        type=float,
        nargs='+',
        metavar='N·m/rad',
        help='of both branches, or of A and of B, the one at the output; inf: rigid',
    )
    group.add_argument('--shaft-stiffness', type=float, metavar='N·m/rad', help='between the arms')
    group.add_argument('--shaft-diameter', type=float, metavar='M', help='of a solid round shaft')
    group.add_argument('--shaft-length', type=float, metavar='M', help='between the arms')
    group.add_argument(
        '--shear-modulus',
        type=float,
        metavar='PA',
        help=f'of the shaft (default: {STEEL_SHEAR_MODULUS:g}, steel)',
    )
    group.add_argument(
        '--backlash',
        type=float,
        metavar='RAD',
        help='play of the output before the turn, which has to close it first (default: 0)',
    )


def stiffness(options: argparse.Namespace) -> Stiffness | None:
    """The stiffnesses given by the options; None if none is given.

    Raises:
        ValueError: if some are missing, or the shaft is given twice.
    """
    dimensions = (options.shaft_diameter, options.shaft_length, options.shear_modulus)
    branches, shaft = options.branch_stiffness, options.shaft_stiffness
    if all(given is None for given in (branches, shaft, *dimensions, options.backlash)):
        return None
    if branches is None:
        raise ValueError('--branch-stiffness is missing (inf for rigid branches)')
    if len(branches) > 2:  # noqa: PLR2004, A and B
        raise ValueError(f'--branch-stiffness takes one value or two, not {len(branches)}')
    if shaft is None:
        diameter, length, modulus = dimensions
        if diameter is None or length is None:
            raise ValueError('--shaft-stiffness or --shaft-diameter and --shaft-length is missing')
        modulus = STEEL_SHEAR_MODULUS if modulus is None else modulus
        shaft = shaft_stiffness(diameter, length, modulus)
    elif any(given is not None for given in dimensions):
        raise ValueError('--shaft-stiffness and dimensions of the shaft exclude each other')
    return Stiffness(branches[0], branches[-1], shaft)
