"""Friction by where the gear breaks away after a reversal of the torque."""

import numpy as np

from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.ramps import Ramps

_REACH = 4.0
"""The friction on the middle line, times this, is how far a half loop is looked at."""
_LEVELS = 200
"""Torques in it at which the angle is taken."""
_SHARES = np.linspace(0.1, 1.0, 37)
"""Where the gear may break away, as shares of twice the friction on the middle line."""


def breakaway_friction(ramps: Ramps) -> float:
    """Return half of the torque by which the gear stands still after a reversal, N·m.

    Creep widens loops as friction does, but leaves the corner where the gear begins to move in its
    place. That of a half loop is where two straight lines that meet there leave the least of its
    angles. The median of all counts; it does not exceed the friction on the middle line.
    """
    middle = float(np.median(Midlines.of(ramps.whole).friction))
    back = np.linspace(0.0, min(_REACH * middle, ramps.amplitude + middle), _LEVELS)
    corners = 2.0 * middle * _SHARES
    angles = np.array(
        [half.angle_at(half.start - np.sign(half.start) * back) for half in ramps.halves()]
    )
    bends = np.maximum(back - corners[:, None], 0.0)
    lines = [np.broadcast_to(line, bends.shape) for line in (np.ones_like(back), back)]
    bases = np.linalg.qr(np.stack([*lines, bends], axis=-1))[0]
    explained = np.sum((angles @ bases) ** 2, axis=-1)
    return 0.5 * float(np.median(corners[np.argmax(explained, axis=0)]))
