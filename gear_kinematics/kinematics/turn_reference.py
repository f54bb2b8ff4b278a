# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Which turn of the rotor an absolute encoder at the output shows, or that it leaves it open.

The rotor angle is 2π k + a with a known angle a and an unknown integer k. With i = N/D in lowest
terms, the output angle within its turn, 2π k D/N + a D/N modulo 2π, takes |N| values that are
2π/|N| apart, so that it tells k modulo |N|, which is D turns of the output.
"""

import math

from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN


def margin(ratio: GearRatio) -> float:
    """Half the distance of the output angles that belong to one rotor angle, rad: π/|N|."""
    return math.pi / abs(ratio.numerator)


def nearest_turns(ratio: GearRatio, error: float) -> tuple[int, float]:
    """Find the turns of the rotor that explain an error of the output best.

    Args:
        ratio: of the gear.
        error: measured less ideal output angle, rad, modulo 2π.

    Returns:
        Turns to add to the rotor's count, modulo |N|: in (-|N|/2, |N|/2]; and the error that they
        leave, rad, within ±`margin`.
    """
    n = abs(ratio.numerator)
    # One step of the output angle is so many turns of the rotor; pow(..., 1) is 0.
    turns_per_step = pow(ratio.denominator if ratio > 0 else -ratio.denominator, -1, n)
    steps = math.floor(error * n / TURN + 0.5)
    turns = steps * turns_per_step % n
    return turns - n * (2 * turns > n), error - TURN * steps / n


def unambiguous(distance: float, budget: float, limit: float) -> bool:
    """Whether the nearest turns are the true ones; all in rad.

    They are if the budget, what measured and true angle may differ by, explains their distance,
    and could not explain that of others, which is at least the limit, the margin.
    """
    return abs(distance) <= budget < limit


def about_zero(ratio: GearRatio, turns: int, output_angle: float) -> int:
    """Return those turns, modulo |N|, that bring the output within ±D/2 turns of angle 0.

    `output_angle`, rad, is the ideal one without them.
    """
    periods = output_angle / (TURN * ratio.denominator) + turns / ratio.numerator
    return turns - ratio.numerator * math.floor(periods + 0.5)
