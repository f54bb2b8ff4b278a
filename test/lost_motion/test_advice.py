"""The least preload without play, on simulated gears and by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from advising import LOADS, Scatter, coverage, readings
from braced_gears import BracedGear

from gear_kinematics.lost_motion.preload.advice import advise, without
from gear_kinematics.lost_motion.preload.model import (
    PlayLine,
    Reading,
    coverage_factor,
    regression,
)
from gear_kinematics.lost_motion.preload.over_preload import told
from gear_kinematics.lost_motion.preload.settings import Scale
from gear_kinematics.state.uncertainty import Estimate

GEAR = BracedGear()
EXACT = Scatter(0.0, 1e-9, 0.0, 0.0)
SETTINGS = (0.0, 0.8, 1.6, 3.0, 4.0, 5.0)


@pytest.fixture(scope='module')
def exact():
    return readings(GEAR, SETTINGS, EXACT, np.random.default_rng(7))


@pytest.mark.parametrize('scale', [GEAR.closing, None])
@pytest.mark.parametrize('load', [0.0, 2.0, 5.0])
def test_advice_without_scatter_is_the_simulated_gear(exact, scale, load):
    advice = advise(exact, scale, LOADS)
    # The simulated gear is summed up at 20 001 angles.
    least = GEAR.least(load) if load else GEAR.end
    assert advice.least(load).value == pytest.approx(least, rel=2e-4)
    price = GEAR.drag(least) - GEAR.friction
    assert advice.price(load).value == pytest.approx(price, rel=2e-4, abs=1e-9)
    for setting in (0.4, 2.0, 3.5, 6.0):
        play = max(-GEAR.squeeze(setting), 0.0)
        assert advice.predicted_play(setting).value == pytest.approx(play, abs=1e-8)
        drag = advice.predicted_friction(setting)
        assert drag.value == pytest.approx(GEAR.drag(setting), rel=1e-6)


def test_stiffness_is_that_of_both_branches_up_to_the_limit():
    """In the range of 8 to 20 N·m: the branches separate at 3.4 to 30 N·m."""
    settings = (0.0, 1.0, 2.0, 10.0, 15.0, 20.0, 25.0)
    advice = advise(readings(GEAR, settings, EXACT, np.random.default_rng(7)), GEAR.closing, LOADS)
    for setting in (1.5, 8.0, 12.0, 18.0, 24.0):
        sides = GEAR.stiffness(setting, *LOADS)
        both = 2.0 / sum(1.0 / side for side in sides)
        assert advice.predicted_stiffness(setting).value == pytest.approx(both, rel=2e-3)
    assert advice.predicted_stiffness(24.0).value > 1.8 * advice.predicted_stiffness(1.5).value


def test_stiffness_that_falls_with_the_preload_is_not_predicted():
    found = readings(GEAR, (0.0, 1.0, 2.0, 10.0, 15.0, 20.0, 25.0), EXACT,
                     np.random.default_rng(0))  # fmt: skip
    upside_down = [
        replace(one, positive=other.positive, negative=other.negative)
        for one, other in zip(found, reversed(found), strict=True)
    ]
    advice = advise(upside_down, GEAR.closing, LOADS)
    assert advice.springs is None
    assert 'does not grow as that of two braced branches' in advice.cause


@pytest.mark.slow
@pytest.mark.parametrize('name', ['seven, turns', 'five twice, numbers', 'five, turns'])
def test_intervals_hold(name):
    found = coverage(name, 500, 2.0)
    # 3.1 standard deviations of the share of 500.
    assert 0.95 - 0.03 <= found['least'] <= 0.95 + 0.03
    assert 0.95 - 0.03 <= found['price'] <= 0.95 + 0.03
    assert 0.95 - 0.03 <= found['friction'] <= 0.95 + 0.03
    assert found['play'] >= 0.95 - 0.03
    assert 0.95 - 0.03 <= found['stiffness'] <= 0.95 + 0.03
    assert found['bounds'] >= 0.95
    assert found['told'] > 0.95


def reading(setting: float, play: float | None, limit: float | None = None) -> Reading:
    seen = None if play is None else Estimate(play, 0.05 * abs(play), 4.0, 5)
    drag = Estimate(1.0 + 0.01 * math.sin(9.0 * setting), None, 0.0, 1)
    return Reading(f'at {setting:g}', setting, seen, limit, drag, None, None)


@pytest.mark.parametrize(
    ('found', 'scale', 'bounds', 'cause'),
    [
        ([reading(1, 4e-3), reading(2, None, 1e-4), reading(3, None, 1e-4)], None, (1, 2),
         '1 recording shows play, and at least 3 are needed'),
        ([reading(1, 4e-3), reading(2, None, 1e-4), reading(3, None, 1e-4)], 1e-3, (1, 2),
         '1 recording shows play, and at least 2 are needed'),
        ([reading(k, None, 1e-4) for k in (1, 2, 3)], None, (None, 1), 'no setting shows play'),
        ([reading(1, 4e-3), reading(2, None, 1e-4), reading(3, 3e-3)], None, (1, None),
         'play at a greater setting than one without'),
        ([reading(k, 1e-3 * k) for k in (1, 2, 3)], None, (3, None), 'does not fall with'),
        ([reading(1, 4.0e-3), reading(2, 1e-3), reading(3, 3.9e-3)], None, (3, None),
         'less than its scatter'),
        ([reading(k, 9e-3 - k * 1e-4) for k in (1, 2, 3)] + [reading(4, None, 1e-5)], None,
         (3, 4), 'the play of the others does not end before at 4'),
    ],
)  # fmt: skip
def test_what_the_model_does_not_describe_gets_bounds_and_a_cause(found, scale, bounds, cause):
    advice = advise(found, scale, LOADS)
    assert advice.least(0.0) is None
    assert (advice.play.greatest_with, advice.play.least_without) == bounds
    assert cause in advice.play.cause
    assert advice.price(2.0) is None


def test_a_small_play_among_settings_without_may_be_chance():
    found = [reading(k, 5e-3 - 2e-3 * k) for k in (0, 1, 2)] + [reading(3, None, 2e-4)]
    doubtful = replace(reading(4, None), play=Estimate(1e-4, 3.4e-5, 4.0, 5))  # 4 %
    advice = advise([*found, doubtful], None, LOADS)
    assert advice.least(0.0).value == pytest.approx(2.5)
    assert advice.play.least_without == 3
    sure = replace(doubtful, play=Estimate(1e-4, 1e-6, 4.0, 5))
    assert advise([*found, sure], None, LOADS).least(0.0) is None


def test_without_a_line_of_the_play_friction_is_a_straight_line():
    found = [reading(1, 4e-3), *(reading(k, None, 1e-4) for k in (2, 3, 4))]
    left = without(advise(found, None, LOADS), 3)
    others = [(r.setting, r.friction.value) for r in found if r.setting != 3]
    slope, base = np.polyfit(*np.transpose(others), 1)
    assert left.predicted_friction(3).value == pytest.approx(base + 3 * slope)
    assert left.predicted_play(3) is None


def test_interval_of_a_line_is_that_of_fieller():
    """Its ends are the zeros of the limits of the confidence band."""
    x, y = np.array([0.0, 1.0, 2.0, 3.0, 4.0]), np.array([10.2, 7.9, 6.1, 3.8, 2.1])
    line = regression(x, y)
    base, both, slope = line.covariance
    play = PlayLine(line.base, -line.slope, (base, -both, slope), line.scatter, 3.0)
    span = play.closes(Estimate(0.0, 0.0, math.inf, 1))

    def edge(setting: float) -> float:
        half = 3.182446 * line.scatter * math.sqrt(0.2 + (setting - 2.0) ** 2 / 10.0)
        return abs(line.base + line.slope * setting) - half

    assert span.value == pytest.approx(-line.base / line.slope)
    assert edge(span.low) == pytest.approx(0.0, abs=1e-5)
    assert edge(span.high) == pytest.approx(0.0, abs=1e-5)
    assert not span.vague


NUMBERS = Scale('', 1.0, None)
VAGUE = list(enumerate((8.81e-3, 7.81e-3, 3.05e-3, 3.05e-3, 3.13e-3), start=1))


@pytest.mark.parametrize(
    ('found', 'load', 'sentence'),
    [
        ([reading(1, 4e-3), reading(2, None, 1e-4), reading(3, None, 1e-4)], 0.0,
         'the play ends between the settings 1 and 2; no ±: 1 recording shows play'),
        ([reading(k, None, 1e-4) for k in (1, 2, 3)], 0.0,
         'no play shows from the setting 1 on, the least that counts; no ±: no setting shows'),
        ([reading(k, 1e-3 * k) for k in (1, 2, 3)], 0.0,
         'there is play up to the setting 3; no ±'),
        ([reading(k, play) for k, play in VAGUE], 0.0,
         'there is play without a load up to the setting 4.3'),
        ([reading(k, play) for k, play in enumerate((5e-3, 3.05e-3, 1e-3))], 0.0,
         'no play without a load from the setting 2.5'),
        ([reading(k, 5e-3 - 2e-3 * k) for k in (0, 1, 2)], 2.0,
         'there is play up to the setting 2; no ±: no stiffness is known'),
        ([replace(reading(k, None), play=None, limit=None) for k in (0, 1, 2)], 0.0,
         'where the play ends is not known; no ±: no play is known; repeat the ramps'),
    ],
)  # fmt: skip
def test_the_sentence_tells_the_setting_or_a_bound_and_why(found, load, sentence):
    assert told(advise(found, None, LOADS), NUMBERS, load).startswith(sentence)


def test_a_price_that_may_be_nothing_is_not_told(exact):
    rough = [
        replace(r, friction=Estimate(1.0 + 0.1 * math.sin(9.0 * r.setting), None, 0.0, 1))
        for r in exact
    ]
    sentence = told(advise(rough, None, LOADS), NUMBERS, 2.0)
    assert sentence.endswith(' on, at what cost in friction is too uncertain to tell')


def test_where_friction_takes_up_the_torque_no_stiffness_is_predicted(exact):
    advice = advise(exact, None, (0.0, 0.0))
    assert advice.springs is None
    assert advice.cause == 'the friction takes up the torque of the ramps'
    assert advice.least(2.0) is not None


def test_a_vague_interval_is_a_bound():
    span = advise([reading(k, play) for k, play in VAGUE], None, LOADS).least(0.0)
    assert span.vague
    assert span.low > 4.0


@pytest.mark.parametrize(
    ('freedom', 'factor'),
    [(1.0, 12.7062), (1.5, 6.01666), (2.0, 4.30265), (2.9, 4.30265), (1e9, 1.95996)],
)
def test_student_factor_of_fractions(freedom, factor):
    """Of tables; that of 1.5 by Simpson's rule and bisection."""
    assert coverage_factor(freedom) == pytest.approx(factor, rel=0.03)
