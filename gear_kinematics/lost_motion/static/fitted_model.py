"""A model, fitted to each of the loops of one amplitude, and what it leaves of them."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.static.friction import more_within
from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.ramps import Array
from gear_kinematics.lost_motion.static.soft_middle import soft_middle
from gear_kinematics.lost_motion.static.springs import Fit, Fitting, Model
from gear_kinematics.state.uncertainty import Estimate, common_part, end_resolution

_BESIDE = 6
"""Levels beside either end of a gap by which the misfit there is known."""
_MISFIT = 3.5
"""Standard uncertainty of a gap over the misfit beside it. Simulated springs that no model of the
family fits, of ramps much larger than the gap, had gaps that were wrong by 5 to 7 misfits."""
_BEYOND = 1.6
"""Share of half of a loop's angle up to which the curve of a model is drawn."""
_ANGLES = 200
"""Of that curve."""


@dataclass(frozen=True, eq=False, slots=True)
class FittedModel:
    """A model that has been fitted to each loop."""

    lines: Midlines
    stiffness: float
    """N·m/rad, beyond the gap."""
    rest: Array
    """(loops, levels), N·m, what it leaves of the loads."""
    half: float
    """rad, half of its gap."""
    off: Array
    """(levels,), rad, from the centre of the gap."""
    angles: Array
    """(n,), rad, of its curve."""
    loads: Array
    """(n,), N·m, at these angles."""

    @classmethod
    def of(cls, model: Model, fitting: Fitting, fit: Fit, lines: Midlines) -> Self | None:
        """Fit the model to each loop; None if it has no spring beyond the gap."""
        springs = fitting.each(model, fit)
        stiffness = soft_middle(model, springs, fitting, lines).beyond
        if not stiffness:
            return None
        angles = _BEYOND * lines.reach * np.linspace(-1.0, 1.0, _ANGLES)
        curves = fitting.load(model, springs, np.tile(angles, (len(lines.load), 1)))
        return cls(
            lines,
            stiffness,
            lines.load - fitting.load(model, springs, lines.angle),
            0.5 * float(np.mean(springs.gap)),
            np.mean(lines.angle - springs.centre[:, None], axis=0),
            angles,
            np.maximum.accumulate(np.mean(curves, axis=0)),
        )

    @property
    def _sides(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Which levels are beyond the gap, below and above it."""
        return self.off < -self.half - self._corner, self.off > self.half + self._corner

    @property
    def _corner(self) -> float:
        """Angle over which the ends of the gap are rounded, rad."""
        return self.lines.blur / self.stiffness

    @property
    def more_friction(self) -> Estimate | None:
        """How much the friction within the gap exceeds that beyond it, N·m."""
        within = np.abs(self.off) < self.half - self._corner
        return more_within(self.lines, within, np.logical_or(*self._sides))

    def width(self, friction: float) -> float:
        """Return the width of its loop at zero torque, rad, with a friction, N·m."""
        return float(np.ptp(np.interp([-friction, friction], self.loads, self.angles)))

    def hidden(self, excess: float, angle_step: float) -> float:
        """Return the standard uncertainty of the gap by what repeats do not show, rad.

        Args:
            excess: N·m, by which friction within the gap moves the load at each of its ends.
            angle_step: rad, between readings of the encoder.
        """
        misfit = self._misfit()
        if not misfit.size:
            return math.inf
        # Both ends have the same misfit and the same excess, but readings of their own.
        return math.hypot(
            _MISFIT * common_part(misfit),
            2.0 * excess / self.stiffness,
            math.sqrt(2.0) * end_resolution(angle_step, self.lines.reach - self.half),
        )

    def _misfit(self) -> Array:
        """Return what is left beside the gap by the stiffness there, (loops, levels), rad."""
        angle, load = np.mean(self.lines.angle, axis=0), np.mean(self.lines.load, axis=0)
        below, above = (np.flatnonzero(side) for side in self._sides)
        left = [
            self.rest[:, part] * (np.ptp(angle[part]) / rise)
            for part in (below[-_BESIDE:], above[:_BESIDE])
            if len(part) and (rise := np.ptp(load[part]))
        ]
        return np.concatenate([self.rest[:, :0], *left], axis=1)
