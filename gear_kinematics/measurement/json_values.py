# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The conversion of results to JSON."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from gear_kinematics.measurement.sentences import Observed
from gear_kinematics.statistics.uncertainty import Estimate


def plain(value: Any) -> Any:
    """Convert dataclasses to mappings for JSON, without arrays, and observations to text."""
    match value:
        case Estimate():
            return {
                'value': value.value,
                'standard_uncertainty': value.standard,
                'degrees_of_freedom': value.degrees_of_freedom,
                'expanded_uncertainty': value.uncertainty,
                'repeats': value.repeats,
            }
        case Fraction() | Observed():
            return str(value)
        case Mapping():
            return {name: plain(item) for name, item in value.items()}
        case tuple() | list():
            return [plain(item) for item in value]
    if is_dataclass(value):
        members = ((field.name, getattr(value, field.name)) for field in fields(value))
        return {name: plain(it) for name, it in members if not isinstance(it, np.ndarray)}
    return value
