"""Reversals of torque ramps, and the angle over the torque between them."""

import math

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps
from hypothesis import assume, given
from hypothesis import strategies as st

from gear_kinematics.measurement.loops import RampError, _isotonic, find_ramps

GEAR = Gear(play=0.01, stiffness=200.0, friction=1.0)


@given(st.lists(st.floats(-10.0, 10.0), min_size=3, max_size=25))
def test_isotonic_fit_is_that_of_the_min_max_formula(values):
    assume(np.ptp(values) > 1e-6)
    bounds = _isotonic(np.array(values))
    levels = np.add.reduceat(values, bounds[:-1]) / np.diff(bounds)
    # R. E. Barlow et al., Statistical Inference under Order Restrictions (1972), p. 19.
    n = len(values)
    expected = [
        max(
            min(math.fsum(values[i:j]) / (j - i) for j in range(k + 1, n + 1))
            for i in range(k + 1)
        )
        for k in range(n)
    ]
    np.testing.assert_allclose(np.repeat(levels, np.diff(bounds)), expected, rtol=0, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize('noise', [0.0, 0.05, 0.3])
def test_ramps_are_told_apart_by_their_amplitude(noise):
    torque = ramps((4.0, 300), (4.0, 300), (4.0, 300), (40.0, 900), (40.0, 900))
    angle = creep(GEAR, torque)
    noisy = torque + noise * np.random.default_rng(1).standard_normal(len(torque))
    small, large = find_ramps(noisy, angle)
    assert (len(small.loops), len(large.loops)) == (3, 2)
    assert small.amplitude == pytest.approx(4.0, abs=0.02 + 0.3 * noise)
    assert large.amplitude == pytest.approx(40.0, abs=0.05 + noise)
    for ramp in (small, large):
        for loop in ramp.loops:
            assert loop.rise.rising
            assert not loop.fall.rising
            assert loop.fall.reaches(0.0)
            assert np.all(np.diff(loop.rise.torque) > 0.0)
            assert np.all(np.diff(loop.fall.torque) < 0.0)
    # The first loading has no history; the first large one begins at a small peak.
    starts = [[round(branch.start / 4.0) for branch in pull] for pull in small.pulls]
    assert starts == [[0, 1], [-1, 1], [-1, 1]]
    starts = [[round(branch.start / 4.0) for branch in pull] for pull in large.pulls]
    assert starts == [[-1, 10], [-10, 10]]


def test_the_loop_at_the_end_of_a_recording_is_not_complete():
    torque = ramps((4.0, 300), (4.0, 300), (40.0, 900), (40.0, 900))
    small, large = find_ramps(torque, creep(GEAR, torque))
    assert [loop.complete for loop in small.loops] == [True, True]
    assert [loop.complete for loop in large.loops] == [True, False]


def test_rate_is_that_of_the_torque():
    torque = ramps(*[(5.0, 100)] * 3, *[(40.0, 200)] * 2)
    travel = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(torque)))])
    angle = creep(GEAR, torque)
    for group in find_ramps(torque, angle, travel / 2.5):
        assert group.rate == pytest.approx(2.5, rel=0.01)
    assert find_ramps(torque, angle)[0].rate is None


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_first_side_does_not_matter(sign):
    torque = sign * ramps((5.0, 200), (5.0, 200))
    (found,) = find_ramps(torque, sign * creep(GEAR, sign * torque))
    assert len(found.loops) == 2
    assert found.loops[0].width(0.0) == pytest.approx(0.01 + 2 * 1.0 / 200.0, abs=1e-5)


def test_halt_at_zero_and_at_the_peaks_changes_nothing():
    torque = ramps((5.0, 200), (5.0, 200))
    halted = np.concatenate(
        [np.repeat(value, 60 if abs(value) in {0.0, 5.0} else 1) for value in torque]
    )
    widths = [
        [
            loop.width(t)
            for t in (-1.0, 0.0, 2.0)
            for loop in find_ramps(t_, creep(GEAR, t_))[0].loops
        ]
        for t_ in (torque, halted)
    ]
    np.testing.assert_allclose(widths[0], widths[1], rtol=0, atol=1e-5)


def test_noise_that_crosses_zero_is_no_ramp():
    torque = ramps((10.0, 500), (10.0, 500))
    noisy = torque.copy()
    burst = np.abs(torque) < 0.5
    noisy[burst] += 3.0 * np.random.default_rng(2).standard_normal(np.count_nonzero(burst))
    (found,) = find_ramps(noisy, creep(GEAR, torque))
    assert len(found.loops) == 2


@pytest.mark.parametrize(
    'torque',
    [
        np.zeros(1000),
        np.linspace(0.0, 5.0, 1000),
        np.abs(ramps((5.0, 200), (5.0, 200))),
        ramps((5.0, 5)),
        np.zeros(0),
        np.zeros(3),
    ],
    ids=['none', 'one way', 'one side', 'too few samples', 'nothing', 'hardly anything'],
)
def test_torque_without_ramps_is_refused(torque):
    with pytest.raises(RampError, match='no torque ramp'):
        find_ramps(torque, np.zeros(len(torque)))


@pytest.mark.parametrize('noise', [0.02, 0.3])
def test_noise_of_the_torque_leaves_no_bias(noise):
    torque = ramps((4.0, 450), (4.0, 450))
    angle = torque / 300.0  # an ideal spring
    errors = []
    for seed in range(20):
        noisy = torque + noise * np.random.default_rng(seed).standard_normal(len(torque))
        (found,) = find_ramps(noisy, angle)
        at = np.linspace(-3.5, 3.5, 15)
        errors += [
            300.0 * branch.angle_at(at) - at
            for loop in found.loops
            for branch in (loop.fall, loop.rise)
            if abs(branch.end) > 3.5
        ]
    errors = np.array(errors)
    assert np.abs(errors.mean()) < 0.02 * noise
    assert errors.std() < 1.2 * 0.01 * 4.0  # a hundredth of the amplitude
