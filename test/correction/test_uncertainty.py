"""Uncertainties against the GUM's own tables and examples, and against mpmath."""

import math

import mpmath
import numpy as np
import pytest

from gear_kinematics.correction.uncertainty import (
    Component,
    Estimate,
    hidden_resolution,
    resolution,
    slope_resolution,
    student_t,
    student_tail,
)

# GUM, table G.2, fraction p = 95 %
TABLE_G2 = {1: 12.71, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57, 6: 2.45, 7: 2.36, 8: 2.31, 9: 2.26,
            10: 2.23, 15: 2.13, 20: 2.09, 30: 2.04, 40: 2.02, 50: 2.01, 100: 1.984}  # fmt: skip


@pytest.mark.parametrize(('degrees', 'expected'), TABLE_G2.items())
def test_student_t_is_that_of_the_table(degrees, expected):
    digits = 2 if degrees < 100 else 3
    assert round(student_t(degrees), digits) == expected


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


def test_mean_of_repeats():
    estimate = Estimate.of_mean([1.0, 2.0, 3.0, 6.0])
    assert estimate.value == 3.0
    assert estimate.standard == pytest.approx(math.sqrt(14 / 3 / 4))
    assert (estimate.degrees_of_freedom, estimate.repeats) == (pytest.approx(3.0), 4)
    assert estimate.uncertainty == pytest.approx(3.182446 * estimate.standard, rel=1e-6)


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


def test_repeats_that_are_all_the_same_leave_the_other_components():
    estimate = Estimate.of_mean([4.0, 4.0, 4.0], Component(0.5))
    assert estimate.standard == 0.5
    assert estimate.uncertainty == pytest.approx(0.5 * 1.959964, rel=1e-6)
    assert Estimate.of_mean([4.0, 4.0]).uncertainty == 0.0


def test_relative_uncertainty_of_the_inverse_is_the_same():
    estimate = Estimate.of_mean([4.0, 4.5, 5.0])
    inverse = estimate.inverse()
    assert inverse.value == 1 / 4.5
    assert inverse.standard / inverse.value == pytest.approx(estimate.standard / estimate.value)
    assert inverse.degrees_of_freedom == estimate.degrees_of_freedom


@pytest.mark.parametrize('scale', [1e-290, 1e-90, 1e90, 1e200])
def test_no_scale_overflows(scale):
    values = [1.0, 2.0, 4.0]
    one = Estimate.of_mean(values, Component(0.5, 7.0))
    scaled = Estimate.of_mean([scale * v for v in values], Component(scale * 0.5, 7.0))
    assert scaled.standard == pytest.approx(scale * one.standard)
    assert scaled.degrees_of_freedom == pytest.approx(one.degrees_of_freedom)


def test_reading_in_steps_has_a_rectangular_distribution():
    # The variance of a rectangle of width 0.3, by numbers.
    rectangle = (np.arange(100_000) + 0.5) / 100_000 * 0.3
    assert resolution(0.3) == pytest.approx(np.std(rectangle), rel=1e-9)


@pytest.mark.parametrize('scatter', [0.0, 0.1, 0.2, 0.3, 0.4])
def test_scatter_of_repeats_shows_the_steps_of_an_encoder(scatter):
    # Means of rounded readings of a normal distribution, for all its places within a step of 1.
    places = np.arange(500) / 500
    off = np.linspace(-6.0, 6.0, 4001) if scatter else np.zeros(1)
    density = np.exp(-0.5 * off**2)
    readings = np.round(places[:, None] + scatter * off)
    error = readings @ density / density.sum() - places
    repeats = [7.0 - scatter, 7.0, 7.0 + scatter]
    found = hidden_resolution(1.0, repeats, readings=1)
    assert 0.75 * found <= np.sqrt(np.mean(error**2)) <= 1.001 * found


def test_readings_of_a_difference_share_its_scatter():
    repeats = [1.0, 1.3, 1.6]
    one = hidden_resolution(1.0, [x / math.sqrt(2.0) for x in repeats], readings=1)
    assert hidden_resolution(1.0, repeats, readings=2) == pytest.approx(math.sqrt(2.0) * one)


def test_a_single_reading_hides_its_whole_step():
    assert hidden_resolution(0.3, [5.0], readings=2) == pytest.approx(0.3 / math.sqrt(6.0))
    assert hidden_resolution(0.0, [5.0, 6.0], readings=2) == 0.0


@pytest.mark.parametrize('steps', [3.0, 10.0, 80.0])
def test_slope_of_a_line_is_as_uncertain_as_its_steps(steps):
    run = np.linspace(0.0, 2.0, 600)
    random = np.random.default_rng(3)
    lines = 0.5 * steps * run + random.uniform(size=(2000, 1)) + random.normal(size=(2000, 600))
    errors = np.polynomial.polynomial.polyfit(run, (np.round(lines) - lines).T, 1)[1]
    aligned = 0.5 * steps * run + random.uniform(size=(2000, 1))
    worst = np.polynomial.polynomial.polyfit(run, (np.round(aligned) - aligned).T, 1)[1]
    stated = slope_resolution(1.0, run=2.0, slope=-0.5 * steps)
    assert max(np.std(errors), np.std(worst)) <= stated


def test_slope_over_few_steps_is_that_between_two_readings():
    assert slope_resolution(0.3, run=2.0, slope=0.1) == pytest.approx(
        math.sqrt(2.0) * resolution(0.3) / 2.0
    )
    assert slope_resolution(0.0, run=2.0, slope=0.1) == 0.0


def test_intervals_hold_the_mean_as_often_as_they_say():
    generator, hits, trials = np.random.default_rng(5), 0, 2000
    for _ in range(trials):
        estimate = Estimate.of_mean(generator.normal(3.0, 0.7, 4).tolist())
        hits += abs(estimate.value - 3.0) <= estimate.uncertainty
    # Within four standard deviations of a binomial count.
    assert abs(hits - 0.95 * trials) < 4 * math.sqrt(trials * 0.95 * 0.05)


@pytest.mark.parametrize(
    ('t', 'degrees', 'probability'),
    [  # tables of Student's distribution, two-sided
        (12.706, 1, 0.05),
        (2.776, 4, 0.05),
        (-2.776, 4.9, 0.05),
        (4.604, 4, 0.01),
        (2.086, 20, 0.05),
        (1.95996, math.inf, 0.05),
        (0.0, 3, 1.0),
    ],
)
def test_probability_of_a_greater_t(t, degrees, probability):
    assert student_tail(t, degrees) == pytest.approx(probability, rel=1e-3)


def test_difference_has_the_degrees_of_freedom_of_welch():
    first = Estimate(5.0, 0.3, 4.0, 5)
    second = Estimate(3.0, 0.4, 8.0, 9)
    difference = first.minus(second)
    assert (difference.value, difference.standard) == pytest.approx((2.0, 0.5))
    # B. L. Welch, Biometrika 34 (1947) 28: s⁴ / Σ (sᵢ⁴ / νᵢ).
    assert difference.degrees_of_freedom == pytest.approx(0.5**4 / (0.3**4 / 4 + 0.4**4 / 8))
    assert difference.probability_of_zero() == student_tail(4.0, 11.0)
    unknown = first.minus(Estimate(3.0, None, 0.0, 1))
    assert unknown.value == 2.0
    assert unknown.uncertainty is None
    assert unknown.probability_of_zero() is None
