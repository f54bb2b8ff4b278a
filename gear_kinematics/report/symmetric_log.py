# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A scale that is logarithmic on both sides of zero, and linear near zero; the texts of ticks.

matplotlib has such a scale, but plotly has none: both draw the heights that it gives.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.report.document import Array, Panel, number

_TICKS = 4
"""Most ticks on each side of zero."""
_DECADES = 12
_SMALLEST = 1e-300
"""Smallest divisor without overflow."""
_DIGITS = 8


class SymmetricLog:
    """The scale of a y axis, for all values and levels of a panel within twelve decades."""

    def __init__(self, panel: Panel) -> None:
        levels = [level for level, _ in panel.levels]
        values = np.concatenate([*(line.y for line in panel.lines), levels])
        values = values[np.isfinite(values) & (values != 0.0)]
        sizes = np.maximum(np.abs(values), _SMALLEST) if len(values) else np.ones(1)
        self._negative = bool(np.any(values < 0.0))
        self._greatest = float(np.max(sizes))
        self._top = _decade(self._greatest)
        low = _decade(max(float(np.min(sizes)), 10.0**-_DECADES * self._greatest, _SMALLEST))
        self._bottom = min(low, self._top - 1)

    def height(self, values: ArrayLike) -> Array:
        """Return the heights of values."""
        return np.copysign(np.log10(1.0 + np.abs(values) / 10.0**self._bottom), values)

    @property
    def axis(self) -> dict[str, Any]:
        """The range and the ticks of the axis: zero, and powers of ten at even distances."""
        step = math.ceil((self._top - self._bottom) / _TICKS)
        ticks = [10.0**decade for decade in range(self._top, self._bottom, -step)]
        ticks = [*(-tick for tick in ticks if self._negative), 0.0, *reversed(ticks)]
        reach = 1.1 * float(self.height(self._greatest))
        return {
            'tickvals': self.height(ticks).tolist(),
            'ticktext': [tick_text(tick) for tick in ticks],
            'range': [-reach if self._negative else -0.1 * reach, reach],
        }


def tick_text(value: float) -> str:
    """Write the number at a tick as plotly does."""
    return number(value, _DIGITS).replace('-', '−')


def _decade(value: float) -> int:
    # From the text, as the logarithm of 1e-9 may be slightly less than -9.
    return int(f'{value:e}'.partition('e')[2])
