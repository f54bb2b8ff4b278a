# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Adds actuators to the parameter file of an arm, as text, so that its comments stay."""

import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.parameters.arm import faults_in, full_name
from gear_kinematics.parameters.files import ConfigError, parameter_blocks, write_config
from gear_kinematics.parameters.yaml_file import Dumper, Loader, load_yaml, read_yaml

_NEW = '/**:\n  ros__parameters:\n    actuators: []'
_ANY_GEAR = "gear_ratio: '1'"


def add_actuators(path: Path, blocks: Mapping[str, Sequence[str]], head: Sequence[str]) -> None:
    """Add actuators to the parameter file of an arm, or begin one; all of them or none.

    The blocks are the lines of YAML below the name of each actuator. A new file begins with the
    head; everything in an existing one is kept. Raises ConfigError if that is impossible, or the
    node would refuse the result.
    """
    new = not os.path.lexists(path)
    write_config(path, _extended(path, blocks, head), new=new)


def check_new(path: Path, actuator: str, joint: str = '', encoder_joint: str = '') -> None:
    """Raise ConfigError if a file is there already, or cannot take an actuator of this name.

    The joints are those of the actuator's rotor and of the encoder at its output, which no other
    one may have; '': not known yet.
    """
    joints = {'rotor_joint': joint, 'output_encoder_joint': encoder_joint}
    block = [_ANY_GEAR, *(f'{key}: {json.dumps(name)}' for key, name in joints.items() if name)]
    there = os.path.lexists(path)  # perhaps a link to nothing
    if actuator and there == path.exists():
        _extended(path, {actuator: block}, ())
    elif there:
        raise ConfigError(f'{path}: exists already; give another name with -o')


def _extended(path: Path, blocks: Mapping[str, Sequence[str]], head: Sequence[str]) -> str:
    """Return the text of a parameter file with more actuators; raises ConfigError."""
    there = read_yaml(path, ConfigError) if os.path.lexists(path) else None
    text = path.read_text('utf-8').rstrip('\n') if there else '\n'.join([*head, _NEW])
    text += '\n'
    before = parameter_blocks(text)
    arms = [parameters for _, parameters in before if 'actuators' in parameters]
    found = [*_lists(yaml.compose(text, Loader))]
    if not len(arms) == len(found) == 1:
        raise ConfigError(
            f'{path}: it is not the file of one arm, which has a list of `actuators`'
        )
    [arm], [(mapping, listed)] = arms, found
    if not arm['actuators'] and 'rotor_joint' in arm:
        raise ConfigError(f'{path}: it is the file of a single gear: give another name with -o')
    arm['actuators'] = names = [*arm['actuators'], *blocks]
    if twice := [name for name in blocks if names.count(name) > 1]:
        remedy = 'delete it there, also from `actuators`, or give another name'
        verb = 'is' if len(twice) == 1 else 'are'
        raise ConfigError(f'{path}: {", ".join(twice)} {verb} in it already: {remedy}')
    indent, at, lines = ' ' * mapping.start_mark.column, _behind(text, mapping), ''
    if comments := re.compile(f'(?:{indent} *#.*\n)*').match(text, at):
        at = comments.end()
    for name, block in blocks.items():
        lines += f'{indent}{_yaml([name])}:\n' + ''.join(f'{indent}  {line}\n' for line in block)
        given = load_yaml('\n'.join(block))
        arm |= {full_name(name, key): value for key, value in given.items()}
    text = text[:at] + lines + text[at:]
    if listed.flow_style:
        start, end, items = listed.start_mark.index, listed.end_mark.index, f'[{_yaml(names)}]'
    else:
        start = end = _behind(text, listed)
        items = ''.join(f'{" " * listed.start_mark.column}- {_yaml([name])}\n' for name in blocks)
    text = text[:start] + items + text[end:]
    try:
        extended = parameter_blocks(text) == before
    except (yaml.YAMLError, ValueError):
        extended = False
    faults = faults_in(arm) if extended else ['write each of its parameters on a line of its own']
    if faults:
        raise ConfigError(f'{path}: {"; ".join(faults)}')
    return text


def _lists(node: Any) -> Iterator[tuple[Any, Any]]:
    """Find the lists of `actuators`, each behind the mapping that it is in."""
    for key, value in node.value if isinstance(node, yaml.MappingNode) else ():
        if key.value == 'actuators' and isinstance(value, yaml.SequenceNode):
            yield node, value
        yield from _lists(value)


def _yaml(names: Sequence[str]) -> str:
    """Write names for YAML, which takes `on` for a truth value."""
    return ', '.join(yaml.dump(name, Dumper=Dumper).splitlines()[0] for name in names)


def _behind(text: str, node: Any) -> int:
    """Find the end of the last line of a node."""
    while isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        last = node.value[-1]
        node = last[1] if isinstance(last, tuple) else last
    return text.index('\n', node.end_mark.index - 1) + 1
