"""Since when a gear has changed: simulated sequences of recordings."""

import numpy as np
import pytest

from gear_kinematics.lost_motion.several.common import Quantity
from gear_kinematics.lost_motion.several.trend import trends
from gear_kinematics.state.uncertainty import Estimate


def recorded(random, means, between=0.0, loops=5) -> Quantity:
    """Record a gear once for each mean; ramps scatter by 1, recordings as well by `between`."""
    centres = np.asarray(means) + between * random.standard_normal(len(means))
    samples = centres[:, None] + random.standard_normal((len(means), loops))
    return Quantity('hysteresis', '', 1.0, tuple(map(Estimate.of_mean, samples.tolist())))


@pytest.mark.slow
@pytest.mark.parametrize(('between', 'loops'), [(0.0, 5), (0.5, 3), (10.0, 5)])
def test_an_unchanged_gear_gives_an_alarm_in_at_most_5_percent(between, loops):
    random = np.random.default_rng(8)
    count, alarms = 1000, 0
    for _ in range(count):
        (trend,) = trends([recorded(random, np.zeros(6), between, loops)], range(6))
        alarms += trend.changed
    # At 5 % there are more in one of 1000 runs.
    assert alarms <= 0.05 * count + 3.1 * (0.05 * 0.95 * count) ** 0.5


def test_a_step_is_found_with_its_place_and_its_size():
    random = np.random.default_rng(1)
    means = [0.0] * 5 + [8.0] * 6
    (trend,) = trends([recorded(random, means, between=0.3)], range(11))
    (step,) = trend.steps
    assert (step.earliest, step.since, step.latest) == (5, 5, 5)
    assert abs(step.change.value - 8.0) < step.change.uncertainty < 2.0
    assert trend.slope is None
    assert trend.fitted == pytest.approx(means, abs=0.6)
    assert trend.probability < 0.001


def test_two_steps_are_found():
    random = np.random.default_rng(2)
    means = [0.0] * 6 + [9.0] * 6 + [3.0] * 6
    (trend,) = trends([recorded(random, means)], range(18))
    assert [step.since for step in trend.steps] == [6, 12]
    assert [step.change.value for step in trend.steps] == pytest.approx([9.0, -6.0], abs=1.0)


def test_a_slope_is_in_proportion_to_time_not_to_the_number():
    random = np.random.default_rng(3)
    days = [0.0, 1.0, 2.0, 10.0, 11.0, 20.0, 29.0, 30.0]
    (trend,) = trends([recorded(random, [0.5 * day for day in days])], days)
    assert trend.steps == ()
    slope = trend.slope
    assert abs(slope.per_day.value - 0.5) < slope.per_day.uncertainty < 0.1
    assert slope.change.value == pytest.approx(30.0 * slope.per_day.value)


def test_few_recordings_give_no_trend():
    random = np.random.default_rng(4)
    assert trends([recorded(random, [0.0, 0.0, 9.0])], range(3)) == []


def test_recordings_without_the_figure_are_passed_over():
    random = np.random.default_rng(5)
    figure = recorded(random, [0.0] * 5 + [9.0] * 5)
    values = list(figure.values)
    values[1] = None
    values[5] = Estimate(9.0, None, 0.0, 1)
    (trend,) = trends([Quantity('hysteresis', '', 1.0, tuple(values))], range(10))
    assert trend.numbers == (0, 2, 3, 4, 6, 7, 8, 9)
    assert [step.since for step in trend.steps] == [6]


def test_all_figures_are_judged_together():
    random = np.random.default_rng(6)
    figures = [recorded(random, np.zeros(8), between=1.0) for _ in range(5)]
    figures.append(recorded(random, [0.0] * 4 + [15.0] * 4, between=1.0))
    assert [trend.changed for trend in trends(figures, range(8))] == [False] * 5 + [True]
