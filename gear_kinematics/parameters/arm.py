# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameters of an arm: several actuators in one node and in one parameter file.

`shoulder.gear_ratio` is a parameter of the actuator `shoulder`; `gear_ratio` is the default of all
actuators. A node without `actuators` has one actuator, whose name is ''.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import yaml

from gear_kinematics.parameters.body_parameters import BRANCH_PARAMETERS, branch_parameters
from gear_kinematics.parameters.files import ConfigError, given_parameters, names_of_files
from gear_kinematics.parameters.node_parameters import (
    NODE,
    PARAMETERS,
    NodeParameters,
    default_config,
    default_value,
)
from gear_kinematics.parameters.parameter import Parameter
from gear_kinematics.parameters.yaml_file import Dumper
from gear_kinematics.wire.nearest import among, nearest

_NONE: Mapping[str, Parameter] = MappingProxyType({})
_SPACING = 1.5  # distance between neighbours in a URDF, in diameters of the largest ring gear
COMMON = 'actuators', 'executor', 'home_file'  # of the node, which cannot differ between actuators

_TOKEN = re.compile('[A-Za-z][A-Za-z0-9_]{,63}', re.ASCII)
"""A name that ROS allows in parameters, topics and services, of which a whole one has 255."""
_EVERY_NODE = re.compile(r'use_sim_time|start_type_description_service|qos_overrides\..*')
"""Parameters that every node has and that are ignored here."""
_GROUPS = 'qos_overrides', 'use_sim_time', 'start_type_description_service'
_SHOWN = 50  # unknown parameters that are named, each with the nearest known name
_JOINTS = 'rotor_joint', 'output_joint', 'output_encoder_joint'
"""Their default is the name of the actuator."""


def load_actuators(
    path: Path | None = None, node: str = NODE, others: Mapping[str, Parameter] = _NONE
) -> dict[str, NodeParameters]:
    """Read the parameters of all actuators of a node, by name; see `NodeParameters.load`.

    Paths in the file are relative to it. Raises ConfigError if it cannot be read, has nothing for
    the node, leaves open which node is meant, or has values or names that are refused, of which
    the text lists all.
    """
    path = path or default_config()
    given = given_parameters(path, node)
    if faults := faults_in(given, others):
        raise ConfigError(f'{path}: {"; ".join(faults)}')
    for name in names_of_files(given):
        given[name] = str(path.parent / given[name])
    return actuators_of(given)


def actuators_of(given: Mapping[str, Any]) -> dict[str, NodeParameters]:
    """Create the parameters of all actuators from valid values by names in ROS."""
    return {name: NodeParameters.of(values, name) for name, values in by_actuator(given).items()}


def chosen(actuators: Mapping[str, NodeParameters], name: str) -> dict[str, NodeParameters]:
    """Return the actuator of a name alone, or all for ''; raises ConfigError for another name."""
    if name and name not in actuators:
        there = among(name, [*filter(None, actuators)])
        raise ConfigError(f'no actuator {name!r} in `actuators`{there}')
    return {name: actuators[name]} if name else dict(actuators)


def as_file(actuators: Iterable[NodeParameters], node: str = '/**') -> str:
    """Write a parameter file for a node or for all, from which `load_actuators` reads the same."""
    values: dict[str, Any] = {}
    names = []
    for each in actuators:
        names += [each.actuator] if each.actuator else []
        for name, value in each.values().items():
            values[name if name in COMMON else full_name(each.actuator, name)] = value
    document = {node: {'ros__parameters': values | {'actuators': names}}}
    return str(yaml.dump(document, Dumper=Dumper, sort_keys=False))


def arm_urdf(actuators: Mapping[str, NodeParameters]) -> tuple[str, list[str]]:
    """Write the URDF of all actuators with known bodies, side by side; return the others' names.

    Raises ValueError if only the ratios are known, or there is no such mechanism.
    """
    from gear_kinematics.shape.urdf import side_by_side  # noqa: PLC0415, of few programs

    shown = {name: each for name, each in actuators.items() if not each.gear_ratio} or actuators
    urdf, *others = (each.urdf() for each in shown.values())
    if others:
        largest = max(each.module * each.ring_teeth for each in shown.values())
        urdf = side_by_side([urdf, *others], _SPACING * largest)
    return urdf, [name for name in actuators if name not in shown]


def full_name(actuator: str, name: str) -> str:
    """Return the name in ROS of a parameter of an actuator."""
    return f'{actuator}.{name}' if actuator else name


def labelled(actuator: str, text: str) -> str:
    """Put the name of an actuator, if it has one, before a text on it."""
    return f'{actuator}: {text}' if actuator else text


def faults_in(given: Mapping[str, Any], others: Mapping[str, Parameter] = _NONE) -> list[str]:
    """List the faults of values and names of parameters in ROS; the node may have `others`."""
    names = given.get('actuators', [])
    if fault := PARAMETERS['actuators'].fault('actuators', names):
        return [fault]
    actuators = by_actuator(given)
    branches = {name: _branches(values) for name, values in actuators.items()}
    every = [branch for each in branches.values() for branch in each]
    known = {**PARAMETERS, **branch_parameters(every), **others}
    refused = {}
    for name, value in given.items():
        first, _, rest = name.partition('.')
        parameter = known.get(rest if first in actuators else name)
        if parameter and (fault := parameter.fault(name, value)):
            refused[name] = fault
    faults = [*refused.values()]
    if names:
        usable = {name: value for name, value in given.items() if name not in refused}
        shared = shared_names(actuators_of(usable))
        faults = [*_name_faults(names, every, others), *faults, *shared]
    return faults + unknown_parameters(given, branches, others)


def shared_names(actuators: Mapping[str, NodeParameters]) -> list[str]:
    """List the faults of gears, and of names that only one actuator of an arm can have."""
    owners = defaultdict[tuple[str, str], list[str]](list)
    joints: Counter[str] = Counter()
    faults = []
    for name, each in actuators.items():
        owners['output_joint', each.output_name].append(name)
        for parameter in ('rotor_joint', 'output_encoder_joint'):
            owners[parameter, getattr(each, parameter)].append(name)
        if not each.gear_ratio:
            owners['frame_prefix', each.frame_prefix].append(name)
        try:
            joints.update(each.joint_names)
        except ValueError as error:
            faults.append(labelled(name, str(error)))
    for (parameter, value), names in owners.items():
        if len(actuators) > 1 and not value and parameter in _JOINTS:
            every = ' and '.join(full_name(name, parameter) for name in names)
            faults.append(f'{every} must name one of several joints, or be left out')
        elif len(names) > 1:
            which = f'{parameter} {value!r} belongs to {" and ".join(names)}'
            faults.append(f'{which}: give each its own, or leave it out')
    twice = [name for name, count in joints.items() if count > 1]
    if twice and not faults:
        faults = [f'two actuators have a joint {name!r}: change an output_joint' for name in twice]
    return faults


def unknown_parameters(
    names: Iterable[str], branches: Mapping[str, Iterable[str]], others: Iterable[str] = ()
) -> list[str]:
    """List a fault for each name that no node has with these branches; all if none is near."""
    every = dict.fromkeys(branch for each in branches.values() for branch in each)
    known = [*PARAMETERS, *branch_parameters(every), *others]
    own = [
        f'{actuator}.{name}'
        for actuator, each in branches.items()
        for name in (*PARAMETERS, *branch_parameters(each), *others)
        if actuator and name not in COMMON
    ]
    faults, all_known, lost = [], dict.fromkeys([*known, *own]), False
    unknown = [n for n in names if n not in all_known and not _EVERY_NODE.fullmatch(n)]
    for name in unknown[:_SHOWN]:
        group, _, key = name.rpartition('.')
        actuator, _, branch = group.rpartition('.')
        if branch and key in BRANCH_PARAMETERS and actuator in ('', *branches):
            hint = f'; `{branch}` is not in `{full_name(actuator, "branches")}`'
        elif name in branches:
            hint = f'; give the parameters of {name} below it, such as `{name}.rotor_joint`'
        elif name.startswith('actuators.'):
            own_name = name.removeprefix('actuators.')
            hint = f'; `actuators` is a list of names: write `{own_name}` beside it'
        elif key in COMMON and group in branches:
            hint = f'; give `{key}` without `{group}.`, as it holds for all actuators'
        else:
            first, _, rest = name.partition('.')
            unlisted = rest in known and not nearest(first, branches)
            hint = f'; `{first}` is not in `actuators`' if unlisted else nearest(name, all_known)
        faults.append(f'unknown parameter `{name}`{hint}')
        lost |= not hint
    if more := len(unknown[_SHOWN:]):
        faults.append(f'and {more} more')
    if lost:
        single = f', and for each actuator such as `{own[0]}`' if own else ''
        faults.append(f'there are: {", ".join(known)}{single}')
    return faults


def by_actuator(given: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the values that apply to each actuator, by names without that of the actuator."""
    common: dict[str, Any] = {}
    values: dict[str, dict[str, Any]] = {name: {} for name in given.get('actuators') or ['']}
    for key, value in given.items():
        name, _, own = key.partition('.')
        if name in values:
            values[name][own] = value
        else:
            common[key] = value
    for name, each in values.items():
        default = {'frame_prefix': f'{name}_', **dict.fromkeys(_JOINTS, name)} if name else {}
        values[name] = default | common | each
    return values


def _branches(values: Mapping[str, Any]) -> list[str]:
    """Return the names of the branches, or the default ones if they are refused."""
    default: list[str] = default_value('branches')
    names: list[str] = values.get('branches', default)
    return default if PARAMETERS['branches'].fault('branches', names) else names


def _name_faults(
    names: Iterable[str], branches: Collection[str], others: Iterable[str]
) -> Iterator[str]:
    groups = {name.partition('.')[0] for name in (*PARAMETERS, *others, *_GROUPS)}
    for name, count in Counter(names).items():
        if count > 1:
            yield f'actuators: `{name}` is listed {count} times'
        if not _TOKEN.fullmatch(name):
            rule = 'at most 64 letters, digits and _, and begin with a letter'
            yield f'actuators: {name!r:.80} must be {rule}'
        elif name in branches:
            yield f'actuators: `{name}` is also the name of a branch'
        elif name in groups:
            yield f'actuators: `{name}` is also the name of a parameter or of a group of them'
