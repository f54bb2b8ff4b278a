"""Fields that are recorded in another unit, with another sign, or of another shaft."""

import math

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN

Array = NDArray[np.float64]

_SCATTER = 1e-5
"""Greatest deviation of all values together from a constant factor, relative to them."""


class FactorFit:
    """The constant factor between recorded and expected values of a field, from running sums."""

    def __init__(self) -> None:
        self._sums = np.zeros(3)  # of expected², expected · recorded, recorded²

    def update(self, recorded: Array, expected: Array) -> None:
        """Add values (n,); those that are not finite are left out."""
        usable = np.isfinite(recorded) & np.isfinite(expected)
        x, y = expected[usable], recorded[usable]
        with np.errstate(over='ignore'):
            self._sums += (x @ x, x @ y, y @ y)

    def factor(self) -> float | None:
        """Return recorded / expected; None if it is not constant, or 1."""
        with np.errstate(all='ignore'):  # garbage has no factor
            xx, xy, yy = self._sums
            factor = float(xy / xx)
            scatter = yy - factor * xy
        if not (abs(factor - 1.0) > _SCATTER and scatter <= _SCATTER**2 * yy):
            return None
        return factor if math.isfinite(factor) else None


def describe(field: str, factor: float, ratio: GearRatio) -> str:
    """Say by which factor the velocity or the effort is wrong, and how that comes.

    Args:
        field: `velocity` or `effort`.
        factor: recorded / expected.
        ratio: of the gear.
    """
    of_rotor = float(ratio) if field == 'velocity' else 1.0 / float(ratio)
    reasons = {
        -1.0: 'the sign is flipped',
        of_rotor: 'it is that of the rotor',
        -of_rotor: 'it is that of the rotor, with the sign flipped',
    }
    if field == 'velocity':
        reasons |= {
            math.degrees(1.0): 'it is in degrees per second',
            60.0 / TURN: 'it is in revolutions per minute',
            1.0 / TURN: 'it is in revolutions per second',
        }
    near = (text for known, text in reasons.items() if math.isclose(factor, known, rel_tol=1e-4))
    reason = next(near, '')
    return f'the recorded {field} is {factor:.6g} times the expected one{reason and ": "}{reason}'
