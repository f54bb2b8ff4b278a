# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reversals of torque ramps, and the angle over the torque between them."""

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps

from gear_kinematics.measurement.loops import RampError, find_ramps

GEAR = Gear(play=0.01, stiffness=200.0, friction=1.0)


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
        for fall, rise in ramp.loops:
            assert np.all(np.diff(rise.torque) > 0.0)
            assert np.all(np.diff(fall.torque) < 0.0)
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


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_recording_of_one_loop_is_completed_by_an_image(sign):
    """It ends at no torque; the missing side is that of a loop which goes on."""
    torque = sign * ramps((5.0, 300), (5.0, 300))
    angle = 0.3 + sign * creep(GEAR, sign * torque)
    half = len(torque) // 2 + 2
    [ramps_of] = find_ramps(torque, angle)
    [alone] = find_ramps(torque[:half], angle[:half])
    [part] = alone.loops
    assert not part.complete
    assert part.completed.complete
    at = np.linspace(-4.9, 4.9, 30)
    for way, other in zip(part.completed, ramps_of.loops[0], strict=True):
        np.testing.assert_allclose(way.angle_at(at), other.angle_at(at), rtol=0, atol=1e-4)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_first_side_does_not_matter(sign):
    torque = sign * ramps((5.0, 200), (5.0, 200))
    (found,) = find_ramps(torque, sign * creep(GEAR, sign * torque))
    assert len(found.loops) == 2
    assert found.loops[0].width(0.0) == pytest.approx(0.01 + 2 * 1.0 / 200.0, abs=1e-5)


def test_halt_at_zero_and_at_the_peaks_changes_nothing():
    torque = ramps((5.0, 200), (5.0, 200))
    halted = np.repeat(torque, np.where(np.isin(np.abs(torque), (0.0, 5.0)), 60, 1))
    widths = [
        [loop.width(t) for t in (-1.0, 0.0, 2.0) for loop in ramps_of.loops]
        for way in (torque, halted)
        for ramps_of in find_ramps(way, creep(GEAR, way))
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
    at = np.linspace(-3.5, 3.5, 15)
    errors = []
    for seed in range(20):
        noisy = torque + noise * np.random.default_rng(seed).standard_normal(len(torque))
        (found,) = find_ramps(noisy, torque / 300.0)  # an ideal spring
        errors += [300.0 * h.angle_at(at) - at for h in found.halves if abs(h.end) > 3.5]
    assert np.abs(np.mean(errors)) < 0.02 * noise
    assert np.std(errors) < 1.2 * 0.01 * 4.0  # a hundredth of the amplitude
