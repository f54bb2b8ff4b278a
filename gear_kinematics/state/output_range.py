# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The range of the output, `output_range`: which of its turns are possible."""

import math

from gear_kinematics.parameters import NodeParameters


def range_fault(
    parameters: NodeParameters, angle: float, tolerance: float, period: float = math.inf
) -> str:
    """Say how an output angle within a tolerance contradicts the range; '' if it does not.

    Where the angle repeats after a period, rad, both ends of the range may be possible.
    """
    if not parameters.output_range:
        return ''
    low, high = parameters.output_range
    possible = [
        low - tolerance <= each <= high + tolerance
        for each in (angle, angle - period, angle + period)
    ]
    if possible == [True, False, False]:
        return ''
    how = 'may be at either end of' if possible[0] else 'is outside of'
    ends = f'{math.degrees(low):.2f}° to {math.degrees(high):.2f}°'
    return f'the output, at {math.degrees(angle):.2f}°, {how} output_range, {ends}'
