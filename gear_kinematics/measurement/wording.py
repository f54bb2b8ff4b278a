# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The formatting of measured quantities."""

import math

from gear_kinematics.report.document import number
from gear_kinematics.statistics.uncertainty import COVERAGE, Estimate

ARC_MINUTES = 60.0 * 180.0 / math.pi  # per radian; catalogues give lost motion in arc minutes
PERCENT = f'{100.0 * COVERAGE:g} %'  # probability with which an interval contains the value
_EXACT = 1e-5  # relative uncertainty below which values are rounded to six digits
_TINY = 1e-9  # uncertainty below which small values are written with an exponent


def plus_minus(estimate: Estimate | None, scale: float = 1.0) -> str:
    """Format a quantity with its uncertainty, if known, to the second digit of the latter."""
    if estimate is None:
        return ''
    value, spread = estimate.value * scale, estimate.uncertainty
    if spread is None:
        return number(value, 4)
    if not spread:
        return f'{number(value, 4)} ± 0'
    spread *= scale
    if spread < max(abs(value) * _EXACT, _TINY):
        return f'{number(value, 6)} ± {number(spread, 2)}'
    decimals = max(0, 1 - math.floor(math.log10(spread)))
    # Adding 0.0 takes the sign from a zero.
    return f'{round(value, decimals) + 0.0:.{decimals}f} ± {spread:.{decimals}f}'


def shown(value: str | float | None) -> str:
    """Format the value of a parameter; None if it is undetermined."""
    if value is None:
        return 'undetermined'
    return f'{value:.6g}' if isinstance(value, float) else str(value) or "''"
