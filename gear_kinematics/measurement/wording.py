# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The formatting of measured quantities."""

import math
import string
from typing import Any

from gear_kinematics.report.document import number
from gear_kinematics.statistics.uncertainty import COVERAGE, Estimate

ARC_MINUTES = 60.0 * 180.0 / math.pi  # per radian; catalogues give lost motion in arc minutes
PERCENT = f'{100.0 * COVERAGE:g} %'  # probability with which an interval contains the value
_UNITS = {'si': 1.0, 'arcmin': ARC_MINUTES, 'deg': math.degrees(1.0), 'ms': 1e3}
_EXACT = 1e-5  # relative uncertainty below which it is written with an exponent
_DIGITS = 16  # which floating point has
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
        places = math.floor(math.log10(abs(value) or spread)) - math.floor(math.log10(spread))
        return f'{number(value, min(max(6, places + 2), _DIGITS))} ± {number(spread, 2)}'
    decimals = max(0, 1 - math.floor(math.log10(spread)))
    # Adding 0.0 takes the sign from a zero.
    return f'{round(value, decimals) + 0.0:.{decimals}f} ± {spread:.{decimals}f}'


def shown(value: str | float | None) -> str:
    """Format the value of a parameter; None if it is undetermined."""
    if value is None:
        return 'undetermined'
    return f'{value:.6g}' if isinstance(value, float) else str(value) or "''"


class MeasuredFormatter(string.Formatter):
    """Formats numbers and estimates in units of `_UNITS`, counts and lists."""

    def format_field(self, value: Any, spec: str) -> str:
        """Format a value as a unit with digits, the forms of a noun, or Python's own want it."""
        if isinstance(value, list):
            return ', '.join(self.format_field(each, spec) for each in value)
        if '%d' in spec:
            one, _, more = spec.partition('|')
            text = one if value == 1 else more or one
            return text % value if value else ''
        unit, _, digits = spec.partition('.')
        if unit not in _UNITS:
            return format(value, spec)
        if isinstance(value, Estimate):
            return plus_minus(value, _UNITS[unit])
        return number(value * _UNITS[unit], int(digits or 3))
