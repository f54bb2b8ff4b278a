# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Which topics the node suggests if the rotor's has no publisher; without DDS."""

from types import SimpleNamespace

import pytest
from live import SECOND, rotor_bytes
from rclpy.impl.implementation_singleton import rclpy_implementation

from gear_kinematics.ros.missing_publisher import MissingPublisher
from gear_kinematics.wire.topics import JOINT_STATE


class Graph:
    """Stands in for the node and the topics around it."""

    def __init__(self, joint='rotor', forbidden=(), **joints) -> None:
        """Set rotor_joint, and the joints of each topic: None where no message comes."""
        self.joint = joint
        self.forbidden = forbidden
        self.joints = {f'/{topic}': names for topic, names in joints.items()}
        self.publishers = [SimpleNamespace(topic_name='/output_state')]
        self.warnings = []
        self.subscribed = {}
        self.missing_publisher = MissingPublisher(self)

    def resolve_topic_name(self, name):
        return f'/{name}'

    def get_parameter(self, name):
        return SimpleNamespace(value={'rotor_joint': self.joint}[name])

    def get_logger(self):
        return SimpleNamespace(warning=self.warnings.append)

    def get_topic_names_and_types(self):
        others = [('/output_state', [JOINT_STATE]), ('/chatter', ['std_msgs/msg/String'])]
        return [(topic, [JOINT_STATE]) for topic in self.joints] + others

    def count_publishers(self, topic):
        return int(topic in self.joints)

    def create_subscription(self, _type, topic, callback, _qos, *, raw):
        assert raw
        if topic in self.forbidden:
            raise rclpy_implementation.RCLError('not allowed')
        self.subscribed[topic] = callback
        return topic

    def destroy_subscription(self, topic):
        del self.subscribed[topic]

    def pass_seconds(self, count, publishers=0):
        """Update once a second, and let messages come in between."""
        for _ in range(count):
            self.missing_publisher.update(publishers)
            for topic, callback in self.subscribed.items():
                if (names := self.joints[topic]) is not None:
                    callback(rotor_bytes(SECOND, names, len(names) * [0.0]))


def test_topics_are_suggested_once_with_their_joints():
    graph = Graph(motor=['m1', 'rotor_1'], silent=None)
    graph.pass_seconds(1)
    assert graph.warnings == []
    graph.pass_seconds(1)
    assert len(graph.warnings) == 1
    graph.pass_seconds(55)
    [warning] = graph.warnings
    assert warning == (
        '/rotor_state has no publisher; there are: /motor (joints m1, rotor_1), '
        '/silent (no message yet); did you mean `--ros-args -r rotor_state:=/motor '
        '-p rotor_joint:=rotor_1`, or with ros2 launch '
        '`rotor_state:=/motor rotor_joint:=rotor_1`?'
    )
    assert graph.subscribed == {}
    graph.pass_seconds(1, publishers=1)
    graph.pass_seconds(20)
    assert len(graph.warnings) == 2


@pytest.mark.parametrize(
    ('joints', 'joint', 'arguments'),
    [
        ({'a': ['rotor'], 'b': ['wheel']}, 'rotor', '-r rotor_state:=/a'),
        ({'a': ['wheel']}, 'rotor', '-r rotor_state:=/a -p rotor_joint:=wheel'),
        ({'a': ['wheel']}, '', '-r rotor_state:=/a'),
        ({'rotor_states': ['m'], 'b': ['m']}, 'm', '-r rotor_state:=/rotor_states'),
        ({'a': ['m'], 'b': ['m']}, 'm', None),
    ],
)
def test_arguments_are_suggested_if_it_is_clear_which(joints, joint, arguments):
    graph = Graph(joint, **joints)
    graph.pass_seconds(9)
    [warning] = graph.warnings
    suggestion = f'; did you mean `--ros-args {arguments}`, or with ' if arguments else ''
    assert suggestion in warning
    assert suggestion or warning.endswith(', /b (joint m)')


@pytest.mark.parametrize(('forbidden', 'publishers'), [(['/motor'], 0), ((), 1)])
def test_nothing_is_suggested_of_a_forbidden_topic_or_with_a_publisher(forbidden, publishers):
    graph = Graph(motor=['rotor'], forbidden=forbidden)
    graph.pass_seconds(20, publishers)
    assert (graph.warnings, graph.subscribed) == ([], {})


def test_bytes_that_are_no_message_are_passed_over():
    graph = Graph(motor=None)
    graph.missing_publisher.update(0)
    graph.subscribed['/motor'](b'none')
    graph.pass_seconds(1)
    assert '/motor (no joints)' in graph.warnings[0]
