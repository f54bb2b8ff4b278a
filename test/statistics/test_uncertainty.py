# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Uncertainties against the GUM's own tables and examples, and against mpmath."""

import math

import mpmath
import numpy as np
import pytest

from gear_kinematics.statistics.uncertainty import (
    Component,
    Estimate,
    jackknife,
    standard_error,
    student_t,
)


@pytest.mark.parametrize('degrees', [1, 2, 3, 4, 7, 12, 51, 400, 3001])
def test_student_t_leaves_a_twentieth_outside(degrees):
    t = mpmath.mpf(student_t(degrees))
    outside = mpmath.betainc(
        mpmath.mpf(degrees) / 2, 0.5, 0, degrees / (degrees + t * t), regularized=True
    )
    assert float(outside) == pytest.approx(0.05, rel=1e-12)


def test_student_t_of_many_degrees_is_that_of_the_normal_distribution():
    normal = math.sqrt(2) * float(mpmath.erfinv(0.95))
    assert student_t(10**9) == student_t(10_000) == pytest.approx(normal, rel=1e-15)
    assert student_t(9_999) == pytest.approx(normal, rel=2e-4)


def test_example_of_the_guide():
    # GUM G.4.1, example: relative standard uncertainties of three factors, in percent.
    parts = (Component(0.25, 9), Component(0.57, 4), Component(0.82, 14))
    estimate = Estimate.of_mean([100.0, 100.0], *parts)
    assert estimate.standard == pytest.approx(1.03, abs=0.005)
    assert estimate.degrees_of_freedom == pytest.approx(19.0, abs=0.05)
    assert estimate.uncertainty == pytest.approx(2.09 * 1.03, abs=0.02)


def test_nothing_bounds_a_value_below_one_degree_of_freedom():
    assert Estimate(1.0, 0.1, 0.9, 2).uncertainty == math.inf


def test_sum_of_means_of_different_repeats():
    estimate = Estimate.of_sum([(0.5, [1.0, 3.0]), (-0.5, [10.0, 10.0, 13.0])])
    assert estimate.value == 1.0 - 5.5
    a, b = 0.5 * math.sqrt(2 / 2), 0.5 * math.sqrt(3 / 3)
    assert estimate.standard == pytest.approx(math.hypot(a, b))
    assert estimate.degrees_of_freedom == pytest.approx((a * a + b * b) ** 2 / (a**4 + b**4 / 2))
    assert estimate.repeats == 2


def test_single_value_has_no_uncertainty():
    estimate = Estimate.of_mean([4.0], Component(1.0))
    assert (estimate.value, estimate.standard, estimate.uncertainty) == (4.0, None, None)
    assert estimate.inverse().uncertainty is None


def test_relative_uncertainty_of_the_inverse_is_the_same():
    estimate = Estimate.of_mean([4.0, 4.5, 5.0])
    inverse = estimate.inverse()
    assert inverse.value == 1 / 4.5
    assert inverse.standard / inverse.value == pytest.approx(estimate.standard / estimate.value)
    assert inverse.degrees_of_freedom == estimate.degrees_of_freedom


def test_jackknife_of_a_mean_is_its_standard_error():
    values = np.random.default_rng(1).standard_normal(24)
    without = [np.delete(values, k).mean() for k in range(24)]
    found = jackknife([values.mean(), *without])
    assert found == Estimate(
        values.mean(), pytest.approx(np.std(values, ddof=1) / 24**0.5), 23, 24
    )


def test_standard_error_of_neighbours_that_are_alike_is_that_of_their_groups():
    groups = np.random.default_rng(0).standard_normal(6)
    error = standard_error(np.repeat(groups, 4), (1, 2, 4))
    assert error == (pytest.approx(np.std(groups, ddof=1) / 6**0.5), 5)
