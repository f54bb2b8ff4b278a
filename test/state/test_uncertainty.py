"""Uncertainties against the GUM's own tables and examples, and against mpmath."""

import math

import mpmath
import numpy as np
import pytest

from gear_kinematics.state.uncertainty import (
    Component,
    Estimate,
    end_resolution,
    expected_effect,
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


@pytest.mark.parametrize('steps', [3.0, 20.0, 130.0])
def test_slope_of_means_is_as_uncertain_as_the_steps_at_its_ends(steps):
    """Of the steps, each of 100 means contains ten readings, at any place of the steps."""
    x = np.linspace(0.0, 1.0, 1000)
    means = [
        np.mean((np.round(steps * x + zero) - steps * x).reshape(100, 10), axis=1)
        for zero in np.linspace(0.0, 1.0, 40, endpoint=False)
    ]
    slopes = np.polynomial.polynomial.polyfit(
        x.reshape(100, 10).mean(axis=1), np.transpose(means), 1
    )[1]
    stated = slope_resolution(0.5, run=2.0, slope=-0.25 * steps, of_means=True)
    assert 0.2 * stated <= 0.25 * np.std(slopes) <= stated
    assert stated <= slope_resolution(0.5, run=2.0, slope=-0.25 * steps)
    assert slope_resolution(0.0, run=2.0, slope=0.1, of_means=True) == 0.0


@pytest.mark.parametrize('steps', [5.0, 20.0, 130.0])
def test_end_of_a_line_through_steps(steps):
    """The true line goes on to its end; what is read is rounded, at any place of the steps."""
    x = np.linspace(0.0, 1.0, 2001)
    ends = [
        np.polyval(np.polyfit(x, np.round(steps * x + zero), 1), 1.0) - steps - zero
        for zero in np.linspace(0.0, 1.0, 40, endpoint=False)
    ]
    assert np.std(ends) <= end_resolution(1.0, run=steps)
    assert end_resolution(0.5, run=0.5 * steps) == pytest.approx(
        0.5 * end_resolution(1.0, run=steps)
    )
    assert end_resolution(0.0, run=1.0) == 0.0


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


@pytest.mark.parametrize('ratio', [0.01, 0.3, 1.0, 5.0])
def test_effects_that_are_not_clear_have_the_moments_of_simulated_ones(ratio):
    """Half of the simulated effects are none, and all are measured with the same uncertainty."""
    rng = np.random.default_rng(3)
    effects = rng.normal(0.0, 2.0, 400_000) * (rng.random(400_000) < 0.5)
    standards = np.full(400_000, 2.0 * ratio)
    values = rng.normal(effects, standards)
    order = np.argsort(abs(values))
    found = expected_effect(values[:, None], standards[:, None], 2.0)
    means, standards = (column[:, 0] for column in found)
    for group in np.array_split(order, 8):
        off = means[group] - effects[group]
        for moment, expected in ((off, 0.0), (off**2, np.mean(standards[group] ** 2))):
            error = 5.0 * np.std(moment) / math.sqrt(len(group))
            assert np.mean(moment) == pytest.approx(expected, abs=error + 1e-12)


def test_effects_known_without_scatter():
    found = expected_effect(np.array([[0.0], [0.3]]), np.zeros((2, 1)), 2.0)
    assert found[0][:, 0] == pytest.approx([0.0, 0.3], abs=1e-5)
    assert found[1][:, 0] == pytest.approx([0.0, 0.0], abs=1e-5)


@pytest.mark.parametrize('size', [0.3, 1.0, 4.0])
def test_an_effect_with_several_explanations_is_as_likely_as_in_simulated_readings(size):
    """Half of the readings have an effect, in proportion to one of three curves."""
    rng = np.random.default_rng(4)
    curves = np.array([[1.0, 1.0, 0.0, 0.0], [0.0, 1.0, 2.0, 0.0], [0.1, 0.0, 0.1, 0.3]])
    count = 300_000
    which, there = rng.integers(3, size=count), rng.random(count) < 0.5
    effects = rng.normal(0.0, size, count) * there
    readings = effects[:, None] * curves[which] + rng.standard_normal((count, 4))
    squares = np.sum(curves**2, axis=1)
    values, standards = readings @ curves.T / squares, np.tile(squares**-0.5, (count, 1))
    means, _ = expected_effect(values, standards, size)
    # The share of effects among readings of which as much is left of one explanation.
    left = means[:, 1] / (size**2 / (size**2 + 1.0 / squares[1]) * values[:, 1])
    for group in np.array_split(np.argsort(left), 10):
        assert np.mean(left[group]) == pytest.approx(np.mean(there[group]), abs=0.015)
