# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameters of the node and of `gearkin --config`: types, bounds, defaults and files."""

from gear_kinematics.parameters.body_parameters import BRANCH_PARAMETERS
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.node_parameters import (
    NODE,
    PARAMETERS,
    NodeParameters,
    default_config,
    default_value,
)

__all__ = [
    'BRANCH_PARAMETERS',
    'NODE',
    'PARAMETERS',
    'ConfigError',
    'NodeParameters',
    'default_config',
    'default_value',
]
