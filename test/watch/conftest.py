# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A driver for the tests that are beside one."""

import pytest


@pytest.fixture(scope='module')
def driver():
    from watching import driving  # noqa: PLC0415, only where rclpy is

    with driving():
        yield
