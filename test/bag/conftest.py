# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the tests of bags have in common."""

import pytest
from shipped_bags import BAGS, TYPES, read_bag

from gear_kinematics.bag import Message


@pytest.fixture(scope='session')
def recorded() -> list[Message]:
    """The first 900 messages of a shipped bag, as rosbags reads them."""
    messages = read_bag(BAGS / 'servo_point_to_point')
    assert len(messages) == 9000
    assert {topic for topic, _, _ in messages} == set(TYPES)
    return messages[:900]
