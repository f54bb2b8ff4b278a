# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Which turn of the rotor an absolute encoder at the output shows, or that it leaves it open.

The rotor angle is 2π k + a with a known angle a and an unknown integer k. With i = N/D in lowest
terms, the output angle within its turn, 2π k D/N + a D/N modulo 2π, takes |N| values that are
2π/|N| apart, so that it tells k modulo |N|, which is D turns of the output.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN

_MANY = 2**31  # the product of two smaller integers fits into 64 bits


class NearestTurns(NamedTuple):
    """The turns of the rotor that explain an error of the output best."""

    turns: Any
    """To add to the rotor's count, modulo |N|: in (-|N|/2, |N|/2]; an int, or an array of them."""
    distance: Any
    """rad, within ±`margin`: the error that they leave."""


def margin(ratio: GearRatio) -> float:
    """Half the distance of the output angles that belong to one rotor angle, rad: π/|N|."""
    return math.pi / abs(ratio.numerator)


def nearest_turns(ratio: GearRatio, error: Any) -> NearestTurns:
    """Find the turns that explain an error of the output best.

    Args:
        ratio: of the gear.
        error: measured less ideal output angle, rad, modulo 2π; a float, or an array of any shape.
    """
    n = abs(ratio.numerator)
    # One step of the output angle is so many turns of the rotor; pow(..., 1) is 0.
    turns_per_step = pow(ratio.denominator if ratio > 0 else -ratio.denominator, -1, n)
    if isinstance(error, np.ndarray):
        nearest = np.floor(error * n / TURN + 0.5)
        steps: Any = nearest.astype(np.int64).astype(np.int64 if n < _MANY else object)
    else:
        nearest = steps = math.floor(error * n / TURN + 0.5)
    turns = steps % n * turns_per_step % n
    return NearestTurns(turns - n * (2 * turns > n), error - TURN * nearest / n)


def unambiguous(distance: Any, budget: Any, limit: Any) -> Any:
    """Whether the nearest turns are the true ones; floats and arrays alike.

    They are if the budget, what measured and true angle may differ by, explains their distance,
    and could not explain that of others, which is at least the limit, the margin; all in rad.
    """
    return (abs(distance) <= budget) & (budget < limit)


def about_zero(ratio: GearRatio, turns: int, output_angle: float) -> int:
    """Return those turns, modulo |N|, that bring the output within ±D/2 turns of angle 0.

    `output_angle`, rad, is the ideal one without them.
    """
    periods = output_angle / (TURN * ratio.denominator) + turns / ratio.numerator
    return turns - ratio.numerator * math.floor(periods + 0.5)
