# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The home file: the zero that the node keeps until its next start."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.node_parameters import PARAMETERS, NodeParameters
from gear_kinematics.parameters.yaml_file import Dumper, read_yaml


def write_home(path: Path, parameters: NodeParameters) -> None:
    """Write the zero of the parameters, completely or not at all; else raise OSError."""
    homed = f'{datetime.now(UTC):%Y-%m-%d %H:%M UTC}'
    document = {'homed': homed, 'rotor_zero': parameters.rotor_zero, **_belonging(parameters)}
    replace_file(path, yaml.dump(document, Dumper=Dumper, sort_keys=False).encode())


def read_home(path: Path, parameters: NodeParameters) -> tuple[float, str] | None:
    """Read `rotor_zero`, rad, from a file of at most 256 KiB, and when it was set.

    None if there is no file.

    Raises:
        ConfigError: if it cannot be used, or its zero is of another gear than that of the
            parameters, of another joint or of another kind of encoder.
    """
    if not path.exists():
        return None
    document = read_yaml(path, ConfigError)
    found = document if isinstance(document, dict) else {}
    for name, value in _belonging(parameters).items():
        if found.get(name) != value:
            raise ConfigError(f'{path}: its {name} is {found.get(name)!r:.80}, not {value!r}')
    zero: Any = found.get('rotor_zero')
    if fault := PARAMETERS['rotor_zero'].fault('rotor_zero', zero):
        raise ConfigError(f'{path}: {fault:.200}')
    return zero, str(found.get('homed'))[:80]


def _belonging(parameters: NodeParameters) -> dict[str, Any]:
    """What the zero belongs to, by names of parameters."""
    names = 'rotor_joint', 'rotor_direction', 'rotor_encoder'
    own = {name: getattr(parameters, name) for name in names}
    ratio = str(parameters.gear.gear_ratio)
    return {'schema': 'gear_kinematics/home/1', 'gear_ratio': ratio, **own}
