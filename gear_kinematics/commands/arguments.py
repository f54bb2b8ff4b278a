"""Arguments that several commands have in common."""

import argparse
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from gear_kinematics.commands.paper_size import add_paper
from gear_kinematics.commands.targets import add_force
from gear_kinematics.kinematics import GearRatio, Mechanism
from gear_kinematics.kinematics.preload import STEEL_SHEAR_MODULUS, Stiffness, shaft_stiffness
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NODE, PARAMETERS, NodeParameters, default_config
from gear_kinematics.wire.nearest import among


def positive(text: str) -> float:
    """Parse a number greater than 0."""
    number = float(text)
    if not (number > 0.0 and math.isfinite(number)):
        raise argparse.ArgumentTypeError(f'must be greater than 0, not {text}')
    return number


def finite(text: str) -> float:
    """Parse a finite number."""
    if not math.isfinite(number := float(text)):
        raise argparse.ArgumentTypeError(f'must be a finite number, not {text}')
    return number


def count(text: str) -> int:
    """Parse an integer of at least 1."""
    if (number := int(text)) < 1:
        raise argparse.ArgumentTypeError(f'must be at least 1, not {text}')
    return number


def ratio(text: str) -> GearRatio:
    """Parse a gear ratio."""
    try:
        return GearRatio.parse(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def parsers(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    """Yield a parser and those of its subcommands."""
    yield parser
    for action in parser._actions:  # noqa: SLF001, argparse has no other way
        if isinstance(action, argparse._SubParsersAction):  # noqa: SLF001
            for below in action.choices.values():
                yield from parsers(below)


def add_config(parser: argparse.ArgumentParser) -> None:
    """Add the options for the parameters of the node."""
    parser.add_argument(
        '--config',
        type=Path,
        metavar='FILE',
        help='parameters of the node as YAML (default: config/actuator.yaml)',
    )
    parser.add_argument(
        '--node',
        default=NODE,
        metavar='NAME',
        help='node in a file with several nodes, with or without namespace, such as '
        f'/left/{NODE} (default: %(default)s)',
    )


def add_report_forms(parser: argparse.ArgumentParser, *, junit: bool = False) -> None:
    """Add the options for files of the report; see `output.Reporter`."""
    for form in ('json', *(['junit'] if junit else []), 'html'):
        parser.add_argument(f'--{form}', metavar='FILE', help=f'report as {form} (-: stdout)')
    parser.add_argument('--plot', metavar='FILE', help='figure: .png, .svg, .pdf ...')
    add_paper(parser)
    add_force(parser)
    add_quiet(parser)


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """Add the option for less output."""
    parser.add_argument(
        '-q',
        '--quiet',
        action='store_true',
        help='print neither progress nor results, but what failed',
    )


def add_fleet(ways: argparse._ActionsContainer) -> None:
    """Add the options that distribute many recordings; see `bag.fleet`."""
    ways.add_argument('--jobs', type=count, default=1, metavar='N', help='processes')
    ways.add_argument('--scheduler', metavar='ADDRESS', help='of a Dask cluster: tcp://host:port')


def config_path(options: argparse.Namespace, bag: Path | None = None) -> Path:
    """The given parameter file, or the one in the bag's folder, or the default."""
    if options.config:
        return Path(options.config)
    default = default_config()
    return (beside(bag, default.name) if bag else None) or default


def load_config(options: argparse.Namespace, bag: Path | None = None) -> NodeParameters:
    """Load the parameters from `config_path`; `--ratio`, `--joint`, `--max-gap` replace some.

    Raises:
        ValueError: for values that the node would refuse.
    """
    config = NodeParameters.load(config_path(options, bag), options.node)
    if given := getattr(options, 'ratio', None):
        config = replace(config, gear_ratio=str(given))
    if (joint := getattr(options, 'joint', None)) is not None:
        config = replace(config, rotor_joint=joint)
    if (max_gap := getattr(options, 'max_gap', None)) is not None:
        config = replace(config, transmission_error_max_gap=max_gap)
    return config


def add_ratio(parser: argparse.ArgumentParser) -> None:
    """Add the options for the ratio of any gear; `load_config` applies `--ratio`."""
    ways = parser.add_mutually_exclusive_group()
    ways.add_argument(
        '--ratio',
        type=ratio,
        metavar='I',
        help='exact gear ratio, such as -19 or 1457/26 (default: the parameter gear_ratio, or '
        'from the teeth)',
    )
    ways.add_argument(
        '--fit-ratio', action='store_true', help='estimate the gear ratio from the recording'
    )


def beside(bag: Path, name: str) -> Path | None:
    """The file of a name in the folder of a bag, if there is one."""
    path = (bag if bag.is_dir() else bag.parent) / name
    return path if path.is_file() else None


def add_mechanism(parser: argparse.ArgumentParser) -> None:
    """Add the options for a mechanism: parameters of the node, and tooth numbers."""
    add_config(parser)
    for name, metavar in (('ring', 'ZK'), ('satellite', 'ZS')):
        text = f'replaces the parameter {name}_teeth'
        parser.add_argument(f'--{name}-teeth', type=int, metavar=metavar, help=text)


def mechanism(options: argparse.Namespace) -> Mechanism:
    """The mechanism given by the options."""
    return node_parameters(options).mechanism


def node_parameters(options: argparse.Namespace) -> NodeParameters:
    """The parameters of the node, some of them replaced by options.

    Raises:
        ValueError: for values that the node would refuse.
    """
    config = load_config(options, getattr(options, 'bag', None))
    for name in ('ring_teeth', 'satellite_teeth', 'eccentricity', 'module'):
        if (given := getattr(options, name, None)) is None:
            continue
        option = f'--{name.replace("_", "-")}'
        if fault := PARAMETERS[name].fault(option, given):
            raise ValueError(fault)
        ratio = '' if name.endswith('_teeth') else config.gear_ratio
        config = replace(config, **{name: given}, gear_ratio=ratio)
    return config


def add_sizes(parser: argparse.ArgumentParser) -> None:
    """Add the options for eccentricity and module."""
    for name in ('eccentricity', 'module'):
        text = f'replaces the parameter {name}, m'
        parser.add_argument(f'--{name}', type=float, metavar='M', help=text)


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
