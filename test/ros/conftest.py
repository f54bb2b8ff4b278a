# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Nodes within the process of the test."""

import pytest
from rclpy.parameter import Parameter

from gear_kinematics.ros.node import GearStatePublisher


@pytest.fixture
def make(context):
    """Return a function that creates a node with parameters; all are destroyed at the end."""
    nodes = []

    def make(namespace='', **values):
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        node = GearStatePublisher(
            context=context, namespace=namespace, parameter_overrides=overrides
        )
        nodes.append(node)
        return node

    yield make
    for node in nodes:
        node.destroy_node()
