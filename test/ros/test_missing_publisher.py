# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Which topics the node names if the rotor's has no publisher; without DDS."""

from types import SimpleNamespace

from gear_kinematics.ros.missing_publisher import MissingPublisher
from gear_kinematics.wire.topics import JOINT_STATE


class Graph:
    """Stands in for the node and the topics around it."""

    def __init__(self, *topics) -> None:
        self.topics = topics
        self.publishers = [SimpleNamespace(topic_name='/output_state')]
        self.warnings = []

    def resolve_topic_name(self, name):
        return f'/{name}'

    def get_logger(self):
        return SimpleNamespace(warning=self.warnings.append)

    def get_topic_names_and_types(self):
        joint_states = [*self.topics, '/output_state', '/rotor_state', '/subscribed']
        return [('/chatter', ['std_msgs/msg/String']), *((t, [JOINT_STATE]) for t in joint_states)]

    def count_publishers(self, topic):
        return int(topic != '/subscribed')


def test_other_topics_are_named_once_in_each_time_without_a_publisher():
    graph = Graph('/wheels', '/motor')
    missing = MissingPublisher(graph)
    counts = []
    for publishers in (0, 0, 0, 1, 1, 0, 0, 0):
        missing.update(publishers)
        counts.append(len(graph.warnings))
    assert counts == [0, 1, 1, 1, 1, 1, 2, 2]
    assert graph.warnings[0] == (
        '/rotor_state has no publisher; there are: /motor, /wheels; choose one with '
        '-r rotor_state:=<topic>, or with ros2 launch rotor_state:=<topic>'
    )


def test_nothing_is_said_where_there_is_no_other_topic():
    graph = Graph()
    missing = MissingPublisher(graph)
    for _ in range(3):
        missing.update(0)
    assert not graph.warnings
