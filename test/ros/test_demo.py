"""The demo shows outputs beside the rotor state they belong to."""

import struct

import pytest

from gear_kinematics.ros.demo import latest_complete

pytestmark = pytest.mark.live  # imports ROS
TOPICS = {'/in', '/out', '/poses'}


@pytest.mark.parametrize(
    ('messages', 'stamp'),
    [
        ([], None),
        ([('/in', 1), ('/in', 2), ('/out', 1)], None),
        ([('/in', 1), ('/in', 2), ('/out', 1), ('/poses', 1)], 1),
        ([('/in', 1), ('/out', 1), ('/poses', 1), ('/in', 2), ('/out', 2)], 1),
        # 2 was rejected.
        ([('/in', 2), ('/in', 3), ('/poses', 3), ('/out', 3), ('/in', 4)], 3),
    ],
)
def test_messages_of_the_latest_complete_stamp_are_shown(messages, stamp):
    received = [
        (topic, 0, b'\0\1\0\0' + struct.pack('<iI', 7, stamp) + topic.encode())
        for topic, stamp in messages
    ]
    found = latest_complete(received, TOPICS)
    expected = [] if stamp is None else [(topic, stamp) for topic in sorted(TOPICS)]
    assert [
        (topic, *struct.unpack_from('<I', data, 8)) for topic, data in sorted(found.items())
    ] == expected
    assert all(data.endswith(topic.encode()) for topic, data in found.items())
