"""Arguments that several commands take."""

import argparse
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gear_kinematics.commands.output import message_progress
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.preload import STEEL_SHEAR_MODULUS, Stiffness, shaft_stiffness
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state import parameters
from gear_kinematics.state.trajectory import Trajectory, read_trajectory


def positive(text: str) -> float:
    """A number greater than 0."""
    number = float(text)
    if not (number > 0.0 and math.isfinite(number)):
        raise argparse.ArgumentTypeError(f'must be greater than 0, not {text}')
    return number


def add_config(parser: argparse.ArgumentParser) -> None:
    """Take the parameters of the node."""
    parser.add_argument(
        '--config',
        type=Path,
        metavar='FILE',
        help='parameters of the node as YAML (default: config/actuator.yaml)',
    )
    parser.add_argument(
        '--node',
        default=parameters.NODE,
        metavar='NAME',
        help='whose parameters to take from a file for several nodes: fully qualified, as '
        f'/left/{parameters.NODE}, or without namespace (default: %(default)s)',
    )


def add_report_forms(parser: argparse.ArgumentParser, *, junit: bool = False) -> None:
    """Take the files for the report; see `output.Reporter`."""
    for form in ('json', *(['junit'] if junit else []), 'html'):
        parser.add_argument(
            f'--{form}', nargs='?', const='-', metavar='FILE', help=f'as {form} (default: stdout)'
        )
    parser.add_argument('--plot', metavar='FILE', help='figure: .png, .svg, .pdf ...')


def add_topics(parser: argparse.ArgumentParser) -> None:
    """Take the names that the node's topics have in a bag."""
    for topic in ('rotor', 'output', 'poses'):
        parser.add_argument(f'--{topic}-topic', metavar='NAME', help='(default: by type and name)')


def config_path(options: argparse.Namespace, bag: Path | None = None) -> Path:
    """The file that was asked for, or the one beside the bag's data, or the default."""
    if options.config:
        return Path(options.config)
    default = parameters.default_config()
    if not bag:
        return default
    beside = (bag if bag.is_dir() else bag.parent) / default.name
    return beside if beside.is_file() else default


def load_config(options: argparse.Namespace, bag: Path | None = None) -> dict[str, Any]:
    """The parameters in the file that `config_path` gives.

    Raises:
        ValueError: for what the node would refuse.
    """
    return parameters.load(config_path(options, bag), options.node)


def add_mechanism(parser: argparse.ArgumentParser) -> None:
    """Take the mechanism from the parameters of the node, and a tooth pair instead of theirs."""
    add_config(parser)
    for name, metavar in (('ring', 'ZK'), ('satellite', 'ZS')):
        text = 'instead of that of the parameters'
        parser.add_argument(f'--{name}-teeth', type=int, metavar=metavar, help=text)


def mechanism(options: argparse.Namespace) -> Mechanism:
    """The mechanism that was asked for."""
    return Mechanism.from_mapping(node_parameters(options))


def node_parameters(options: argparse.Namespace) -> dict[str, Any]:
    """The parameters of the node, with what was asked for instead of theirs.

    Raises:
        ValueError: for what the node would refuse.
    """
    config = load_config(options, getattr(options, 'bag', None))
    for name in ('ring_teeth', 'satellite_teeth', 'eccentricity', 'module'):
        if (given := getattr(options, name, None)) is None:
            continue
        option = f'--{name.replace("_", "-")}'
        if fault := parameters.PARAMETERS[name].fault(option, given, config[name]):
            raise ValueError(fault)
        config[name] = given
    return config


def add_sizes(parser: argparse.ArgumentParser) -> None:
    """Take eccentricity and module of a tooth pair."""
    for name in ('eccentricity', 'module'):
        parser.add_argument(f'--{name}', type=float, metavar='M')


def module(options: argparse.Namespace) -> float:
    """The module of the teeth that was asked for, m."""
    return float(node_parameters(options)['module'])


def add_branch(parser: argparse.ArgumentParser) -> None:
    """Take the name of a branch."""
    parser.add_argument('--branch', metavar='NAME', help='(default: the first)')


def branch(options: argparse.Namespace, mechanism: Mechanism) -> int:
    """The index of the branch that was asked for.

    Raises:
        ValueError: if the mechanism has none of this name.
    """
    names = [branch.name for branch in mechanism.branches]
    if options.branch not in {None, *names}:
        raise ValueError(f'no branch {options.branch!r}; there are {", ".join(names)}')
    return names.index(options.branch) if options.branch else 0


def add_recording(
    parser: argparse.ArgumentParser, ways: argparse._ActionsContainer, *, lasting: bool = True
) -> None:
    """Take the rotor's motion from a bag, as one of the ways to give it."""
    ways.add_argument('--bag', type=Path, metavar='BAG', help="the rotor's motion as recorded")
    parser.add_argument('--rotor-topic', metavar='NAME', help='(default: by type and name)')
    parser.add_argument('--start-offset', type=float, metavar='S', help='in the recording')
    if lasting:
        parser.add_argument('--duration', type=positive, metavar='S', help='(default: all of it)')


def recording(
    options: argparse.Namespace, config: Mapping[str, Any], *of_it: str
) -> Trajectory | None:
    """The rotor's motion in the bag from the offset on; None without a bag.

    Args:
        options: as given.
        config: the parameters of the node.
        of_it: names of further options that are of use for a bag only.

    Raises:
        ValueError: if such options are given without a bag.
    """
    if not options.bag:
        for name in ('rotor_topic', 'start_offset', *of_it):
            if getattr(options, name) is not None:
                raise ValueError(f'--{name.replace("_", "-")} is of use with --bag only')
        return None
    start = options.start_offset or 0.0
    duration = getattr(options, 'duration', None) or math.inf
    with message_progress(options.bag.name) as told:
        whole = read_trajectory(options.bag, config, options.rotor_topic, told)
    return whole.between(start, start + duration)


def add_ring_turn(ways: argparse._ActionsContainer) -> None:
    """Take a turn of the ring gear, in rad or in degrees."""
    ways.add_argument('--angle', type=float, metavar='RAD', help='turn of the ring gear')
    ways.add_argument('--degrees', type=float, metavar='DEG', help='the same in degrees')


def ring_turn(options: argparse.Namespace) -> float | None:
    """The turn that was asked for, rad, if one was."""
    if options.degrees is not None:
        return math.radians(options.degrees)
    return None if options.angle is None else float(options.angle)


def within_a_turn(angle: float) -> float:
    """The turn of a ring gear, rad, if it is one.

    Raises:
        ValueError: if it is more than a whole turn either way.
    """
    if not abs(angle) <= TURN:
        raise ValueError(f'a ring gear is turned by at most a whole turn, not by {angle:g} rad')
    return angle


def add_setting(parser: argparse._ActionsContainer, option: str, name: str, text: str) -> None:
    """Take a tooth and two holes under a name."""
    holes = ('TOOTH', 'RING_HOLE', 'CHASSIS_HOLE')
    parser.add_argument(option, dest=name, type=int, nargs=3, metavar=holes, help=text)


def add_stiffness(parser: argparse.ArgumentParser) -> None:
    """Take the stiffnesses of branches and shaft, and the backlash."""
    group = parser.add_argument_group(
        'stiffness', 'torsional, at the output; given here, since the node has no use for it'
    )
    group.add_argument(
        '--branch-stiffness',
        type=float,
        nargs='+',
        metavar='N·m/rad',
        help='of both branches, or of A and then of B, the one at the output; inf: rigid',
    )
    group.add_argument('--shaft-stiffness', type=float, metavar='N·m/rad', help='between the arms')
    group.add_argument('--shaft-diameter', type=float, metavar='M', help='of a full round shaft')
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
        help='play of the output where the turn starts, which it has to close first (default: 0)',
    )


def stiffness(options: argparse.Namespace) -> Stiffness | None:
    """The stiffnesses that were given; None if none was.

    Raises:
        ValueError: if some are missing, or are given twice.
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
