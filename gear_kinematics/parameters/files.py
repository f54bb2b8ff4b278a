# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Parameter files of ROS: which of their parameters apply to a node."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.parameters.yaml_file import Loader, load_yaml, read_yaml
from gear_kinematics.wire.nearest import nearest

_NODE_PATTERN = re.compile(r'(/(\*\*?|[A-Za-z_]\w*))+', re.ASCII)
"""A node's name in a parameter file, as in rcl; `*` is any token, `**` any number of tokens."""
_LONGEST = 255  # characters of a name in ROS

_GEAR = {'gear_ratio', 'ring_teeth', 'satellite_teeth', 'rotor_joint', 'rotor_direction',
         'rotor_zero', 'rotor_encoder', 'output_joint', 'calibration', 'home_file'}  # fmt: skip
"""Parameters that describe a gear, and hardly any other node has."""

_RATIO = {'gear_ratio', 'ring_teeth', 'satellite_teeth'}

_FILES = 'calibration', 'home_file'  # parameters that name files, relative to the parameter file


class ConfigError(ValueError):
    """A parameter file that cannot be used; the text names the file and the cause."""


class _OtherNodesError(ConfigError):
    """A parameter file that has parameters, but none of the node."""


def names_of_files(given: Mapping[str, Any]) -> list[str]:
    """Return the names of those given parameters, also of actuators, that name files."""
    return [name for name, value in given.items() if name.rpartition('.')[2] in _FILES and value]


def require_any(paths: Collection[Path], node: str) -> dict[str, Path]:
    """Return the calibrations and home files that parameter files name, relative to these.

    Raises ConfigError if a file has no parameters, or none has any for the node. ROS silently
    ignores such files, and the node would run with its default values.
    """
    useless = []
    files: dict[str, Path] = {}
    for path in paths:
        try:
            given = given_parameters(path, node)
            for name in names_of_files(given):
                files.setdefault(str(given[name]), path.parent / str(given[name]))
        except _OtherNodesError as error:
            useless.append(str(error))
    if paths and len(useless) == len(paths):
        raise ConfigError('; '.join(useless))
    return files


def given_parameters(path: Path, node: str) -> dict[str, Any]:
    """Read the parameters for a node from a file, by dotted names.

    Of all blocks that apply to the node, with wildcards or not, a later one replaces the values of
    an earlier one.
    """
    blocks = _read(path)
    if not blocks:
        raise ConfigError(f'{path}: no ros__parameters in it')
    name = f'/{node.lstrip("/")}' if '/' in node else _full_name(path, node, blocks)
    applying = [parameters for pattern, parameters in blocks if _applies(pattern, name)]
    if not applying:
        patterns = [pattern for pattern, _ in blocks]
        there = f'{", ".join(patterns)}{nearest(name, patterns)}'
        raise _OtherNodesError(f'{path}: no parameters of {name} in it, only of {there}')
    _check_strays(path, name, blocks)
    return {key: value for parameters in applying for key, value in parameters.items()}


default_values = cache(given_parameters)  # of an installed file, which does not change


def write_config(path: Path, text: str, *, new: bool = True) -> None:
    """Write a file, by default a new one, completely or not at all; raises ConfigError."""
    try:
        replace_file(path, text.encode(), new=new)
    except OSError as error:
        raise ConfigError(f'{path}: {error.strerror}') from error


def _check_strays(path: Path, name: str, blocks: Sequence[tuple[str, dict[str, Any]]]) -> None:
    """Refuse parameters that seem to be meant for a node to which only wildcards apply.

    They are below a name that is nearly its own, or they describe a gear or have its ratio, and no
    wildcard does.
    """
    others, common = dict[str, set[str]](), set[str]()
    for pattern, parameters in blocks:
        given = _GEAR & parameters.keys()
        if '*' not in pattern:
            if _applies(pattern, name):
                return
            others[pattern] = given
        elif _applies(pattern, name):
            common |= given
    if strays := [
        each
        for each, given in others.items()
        if _mistyped(each, name)
        or any(of_gear & given and not of_gear & common for of_gear in (_GEAR, _RATIO))
    ]:
        raise ConfigError(
            f'{path}: only the parameters of a wildcard apply to {name}, not those of '
            f'{", ".join(strays)}: correct one of the two names'
        )


def _mistyped(pattern: str, name: str) -> bool:
    """Return whether the names of two nodes, without namespace, differ by a typing error."""
    given, own = (each.rpartition('/')[2] for each in (pattern, name))
    shorter, longer = sorted((given, own), key=len)
    numbered = re.fullmatch(r'_?\d+|_\w+', longer.removeprefix(shorter))
    return given != own and not numbered and bool(get_close_matches(given, [own], cutoff=0.8))


def _full_name(path: Path, node: str, blocks: Iterable[tuple[str, object]]) -> str:
    """Find the fully qualified name of the only such node in a file; `/node` if there is none."""
    names = [name for name, _ in blocks if name.rpartition('/')[2] == node and '*' not in name]
    if len(names) > 1:
        raise ConfigError(
            f'{path}: parameters of more than one node: {", ".join(names)}; choose one with --node'
        )
    return names[0] if names else f'/{node}'


def _applies(pattern: str, name: str) -> bool:
    """Return whether a block of a parameter file is for a node, as in rclpy and rclcpp."""
    tokens, covered = name.split('/')[1:], {0}  # numbers of tokens that the parts so far can cover
    for part in pattern.split('/')[1:]:
        if part == '**':
            covered = {*range(min(covered), len(tokens) + 1)}
        else:
            covered = {k + 1 for k in covered if k < len(tokens) and part in {'*', tokens[k]}}
        if not covered:
            return False
    return len(tokens) in covered


def _read(path: Path) -> list[tuple[str, dict[str, Any]]]:
    """Read the blocks of a parameter file: names of nodes, and parameters by dotted names."""
    document = read_yaml(path, ConfigError, _RosLoader)
    blocks: dict[str, dict[str, Any]] = {}
    for name, parameters in _blocks(document):
        blocks.setdefault(name, {}).update(parameters)
    # `node` and `/node` mean the same to rcl, but are two blocks.
    found = [(f'/{name.removeprefix("/")}', parameters) for name, parameters in blocks.items()]
    for name, _ in found:
        if len(name) > _LONGEST or not _NODE_PATTERN.fullmatch(name):
            raise ConfigError(f'{path}: {name:.{_LONGEST}} is not a valid node name')
    return found


class _Pairs(tuple[tuple[Any, Any], ...]):
    """A mapping with possibly repeated keys, which ROS merges."""

    __slots__ = ()


class _RosLoader(Loader):
    """Keeps repeated keys, which ROS merges; the file may have parameters of many nodes."""

    max_bytes = 2**20
    max_events = 2**17
    tags = False


def _pairs(loader: _RosLoader, node: yaml.MappingNode) -> _Pairs:
    """Read a mapping, whose keys are texts even if they look like numbers or truth values."""
    return _Pairs(
        (loader.construct_scalar(key), loader.construct_object(value, deep=True))
        for key, value in node.value
    )


_RosLoader.add_constructor('tag:yaml.org,2002:map', _pairs)


def parameter_blocks(text: str) -> list[tuple[str, dict[str, Any]]]:
    """List the blocks in the text of a parameter file: names of nodes, with their parameters."""
    return [*_blocks(load_yaml(text, _RosLoader))]


def _blocks(tree: Any, name: str = '') -> Iterator[tuple[str, dict[str, Any]]]:
    for key, value in tree if isinstance(tree, _Pairs) else ():
        if key != 'ros__parameters':
            yield from _blocks(value, f'{name}/{key}' if name.strip('/') else f'{name}{key}')
        elif isinstance(value, _Pairs):
            yield name, dict(_flatten(value))


def _flatten(tree: _Pairs, prefix: str = '') -> Iterator[tuple[str, Any]]:
    for key, value in tree:
        if isinstance(value, _Pairs):
            yield from _flatten(value, f'{prefix}{key}.')
        else:
            yield f'{prefix}{key}', value
