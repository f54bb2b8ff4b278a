# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The transmission error sample by sample, against numpy over whole records."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gear_kinematics.correction.error_window import ErrorStatistics, ErrorWindow
from gear_kinematics.correction.transmission_error import Direction, ErrorSample, TransmissionError

SECOND = 10**9
MS = 10**6
START = 1_700_000_000 * SECOND + 123_456_789


def make(**changes) -> TransmissionError:
    return TransmissionError(**{'max_gap': 50 * MS, 'travel': 0.01, **changes})


def feed(comparison, ideal, measured, order) -> list[ErrorSample]:
    """Feed both records; `order` says for each sample whether it is an ideal one."""
    samples, ideal, measured = [], list(ideal), list(measured)
    for is_ideal in order:
        if is_ideal and ideal:
            samples += comparison.add_ideal(*ideal.pop(0))
        elif measured:
            samples += comparison.add_measured(*measured.pop(0))
    for sample in ideal:
        samples += comparison.add_ideal(*sample)
    for sample in measured:
        samples += comparison.add_measured(*sample)
    return samples


def split(angle: float) -> tuple[int, float]:
    turns = round(angle / (2 * math.pi))
    return turns, angle - turns * 2 * math.pi


def wrapped(angle):
    return (angle + math.pi) % (2 * math.pi) - math.pi


@pytest.mark.slow
@given(
    st.lists(st.integers(1, 40 * MS), min_size=2, max_size=40),
    st.lists(st.integers(0, 1000 * MS), max_size=40),
    st.lists(st.booleans(), max_size=80),
    st.floats(-30.0, 30.0),
    st.floats(-3.0, 3.0),
)
def test_errors_are_those_of_the_interpolated_record_in_any_order_of_arrival(
    periods, times, order, speed, offset
):
    stamps = START + np.cumsum(periods)
    angles = speed * (stamps - START) * 1e-9 + 0.3 * np.sin(np.arange(len(stamps)))
    times = START + np.sort(np.array(times, np.int64))
    known = (times >= stamps[0]) & (times <= stamps[-1])
    ideal_at = np.interp(
        (times - START).astype(float), (stamps - START).astype(float), angles.astype(float)
    )
    errors = offset + 1e-3 * np.cos(np.arange(len(times)))
    measured = wrapped(ideal_at + errors)

    comparison = make()
    samples = feed(
        comparison,
        ((int(s), *split(a)) for s, a in zip(stamps, angles, strict=True)),
        ((int(s), float(a)) for s, a in zip(times, measured, strict=True)),
        order,
    )
    assert [sample.stamp for sample in samples] == times[known].tolist()
    found = np.array([sample.error for sample in samples])
    np.testing.assert_allclose(found, errors[known], rtol=0, atol=1e-12)
    ideal = [sample.turns * 2 * math.pi + sample.ideal for sample in samples]
    ideal = np.array(ideal) - ideal_at[known]
    np.testing.assert_allclose(ideal, 0.0, rtol=0, atol=1e-12)
    assert comparison.matched == len(samples)
    early = np.count_nonzero(times < stamps[0])
    # What is later than the last ideal sample still waits for one.
    assert dict(comparison.unmatched) == ({'no ideal angle before': early} if early else {})


def test_last_bits_survive_any_number_of_turns():
    comparison = make()
    comparison.add_ideal(START, 10**12, 3.0)
    # Past half a turn, the turns increase and the angle wraps.
    comparison.add_ideal(START + 10 * MS, 10**12 + 1, 3.1 - 2 * math.pi)
    (sample,) = comparison.add_measured(START + 5 * MS, 3.05 + 1e-13)
    assert sample.error == pytest.approx(1e-13, abs=1e-15)
    assert (sample.turns, sample.ideal) == (10**12, pytest.approx(3.05))


def test_errors_are_continuous_at_an_offset_of_half_a_turn():
    comparison = make()
    comparison.add_ideal(START, 0, 0.0)
    comparison.add_ideal(START + 40 * MS, 0, 0.0)
    errors = [
        comparison.add_measured(START + k * MS, math.pi + 0.01 * math.cos(k))[0].error
        for k in range(40)
    ]
    assert max(errors) - min(errors) < 0.021
    assert all(abs(b - a) < 0.02 for a, b in pairwise(errors))


def test_correction_is_interpolated_with_the_wider_interval():
    comparison = make()
    comparison.add_ideal(START, 0, 0.0, 1e-3, 2e-4)
    comparison.add_measured(START + 1 * MS, 0.0)
    (sample,) = comparison.add_ideal(START + 4 * MS, 0, 0.0, 5e-3, 1e-4)
    assert (sample.deviation, sample.half_width) == (pytest.approx(2e-3), 2e-4)


def test_nothing_is_compared_across_a_gap():
    comparison = make(max_gap=50 * MS)
    comparison.add_ideal(START, 0, 0.0)
    comparison.add_measured(START + 30 * MS, 0.0)
    assert comparison.add_ideal(START + 51 * MS, 0, 0.0) == []
    assert comparison.unmatched == {'gap of the ideal angle': 1}
    # A gap of exactly `max_gap` is interpolated.
    comparison.add_measured(START + 60 * MS, 0.0)
    (sample,) = comparison.add_ideal(START + 101 * MS, 0, 0.0)
    assert sample.stamp == START + 60 * MS
    assert comparison.matched == 1


def test_unusable_measured_angles_are_counted():
    comparison = make()
    comparison.add_ideal(START, 0, 0.0)
    comparison.add_ideal(START + 10 * MS, 0, 0.0)
    for stamp, angle in (
        (START + 5 * MS, math.nan),
        (START + 5 * MS, math.inf),
        (START + 5 * MS, -1.5e16),
        (START + 5 * MS, 0.0),
        (START + 4 * MS, 0.0),
        (START + 5 * MS, 0.0),
    ):
        comparison.add_measured(stamp, angle)
    assert comparison.matched == 2
    assert comparison.unmatched == {'not finite, or too large': 3, 'out of order': 1}


@pytest.mark.parametrize('first', ['ideal', 'measured'])
def test_clock_that_is_set_back_resets_the_comparison(first):
    comparison = make()
    comparison.add_ideal(START, 0, 0.0)
    comparison.add_ideal(START + 10 * MS, 0, 0.0)
    (before,) = comparison.add_measured(START + 5 * MS, 3.0)
    assert before.error == pytest.approx(3.0)

    early = START - 2 * SECOND
    if first == 'measured':
        assert comparison.add_measured(early - MS, 1.0) == []
    comparison.add_ideal(early, 0, 0.0)
    comparison.add_ideal(early + 10 * MS, 0, 0.0)
    # The new offset is also accepted.
    (after,) = comparison.add_measured(early + 5 * MS, -3.0)
    assert after.error == pytest.approx(-3.0)


def test_memory_is_bounded_when_one_side_is_silent():
    comparison = make()
    for k in range(20_000):
        comparison.add_measured(START + k * MS, 0.0)
    assert comparison.unmatched == {'no ideal angle since': 20_000 - 8192}
    comparison = make()
    for k in range(20_000):
        comparison.add_ideal(START + k * MS, 0, 0.0)
    assert comparison.add_measured(START, 0.0) == []
    assert comparison.unmatched == {'no ideal angle before': 1}


# Direction


@given(st.lists(st.integers(-8, 8), max_size=60), st.integers(1, 12))
def test_direction_is_that_of_the_last_long_enough_travel(steps, travel):
    direction = Direction(float(travel))
    found = [direction.move(float(step)) for step in steps]
    # The position now is the extreme of a motion at least as long as the travel.
    places = np.concatenate([[0], np.cumsum(steps)])
    for k, known in enumerate(found, start=1):
        past = places[: k + 1]
        up = past[k] - np.minimum.accumulate(past[::-1])[::-1]
        down = np.maximum.accumulate(past[::-1])[::-1] - past[k]
        # Since when has no position exceeded the present one?
        higher, lower = np.flatnonzero(past > past[k]), np.flatnonzero(past < past[k])
        rising = (up[higher[-1] + 1 if len(higher) else 0 :] >= travel).any()
        falling = (down[lower[-1] + 1 if len(lower) else 0 :] >= travel).any()
        assert known == int(rising) - int(falling)


def test_gap_makes_the_direction_unknown():
    comparison = make(travel=0.01)
    comparison.add_ideal(START, 0, 0.0)
    comparison.add_ideal(START + MS, 0, 0.02)
    comparison.add_ideal(START + 2 * MS, 0, 0.03)
    (sample,) = comparison.add_measured(START + MS + 1, 0.0)
    assert sample.direction == 1
    comparison.add_ideal(START + SECOND, 0, 0.04)
    comparison.add_ideal(START + SECOND + MS, 0, 0.045)
    (sample,) = comparison.add_measured(START + SECOND + 1, 0.0)
    assert sample.direction == 0


# Window


def test_window_is_that_of_its_last_samples_by_direction():
    window = ErrorWindow(50)
    assert window.statistics() == ErrorStatistics()
    for k in range(100):
        window.add(ErrorSample(START + k, 1e9 * math.sin(k), k, 0.1, 1 - 2 * (k % 2), 0.5))
        if k % 30 == 0:
            window.statistics()
    ways, errors = [1, 1, -1, 0, -1], [1e-9, 3e-9, 4e-9, 2e-9, 5e-9]
    stamps = [103, 150, 151, 152, 153]  # the first is just in the window
    for stamp, way, error in zip(stamps, ways, errors, strict=True):
        window.add(ErrorSample(START + stamp, error, 0, 0.0, way, 0.5))
    found = window.statistics()
    assert found[:3] == pytest.approx((5, 3e-9, 4e-9), rel=1e-14)
    window.add(ErrorSample(START, 1.0, 0, 0.0, 0, 0.0))  # the clock was set back
    assert window.statistics() == ErrorStatistics(1, 1.0, 0.0)


def test_lost_motion_is_the_difference_at_the_same_angles():
    window = ErrorWindow(SECOND)
    window.add(ErrorSample(START, 0.1, 10**12, 0.0, 1, 0.5))
    window.add(ErrorSample(START + MS, 0.3, 10**12, 0.1, -1, -0.5))  # elsewhere
    assert window.statistics().reversals is None
    for error in (0.3, 0.4):
        window.add(ErrorSample(START + 2 * MS, error, 10**12, 1e-4, -1, -0.7))
    found = window.statistics().reversals
    assert found.difference.value == pytest.approx(0.25)
    assert found.difference.uncertainty is None
    assert found.lost_motion is None
