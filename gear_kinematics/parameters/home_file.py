# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The home file: the zero that the node keeps until its next start."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.parameters.node_parameters import PARAMETERS, NodeParameters
from gear_kinematics.parameters.yaml_file import Dumper, read_yaml

SCHEMA = 'gear_kinematics/home/1'
"""Identifies the files and their version."""
_DATE = '%Y-%m-%d %H:%M UTC'
_LONGEST_FAULT = 1000  # characters; a value in it may be as long as the file


class HomeFileError(ValueError):
    """A home file that cannot be used; the text names it and the cause."""


def home_text(parameters: NodeParameters) -> str:
    """Return the content of the file for the zero that is set now."""
    homed = {'homed': f'{datetime.now(UTC):{_DATE}}', 'rotor_zero': parameters.rotor_zero}
    document = {'schema': SCHEMA, **homed, **_gear(parameters)}
    return str(yaml.dump(document, Dumper=Dumper, sort_keys=False))


def read_home(path: Path, parameters: NodeParameters) -> tuple[float, str] | None:
    """Read `rotor_zero`, rad, from a file of at most 256 KiB, and when it was set.

    None if there is no file.

    Raises:
        HomeFileError: if it cannot be used, or its zero is of another gear than that of the
            parameters, of another joint or of another kind of encoder.
    """
    try:
        document = read_yaml(path, HomeFileError)
    except HomeFileError as error:
        if isinstance(error.__cause__, FileNotFoundError):
            return None
        raise
    if fault := _fault(document, _gear(parameters)):
        raise HomeFileError(f'{path}: {fault[:_LONGEST_FAULT]}')
    return document['rotor_zero'], document['homed']


def _gear(parameters: NodeParameters) -> dict[str, Any]:
    """What the zero depends on, by names of parameters."""
    names = 'rotor_joint', 'rotor_direction', 'rotor_encoder'
    own = {name: getattr(parameters, name) for name in names}
    return {'gear_ratio': str(parameters.gear.gear_ratio), **own}


def _fault(document: Any, gear: dict[str, Any]) -> str | None:
    """Why the document gives no zero of the gear, or None."""
    names = 'schema', 'homed', 'rotor_zero', *gear
    if not isinstance(document, dict) or document.get('schema') != SCHEMA:
        return f'no home file: its `schema` is not {SCHEMA}'
    if document.keys() != set(names):
        return f'no home file: it must have {", ".join(names)}'
    for name, value in gear.items():
        if document[name] != value:
            return f'homed with {name} {document[name]!r}, not with {value!r}'
    try:
        datetime.strptime(document['homed'], _DATE).replace(tzinfo=UTC)
    except (TypeError, ValueError):
        return 'homed must be a date such as 2026-03-01 12:00 UTC'
    return PARAMETERS['rotor_zero'].fault('rotor_zero', document['rotor_zero'])
