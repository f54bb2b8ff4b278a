# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameter `meshes`: where viewers find the meshes of the URDF."""

import re
from typing import Any

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.share import PACKAGE, share_directory

AUTO = 'auto'  # value that selects the installed meshes, if there are any for this mechanism
NONE = 'none'  # value that selects simple shapes
_URI = re.compile(r'[A-Za-z][A-Za-z0-9+.-]*://[!-~]+')


def check(value: str) -> None:
    """Raise ValueError unless it is a value of the parameter, or the URI of a folder."""
    if value not in {AUTO, NONE} and not _URI.fullmatch(value):
        raise ValueError(
            f'must be {AUTO}, {NONE} or a URI such as package://my_robot/meshes, not {value!r}'
        )


def folder_name(mechanism: Mechanism, module: float) -> str:
    """Name the folder of a mechanism's meshes below `meshes` of the package's share directory.

    The name contains every size that determines the meshes, and no dots: foxglove_bridge serves
    no folders with dots in their names.
    """
    teeth = mechanism.ring_teeth, mechanism.satellite_teeth
    return re.sub(r'\W', '_', '_'.join(map(repr, (*teeth, mechanism.eccentricity, module))))


def folder_uri(value: Any, mechanism: Mechanism, module: float) -> str:
    """Return the URI of the folder with the meshes, for a value of the parameter; '' for none."""
    if value == AUTO:
        name = folder_name(mechanism, module)
        installed = (share_directory() / 'meshes' / name).is_dir()
        return f'package://{PACKAGE}/meshes/{name}' if installed else ''
    return '' if value == NONE else str(value).rstrip('/')
