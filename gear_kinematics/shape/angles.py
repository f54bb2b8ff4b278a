# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Angles in degrees, minutes and seconds of arc."""

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

_Angle = TypeVar('_Angle', float, NDArray[np.float64])


def arc(angle: float) -> str:
    """Format a finite angle, rad, to a thousandth of a second of arc: -1° 02′ 03.450″."""
    thousandths = round(arc_seconds(abs(angle)) * 1000.0)
    sign = '-' if angle < 0.0 and thousandths else ''
    minutes, rest = divmod(thousandths, 60_000)
    degrees, minutes = divmod(minutes, 60)
    seconds = rest / 1000.0
    if degrees:
        return f'{sign}{degrees}° {minutes:02}′ {seconds:06.3f}″'
    if minutes:
        return f'{sign}{minutes}′ {seconds:06.3f}″'
    return f'{sign}{seconds:.3f}″'


def arc_seconds(angle: _Angle) -> _Angle:
    """Convert an angle in rad, or an array of them, to seconds of arc."""
    return angle * (3600.0 * 180.0 / math.pi)
