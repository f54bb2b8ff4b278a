"""When the topics that there are are told, if the rotor's has no publisher; without DDS."""

from types import SimpleNamespace

import pytest
from live import SECOND, rotor_bytes
from rclpy.impl.implementation_singleton import rclpy_implementation

from gear_kinematics.ros.unheard import UnheardTopic
from gear_kinematics.wire.topics import JOINT_STATE


class Graph:
    """A node as far as it is asked, and the topics around it."""

    def __init__(self, **joints) -> None:
        """Give the joints on each topic; None where no message comes."""
        self.joints = {f'/{topic}': names for topic, names in joints.items()}
        self.publishers = [SimpleNamespace(topic_name='/output_state')]
        self.told = []
        self.subscribed = {}
        self.forbidden = set()
        self.joint = 'rotor'
        self.unheard = UnheardTopic(self, 'rotor_state', 'rotor_joint')

    def resolve_topic_name(self, name):
        return f'/{name}'

    def get_parameter(self, name):
        assert name == 'rotor_joint'
        return SimpleNamespace(value=self.joint)

    def get_logger(self):
        return SimpleNamespace(warning=self.told.append)

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

    def pass_time(self, start, end, publishers=0):
        """Look once a second, and let messages come in between."""
        for now in range(start, end):
            self.unheard.look(publishers, float(now))
            for topic, callback in self.subscribed.items():
                if (names := self.joints[topic]) is not None:
                    callback(rotor_bytes(SECOND, names, len(names) * [0.0]))


def test_topics_are_told_once_with_their_joints():
    graph = Graph(motor=['m1', 'rotor_1'], silent=None)
    graph.pass_time(0, 5)
    assert graph.told == []
    graph.pass_time(5, 60)
    (told,) = graph.told
    assert told == (
        '/rotor_state has no publisher; there are: /motor (joints m1, rotor_1), '
        '/silent (no message yet); did you mean `--ros-args -r rotor_state:=/motor '
        '-p rotor_joint:=rotor_1`?'
    )
    assert graph.subscribed == {}
    graph.pass_time(60, 61, publishers=1)
    graph.pass_time(61, 80)
    assert len(graph.told) == 2


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
def test_arguments_are_told_if_it_is_clear_which(joints, joint, arguments):
    graph = Graph(**joints)
    graph.joint = joint
    graph.pass_time(0, 9)
    (told,) = graph.told
    assert ('did you mean' in told) == (arguments is not None)
    assert told.endswith(f'did you mean `--ros-args {arguments}`?' if arguments else '(joint m)')


def test_a_topic_that_appears_later_is_told_with_its_joints():
    graph = Graph()
    graph.pass_time(0, 20)
    assert graph.told == []
    graph.joints['/motor'] = ['rotor']
    graph.pass_time(20, 23)
    assert [text.partition(';')[2] for text in graph.told] == [
        ' there are: /motor (joint rotor); did you mean `--ros-args -r rotor_state:=/motor`?'
    ]


def test_nothing_is_told_of_what_must_not_be_listened_to_or_while_there_is_a_publisher():
    graph = Graph(motor=['rotor'])
    graph.forbidden = {'/motor'}
    graph.pass_time(0, 20)
    assert graph.told == []
    other = Graph(motor=['rotor'])
    other.pass_time(0, 20, publishers=1)
    assert (other.told, other.subscribed) == ([], {})


def test_bytes_that_are_no_message_are_passed_over():
    graph = Graph(motor=None)
    graph.pass_time(0, 5)
    graph.subscribed['/motor'](b'none')
    graph.pass_time(5, 9)
    assert '/motor (no joints)' in graph.told[0]
