# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Elimination of a recording's own unknowns, prediction of folds."""

import numpy as np
import pytest

from gear_kinematics.statistics.normal_equations import NormalEquations, block_bounds


@pytest.fixture
def line():
    """Give columns (x, zero, error) of a slope of 2 whose zero jumps in the middle, in blocks."""
    x = np.random.default_rng(4).standard_normal((24, 40))
    error = 2.0 * x + np.repeat([5.0, 6.0], 12)[:, None]
    columns = np.stack([x, np.ones_like(x), error], axis=2)
    return np.swapaxes(columns, 1, 2) @ columns


def test_blocks_cover_all_samples_once():
    for bounds, count in zip(block_bounds([1000, 100, 5]), [1000, 100, 5], strict=True):
        assert len(bounds) >= 3
        assert bounds == sorted({0, *bounds, count})


def test_halves_are_predicted_with_the_zero_of_the_other_one(line):
    halves = NormalEquations(line, np.repeat([0, 1], 12))
    assert halves.solve([0, 1])[1:] == pytest.approx(np.array([[2.0, 6.0], [2.0, 5.0]]), abs=1e-6)
    assert halves.errors([0, 1]) == pytest.approx(np.full(24, 40.0), rel=1e-5)  # 1 of each sample


def test_a_column_that_another_explains_gets_half_of_it(line):
    place = [1, 0, 1, 2]
    equations = NormalEquations(line[:, place][:, :, place])
    assert equations.solve([0, 1, 2])[0] == pytest.approx([2.75, 2.0, 2.75], abs=0.02)


def test_influences_are_those_of_blocks_left_out(line):
    equations = NormalEquations(line)
    exact, nearly = equations.solve([0, 1]), equations.first_order([0, 1])
    assert nearly[0] == pytest.approx(exact[0], rel=1e-12)
    assert nearly[1:] - nearly[0] == pytest.approx(exact[1:] - exact[0], rel=0.15, abs=1e-4)


@pytest.mark.parametrize('seed', range(40))
def test_what_is_left_where_coefficients_may_not_be_positive(seed):
    # Columns that are nearly alike, as those of stop operators are.
    optimize = pytest.importorskip('scipy.optimize')
    rng = np.random.default_rng(seed)
    columns = np.cumsum(rng.standard_normal((500, 20)), axis=1) + 30.0
    error = columns @ rng.standard_normal(20) + rng.standard_normal(500)
    blocks = np.array_split(np.column_stack([columns, error]), 24)
    equations = NormalEquations(np.array([block.T @ block for block in blocks]))
    limited = np.arange(20) % 4 > 0
    bounds = np.where(limited, 0.0, np.inf)
    known = optimize.lsq_linear(columns, error, (-np.inf, bounds), method='bvls', tol=1e-14)
    np.testing.assert_array_equal(equations.not_above_zero(limited), known.active_mask == 0)
    chosen, groups = range(2, 20), [[2], [5, 6], [19], [8, 12, 17]]
    fewer = [equations.errors([k for k in chosen if k not in group]) for group in groups]
    np.testing.assert_allclose(equations.errors_without(chosen, groups), fewer, rtol=1e-6)
