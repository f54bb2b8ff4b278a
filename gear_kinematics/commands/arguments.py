# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Arguments shared by several commands."""

import argparse
import math
from collections.abc import Callable, Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.parameters import NODE, PARAMETERS, NodeParameters, default_config
from gear_kinematics.parameters.arm import chosen, load_actuators


def between(
    low: float, high: float = math.inf, kind: Callable[[str], float] = float
) -> Callable[[str], float]:
    """Return a parser of numbers between two bounds; `kind` is `int` or `float`."""

    def number(text: str) -> float:
        if not low <= (value := kind(text)) <= high:
            bounds = f'at least {low:g}' if high == math.inf else f'between {low:g} and {high:g}'
            raise argparse.ArgumentTypeError(f'must be {bounds}, not {text}')
        return value

    number.__name__ = kind.__name__
    return number


RATE = between(1e-3, 1e3)  #: parser of the speed of a playback
MAGNITUDE = between(-1e6, 1e6)  #: parser of torques, N·m, of speeds, rad/s, and of angles, deg


def group(parser: argparse.ArgumentParser, title: str) -> argparse._ArgumentGroup:
    """Return the group of options under a heading of --help, and create it if it is missing."""
    known = (group for group in parser._action_groups if group.title == title)  # noqa: SLF001
    return next(known, None) or parser.add_argument_group(title)


ALL = 'use this actuator of an arm only (default: all)'
"""The help on `--actuator` of commands that work on all actuators."""


def add_config(
    parser: argparse.ArgumentParser,
    node: str = NODE,
    default: str = 'actuator.yaml beside a recording, if any, else that of the package',
    *,
    chosen: str = '',
    actuator: str = 'use this actuator of an arm',
) -> None:
    """Add the options for the parameters of a node; `chosen` replaces the help on `--node`."""
    gear = group(parser, 'gear')
    text = f'parameters of the node as YAML (default: {default})'
    gear.add_argument('--config', type=Path, metavar='FILE', help=text)
    gear.add_argument(
        '--node',
        default=node,
        metavar='NAME',
        help=chosen
        or 'node to select in a file for several nodes, with or without namespace, such as '
        f'/left/{node} (default: %(default)s)',
    )
    gear.add_argument('--actuator', default='', metavar='NAME', help=actuator)


def add_mechanism(parser: argparse.ArgumentParser, *, sizes: bool = False) -> None:
    """Add the options for a mechanism: parameters of the node, tooth numbers and sizes."""
    add_config(parser)
    gear = group(parser, 'gear')
    for name, metavar in ('ring', 'ZK'), ('satellite', 'ZS'):
        text = f'replace the parameter {name}_teeth'
        gear.add_argument(f'--{name}-teeth', type=int, metavar=metavar, help=text)
    for name in ('eccentricity', 'module') if sizes else ():
        text = f'replace the parameter {name}, m'
        gear.add_argument(f'--{name}', type=float, metavar='M', help=text)


def _full_name(text: str) -> str:
    parts = text.removeprefix('/').split('/')
    if text and not all(part.isascii() and part.isidentifier() for part in parts):
        raise argparse.ArgumentTypeError(f'ROS has no nodes of the name {text!r}')
    return text


def add_running(parser: argparse.ArgumentParser, node: str, actuator: str) -> None:
    """Add the options for a running node and its actuator, with texts on their defaults."""
    text = f'the node, such as /left/{NODE} (default: {node})'
    parser.add_argument('--node', default='', type=_full_name, metavar='FULL_NAME', help=text)
    text = f'actuator of an arm (default: {actuator})'
    parser.add_argument('--actuator', default='', metavar='NAME', help=text)


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """Add the option for less output."""
    text = 'print only what failed, and neither progress nor results'
    group(parser, 'output').add_argument('-q', '--quiet', action='store_true', help=text)


def add_verbose(
    parser: argparse.ArgumentParser, text: str = 'print tables and remarks in a pipe, too'
) -> None:
    """Add the option for more output."""
    group(parser, 'output').add_argument('-v', '--verbose', action='store_true', help=text)


def config_path(options: argparse.Namespace, bag: Path | None = None) -> Path:
    """Choose the given parameter file, or the one in the bag's folder, or the default."""
    if options.config:
        return Path(options.config)
    default = default_config()
    return (in_bag_folder(bag, default.name) if bag else None) or default


_REPLACED = {
    **{name: name for name in ('ring_teeth', 'satellite_teeth', 'eccentricity', 'module')},
    'ratio': 'gear_ratio',
    'joint': 'rotor_joint',
}
"""Parameters of the node by the options that replace them."""


def load_config(options: argparse.Namespace, bag: Path | None = None) -> NodeParameters:
    """Load the parameters of one actuator from `config_path`; options replace some of them.

    Raises ValueError if the node would refuse one, or it is not clear which actuator is meant.
    """
    path = config_path(options, bag)
    config = NodeParameters.load(path, options.node, actuator=options.actuator)
    return replace(config, **_replacing(options))


def load_configs(
    options: argparse.Namespace, bag: Path | None = None
) -> dict[str, NodeParameters]:
    """Load the parameters of all actuators, or the chosen one, by name; a single gear has ''.

    Options replace some of them. Raises ValueError for values that the node would refuse, and for
    options that would replace a parameter of several actuators.
    """
    found = load_actuators(config_path(options, bag), options.node)
    found, replacing = chosen(found, options.actuator), _replacing(options)
    if replacing and len(found) > 1:
        names = ', '.join(replacing)
        raise ValueError(f'{names} can be replaced for one actuator: choose it with --actuator')
    return {name: replace(config, **replacing) for name, config in found.items()}


def check_of_one(options: argparse.Namespace, actuators: Collection[str], *names: str) -> None:
    """Raise ValueError if options that apply to one gear are given for several actuators."""
    for name in names if len(actuators) > 1 else ():
        if getattr(options, name, None):
            option = f'--{name.replace("_", "-")}'
            raise ValueError(
                f'{option} is for one of {", ".join(actuators)}: choose it with --actuator'
            )


def _replacing(options: argparse.Namespace) -> dict[str, Any]:
    """Return the values of parameters in options."""
    given = {}
    for name, parameter in _REPLACED.items():
        if (value := getattr(options, name, None)) is None:
            continue
        given[parameter] = value
        if name == parameter:
            option = f'--{name.replace("_", "-")}'
            if fault := PARAMETERS[name].fault(option, value):
                raise ValueError(fault)
    if 'ring_teeth' in given or 'satellite_teeth' in given:
        given['gear_ratio'] = ''
    return given


def in_bag_folder(bag: Path, name: str) -> Path | None:
    """Find the file with a name in the folder of a bag, if there is one."""
    path = (bag if bag.is_dir() else bag.parent) / name
    return path if path.is_file() else None


def add_ratio(parser: argparse.ArgumentParser) -> None:
    """Add the option that replaces the parameter `gear_ratio`; `load_config` applies it."""
    text = (
        'exact gear ratio, such as -19 or 1457/26 (default: the parameter gear_ratio, or '
        'from the teeth; gearkin commission finds it)'
    )
    group(parser, 'gear').add_argument('--ratio', type=ratio_text, metavar='I', help=text)


def ratio_text(text: str) -> str:
    """Check a gear ratio, and write it as the parameter `gear_ratio`."""
    try:
        return str(GearRatio.parse(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
