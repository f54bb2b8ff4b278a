# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Velocities that contradict the positions, as drivers send them."""

import math
from contextlib import suppress

import numpy as np
import pytest
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.joint_reader import RejectedInputError

SETTINGS = NodeParameters.load()


def messages(factor, speed=100.0, rate=500, scatter=0.0, duration=1.0) -> list[bytes]:
    generator = np.random.default_rng(1)
    times = np.arange(round(duration * rate)) / rate
    return [
        rotor_bytes(
            SECOND + round(t * SECOND),
            position=[speed * t],
            velocity=[factor * speed + scatter * generator.normal()],
        )
        for t in times
    ]


@pytest.mark.parametrize(
    ('factor', 'meaning'),
    [
        (0.0, '0'),
        (30.0 / math.pi, 'rpm'),
        (0.5 / math.pi, 'turns/s'),
        (180.0 / math.pi, 'deg/s'),
        (-1.0 / 19.0, 'the velocity of the output'),
        (-1.0, 'the velocity with the opposite sign'),
        (3.0, 'an unknown quantity'),
    ],
)
def test_wrong_velocities_are_named_and_not_passed_on(factor, meaning):
    rotor = RotorInput(SETTINGS)
    samples = [rotor.accept(data, int) for data in messages(factor)]
    assert rotor.velocity_field.meaning.values['meaning'] == meaning
    assert rotor.velocity_field.factor == pytest.approx(factor, abs=1e-6)
    assert samples[-1].velocity is None


@pytest.mark.parametrize(
    ('factor', 'speed', 'meaning'),
    [
        (0.0, 1.0, '0'),
        (0.5 / math.pi, 1.0, 'turns/s'),
        (-1.0, -3.0, 'the velocity with the opposite sign'),
        (1.0, 1.0, None),
        (2.0, 1.0, None),  # whole rad/s, rounded up, of half as many
    ],
)
def test_wrong_velocities_of_a_slow_rotor_are_named(factor, speed, meaning):
    rotor = RotorInput(SETTINGS)
    for data in messages(factor, speed, rate=25, duration=8.0):
        rotor.accept(data, int)
    found = rotor.velocity_field.meaning
    assert (found and found.values['meaning']) == meaning


@pytest.mark.parametrize(('motion', 'meaning'), [
    (lambda t: 4.0 * math.sin(t), '0'),
    (lambda t: 100.0 * (t > 4.0) + 0.1 * math.sin(t), None),  # a jump of the encoder near rest
])  # fmt: skip
def test_velocities_of_0_throughout_an_unsteady_slow_motion_are_named(motion, meaning):
    rotor = RotorInput(SETTINGS)
    for k in range(800):
        data = rotor_bytes(k * SECOND // 100 + 1, position=[motion(k / 100)], velocity=[0.0])
        with suppress(RejectedInputError):
            rotor.accept(data, int)
    found = rotor.velocity_field.meaning
    assert (found and found.values['meaning']) == meaning


def test_velocities_that_are_noise_around_zero_are_not_used():
    rotor = RotorInput(SETTINGS)
    samples = [rotor.accept(data, int) for data in messages(0.0, scatter=2.0)]
    assert rotor.velocity_field.contradicts
    assert samples[-1].velocity is None


def test_velocities_of_an_encoder_that_is_stuck_contradict_it():
    rotor = RotorInput(SETTINGS)
    for k in range(1000):
        position = min(0.02 * k, 5.0)
        rotor.accept(rotor_bytes(k * SECOND // 500 + 1, position=[position], velocity=[10.0]), int)
    unknown = Condition.VELOCITIES_ARE(meaning='an unknown quantity')
    assert rotor.velocity_field.meaning == unknown


@pytest.mark.parametrize(
    ('factor', 'speed', 'scatter'), [(1.0, 100.0, 3.0), (1.0, -100.0, 0.0), (0.0, 0.5, 0.0)]
)
def test_right_velocities_and_slow_motion_raise_no_alarm(factor, speed, scatter):
    rotor = RotorInput(SETTINGS)
    samples = [rotor.accept(data, int) for data in messages(factor, speed, scatter=scatter)]
    assert rotor.velocity_field.meaning is None
    assert all(sample.velocity is not None for sample in samples)
