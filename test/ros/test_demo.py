"""The demo pairs what belongs together."""

import struct

import pytest

from gear_kinematics.ros.demo import Answers

pytestmark = pytest.mark.live  # imports ROS
TOPICS = {'/in', '/out', '/poses'}


def message(topic, stamp):
    return topic, 0, b'\0\1\0\0' + struct.pack('<iI', 7, stamp) + topic.encode()


def test_latest_answers_are_those_to_one_rotor_state():
    answers = Answers(TOPICS)

    def latest_after(*messages):
        for topic, stamp in messages:
            answers.add(message(topic, stamp))
        found = {
            (topic, struct.unpack_from('<I', data, 8)) for topic, data in answers.latest.items()
        }
        stamps = {stamp for _, (stamp,) in found}
        assert len(stamps) <= 1
        assert {topic for topic, _ in found} == (TOPICS if stamps else set())
        return stamps

    assert latest_after(('/in', 1), ('/in', 2), ('/out', 1)) == set()
    assert latest_after(('/poses', 1)) == {1}
    assert latest_after(('/in', 3), ('/out', 2), ('/out', 3)) == {1}
    assert latest_after(('/poses', 2)) == {2}
    # A rotor state that is rejected has no answer.
    assert latest_after(('/in', 4), ('/in', 5), ('/poses', 5), ('/out', 5)) == {5}
    # Stamps step back in a bag that loops.
    assert latest_after(('/in', 1), ('/poses', 1), ('/out', 1)) == {1}
