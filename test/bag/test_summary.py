# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What is in a recording."""

from pathlib import Path

import pytest
from live import rotor_bytes
from mcap.writer import Writer
from shipped_bags import BAGS, JOINT_STATE, write_bag

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.summary import summarise


def write(path, *topics, names=('m1', 'm2'), lost=()) -> Path:
    """Write 100 joint states at 100 Hz on each topic, without those that are lost."""
    messages = [
        (topic, stamp, rotor_bytes(stamp, names, [0.1 * k] * len(names)))
        for k, stamp in enumerate(range(10**18, 10**18 + 10**9, 10**7))
        for topic in topics
        if k not in lost
    ]
    return write_bag(path, messages, dict.fromkeys(topics, JOINT_STATE))


def summary(path, *arguments):
    with Bag(path) as bag:
        return summarise(bag, *arguments)


def test_the_duration_is_that_of_all_runs_where_time_begins_anew(tmp_path):
    """Twice 0.99 s, from 5 s and from 4.5 s on."""
    stamps = [*range(5 * 10**9, 6 * 10**9, 10**7), *range(4_500_000_000, 5_500_000_000, 10**7)]
    messages = [('/motor', stamp, rotor_bytes(stamp, ['m1'], [0.0])) for stamp in stamps]
    found = summary(write_bag(tmp_path / 'bag', messages, {'/motor': JOINT_STATE}))
    assert found.duration == pytest.approx(1.98)


def test_gaps_are_counted(tmp_path):
    """At 100 Hz, from the 19th to the 30th message are 11 periods."""
    (topic,) = summary(write(tmp_path / 'bag', '/motor', lost=range(20, 30))).topics
    assert (topic.part, topic.messages, topic.gaps) == ('rotor', 90, 1)
    assert topic.rate == pytest.approx(100.0)
    assert topic.longest_gap == pytest.approx(0.11)


@pytest.mark.parametrize('stamp', [lambda k: k // 100, lambda _: 0], ids=['seconds', 'constant'])
def test_stamps_that_repeat_tell_no_rate(tmp_path, stamp):
    stamps = [10**9 * (10**9 + stamp(k)) for k in range(300)]
    messages = [
        ('/motor', 10**18 + 10**7 * k, rotor_bytes(each, ['m1'], [0.1 * k]))
        for k, each in enumerate(stamps)
    ]
    write_bag(tmp_path / 'bag', messages, {'/motor': JOINT_STATE})
    (topic,) = summary(tmp_path / 'bag').topics
    assert (topic.rate, topic.gaps) == (pytest.approx(100.0), 0)


def test_rate_of_drivers_with_two_clocks_is_that_of_reception(tmp_path):
    messages = [
        ('/motor', 10**18 + 10**7 * k, rotor_bytes(10**18 + 10**7 * k - k % 2 * 5 * 10**8))
        for k in range(100)
    ]
    (topic,) = summary(write_bag(tmp_path / 'bag', messages, {'/motor': JOINT_STATE})).topics
    assert (topic.rate, topic.gaps) == (pytest.approx(100.0), 0)


def test_several_topics_are_told_apart_by_the_joint(tmp_path):
    path = write(tmp_path / 'bag', '/a', '/b')
    unclear = summary(path)
    assert unclear.unclear == (
        'which topic is rotor_state? /a (joints m1, m2), /b (joints m1, m2); '
        'name it with --rotor-topic'
    )
    assert [topic.part for topic in unclear.topics] == ['', '']
    assert [topic.part for topic in summary(path, '/b').topics] == ['rotor', '']
    with pytest.raises(BagError, match='no topic /c '):
        summary(path, '/c')
    joints = {'/a': 'm1', '/b': 'wheel'}
    messages = [(topic, 1, rotor_bytes(10**18, [name], [0.0])) for topic, name in joints.items()]
    two = write_bag(tmp_path / 'two', messages, dict.fromkeys(joints, JOINT_STATE))
    found = summary(two, None, ['wheel'])
    assert [(topic.part, topic.name) for topic in found.topics] == [('rotor', '/b'), ('', '/a')]
    assert [topic.rate for topic in found.topics] == [None, None]


def test_joint_states_of_another_encoding_are_no_part(tmp_path):
    path = tmp_path / 'bag.mcap'
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema(JOINT_STATE, 'ros2msg', b'')
        channels = [
            writer.register_channel(topic, encoding, schema)
            for topic, encoding in (('/rotor_state', 'json'), ('/motor', 'cdr'))
        ]
        data = b'{"name": ["m1"]}', rotor_bytes(10**18, ['m1'], [0.0])
        for k in range(30):
            writer.add_message(channels[k % 3 == 0], k, data[k % 3 == 0], k)
        writer.finish()
    topics = summary(path).topics
    found = [(topic.part, topic.name, topic.messages, topic.joints) for topic in topics]
    assert found == [('rotor', '/motor', 10, ('m1',)), ('', '/rotor_state', 20, ())]


def test_the_mean_rate_is_told_beside_that_of_the_median_period(tmp_path):
    """Ten messages in each 0.1 s, 1 ms apart."""
    stamps = (10**18 + k // 10 * 10**8 + k % 10 * 10**6 for k in range(101))
    messages = [('/motor', stamp, rotor_bytes(stamp, ['m1'], [0.0])) for stamp in stamps]
    (topic,) = summary(write_bag(tmp_path / 'bag', messages, {'/motor': JOINT_STATE})).topics
    assert topic.rate == pytest.approx(1000.0)
    assert topic.mean_rate == pytest.approx(100.0)


def test_what_is_before_the_damage_is_summarised(tmp_path):
    (file,) = (BAGS / 'constant_speed_3000rpm').glob('*.mcap')
    data = file.read_bytes()
    path = tmp_path / 'cut.mcap'
    path.write_bytes(data[: len(data) // 2])
    found = summary(path)
    assert 0 < found.topics[0].messages < 3000
    assert found.damage.startswith(str(path))


def test_rate_and_gaps_are_those_of_the_joint_on_a_shared_topic(shared_path):
    found = summary(shared_path('data/faults/grippers_share_joint_states.mcap'), None, ['m1'])
    (topic,) = found.topics
    # As the file is described: 200 Hz for 1.5 s, and two grippers beside it.
    assert (topic.part, topic.messages, topic.of_others) == ('rotor', 900, 600)
    assert (topic.rate, topic.gaps) == (pytest.approx(200.0, rel=1e-3), 0)


def test_the_rate_is_that_of_the_first_joint_that_is_recorded(tmp_path):
    (topic,) = summary(write(tmp_path / 'bag', '/motor'), None, ['m0', 'm2', 'm1']).topics
    assert (topic.followed, topic.of_others) == ('m2', 0)
    assert topic.rate == pytest.approx(100.0)


def test_a_first_message_without_joints_and_stamp_hides_no_joint(tmp_path):
    """Two drivers share the topic, and each sends 100 messages a second."""
    messages = [('/motor', 10**18, rotor_bytes(0, [], []))] + [
        ('/motor', stamp + late, rotor_bytes(stamp + late, [joint], [0.0]))
        for stamp in range(10**18 + 10**7, 2 * 10**18, 10**7)[:100]
        for joint, late in (('m1', 0), ('m2', 10**6))
    ]
    (topic,) = summary(write_bag(tmp_path / 'bag', messages, {'/motor': JOINT_STATE})).topics
    assert (topic.followed, topic.of_others, topic.gaps) == ('m1', 100, 0)
    assert topic.rate == pytest.approx(100.0)


def test_joints_of_the_rotor_topic_are_known_where_none_is_the_wanted_one():
    found = summary(BAGS / 'constant_speed_3000rpm', None, ['m1'])
    rotor = found.topics[0]
    assert (rotor.part, rotor.joints, rotor.of_others) == ('rotor', ('rotor',), 3000)


def test_drivers_with_a_message_each_leave_no_gaps_on_any_topic(tmp_path):
    """Three messages in a row every 10 ms, as of an arm whose motors have a driver each."""
    joints, topics = ('left_arm_elbow', 'wrist', 'hand'), ('/rotor_state', '/output_state')
    messages = [
        (topic, stamp + k, rotor_bytes(stamp + 1000 * k, [name], [0.0]))
        for stamp in range(10**18, 10**18 + 10**9, 10**7)
        for k, name in enumerate(joints)
        for topic in topics
    ]
    path = write_bag(tmp_path / 'bag', messages, dict.fromkeys(topics, JOINT_STATE))
    for topic in summary(path, None, ['wrist']).topics:
        assert (topic.joints, topic.messages, topic.of_others) == (joints, 300, 200)
        assert topic.followed == ('wrist' if topic.part == 'rotor' else 'left_arm_elbow')
        assert (topic.rate, topic.gaps) == (pytest.approx(100.0), 0)


def test_joints_of_a_driver_that_began_late_are_named(tmp_path):
    messages = [
        ('/motors', k, rotor_bytes(k + 1, ['m1' if k < 2000 else 'm2'], [0.0]))
        for k in range(2010)
    ]
    with Bag(write_bag(tmp_path / 'bag', messages, {'/motors': JOINT_STATE})) as bag:
        (topic,) = summarise(bag).topics
    assert (topic.joints, topic.of_others) == (('m1', 'm2'), 10)
