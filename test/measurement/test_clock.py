"""Times of rows: their unit, coarse clocks, disorder, and when a recording was made."""

from datetime import UTC, datetime

import numpy as np
import pytest

from gear_kinematics.measurement.clock import (
    ClockError,
    Dates,
    common_times,
    in_order,
    named_time,
    times_of_rows,
    unit_since_1970,
)


@pytest.mark.parametrize(
    ('time', 'unit'),
    [
        (1_721_381_453.0, 1.0),
        (1_721_381_453_000.0, 1e-3),
        (1_721_381_453_000_000.0, 1e-6),
        (1_721_381_453_000_000_000.0, 1e-9),
        (80.5, None),
        (0.0, None),
        (float('nan'), None),
    ],
)
def test_unit_of_times_since_1970(time, unit):
    assert unit_since_1970(time) == unit


def test_rows_are_spread_over_the_steps_of_a_coarse_clock():
    # Sampled every 2 ms or so, with a clock of 1/64 s.
    true = np.arange(1000) * 0.0021
    coarse = np.floor(true * 64.0) / 64.0
    found = times_of_rows(coarse)
    assert np.diff(found).min() > 0.0
    np.testing.assert_allclose(found, true, rtol=0, atol=0.0021 + 1e-12)


def test_times_that_differ_are_kept():
    time = np.array([5.0, 5.1, 5.15, 7.0])
    np.testing.assert_allclose(times_of_rows(time), [0.0, 0.1, 0.15, 2.0], atol=1e-12)


@pytest.mark.parametrize(
    ('time', 'cause'),
    [
        ([3.0, 3.0, 3.0], 'stand still'),
        ([3.0], 'stand still'),
        ([0.0, np.nan, 1.0], 'not numbers'),
        ([5.0, 1.0, 2.0, 3.0], 'go back'),
    ],
)
def test_times_that_cannot_be_used(time, cause):
    with pytest.raises(ClockError, match=cause):
        times_of_rows(np.array(time))


def test_stamps_in_disorder_are_left_out_and_a_clock_that_was_set_back_ends_them():
    second = 10**9
    stamps = np.array([0, 1, 3, 2, 4, 4, 5, 3, 6]) * second // 4
    kept, disordered = in_order(stamps)
    np.testing.assert_array_equal(kept, [0, 1, 2, 4, 5, 6, 8])
    assert disordered == 2
    kept, disordered = in_order(np.array([10, 11, 5, 6, 12]) * second)
    np.testing.assert_array_equal(kept, [0, 1])
    assert disordered == 0


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


def test_the_first_source_that_dates_all_recordings_counts():
    both, named = Dates(3.0, 30.0, 300.0), Dates(None, 10.0, 100.0)
    assert common_times([both, both])[0] == [3.0, 3.0]
    assert common_times([both, named]) == ([30.0, 10.0], 'the times in their names')
    times, source = common_times([both, named, Dates(None, None, 200.0)])
    assert times == [300.0, 100.0, 200.0]
    assert 'copying' in source
