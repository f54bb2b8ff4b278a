# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Losses by the numbers of messages."""

import pytest

from gear_kinematics.state.losses import Losses


@pytest.mark.parametrize(
    ('numbers', 'missing'),
    [
        ((1, 2, 3), 0),
        ((5, 6, 9, 10), 2),
        ((5, 6, 1, 2, 4), 1),  # another driver in its place
        ((7, None, 9), 1),
    ],
)
def test_messages_between_two_numbers_of_a_driver_are_lost(numbers, missing):
    losses = Losses()
    for number in numbers:
        losses.note(number)
    assert losses.missing == missing
    assert losses.numbered == (None not in numbers)
