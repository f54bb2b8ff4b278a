# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads YAML files that users write, with one clear error whatever is wrong with them."""

import os
import re
import stat
from pathlib import Path
from typing import Any, ClassVar

import yaml

_MAX_DEPTH = 20  # libyaml has no limit of recursion
_MAX_NUMBERS = 100  # as keys of a mapping: hashes of numbers can be made to collide
_TEXT = 'tag:yaml.org,2002:str'
_SCALARS = {
    'bool': ('y|Y|yes|Yes|YES|true|True|TRUE|on|On|ON|n|N|no|No|NO|false|False|FALSE|off|Off|OFF',
             'yYnNtTfFoO'),
    'int': ('[-+]?(0[0-7]*|[1-9][0-9]*|0x[0-9a-fA-F]+)', '-+0123456789'),
    'float': (r'[-+]?((?i:\.?inf|\.?nan|infinity)|([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?)',
              '-+.0123456789iInN'),
    'null': ('|~|null|Null|NULL', ['', *'~nN']),
}  # fmt: skip
"""What is no text without quotes, by kind: as in rcl, besides `null`, and the first characters."""


class Loader(getattr(yaml, 'CSafeLoader', yaml.SafeLoader)):  # type: ignore[misc]
    """Reads y as a truth value, 15e-4 as a number, and 1:30 as a text, as rcl does."""

    max_bytes: ClassVar[int] = 2**18
    max_events: ClassVar[int] = 2**13
    """Greatest number of values and of begins and ends of lists, which load within 50 ms: twice as
    many as in a calibration of 60 coefficients, the largest that is ever fitted."""
    aliases: ClassVar[bool] = False
    """Whether aliases are allowed: text written from their values can expand without end."""
    tags: ClassVar[bool] = True  # whether others than !!str are allowed: old ROS ignores them
    bool_values: ClassVar = yaml.SafeLoader.bool_values | {'y': True, 'n': False}
    yaml_implicit_resolvers: ClassVar[dict[str, Any]] = {}  # replaced by `_SCALARS`

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        """Leave keys with the tag !!merge, which can expand without end, to be refused."""
        if sum(key.tag != _TEXT for key, _ in node.value) > _MAX_NUMBERS:
            raise ValueError(f'a mapping of more than {_MAX_NUMBERS} numbers')


class Dumper(yaml.SafeDumper):
    """Writes what `Loader` and rcl read: texts like numbers or truth values are quoted."""


for _kind, (_pattern, _first) in _SCALARS.items():
    for _either in (Loader, Dumper):
        _either.add_implicit_resolver(
            f'tag:yaml.org,2002:{_kind}', re.compile(f'({_pattern})$'), list(_first)
        )


def read_yaml(path: Path, error_type: type[ValueError], loader: type[Loader] = Loader) -> Any:
    """Read the document of a regular file, as a pipe could block for ever.

    If that is impossible, an error of the type names the file and the cause.
    """
    try:
        with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), 'rb') as file:  # no folder
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise error_type(f'{path}: not a regular file')
            # read() allocates as much as it may read; files of /proc have no size.
            data = file.read(min(status.st_size or loader.max_bytes, loader.max_bytes) + 1)
        if len(data) > loader.max_bytes:
            raise error_type(f'{path}: longer than {loader.max_bytes} bytes')
        text = data.decode()
    except error_type:
        raise
    except OSError as error:
        raise error_type(f'{path}: {error.strerror}') from error
    except ValueError as error:  # no UTF-8, or a path with a zero byte
        raise error_type(f'{path}: {error}') from error
    try:
        return load_yaml(text, loader)
    except Exception as error:  # PyYAML's constructors raise whatever they like
        raise error_type(f'{path}: not YAML: {_cause(error)}') from error


def load_yaml(text: str, loader: type[Loader] = Loader) -> Any:
    """Load a document within the bounds of a loader; raises any Exception if that fails."""
    depth = 0
    if '%TAG' in text:  # libyaml compares each with all others
        raise ValueError('%TAG is not supported')
    for number, event in enumerate(yaml.parse(text, loader), start=1):
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        if number > loader.max_events:
            raise ValueError(f'more than {loader.max_events} values')
        if depth > _MAX_DEPTH:
            raise ValueError(f'nested deeper than {_MAX_DEPTH} levels')
        tag, problem = getattr(event, 'tag', None), ''
        if isinstance(event, yaml.AliasEvent) and not loader.aliases:
            problem = 'aliases are not supported'
        elif tag not in {None, _TEXT} and not loader.tags:
            problem = f'the tag {tag!r} has no effect before ROS Lyrical: leave it out'
        if problem:
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=event.start_mark)  # type: ignore[arg-type]
    return yaml.load(text, loader)  # noqa: S506, it is safe


def _cause(error: Exception) -> str:
    """Describe the cause without lines of the file, which may be any file, and a secret."""
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark:
        return f'{error.problem} in line {error.problem_mark.line + 1}'
    if not isinstance(error, (yaml.YAMLError, ValueError)):
        return 'a value does not fit its tag'
    return ' '.join(str(error).split())
