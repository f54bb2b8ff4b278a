# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Uncertainties from blocks, elimination of a recording's own unknowns, prediction of folds."""

import numpy as np
import pytest

from gear_kinematics.measurement.calibration.selection import (
    NormalEquations,
    blocks_of,
    is_as_good,
    standard_error,
    widening,
)


def test_standard_error_is_that_of_the_mean_of_independent_blocks():
    values = np.array([1.0, 3.0] * 12)
    # Neighbours together are equal, so that single blocks have the greatest error.
    error = standard_error(values)
    assert error == (pytest.approx(np.std(values, ddof=1) / 24**0.5), 23)


def test_standard_error_of_neighbours_that_are_alike_is_that_of_their_groups():
    groups = np.random.default_rng(0).standard_normal(6)
    error = standard_error(np.repeat(groups, 4))
    assert error == (pytest.approx(np.std(groups, ddof=1) / 6**0.5), 5)


def test_a_model_is_as_good_unless_it_is_worse_in_most_blocks():
    random = np.random.default_rng(2)
    best = 1.0 + 0.1 * random.standard_normal(24)
    assert is_as_good(best, best)
    assert is_as_good(best + 0.1 * random.standard_normal(24), best)
    assert not is_as_good(best + 0.1, best)


def test_intervals_hold_on_other_errors_of_a_random_scale():
    random = np.random.default_rng(3)
    inside, plain = [], []
    for _ in range(2000):
        first, second = random.standard_normal((2, 6))
        errors = np.repeat(first**2, 4)
        half_width = 1.96 * np.sqrt(errors.mean())
        inside.append(np.abs(second) <= half_width * widening(errors))
        plain.append(np.abs(second) <= half_width)
    assert np.mean(plain) < 0.91
    assert 0.93 <= np.mean(inside) <= 0.985


@pytest.fixture
def line():
    """Give columns (x, zero, drift, error) of two recordings: slope 2, and each its own zero."""
    random = np.random.default_rng(4)
    x = random.standard_normal((2, 480))
    drift = np.linspace(-1.0, 1.0, 480)
    error = 2.0 * x + np.array([[5.0], [-3.0]]) + 0.5 * drift
    blocks = blocks_of([480, 480])

    def columns(block):
        rows = block.rows
        count = rows.stop - rows.start
        return np.column_stack([
            x[block.recording, rows], np.ones(count), drift[rows], error[block.recording, rows],
        ])  # fmt: skip

    return np.array([c.T @ c for c in map(columns, blocks)]), blocks


def test_blocks_cover_all_samples_once():
    blocks = blocks_of([1000, 100, 5])
    for recording, count in enumerate([1000, 100, 5]):
        rows = [b.rows for b in blocks if b.recording == recording]
        assert len(rows) >= 2
        assert [k for part in rows for k in range(part.start, part.stop)] == list(range(count))


def test_prediction_has_the_zero_of_what_was_left_out_only_if_it_is_to_be_a_check(line):
    products, blocks = line
    halves = np.array([k % 12 >= 6 for k in range(len(blocks))], int)
    own = halves + 2 * np.array([block.recording for block in blocks])
    errors = {
        checked: NormalEquations(products, blocks, halves, 1, (0, 1), (0,), groups).errors([0])
        for checked, groups in ((False, None), (True, own))
    }
    # The drift of ±0.5 over a recording remains: its variance is 1/12, in a half of it 1/48.
    assert errors[False].mean() == pytest.approx(1.0 / 12.0, rel=0.01)
    assert errors[True].mean() == pytest.approx(1.0 / 48.0, rel=0.01)


def test_a_column_that_the_zero_explains_gets_no_coefficient(line):
    products, blocks = line
    place = [1, 0, 1, 2, 3]  # the zero's column as a common one, too
    equations = NormalEquations(
        products[:, place][:, :, place], blocks, np.arange(len(blocks)), 2, (0, 1), (0,)
    )
    assert equations.solve([0, 1])[0] == pytest.approx([0.0, 2.0], abs=1e-5)
