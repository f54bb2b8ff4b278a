# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The home file, in which the node keeps its zero until its next start."""

import errno
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.node_parameters import PARAMETERS, NodeParameters
from gear_kinematics.parameters.yaml_file import Dumper, read_yaml


def write_home(path: Path, parameters: NodeParameters, node: str) -> None:
    """Write the zero of a node, given by its full name.

    Raises:
        OSError: if it cannot be written. An older zero is removed, as it would be wrong at the
            next start; the text says so where that fails as well.
    """
    homed = f'{datetime.now(UTC):%Y-%m-%d %H:%M UTC}'
    if path.is_symlink():
        raise OSError(errno.ELOOP, 'it is a link, which could lead to any file')
    document = {'homed': homed, 'rotor_zero': parameters.rotor_zero, **_owner(parameters, node)}
    try:
        replace_file(path, yaml.dump(document, Dumper=Dumper, sort_keys=False).encode())
    except OSError as error:
        try:
            path.unlink(missing_ok=True)
        except OSError:
            stale = f'{error.strerror}; delete it, since its zero is out of date'
            raise OSError(error.errno, stale) from error
        raise


def read_home(path: Path, parameters: NodeParameters, node: str) -> tuple[float, str] | None:
    """Read `rotor_zero`, rad, from a file of at most 256 KiB, and when it was set.

    None if there is no file.

    Raises:
        ConfigError: if it cannot be used, or its zero belongs to another node, by its full name,
            to another gear, joint or kind of encoder.
    """
    if path.is_symlink():
        raise ConfigError(f'{path}: the home file must not be a link')
    if not path.exists():
        return None
    document = read_yaml(path, ConfigError)
    found = document if isinstance(document, dict) else {}
    for name, value in _owner(parameters, node).items():
        if name == 'node' and name not in found:
            continue  # written by release 0.2 or older
        if found.get(name) != value:
            raise ConfigError(f'{path}: its {name} is {found.get(name)!r:.80}, not {value!r}')
    zero: Any = found.get('rotor_zero')
    if fault := PARAMETERS['rotor_zero'].fault('rotor_zero', zero):
        raise ConfigError(f'{path}: {fault:.200}')
    return zero, str(found.get('homed'))[:80]


def _owner(parameters: NodeParameters, node: str) -> dict[str, Any]:
    """Return what the zero belongs to: node, gear, joint and encoder."""
    names = 'rotor_joint', 'rotor_direction', 'rotor_encoder'
    own = {name: getattr(parameters, name) for name in names}
    ratio = str(parameters.gear.gear_ratio)
    return {'schema': 'gear_kinematics/home/1', 'node': node, 'gear_ratio': ratio, **own}
