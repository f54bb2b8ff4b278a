"""Times of rows: their unit, coarse clocks, and times that cannot be used."""

import numpy as np
import pytest

from gear_kinematics.lost_motion.recorded.clock import ClockError, times_of_rows, unit_since_1970


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
        ([0.0, 1.0, 0.5], 'go back'),
        ([3.0, 3.0, 3.0], 'stand still'),
        ([3.0], 'stand still'),
        ([0.0, np.nan, 1.0], 'not numbers'),
    ],
)
def test_times_that_cannot_be_used(time, cause):
    with pytest.raises(ClockError, match=cause):
        times_of_rows(np.array(time))
