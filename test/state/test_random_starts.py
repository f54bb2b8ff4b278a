# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""200,000 random starts: turns are never wrong within the budget, and refused beyond it.

The truth is simulated in integers: with i = N/D, T turns of the rotor are TD/N of the output.
"""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.turn_reference import decide

STARTS = 10_000  # for each of 20 ratios
GAP = 0.1  # s
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


@pytest.mark.slow
@pytest.mark.parametrize('ratio', RATIOS, ids=str)
def test_turns_are_the_true_ones_or_refused(ratio):
    random = np.random.default_rng(ratio.numerator % 1000 + ratio.denominator)
    n = abs(ratio.numerator)
    margin = math.pi / n
    settings = replace(
        NodeParameters.load(),
        gear_ratio=str(ratio),
        rotor_encoder='single_turn',
        transmission_error_limit=0.01 * margin,
        transmission_error_max_gap=GAP,
    )
    truth, count = random.integers(-5 * n, 5 * n + 1, (2, STARTS)).tolist()
    scatters, delays = min(margin, math.pi / 2) * random.uniform(0.0, 0.6, (2, STARTS))
    budgets = 0.01 * margin + scatters + delays
    # Anywhere within the budget, just inside, just outside, and as far as the next turn allows.
    just = 1.0 + random.choice((-1e-6, 1e-6), STARTS)
    sizes = np.where(random.random(STARTS) < 0.5, random.uniform(0.0, 1.0, STARTS), just) * budgets
    beyond = random.random(STARTS) < 0.2
    sizes[beyond] = random.uniform(budgets, np.maximum(2.0 * margin - budgets, budgets))[beyond]
    errors = sizes * random.choice((-1.0, 1.0), STARTS)
    errors += math.tau * random.integers(-2, 3, STARTS)
    angles = random.uniform(-math.pi, math.pi, STARTS)
    columns = (column.tolist() for column in (budgets, sizes, errors, angles, scatters, delays))
    times_found = 0
    for true, counted, budget, size, error, angle, scatter, delay in zip(
        truth, count, *columns, strict=True
    ):
        moved = within_turn(ratio, true, angle) - within_turn(ratio, counted, angle)
        samples = [
            ErrorSample(0, error + moved + noise, counted, angle, 0, speed)
            for noise, speed in ((scatter, -delay / GAP), (-scatter, 0.0))
        ]
        decision = decide(samples, settings)
        assert decision.unambiguous == (size < budget < margin)
        assert not decision.unambiguous or (decision.turns - (true - counted)) % n == 0
        times_found += decision.unambiguous
    assert times_found > STARTS // 4
