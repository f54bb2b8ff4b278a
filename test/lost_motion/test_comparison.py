"""Groups of recordings, and the significance of the differences between them."""

import math

import numpy as np
import pytest

from gear_kinematics.lost_motion.several.common import Quantity
from gear_kinematics.lost_motion.several.comparison import Group, changes, grouped, holm, spread
from gear_kinematics.state.uncertainty import Estimate

NAMES = ['before_1.csv', 'other.csv', 'before_2.csv', 'after_1.csv']


def test_globs_name_groups():
    groups, others = grouped(NAMES, ['after*', 'before*'])
    assert groups == [Group('before*', (0, 1)), Group('after*', (2,))]
    assert others == [1]


def test_the_text_of_a_regular_expression_names_groups():
    groups, others = grouped(NAMES, [r'^(\w+)_\d'])
    assert groups == [Group('before', (0, 1)), Group('after', (2,))]
    assert others == [1]


def test_holm_adjusts_as_its_author_does():
    # S. Holm, Scand. J. Statistics 6 (1979) 65: the k-th least of n counts n - k + 1 times.
    adjusted = holm([0.01, 0.04, 0.03, 0.005, math.nan])
    assert adjusted[:4] == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert math.isnan(adjusted[4])


def measured(value: float, standard: float | None, degrees: float = 10.0) -> Estimate:
    return Estimate(value, standard, degrees, 5)


def test_a_relative_change_has_the_uncertainty_of_both_values():
    values = (measured(2.0, 0.1), measured(3.0, 0.2))
    friction = Quantity('friction', 'N·m', 1.0, values, relative=True)
    (change,) = changes([friction], [Group('a', (0,)), Group('b', (1,))])
    assert change.difference.value == pytest.approx(1.0)
    assert change.difference.standard == pytest.approx(math.hypot(0.1, 0.2))
    assert change.relative.value == pytest.approx(0.5)
    assert change.relative.standard == pytest.approx(1.5 * math.hypot(0.1 / 2.0, 0.2 / 3.0))


def test_without_repeats_nothing_is_judged():
    figure = Quantity('hysteresis', 'arcmin', 1.0, (measured(1.0, None), measured(9.0, 0.1)))
    (change,) = changes([figure], [Group('a', (0,)), Group('b', (1,))])
    assert change.probability is None
    assert not change.significant


def test_a_group_has_the_mean_and_the_spread_of_its_recordings():
    values = tuple(measured(value, 0.001) for value in (1.0, 2.0, 3.0, 4.0, 9.0))
    figure = Quantity('hysteresis', 'arcmin', 1.0, values)
    first, second = Group('a', (0, 1, 2)), Group('b', (3, 4))
    (change,) = changes([figure], [first, second])
    assert (change.before.value, change.after.value) == (2.0, 6.5)
    assert change.before.standard == pytest.approx(1.0 / math.sqrt(3.0))
    assert spread(figure, first) == pytest.approx(1.0)
    assert not change.significant


def test_an_unchanged_gear_shows_a_significant_change_in_at_most_5_percent():
    random = np.random.default_rng(3)
    groups = [Group('a', (0,)), Group('b', (1,)), Group('c', (2,))]
    alarms = 0
    for _ in range(1000):
        samples = random.standard_normal((4, 3, 5))
        figures = [
            Quantity(str(k), '', 1.0, tuple(Estimate.of_mean(own.tolist()) for own in figure))
            for k, figure in enumerate(samples)
        ]
        alarms += any(change.significant for change in changes(figures, groups))
    assert alarms <= 50
