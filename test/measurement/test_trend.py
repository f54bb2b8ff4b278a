# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Since when a gear has changed: simulated sequences of recordings."""

from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.compare.changes import trend
from gear_kinematics.measurement.compare.quantities import Quantity, at_common_torque
from gear_kinematics.measurement.compare.section import over_time
from gear_kinematics.measurement.figures import gear_figures, settings_for
from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.names import common_times, named_time

DAY = 86400.0


def recorded(means, seed, scatter=0.1) -> Quantity:
    values = means * np.exp(scatter * np.random.default_rng(seed).standard_normal(len(means)))
    found = (Estimate(value, None, 0.0, 1) for value in values)
    return Quantity('hysteresis', 'rad', tuple(found), main=True)


def trend_of(quantity, times=None):
    count = len(quantity.values)
    return trend(quantity, times or range(count), [str(k) for k in range(count)])


@pytest.mark.slow
@pytest.mark.parametrize('count', [5, 12])
def test_an_unchanged_gear_shows_a_change_in_at_most_5_percent(count):
    chances = [trend_of(recorded(np.ones(count), seed)).probability for seed in range(400)]
    # At exactly 5 %, more than 33 of 400 come up in one of 500 runs.
    assert 5 <= np.count_nonzero(np.array(chances) <= 0.05) <= 33


def test_a_step_is_found_with_its_place_and_its_size():
    found = trend_of(recorded([1.0] * 5 + [2.0] * 7, seed=1))
    assert (found.first, found.second) == ('4', '5')
    low, high = found.interval
    assert 1.6 < low < 2.0 < high < 2.5
    assert found.probability < 0.005


def test_a_slope_is_in_proportion_to_time_and_robust():
    days = [0.0, 1.0, 2.0, 10.0, 11.0, 20.0, 26.0, 30.0, 31.0, 40.0]
    means = np.exp(0.03 * np.array(days))
    means[3] *= 1.5  # one odd recording
    found = trend_of(recorded(means, seed=2, scatter=0.02), [DAY * day for day in days])
    assert (found.first, found.second) == ('0', '9')
    low, high = found.interval
    assert low < np.exp(0.03 * 40.0) < high
    assert found.after / found.before == pytest.approx(np.exp(1.2), rel=0.1)
    assert found.probability < 0.002


def test_the_sentence_says_since_when():
    torque, reports = ramps(*[(4.0, 30)] * 2, (40.0, 30)), []
    for number, play in enumerate([0.004] * 4 + [0.012] * 5):
        friction = 0.8 + 0.02 * (number % 3)
        found = find_ramps(torque, creep(Gear(play, 300.0, friction), torque))
        figures = gear_figures(found, settings_for(found, 0.0))
        reports.append(LostMotion(f'0302_0{number}00.csv', None, None, figures))
    comparison = over_time(at_common_torque(reports), [DAY * k for k in range(9)], 'names')
    # In the model the hysteresis is play + 2 friction / stiffness.
    assert comparison.sentence.startswith('since 0302_04: hysteresis 32.')


# When recordings were made


@pytest.mark.parametrize(
    ('name', 'time'),
    [
        ('2024-07-12__14-07-48__torqueramp__conic 1pre1.csv', (2024, 7, 12, 14, 7, 48)),
        ('rosbag2_2024_07_12-14_07_48', (2024, 7, 12, 14, 7, 48)),
        ('ramps-20240712T140748.csv', (2024, 7, 12, 14, 7, 48)),
        ('0712_1407_conic_1pre1.csv', (2000, 7, 12, 14, 7, 0)),
        ('0229_0001.csv', (2000, 2, 29, 0, 1, 0)),
        ('9999_9999_then_0712_1407.csv', (2000, 7, 12, 14, 7, 0)),
        ('conic_onyx_preload_1_position_1.csv', None),
        ('serial_123456789_0712.csv', None),
        ('1332_1407.csv', None),
    ],
)
def test_time_in_a_name(name, time):
    assert named_time(name) == (time and datetime(*time, tzinfo=UTC).timestamp())


def test_the_first_source_that_dates_all_recordings_counts(tmp_path):
    def made(name: str, start: float | None):
        (tmp_path / name).touch()
        return SimpleNamespace(path=tmp_path / name, start=start)

    both, named = made('0712_1407.csv', 3.0), made('0712_1408.csv', None)
    assert common_times([both, both])[0] == [3.0, 3.0]
    times, source = common_times([both, named])
    assert (times[1] - times[0], source) == (60.0, 'the times in their names')
    assert 'copying' in common_times([both, named, made('x.csv', None)])[1]
