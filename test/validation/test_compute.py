# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Computed bags: same bytes as the node's, other topics unchanged, complete or nothing."""

import hashlib
from collections import Counter
from pathlib import Path

import mcap.reader
import mcap.writer
import pytest
import replaying
from live import SECOND, rotor_bytes
from made_bags import definition_of
from rosbags.rosbag2 import StoragePlugin, Writer
from shipped_bags import BAGS, TYPES, config, config_of, read_bag, write_bag

from gear_kinematics.bag import Bag, BagError, DamagedBagError
from gear_kinematics.bag.roles import Topics
from gear_kinematics.state.statuses import Condition
from gear_kinematics.validation.compute import ComputeResult, compute

OUTPUTS = ('/output_state', '/body_poses')
UNKNOWN = b'\x00\x01\x00\x00nobody knows'


def of_topic(messages, topic) -> list[bytes]:
    return [data for found, _, data in messages if found == topic]


def run(source: Path, target: Path, settings=None, **options) -> ComputeResult:
    target.parent.mkdir(exist_ok=True)
    with Bag(source) as bag:
        return compute(bag, target, {'': settings or config_of(source.name)}, **options)


def digests(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob('*')
        if path.is_file()
    }


@pytest.fixture
def rotor_only(tmp_path) -> Path:
    """Make a bag as recorded from a driver alone, with a topic of an unknown type."""
    path = tmp_path / 'rotor_only'
    joint_state = TYPES['/rotor_state']
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        rotor = writer.add_connection('/rotor_state', joint_state, typestore=replaying.TYPESTORE)
        other = writer.add_connection(
            '/grip', 'acme_msgs/msg/Grip', msgdef='uint8 force\n', rihs01='RIHS01_' + 64 * 'a'
        )
        for number in range(40):
            stamp = SECOND + 1_000_000 * number
            data = rotor_bytes(stamp, position=[0.1 * number], velocity=[100.0])
            writer.write(rotor, stamp + 500, data)
            if number % 10 == 0:
                writer.write(other, stamp + 600, UNKNOWN)
    return path


@pytest.mark.parametrize(('effort', 'tick', 'doubt'), [
    (0.0, 1, Condition.EFFORT_IS_ZERO()),
    (1.0, SECOND // 50, Condition.REPEATED_STAMPS(count=50)),
])  # fmt: skip
def test_efforts_of_zero_and_repeated_stamps_make_outputs_doubtful(tmp_path, effort, tick, doubt):
    stamps = range(SECOND, 2 * SECOND, SECOND // 100)
    data = [rotor_bytes(t - t % tick, position=[t / SECOND], effort=[effort]) for t in stamps]
    messages = [('/rotor_state', t, each) for t, each in zip(stamps, data, strict=True)]
    types = {'/rotor_state': TYPES['/rotor_state']}
    done = run(write_bag(tmp_path / 'in', messages, types), tmp_path / 'out', config())
    assert done.doubts == {'': [doubt]}


@pytest.mark.parametrize('compression', ['none', 'zstd'])
def test_copies_keep_publish_time_and_topic_type_hash(tmp_path, compression):
    """Times that differ from those of reception, as of rosbag2, over more than a chunk."""
    source, kind, type_hash = tmp_path / 'b.mcap', TYPES['/rotor_state'], 'RIHS01_' + 64 * 'a'
    recorded = []
    with source.open('wb') as stream:
        writer = mcap.writer.Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema(kind, 'ros2msg', definition_of(kind).encode())
        metadata = {'topic_type_hash': type_hash, 'offered_qos_profiles': ''}
        for topic in ('/rotor_state', '/b'):
            writer.register_channel(topic, 'cdr', schema, metadata)
        for number in range(4_000):
            stamp = SECOND + 1_000_000 * number
            data = rotor_bytes(stamp, position=[0.1 * number], velocity=[100.0])
            for channel, topic in enumerate(('/rotor_state', '/b'), 1):
                received, published = stamp + 500, stamp + 250 * (number % 3)
                writer.add_message(channel, received, data, published)
                recorded.append((topic, received, published, data))
        writer.finish()
    run(source, tmp_path / 'copy', config(), compression=compression)
    with (tmp_path / 'copy' / 'copy_0.mcap').open('rb') as stream:
        reader = mcap.reader.make_reader(stream, validate_crcs=True)
        found = list(reader.iter_messages(log_time_order=False))
        assert len(reader.get_summary().chunk_indexes) > 1
    hashes = {channel.topic: channel.metadata['topic_type_hash'] for _, channel, _ in found}
    assert hashes == {'/rotor_state': type_hash, '/b': type_hash} | {
        topic: replaying.TYPESTORE.hash_rihs01(TYPES[topic]) for topic in OUTPUTS
    }
    messages = [(c.topic, m.log_time, m.publish_time, m.data) for _, c, m in found]
    assert [message for message in messages if message[0] not in OUTPUTS] == recorded
    computed = [message for message in messages if message[0] in OUTPUTS]
    assert len(computed) == 2 * 4_000
    assert all(received == published for _, received, published, _ in computed)


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'received', 'valid', 'storage', 'compression'),
    [
        ('servo_point_to_point', 3000, 3000, 'mcap', 'none'),
        ('constant_speed_3000rpm', 3000, 3000, 'mcap', 'zstd'),
        ('single_turn_encoder', 2500, 2500, 'sqlite3', 'none'),
        ('driver_faults', 1314, 1265, 'sqlite3', 'zstd'),
    ],
)
@pytest.mark.parametrize('recorded_outputs', [True, False], ids=['replaced', 'added'])
def test_the_computed_outputs_are_those_that_the_node_published(
    name, received, valid, storage, compression, recorded_outputs, tmp_path
):
    recorded = read_bag(BAGS / name)
    source = BAGS / name
    if not recorded_outputs:
        states = [message for message in recorded if message[0] == '/rotor_state']
        source = write_bag(tmp_path / 'source', states, {'/rotor_state': TYPES['/rotor_state']})
    form = {'storage': storage, 'compression': compression}
    result = run(source, tmp_path / 'computed', config_of(name), **form)
    with Bag(tmp_path / 'computed') as bag:
        computed = list(bag.messages(bag.topics))
    counts = {'/rotor_state': received, '/output_state': valid, '/body_poses': valid}
    assert Counter(topic for topic, *_ in computed) == counts
    for topic in TYPES:
        assert of_topic(computed, topic) == of_topic(recorded, topic)
    rotor = result.inputs['']
    assert (rotor.received, result.computed, result.copied) == (received, valid, 0)
    assert rotor.rejected.total() + rotor.of_others == received - valid


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_each_output_comes_right_after_its_rotor_message(storage, rotor_only, tmp_path):
    run(rotor_only, tmp_path / 'computed', config(), storage=storage)
    messages = read_bag(tmp_path / 'computed')
    positions = [k for k, (topic, *_) in enumerate(messages) if topic == '/rotor_state']
    assert len(positions) == 40
    for k in positions:
        assert [topic for topic, *_ in messages[k : k + 3]] == ['/rotor_state', *OUTPUTS]
        assert len({received for _, received, _ in messages[k : k + 3]}) == 1


def test_an_input_without_a_stamp_gets_the_time_of_its_reception(tmp_path):
    """No stamp can hold the last two, which give no output."""
    times = [5 * SECOND, 2**31 * SECOND - 1, 2**31 * SECOND, 2**63 - 1]
    messages = [('/rotor_state', time, rotor_bytes(0, position=[1.0])) for time in times]
    result = run(write_bag(tmp_path / 'source', messages), tmp_path / 'computed', config())
    assert (result.computed, result.inputs[''].rejected) == (2, {'stamp out of range': 2})
    computed = read_bag(tmp_path / 'computed')
    assert len(of_topic(computed, '/rotor_state')) == 4
    for topic in OUTPUTS:
        decoded = [replaying.decode(data, TYPES[topic]) for data in of_topic(computed, topic)]
        assert [replaying.stamp_of(message) for message in decoded] == times[:2]


def test_computing_a_computed_bag_changes_nothing(tmp_path):
    run(BAGS / 'driver_faults', tmp_path / 'one' / 'computed')
    run(tmp_path / 'one' / 'computed', tmp_path / 'two' / 'computed')
    assert digests(tmp_path / 'one') == digests(tmp_path / 'two')


def test_damage_of_the_source_leaves_nothing(tmp_path):
    (file,) = (BAGS / 'servo_point_to_point').glob('*.mcap')
    source = tmp_path / 'cut.mcap'
    source.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(DamagedBagError, match='cut off'):
        run(source, tmp_path / 'computed', config())
    assert list(tmp_path.iterdir()) == [source]


@pytest.mark.parametrize(('options', 'words'), [
    ({'topics': Topics('/motor')}, ['/motor', '/rotor_state']),
    ({'topics': Topics('/body_poses', poses='/p')}, ['PoseArray', 'JointState']),
    ({'topics': Topics(output='/body_poses', poses='/p')}, ['/body_poses', 'PoseArray']),
    ({'topics': Topics(output='/rotor_state')}, ['/rotor_state', 'must differ']),
    ({'others': ['/rotor_state', '/grip']}, ['no topic /grip in it', '/rotor_state']),
], ids=['missing', 'wrong type', 'not an output', 'twice', 'other missing'])  # fmt: skip
def test_an_unusable_topic_is_named_and_nothing_is_written(options, words, tmp_path):
    with pytest.raises(ValueError, match=words[0]) as caught:
        run(BAGS / 'servo_point_to_point', tmp_path / 'computed', **options)
    assert all(word in str(caught.value) for word in words)
    assert '\n' not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ('count', 'joint', 'words'),
    [
        (0, 'rotor', ['no messages']),
        (3, 'gripper', ["'rotor'", 'joint missing 3: no joint', 'are: gripper']),
    ],
)
def test_a_bag_that_gives_no_output_is_refused(count, joint, words, tmp_path):
    times = range(SECOND, SECOND + count)
    messages = [('/rotor_state', time, rotor_bytes(time, [joint], [0.0])) for time in times]
    source = write_bag(tmp_path / 'source', messages)
    with pytest.raises(BagError, match='source') as caught:
        run(source, tmp_path / 'computed', config())
    assert all(word in str(caught.value) for word in words)
    assert list(tmp_path.iterdir()) == [source]
