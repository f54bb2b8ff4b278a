# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The diagnostics of a node, and checks of its connections in the ROS graph."""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSCompatibility, QoSProfile, ReliabilityPolicy, qos_check_compatible
from rclpy.subscription import Subscription

from gear_kinematics.ros.graph import node_of
from gear_kinematics.state.statuses import Condition, Fact, GearReport

_POLICIES = 'reliability', 'durability', 'deadline', 'liveliness', 'liveliness_lease_duration'
"""Policies in which a subscription can request more than a publisher offers."""


def diagnostic_array(node: Node, reports: Mapping[str, GearReport]) -> DiagnosticArray:
    """Return the message for reports by subject."""
    name = node.get_fully_qualified_name()
    message = DiagnosticArray()
    message.header.stamp = node.get_clock().now().to_msg()
    message.status = [
        DiagnosticStatus(
            level=bytes([report.level]),
            name=f'{name.removeprefix("/")}: {subject}',
            hardware_id=name,
            message=report.message,
            values=[KeyValue(key=key, value=value) for key, value in report.texts.items()],
        )
        for subject, report in reports.items()
    ]
    return message


def find_faults(
    node: Node,
    subscriptions: Iterable[Subscription],
    publishers: Iterable[Publisher],
    exclusive: Collection[str],
    clash: Callable[[str, str], bool] = lambda _other, _topic: True,
) -> list[Fact]:
    """Find incompatible QoS, other publishers on exclusive topics, and a node of the same name.

    Another publisher is a fault if it clashes, given the full name of its node and the topic.
    """
    own_name = node.get_fully_qualified_name()
    faults = [
        Condition.DRIVER_QOS(topic=subscription.topic, policy=policy, node=node_of(driver))
        for subscription in subscriptions
        for driver in node.get_publishers_info_by_topic(subscription.topic)
        for policy in _unmet(subscription.qos_profile, driver.qos_profile)
    ]
    shared = defaultdict(list)
    for topic in (publisher.topic for publisher in publishers):
        listeners = node.get_subscriptions_info_by_topic(topic)
        if not listeners and topic not in exclusive:
            continue
        offers = {
            node_of(end): end.qos_profile for end in node.get_publishers_info_by_topic(topic)
        }
        # Ask the graph: in a publisher's own profile some policies are left to the middleware.
        if own_offer := offers.pop(own_name, None):
            faults += [
                Condition.LISTENER_QOS(topic=topic, policy=policy, node=node_of(listener))
                for listener in listeners
                for policy in _unmet(listener.qos_profile, own_offer)
            ]
        if topic in exclusive:
            for other in offers:
                if clash(other, topic):
                    shared[other].append(topic)
    faults += [Condition.ALSO_PUBLISHES(node=other, topics=shared[other]) for other in shared]
    names = node.get_node_names_and_namespaces()
    if names.count((node.get_name(), node.get_namespace())) > 1:
        faults.append(Condition.SAME_NAME(node=own_name))
    return faults


def _unmet(requested: QoSProfile, offered: QoSProfile) -> Iterator[str]:
    """Yield the policies in which more is requested than offered."""
    for policy in _POLICIES:
        alone = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)  # requests nothing
        setattr(alone, policy, getattr(requested, policy))
        compatibility, _ = qos_check_compatible(offered, alone)
        if compatibility == QoSCompatibility.ERROR:
            yield policy.upper()
