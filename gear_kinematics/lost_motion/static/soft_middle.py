"""The middle of a spring in which it yields much more easily than beyond: play, or nearly so."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.ramps import Array
from gear_kinematics.lost_motion.static.springs import Fitting, Model, Springs
from gear_kinematics.state.uncertainty import Estimate

SOFTEST = 0.2
"""Play: the gear yields at less than this share of its stiffness beyond."""
_POINTS = 4001
"""Angles at which the curve of a model is examined."""
_ROUNDS = 4
"""Of finding a soft middle by the stiffness beyond it."""


class SoftMiddle(NamedTuple):
    """The middle in which a spring is less stiff than a share of the rest of it."""

    widths: Array
    """(loops,), rad; 0 where there is none."""
    ratio: float
    """Stiffness within over that beyond."""
    beyond: float
    """N·m/rad."""

    @property
    def width(self) -> Estimate:
        """The mean of the widths, rad."""
        return Estimate.of_mean(self.widths.tolist())

    @property
    def least(self) -> float:
        """Lower end of the interval of the width, rad."""
        return self.width.value - (self.width.uncertainty or 0.0)

    @property
    def most(self) -> float:
        """Upper end, rad."""
        return self.width.value + (self.width.uncertainty or 0.0)


def soft_middle(
    model: Model, springs: Springs, fitting: Fitting, lines: Midlines, share: float = SOFTEST
) -> SoftMiddle:
    """Find the soft middle of the curve of each loop, around the centre of its gap.

    Args:
        model: that describes the curves.
        springs: the model, fitted to each loop.
        fitting: that has fitted it.
        lines: which it fits.
        share: of the stiffness beyond, below which a spring is soft.
    """
    angle = np.linspace(lines.angle[:, 0], lines.angle[:, -1], _POINTS, axis=1)
    steps = (angle[:, -1] - angle[:, 0]) / (_POINTS - 1)
    rises = np.diff(fitting.load(model, springs, angle), axis=1)
    found = []
    for own, step, centre, start, gap in zip(
        rises, steps, springs.centre, angle[:, 0], springs.gap, strict=True
    ):
        middle = int(np.clip((centre - start) / step, 0, len(own) - 1))
        # The stiffest quarter is beyond, if anything is.
        soft = own < np.quantile(own, 0.75)
        for _ in range(_ROUNDS):
            beyond = float(np.sum(own[~soft])) / (max(np.count_nonzero(~soft), 1) * step)
            soft = _around(own < share * beyond * step, middle)
        width = np.count_nonzero(soft) * step
        # The edges of a gap lie between the points.
        width = gap if abs(width - gap) < 3.0 * step else width
        found.append((width, float(np.sum(own[soft])), beyond))
    widths, within, stiffness = np.transpose(found)
    total, beyond = float(np.sum(widths)), float(np.mean(stiffness))
    ratio = float(np.sum(within)) / total / beyond if total and beyond else 0.0
    return SoftMiddle(widths, ratio, beyond)


def _around(marked: NDArray[np.bool_], middle: int) -> NDArray[np.bool_]:
    """Keep of what is marked the run around the middle."""
    off = np.flatnonzero(~marked)
    before, after = off[off <= middle], off[off >= middle]
    low = int(before[-1]) + 1 if len(before) else 0
    high = int(after[0]) if len(after) else len(marked)
    kept = np.zeros_like(marked)
    kept[low:high] = True
    return kept
