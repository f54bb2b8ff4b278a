# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Lost motion and delay of simulated gears, live and from pairs of runs."""

import math

import numpy as np
import pytest
from simulated_encoders import ARC_MINUTE, MS, TURN, Drive, sine_strokes, stamps

from gear_kinematics.correction.error_window import ErrorWindow
from gear_kinematics.correction.reversals import separate
from gear_kinematics.correction.transmission_error import TransmissionError

PLAY = 3.0 * ARC_MINUTE
DELAY = 2e-3  # s
ERRORS = {1: 4.0 * ARC_MINUTE, 19: 1.0 * ARC_MINUTE, 20: 0.3 * ARC_MINUTE}
STEPS = {'rotor_step': TURN / 2**14, 'output_step': TURN / 2**17}


def live(drive: Drive, profile, seconds, every=1.0, rate=500.0, seed=1):
    """Return what the node's window of 10 s says at times from the first reversal on."""
    times, rotor, output = drive.readings(profile, seconds, rate, seed)
    comparison = TransmissionError(max_gap=100 * MS, travel=math.radians(1.0))
    window, found, due = ErrorWindow(10 * 1000 * MS), [], 9.0
    ideal = (rotor / drive.ratio).tolist()
    readings = zip(times.tolist(), stamps(times).tolist(), ideal, output.tolist(), strict=True)
    for time, stamp, angle, reading in readings:
        for sample in comparison.add_ideal(stamp, 0, angle) + comparison.add_measured(
            stamp, reading
        ):
            window.add(sample)
        if time >= due:
            found.append(window.statistics().reversals)
            due += every
    return found


@pytest.mark.slow
@pytest.mark.parametrize('delay', [0.0, DELAY])
def test_lost_motion_is_the_play_at_any_time(delay):
    drive = Drive(PLAY, ERRORS, delay, noise=0.1 * ARC_MINUTE, **STEPS)
    found = live(drive, sine_strokes(1.0, 8.0), 41.0)
    known = [reversals for reversals in found if reversals and reversals.lost_motion]
    assert len(known) >= 0.7 * len(found)  # about the turning points too few angles are covered
    values = np.array([k.lost_motion.value for k in known])
    spreads = np.array([k.lost_motion.uncertainty for k in known])
    np.testing.assert_allclose(values, PLAY, rtol=0, atol=0.2 * ARC_MINUTE)
    assert np.mean(np.abs(values - PLAY) <= spreads) >= 0.85
    assert np.median(spreads) < 0.1 * ARC_MINUTE
    delays = np.array([k.delay.value for k in known])
    np.testing.assert_allclose(delays, delay, rtol=0, atol=2e-4)


# Angles that both directions cover


def test_two_speeds_tell_a_delay():
    speed = np.repeat([0.2, 1.0], 200)
    noise = 1e-5 * np.random.default_rng(0).standard_normal(len(speed))
    found = separate(1e-3 - 4e-3 * speed + noise, speed)
    for estimate, true in ((found.lost_motion, 1e-3), (found.delay, -4e-3)):
        assert abs(estimate.value - true) <= 2.0 * estimate.uncertainty
    assert found.delay.uncertainty < 2e-5


def test_noise_of_the_speed_is_no_variation_of_it():
    noisy = 0.5 + 0.3 * np.random.default_rng(3).standard_normal(400)
    assert separate(1e-3 + 2e-3 * np.full(400, 0.5), noisy).lost_motion is None


def test_nothing_in_common_is_nothing_found():
    assert separate(np.zeros(0), np.zeros(0)) is None
