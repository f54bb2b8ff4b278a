# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Efforts that are no torques: zeros in motion, other units."""

from dataclasses import replace

import numpy as np
import pytest
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.effort_field import questioned
from gear_kinematics.state.rotor_input import RotorInput

MULTI = NodeParameters.load()
STEP = 0.04  # rad: a second one is a motion


def efforts(settings, given, batches) -> list:
    """What is taken of the efforts at positions 0, 1, 2, ... steps, nan for none."""
    rotor, found = RotorInput(settings), []
    messages = [
        rotor_bytes(100 * SECOND + k * 10_000_000, position=[STEP * place], effort=effort)
        for k, (place, effort) in enumerate(given)
    ]
    for part in np.array_split(np.arange(len(given)), batches) if batches else ():
        data = [messages[k] for k in part]
        found += rotor.accept_batch(data, [0] * len(data)).effort.tolist()
    if not batches:
        found = [rotor.accept(data, int).effort for data in messages]
    return [np.nan if each is None else each for each in found]


NONE = np.nan


@pytest.mark.parametrize('settings', [MULTI, replace(MULTI, rotor_encoder='single_turn')])
@pytest.mark.parametrize('batches', [0, 3])
@pytest.mark.parametrize(
    ('given', 'taken'),
    [
        ([(k, [0.0]) for k in range(5)], [0.0, 0.0, NONE, NONE, NONE]),
        ([(k % 2, [0.0]) for k in range(5)], [0.0] * 5),  # at rest
        ([(0, [0.0]), (2, []), (2, [0.0]), (0, [0.0])], [0.0, NONE, NONE, NONE]),
        ([(k, [3.0 * (k == 3)]) for k in range(7)], [0.0, 0.0, NONE, 3.0, 0.0, 0.0, 0.0]),
        ([(k, [-1.0 * (k == 0)]) for k in range(4)], [-1.0, 0.0, 0.0, 0.0]),
    ],
)
def test_zero_throughout_a_motion_is_no_effort(settings, batches, given, taken):
    np.testing.assert_array_equal(efforts(settings, given, batches), taken)


@pytest.mark.parametrize('batches', [0, 2])
def test_factor_and_direction_make_torques_of_efforts(batches):
    settings = replace(MULTI, rotor_direction=-1, rotor_effort_factor=0.05)
    given = [(0, [2.0]), (1, [-400.0])]
    np.testing.assert_allclose(efforts(settings, given, batches), [-0.1, 20.0], rtol=1e-15)


def test_torque_that_a_gear_of_that_size_cannot_bear_is_questioned():
    small = replace(MULTI, eccentricity=1e-4).mechanism  # 0.5 π 5e8 Pa (1.9 mm)³/19 = 0.28 N·m
    cases = [(99.0, None), (101.0, None), (-0.27, small), (-0.3, small), (90.0, MULTI.mechanism)]
    asked = [bool(questioned(effort, mechanism)) for effort, mechanism in cases]
    assert asked == [False, True, False, True, False]
