"""What `plot`, `animate` and `urdf` have in common: the image, the motion and the branch drawn."""

import argparse
from typing import TextIO

from gear_kinematics.commands import arguments, bags
from gear_kinematics.commands.files import add_force
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair
from gear_kinematics.wire.nearest import among


def add_image(
    parser: argparse.ArgumentParser, formats: str, *, lasting: bool = True
) -> argparse._MutuallyExclusiveGroup:
    """Add the arguments for a drawing of a mechanism; returns the group of alternative motions."""
    parser.add_argument('out', metavar='FILE', help=f'image file: {formats}')
    arguments.add_mechanism(parser)
    arguments.add_sizes(parser)
    add_force(parser)
    arguments.add_quiet(parser)
    motions = parser.add_mutually_exclusive_group()
    bags.add_recording(parser, motions, lasting=lasting)
    return motions


def add_branch(parser: argparse.ArgumentParser) -> None:
    """Add the option for a branch."""
    parser.add_argument('--branch', metavar='NAME', help='branch to draw (default: the first)')


def branch(options: argparse.Namespace, mechanism: Mechanism) -> int:
    """The index of the branch given by the options.

    Raises:
        ValueError: if the mechanism has no branch of this name.
    """
    names = [branch.name for branch in mechanism.branches]
    if options.branch not in {None, *names}:
        raise ValueError(f'no branch {options.branch!r}{among(options.branch, names)}')
    return names.index(options.branch) if options.branch else 0


def warn_if_teeth_cannot_mesh(
    mechanism: Mechanism, module: float, stream: TextIO | None = None
) -> None:
    """Print why gears are drawn without teeth, if these cannot mesh; module in m.

    The text goes to a stream, by default to stdout.
    """
    try:
        tooth_pair(mechanism, module)
    except InterferenceError as error:
        print(f'The gears are drawn as circles: {error}', file=stream)
