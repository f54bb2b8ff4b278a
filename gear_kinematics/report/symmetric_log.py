"""A scale that is logarithmic on both sides of zero, and linear near zero."""

import math
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.report.document import Array, Panel, number

_TICKS = 4
"""Most ticks on each side of zero."""
_SMALLEST = 1e-300
"""Smallest divisor without overflow."""


@dataclass(frozen=True, slots=True)
class SymmetricLog:
    """The scale of a y axis."""

    smallest: float
    """The power of ten at which the logarithmic part starts."""
    greatest: float

    @classmethod
    def of(cls, panel: Panel) -> Self:
        """Choose the scale for all values and levels of a panel."""
        levels = [level for level, _ in panel.levels]
        return cls.fit(np.concatenate([*(line.y for line in panel.lines), levels]))

    @classmethod
    def fit(cls, values: ArrayLike) -> Self:
        """Choose the scale that shows all finite magnitudes within twelve decades."""
        sizes = np.abs(values)
        sizes = sizes[np.isfinite(sizes) & (sizes > 0.0)]
        if not len(sizes):
            sizes = np.ones(1)
        greatest = max(float(sizes.max()), _SMALLEST)
        least = max(float(sizes.min()), 1e-12 * greatest, _SMALLEST)
        # At least one decade, even for a single magnitude.
        return cls(10.0 ** (_decade(least) - (_decade(least) == _decade(greatest))), greatest)

    def height(self, values: ArrayLike) -> Array:
        """Return the heights of values."""
        return np.copysign(np.log10(1.0 + np.abs(values) / self.smallest), values)

    def ticks(self) -> list[float]:
        """Return powers of ten up to the greatest value, at even distances."""
        lowest, highest = _decade(self.smallest), _decade(self.greatest)
        step = max(1, math.ceil((highest - lowest) / _TICKS))
        return [10.0**decade for decade in range(highest, lowest, -step)]

    def axis(self, panel: Panel) -> dict[str, Any]:
        """Return the range and the ticks of the axis of a panel."""
        negative = any(np.nanmin(line.y, initial=0.0) < 0.0 for line in panel.lines)
        signs = (-1, 1) if negative else (1,)
        ticks = sorted({0.0, *(sign * tick for sign in signs for tick in self.ticks())})
        reach = 1.1 * float(self.height(self.greatest))
        return {
            'tickvals': self.height(ticks).tolist(),
            'ticktext': [number(tick) for tick in ticks],
            'range': [-reach if negative else -0.1 * reach, reach],
        }


def _decade(value: float) -> int:
    # From the text, as the logarithm of 1e-9 may be slightly less than -9.
    return int(f'{value:e}'.partition('e')[2])
