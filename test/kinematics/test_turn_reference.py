# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Turns from the angle of the output: never wrong within the budget, refused beyond it.

The truth is simulated in integers: with i = N/D, T turns of the rotor are TD/N of the output.
"""

import math
from fractions import Fraction

import numpy as np
import pytest

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.kinematics.turn_reference import (
    about_zero,
    margin,
    nearest_turns,
    unambiguous,
)

STARTS = 50_000  # for each of 20 ratios
_random = np.random.default_rng(36)
RATIOS = [
    *map(Fraction, ('-19', '36/5', '1457/26', '101', '1/3', '-1457/26', '121', '-1/3', '1', '-1')),
    *(Fraction(*map(int, _random.integers((-3000, 1), (0, 60)))) for _ in range(5)),
    *(Fraction(*map(int, _random.integers((1, 1), (3000, 60)))) for _ in range(5)),
]


def within_turn(ratio, turns, angle):
    """Return the output angle that belongs to turns and angle of the rotor, modulo 2π."""
    sign, n, d = ratio.numerator // abs(ratio.numerator), abs(ratio.numerator), ratio.denominator
    return math.tau * (sign * d * turns % n) / n + angle * (sign * d / n)


@pytest.mark.parametrize('ratio', RATIOS, ids=str)
def test_turns_are_the_true_ones_or_refused(ratio):
    random = np.random.default_rng(ratio.numerator % 1000 + ratio.denominator)
    gear, n = GearRatio(ratio), abs(ratio.numerator)
    limit = math.pi / n
    assert margin(gear) == limit
    truth, count = random.integers(-5 * n, 5 * n + 1, (2, STARTS)).tolist()
    budgets = limit * random.uniform(0.01, 1.2, STARTS)
    # Anywhere within the budget, just inside, just outside, and as far as the next turn allows.
    just = 1.0 + random.choice((-1e-6, 1e-6), STARTS)
    sizes = np.where(random.random(STARTS) < 0.5, random.uniform(0.0, 1.0, STARTS), just) * budgets
    beyond = random.random(STARTS) < 0.2
    sizes[beyond] = random.uniform(budgets, np.maximum(2.0 * limit - budgets, budgets))[beyond]
    errors = sizes * random.choice((-1.0, 1.0), STARTS)
    errors += math.tau * random.integers(-2, 3, STARTS)
    angles = random.uniform(-math.pi, math.pi, STARTS)
    columns = (column.tolist() for column in (budgets, sizes, errors, angles))
    times_found = 0
    for true, counted, budget, size, error, angle in zip(truth, count, *columns, strict=True):
        moved = within_turn(ratio, true, angle) - within_turn(ratio, counted, angle)
        turns, distance = nearest_turns(gear, error + moved)
        found = unambiguous(distance, budget, limit)
        assert found == (size < budget < limit)
        assert not found or (turns - (true - counted)) % n == 0
        times_found += found
    assert times_found > STARTS // 3


@pytest.mark.parametrize('ratio', RATIOS, ids=str)
def test_turns_about_zero_are_the_same_modulo_the_period(ratio):
    gear, n = GearRatio(ratio), abs(ratio.numerator)
    random = np.random.default_rng(n)
    for counted, turns in random.integers(-5 * n, 5 * n + 1, (1000, 2)).tolist():
        chosen = about_zero(gear, turns, math.tau * float(counted / ratio))
        assert (chosen - turns) % n == 0
        assert abs(counted + chosen) <= n / 2
