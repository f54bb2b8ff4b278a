"""Friction that has not built up yet after a reversal, taken out of middle lines.

P. R. Dahl, A solid friction model, Aerospace Corporation TOR-0158(3107-18)-1 (1968): after a
reversal, friction approaches its value over some way. Until then one half of a loop lies nearer
to the spring than the other, so that the friction and the load that are read are off by the same.
"""

from dataclasses import replace

import numpy as np

from gear_kinematics.lost_motion.midline import Midlines
from gear_kinematics.lost_motion.ramps import Array
from gear_kinematics.state.uncertainty import Estimate

_SHARES = np.linspace(0.1, 0.95, 18)
"""Loads, as shares of the greatest load of a loop, at which the friction is compared."""
_FAR, _NEAR = slice(0, 9), slice(-3, None)
"""Up to half of the load, where friction has built up, and above 80 %, where it may not have."""
_CLEAR = 0.02
"""Share of the friction that is missing there, if it builds up visibly."""


def without_build_up(lines: Midlines) -> tuple[Midlines, Estimate | None]:
    """Take the missing friction out of the loads, if it is significant.

    Returns:
        Middle lines with other loads, and the friction that is missing near the peaks, N·m; or
        the same ones and None.
    """
    sides = [
        (sign * load[::sign], friction[::sign], sign * load[::sign] > 0.0)
        for load, friction in zip(lines.load, lines.friction, strict=True)
        for sign in (1, -1)
    ]
    if not all(np.any(away) for _, _, away in sides):
        return lines, None
    friction = np.array([_at_shares(load[away], friction[away]) for load, friction, away in sides])
    full = np.mean(friction[:, _FAR], axis=1)
    missing = full[:, None] - friction
    near = Estimate.of_mean(np.mean(missing[:, _NEAR], axis=1).tolist())
    if near.value <= max(near.uncertainty or 0.0, _CLEAR * float(np.mean(full))):
        return lines, None
    # The longer the way since the reversal, the less is missing.
    mean = np.maximum.accumulate(np.maximum(np.mean(missing, axis=0), 0.0))
    off = [
        np.sign(load) * np.interp(np.abs(load) / np.max(np.abs(load)), _SHARES, mean)
        for load in lines.load
    ]
    return replace(lines, load=lines.load - np.array(off)), near


def _at_shares(load: Array, friction: Array) -> Array:
    """The friction at shares of the greatest load, of one side of a loop."""
    rising = np.maximum.accumulate(load)
    found: Array = np.interp(_SHARES * rising[-1], rising, friction)
    return found
