# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Gears whose nodes share topics, in one process."""

import pytest
from blocked_bags import wait_until
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from gear_kinematics.ros.other_gears import OtherGears
from gear_kinematics.wire.topics import BODY_POSES, OUTPUT_STATE

pytestmark = pytest.mark.live


@pytest.fixture
def executor(context):
    executor = SingleThreadedExecutor(context=context)
    yield executor
    executor.shutdown()


@pytest.mark.parametrize(
    ('theirs', 'clashes'),
    [
        ({}, [True, True]),
        ({'output_joint': 'elbow'}, [False, True]),  # the rotors have the same name
        ({'frame_prefix': 'elbow_'}, [False, False]),
        ({'actuators': ['output_shaft', 'elbow']}, [True, False]),  # an arm
        (None, [True, True]),  # no gear, as far as one can tell
    ],
    ids=['same', 'other joint', 'other prefix', 'arm', 'other node'],
)
def test_only_joints_of_the_same_names_clash(context, make, executor, theirs, clashes):
    mine, name = make('/sharing'), '/sharing/other/gear_state_publisher'
    other = make('/sharing/other', **theirs) if theirs is not None else None
    if other is None:
        other = Node('gear_state_publisher', context=context, namespace='/sharing/other')
    for node in (mine, other):
        executor.add_node(node)
    gears = OtherGears(mine, lambda: mine._current().values())
    assert not gears.clash(name, OUTPUT_STATE)  # it is asked
    answered = lambda: gears._names or (theirs is None and gears._asked[name] > 20)  # noqa: E731

    def look():
        executor.spin_once(timeout_sec=0.05)
        gears.clash(name, OUTPUT_STATE)
        return answered()

    wait_until(look, 'its answer')
    assert [gears.clash(name, topic) for topic in (OUTPUT_STATE, BODY_POSES)] == clashes
    if theirs is None:
        other.destroy_node()


def test_node_that_is_gone_clashes_after_a_while(make):
    gears = OtherGears(make('/alone'), list)
    found = [gears.clash('/alone/gone', OUTPUT_STATE) for _ in range(5)]
    assert found == [False, False, False, True, True]
