# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings in which two motions are in turn, as of two drivers, and others that look alike."""

import math
from itertools import accumulate, cycle, islice
from random import Random

import numpy as np
import pytest
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition

SETTINGS = NodeParameters.load()


def turning(time) -> float:
    return 40.0 * math.sin(0.75 * time)


def sent(rate, angle, *, begin=0.0) -> list[tuple[float, float]]:
    """Return times, s, and readings, rad, of a driver."""
    return [(begin + k / rate, angle(begin + k / rate)) for k in range(round(6.0 * rate))]


def fault_of(*drivers, batch=500):
    """Return what is found in a recording of drivers, in batches of so many messages."""
    readings = sorted((r for driver in drivers for r in driver), key=lambda reading: reading[0])
    rotor_input = RotorInput(SETTINGS)
    for first in range(0, len(readings), batch):
        times = [100 * SECOND + round(t * SECOND) for t, _ in readings[first : first + batch]]
        angles = [angle for _, angle in readings[first : first + batch]]
        messages = [
            rotor_bytes(t, position=[angle]) for t, angle in zip(times, angles, strict=True)
        ]
        rotor_input.accept_batch(messages, times)
    return rotor_input.disorder.fault


@pytest.mark.parametrize('second', [
    pytest.param(sent(200, lambda t: turning(t) + 0.3, begin=0.0003), id='near'),
    pytest.param(sent(200, lambda t: turning(t) + 7.0, begin=0.0003), id='far'),
    pytest.param(sent(200, lambda t: turning(t - 0.1), begin=0.0003), id='late'),
    pytest.param(sent(200, lambda t: 25.0 + 30.0 * math.sin(0.9 * t), begin=0.0003), id='robot'),
    pytest.param(sent(10, lambda _: 0.0, begin=0.0003), id='zeros'),
    pytest.param(sent(200, lambda _: 9.0, begin=0.0003), id='stuck'),
])  # fmt: skip
def test_readings_of_two_drivers_are_said_to_alternate(second):
    assert fault_of(sent(200, turning), second) == Condition.TWO_MOTIONS()


@pytest.mark.parametrize('batch', [100, 500, 2000])
def test_two_drivers_are_found_however_a_recording_is_cut(batch):
    """The second one sends for 0.1 s, and again for a moment at the end."""
    second = sent(200, lambda t: turning(t) + 0.4, begin=0.0003)
    readings = sent(200, turning), second[400:420], second[-4:]
    assert fault_of(*readings, batch=batch) == Condition.TWO_MOTIONS()


def test_one_driver_is_not_said_to_alternate():
    random = Random(5)  # noqa: S311
    assert fault_of(sent(200, turning)) is None
    corrupt = sent(200, lambda t: turning(t) + (random.random() < 0.02) * random.uniform(-99, 99))
    assert fault_of(corrupt) is None
    jump = sent(200, lambda t: turning(t) + 100.0 * (t > 3.0))
    assert fault_of(jump) is None


@pytest.mark.parametrize('kind', [float, np.float32])
@pytest.mark.parametrize('steps', [24, 42, 64, 4096])
def test_a_rotor_that_trembles_is_not_said_to_alternate(steps, kind):
    """It changes by one step of its encoder with each message, or vibrates within its limits."""
    step = math.tau / steps
    counts = sent(1000, lambda t: 5e4 + round(t * 1000) % 2 + round(turning(t) / step))
    assert fault_of([(t, float(kind(step * count))) for t, count in counts]) is None
    limit = SETTINGS.max_rotor_acceleration
    vibrating = sent(200, lambda t: limit / (math.tau * 90.0) ** 2 * math.sin(math.tau * 90.0 * t))
    assert fault_of(vibrating) is None


def test_a_rotor_that_trembles_is_not_said_to_alternate_where_the_rate_changes():
    """It vibrates at 6317 rad/s²; its driver sends at 1000 Hz, and at times at 100 Hz."""
    times = accumulate(islice(cycle([0.001] * 400 + [0.01] * 100), 3000))
    assert fault_of([(t, 0.1 * math.sin(math.tau * 40.0 * t)) for t in times]) is None


@pytest.mark.parametrize('rate', [20, 50])
def test_a_rotor_that_trembles_is_not_said_to_alternate_where_stamps_are_whole_seconds(rate):
    """It vibrates at 6000 rad/s², or at 600 rad/s, in four tenths of the rate."""
    turning_rate = math.tau * 0.4 * rate
    swing = min(6000.0 / turning_rate, 600.0) / turning_rate
    readings = sent(rate, lambda t: swing * math.sin(turning_rate * t))
    assert fault_of([(float(int(t)), angle) for t, angle in readings]) is None
