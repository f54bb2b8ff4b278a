# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the steps of an encoder add to the uncertainty of what is computed from its readings."""

import math
from collections.abc import Sequence

from gear_kinematics.correction.uncertainty import deviation, resolution


def hidden_resolution(step: float, repeats: Sequence[float], readings: int) -> float:
    """Standard uncertainty by the steps of an encoder that the scatter of repeats does not show.

    Repeats that scatter over steps are rounded differently. With normal scatter of the standard
    deviation s, exp(-2π²(s/step)²) is the most that remains in their mean: B. Widrow, I. Kollár,
    M.-C. Liu, IEEE Trans. Instrum. Meas. 45 (1996) 353.

    Args:
        step: of a reading.
        repeats: at least one, each a sum or difference of readings.
        readings: their number in each repeat.
    """
    if not step or len(repeats) == 1:
        return math.sqrt(readings) * resolution(step)
    turns = math.pi * deviation(repeats) / math.sqrt(readings) / step
    return math.sqrt(readings) * resolution(step) * math.exp(-2.0 * turns * turns)


def slope_resolution(step: float, run: float, slope: float) -> float:
    """Standard uncertainty of a slope by the steps of an encoder.

    The line goes through many readings, of which those within a step count as one; over less than
    six steps, the line counts as one through its ends.

    Args:
        step: of a reading.
        run: length of the line on the other axis.
        slope: of the line, in the unit of the step over that of the run.
    """
    if not step:
        return 0.0
    steps = max(6.0, abs(slope) * run / step)
    return resolution(step) / run * math.sqrt(12.0 / steps)
