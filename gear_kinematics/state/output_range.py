# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The range of the output, `output_range`: which of its turns are possible."""

import math

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.statuses import Condition, Fact


def range_fault(
    parameters: NodeParameters, angle: float, tolerance: float, period: float = math.inf
) -> Fact | None:
    """Return how an output angle within a tolerance contradicts the range, if it does.

    Where the angle repeats after a period, rad, both ends of the range may be possible.
    """
    if not parameters.output_range:
        return None
    low, high = parameters.output_range
    possible = [
        low - tolerance <= each <= high + tolerance
        for each in (angle, angle - period, angle + period)
    ]
    if possible == [True, False, False]:
        return None
    which = Condition.AT_EITHER_END if possible[0] else Condition.OUTSIDE
    at, low, high = (math.degrees(each) for each in (angle, low, high))
    return which(angle_deg=at, low_deg=low, high_deg=high)
