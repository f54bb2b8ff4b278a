# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Faults in the graph, with nodes that share a participant, so that changes show at once."""

import itertools

import pytest
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from gear_kinematics.ros.diagnostics import find_faults
from gear_kinematics.state.statuses import Condition

pytestmark = pytest.mark.live

BEST_EFFORT = {'reliability': ReliabilityPolicy.BEST_EFFORT}
LATCHED = {'durability': DurabilityPolicy.TRANSIENT_LOCAL}
SECOND = Duration(seconds=1)
namespaces = (f'/graph_{number}' for number in itertools.count())


@pytest.fixture
def make(context):
    """A function that creates a node, by default in a namespace of the test."""
    nodes, own = [], next(namespaces)

    def make(name, namespace=own):
        nodes.append(Node(name, context=context, namespace=namespace))
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()


def publisher(node, topic='out', **policies):
    return node.create_publisher(JointState, topic, QoSProfile(depth=1, **policies))


def subscription(node, topic='in', **policies):
    profile = QoSProfile(depth=1, **policies)
    return node.create_subscription(JointState, topic, lambda _: None, profile)


@pytest.mark.parametrize(('offered', 'requested', 'policies'), [
    ({}, {}, []), ({}, BEST_EFFORT, []), (LATCHED, LATCHED, []),
    (BEST_EFFORT, LATCHED, ['RELIABILITY', 'DURABILITY']),
    ({}, {'deadline': SECOND}, ['DEADLINE']),
    ({}, {'liveliness': LivelinessPolicy.MANUAL_BY_TOPIC}, ['LIVELINESS']),
    ({}, {'liveliness_lease_duration': SECOND}, ['LIVELINESS_LEASE_DURATION']),
], ids=str)  # fmt: skip
def test_listener_that_requests_more_than_offered_is_a_warning(make, offered, requested, policies):
    mine, other = make('mine'), make('other')
    output = publisher(mine, **offered)
    listener = subscription(other, 'out', **requested)
    name = other.get_fully_qualified_name()
    assert find_faults(mine, [], [output], ['out']) == [
        Condition.LISTENER_QOS(topic='out', policy=policy, node=name) for policy in policies
    ]
    other.destroy_subscription(listener)
    assert find_faults(mine, [], [output], ['out']) == []


@pytest.mark.parametrize(
    ('reliability', 'found'),
    [('RELIABLE', True), ('BEST_EFFORT', False), ('BEST_AVAILABLE', False)],
)
def test_driver_that_offers_less_than_requested_is_an_error(make, reliability, found):
    mine, driver = make('mine'), make('driver')
    topic_input = subscription(mine, reliability=ReliabilityPolicy[reliability])
    name = driver.get_fully_qualified_name()
    publisher(driver, 'in')
    assert find_faults(mine, [topic_input], [], []) == []
    wrong = publisher(driver, 'in', **BEST_EFFORT)
    faults = [Condition.DRIVER_QOS(topic='in', policy='RELIABILITY', node=name)] * found
    assert find_faults(mine, [topic_input], [], []) == faults
    driver.destroy_publisher(wrong)
    assert find_faults(mine, [topic_input], [], []) == []


def test_other_publishers_on_exclusive_topics_are_named_with_these(make):
    mine, other, third = make('mine'), make('other'), make('third')
    outputs = [publisher(mine, topic) for topic in ('a', 'b', 'c', 'shared')]
    for topic in ('a', 'c', 'shared'):
        publisher(other, topic)
    publisher(third, 'c')
    namespace = mine.get_namespace()
    assert find_faults(mine, [], outputs, ['a', 'b', 'c']) == [
        Condition.ALSO_PUBLISHES(node=f'{namespace}/other', topics=['a', 'c']),
        Condition.ALSO_PUBLISHES(node=f'{namespace}/third', topics=['c']),
    ]


def test_outputs_of_the_node_itself_may_share_a_topic(make):
    mine = make('mine')
    assert find_faults(mine, [], [publisher(mine), publisher(mine)], ['out']) == []


def test_node_of_the_same_name_is_a_warning_in_the_same_namespace_only(make):
    mine = make('mine')
    make('mine', f'{mine.get_namespace()}/deeper')
    assert find_faults(mine, [], [], []) == []
    make('mine')
    same = Condition.SAME_NAME(node=mine.get_fully_qualified_name())
    assert find_faults(mine, [], [], []) == [same]


def test_name_in_the_root_namespace_begins_with_one_slash(make):
    mine = make('mine')
    publisher(make('stranger', ''), f'{mine.get_namespace()}/out')
    faults = find_faults(mine, [], [publisher(mine)], ['out'])
    assert faults == [Condition.ALSO_PUBLISHES(node='/stranger', topics=['out'])]


def test_output_that_is_not_in_the_graph_yet_is_not_checked(make, monkeypatch):
    mine = make('mine')
    subscription(mine, 'out', **LATCHED)
    monkeypatch.setattr(Node, 'get_publishers_info_by_topic', lambda *_: [])
    assert find_faults(mine, [], [publisher(mine)], ['out']) == []
