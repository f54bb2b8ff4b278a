# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The home file, in which the node keeps its zero until its next start."""

import errno
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.node_parameters import PARAMETERS, NodeParameters
from gear_kinematics.parameters.yaml_file import Dumper, read_yaml


def write_home(path: Path, actuators: Mapping[str, NodeParameters], node: str) -> None:
    """Write the zeros of all actuators of the node with a full name; a single one has ''.

    Raises OSError if they cannot be written. Older zeros are removed, as they would be wrong at
    the next start; the text says so where that fails as well.
    """
    if path.is_symlink():
        raise OSError(errno.ELOOP, 'it is a link, which could lead to any file')
    document: dict[str, Any] = {'homed': f'{datetime.now(UTC):%Y-%m-%d %H:%M UTC}'}
    zeros = {name: {'rotor_zero': each.rotor_zero} for name, each in actuators.items()}
    if '' in actuators:
        document |= zeros[''] | _owner(actuators, node) | _gear(actuators[''])
    else:
        document |= _owner(actuators, node)
        document['actuators'] = {
            name: zeros[name] | _gear(each) for name, each in actuators.items()
        }
    try:
        replace_file(path, yaml.dump(document, Dumper=Dumper, sort_keys=False).encode())
    except OSError as error:
        try:
            if path.exists():
                path.unlink()
        except OSError:
            stale = f'{error.strerror}; delete it, since its zero is out of date'
            raise OSError(error.errno, stale) from error
        raise


def read_home(
    path: Path, actuators: Mapping[str, NodeParameters], node: str
) -> tuple[dict[str, float], str] | None:
    """Read `rotor_zero`, rad, by actuator from a file of at most 256 KiB, and when it was set.

    An arm's file has the zeros of the actuators that were homed. None if there is no file. Raises
    ConfigError if it cannot be used, or a zero belongs to another node, by its full name, to
    another actuator, gear, joint or kind of encoder.
    """
    if path.is_symlink():
        raise ConfigError(f'{path}: the home file must not be a link')
    if not path.exists():
        return None
    document = read_yaml(path, ConfigError)
    found = document if isinstance(document, dict) else {}
    owner = _owner(actuators, node)
    if 'node' not in found and '' in actuators:
        del owner['node']  # written by release 0.2 or older
    _check(path, found, owner)
    entries = {'': found} if '' in actuators else found.get('actuators')
    zeros: dict[str, Any] = {}
    for name, entry in entries.items() if isinstance(entries, dict) else ():
        if name not in actuators:
            raise ConfigError(f'{path}: its {name!r:.80} is not in `actuators`')
        values = entry if isinstance(entry, dict) else {}
        _check(path, values, _gear(actuators[name]), name and f'{name}.')
        zeros[name] = values.get('rotor_zero')
        if fault := PARAMETERS['rotor_zero'].fault('rotor_zero', zeros[name]):
            raise ConfigError(f'{path}: {fault:.200}')
    return zeros, str(found.get('homed'))[:80]


def _check(
    path: Path, found: Mapping[str, Any], expected: Mapping[str, Any], prefix: str = ''
) -> None:
    for name, value in expected.items():
        if found.get(name) != value:
            raise ConfigError(
                f'{path}: its {prefix}{name} is {found.get(name)!r:.80}, not {value!r}'
            )


def _owner(actuators: Mapping[str, NodeParameters], node: str) -> dict[str, Any]:
    return {'schema': f'gear_kinematics/home/{1 if "" in actuators else 2}', 'node': node}


def _gear(parameters: NodeParameters) -> dict[str, Any]:
    """Return what a zero belongs to: gear, joint and encoder."""
    names = 'rotor_joint', 'rotor_direction', 'rotor_encoder'
    own = {name: getattr(parameters, name) for name in names}
    return {'gear_ratio': str(parameters.gear.gear_ratio), **own}
