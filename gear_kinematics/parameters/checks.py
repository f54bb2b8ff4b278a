# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Checks of values beyond type and bounds; each raises ValueError."""

import math
from collections.abc import Sequence

from gear_kinematics.kinematics.rotor_turns import TURN

_MOST_NAMES = 256
_LEAST_RANGE = 0.5  # rad, of an encoder: ten times the noise that is expected of any


def names(values: Sequence[str]) -> None:
    """Refuse more branches or actuators than any robot has, which would fill the memory."""
    if len(values) > _MOST_NAMES:
        raise ValueError(f'at most {_MOST_NAMES} names, not {len(values)}')


def stiffness(values: Sequence[float]) -> None:
    """Refuse a list of stiffnesses that are not one or two, or not finite or negative."""
    if len(values) not in {1, 2} or not all(0.0 <= each < math.inf for each in values):
        raise ValueError(f'one or two values of at least 0, not {[*values]}')


def output_range(values: Sequence[float]) -> None:
    """Refuse a range of angles, rad, that is neither empty nor ascending and less than a turn."""
    if values and not (len(values) == 2 and 0.0 < values[1] - values[0] < TURN):  # noqa: PLR2004
        raise ValueError(f'[] or two angles, ascending and less than 2π apart, not {[*values]}')


def encoder_range(value: float) -> None:
    """Refuse a range of an encoder, rad, that noise alone would cross."""
    if 0.0 < value < _LEAST_RANGE:
        raise ValueError(f'0, or at least {_LEAST_RANGE} rad, not {value}')


def factor(value: float) -> None:
    """Refuse a factor of 0, which would make every value 0."""
    if not value:
        raise ValueError(f'must not be {value}, as every value would be 0')
