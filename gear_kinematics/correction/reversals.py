# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Separation of lost motion on reversals from a delay between the stamps of the encoders.

Both make the error of backward motion exceed that of forward motion at the same output angle. Lost
motion does so by a constant, a delay τ in proportion to the speed: an output angle that is stamped
late by τ lags by its speed times τ. So over the common angles

    error backward - error forward = lost motion + τ (speed forward - speed backward)

which is a straight line over the difference of the signed speeds.
"""

from dataclasses import dataclass

import numpy as np

from gear_kinematics.statistics.normal_equations import Array, NormalEquations
from gear_kinematics.statistics.uncertainty import Estimate, jackknife

_BLOCKS = 20  # blocks of angles; errors within a block may be correlated, those of blocks are not
_LEAST = 3  # least number of blocks for a straight line and its scatter
_SPREAD = 0.01  # least standard deviation of the speed, over its mean, that shows a delay
_STEADY = 0.02  # greatest share of noise in the variance of the speed; noise reduces the delay


@dataclass(frozen=True, slots=True)
class Reversals:
    """Differences between both directions of motion."""

    difference: Estimate  #: mean error backward minus forward, rad: lost motion, delay times speed
    lost_motion: Estimate | None  #: rad; None if the speed varies too little to tell a delay
    delay: Estimate | None  #: of the stamps of the measured angles, s; None in the same case


def separate(difference: Array, speed: Array) -> Reversals | None:
    """Separate lost motion from a delay, at angles that both directions cover, in their order.

    The uncertainties are those of a jackknife that leaves out one block of angles at a time. The
    result is None without common angles.

    Args:
        difference: error of backward minus forward motion, (n,), rad.
        speed: speed of forward minus that of backward motion, (n,), rad/s.
    """
    if not len(speed):
        return None
    columns = np.stack([np.ones(len(speed)), speed, difference], axis=1)
    parts = np.array_split(columns, min(_BLOCKS, len(columns)))
    rows = np.array([np.sqrt(len(part)) * part.mean(axis=0) for part in parts])
    equations = NormalEquations(rows[:, :, None] * rows[:, None, :])
    mean = jackknife(equations.solve([0])[:, 0])
    if not tells_delay(speed, rows[:, 1] / rows[:, 0]):
        return Reversals(mean, None, None)
    return Reversals(mean, *(jackknife(fits) for fits in equations.solve([0, 1]).T))


def tells_delay(speed: Array, means: Array) -> bool:
    """Return whether speeds, (n,), and their means in blocks, vary by more than noise.

    Otherwise a delay is inseparable from lost motion.
    """
    if len(means) <= _LEAST:
        return False
    # Second differences contain hardly anything of a motion.
    noise = np.var(np.diff(speed, 2)) / 6.0 * len(means) / len(speed)
    variance = np.var(means)
    return bool(variance > (_SPREAD * np.mean(means)) ** 2 and noise <= _STEADY * variance)
