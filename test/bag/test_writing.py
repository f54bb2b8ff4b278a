# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Written bags: complete or nothing, read by others, with the descriptions of copied topics."""

import re
from contextlib import suppress
from pathlib import Path

import mcap.reader
import mcap.writer
import pytest
from gear_recordings import old_recording
from made_bags import JAZZY, definition_of, read, ros1_bag
from rosbags import rosbag2
from rosbags.rosbag2.metadata import parse_qos
from shipped_bags import TYPES, read_bag, write_bag

from gear_kinematics.bag import Bag, BagError, DamagedBagError, Message, TopicError
from gear_kinematics.bag.writing import BagWriter

FORMS = [('mcap', 'none'), ('mcap', 'zstd'), ('sqlite3', 'none'), ('sqlite3', 'zstd')]
WRITTEN = pytest.mark.parametrize(('storage', 'compression'), FORMS)
FILES = dict(zip(FORMS, ['bag_0.mcap', 'bag_0.mcap', 'bag_0.db3', 'bag_0.db3.zstd'], strict=True))


def contents(path: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in path.iterdir()}


@pytest.mark.parametrize('compression', ['none', 'zstd'])
def test_another_implementation_reads_what_is_written(recorded, tmp_path, compression):
    path = write_bag(tmp_path / 'bag', recorded, compression=compression)
    with (path / 'bag_0.mcap').open('rb') as stream:
        reader = mcap.reader.make_reader(stream, validate_crcs=True)
        found = list(reader.iter_messages())
        chunks = reader.get_summary().chunk_indexes
    assert {chunk.compression for chunk in chunks} == {compression.replace('none', '')}
    assert [(c.topic, m.log_time, m.data) for _, c, m in found] == recorded
    for schema, channel, _ in found:
        assert (schema.name, schema.encoding) == (TYPES[channel.topic], 'ros2msg')
        assert schema.data.decode() == definition_of(schema.name)


@WRITTEN
def test_added_topics_are_described(recorded, tmp_path, storage, compression):
    path = write_bag(tmp_path / 'bag', recorded, storage=storage, compression=compression)
    with rosbag2.Reader(path) as reader:
        assert {c.topic: c.msgtype for c in reader.connections} == TYPES
        for connection in reader.connections:
            assert connection.digest == JAZZY.hash_rihs01(connection.msgtype)
            assert connection.msgcount == sum(m[0] == connection.topic for m in recorded)
        assert (reader.start_time, reader.end_time) == (recorded[0][1], recorded[-1][1] + 1)


@WRITTEN
def test_a_copy_of_a_copy_has_the_same_bytes(recorded, tmp_path, storage, compression):
    source = write_bag(tmp_path / 'bag', recorded, storage=storage, compression=compression)
    files = contents(source)
    assert files.keys() == {'metadata.yaml', FILES[storage, compression]}
    (tmp_path / 'copied').mkdir()
    copy = tmp_path / 'copied' / 'bag'
    with Bag(source) as bag, BagWriter(copy, storage, compression) as writer:
        for topic in bag.topics:
            writer.copy_topic(bag, topic)
        writer.write_all(bag.messages(bag.topics))
    assert contents(copy) == files


@WRITTEN
@pytest.mark.parametrize('name', ['bag', 'new/folder/bag'])
@pytest.mark.parametrize('error', [ValueError, KeyboardInterrupt])
def test_an_interruption_leaves_nothing(recorded, tmp_path, storage, compression, error, name):
    def interrupted():
        yield from recorded[:5]
        assert not (tmp_path / name).exists()
        assert len(list(tmp_path.iterdir())) == 1
        raise error

    with pytest.raises(error):
        write_bag(tmp_path / name, interrupted(), storage=storage, compression=compression)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize('step', ['write', 'close', 'close_chunk'])
def test_a_bag_keeps_what_was_written_before_the_disk_was_full(
    recorded, tmp_path, monkeypatch, step
):
    first = step == 'close_chunk'  # which is cut off, so that nothing can be read

    def full(*_):
        raise OSError(28, 'No space left on device')

    def write():
        with BagWriter(tmp_path / 'bag') as writer:
            for topic, kind in TYPES.items():
                writer.add_topic(topic, kind)
            writer.keeps = True
            writer.write_all(recorded)
            if not first:
                writer._file.close_chunk()
            monkeypatch.setattr(writer._file, step, full)
            writer.write_all(recorded[:1])

    with pytest.raises(BagError) as raised:
        write()
    words = f'No space left on device; {"nothing" if first else "what was written before"} is kept'
    assert str(raised.value) == f'{tmp_path}/bag: {words}'
    assert [each.name for each in tmp_path.iterdir()] == ([] if first else ['bag'])
    if first:
        return
    read = list[Message]()
    with Bag(tmp_path / 'bag') as bag, suppress(DamagedBagError):
        read.extend(bag.messages(bag.topics))
    assert read == recorded


def test_a_bag_that_cannot_be_finished_leaves_nothing(tmp_path, monkeypatch):
    def rename(*_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(Path, 'rename', rename)
    with pytest.raises(BagError, match=r'/bag: No space left on device$'):
        write_bag(tmp_path / 'bag', [])
    assert not list(tmp_path.iterdir())


def test_an_existing_target_is_left_alone(tmp_path):
    (tmp_path / 'folder').mkdir()
    (tmp_path / 'file').write_text('kept')
    (tmp_path / 'link').symlink_to('nowhere')
    for name in ('folder', 'file', 'link'):
        with pytest.raises(BagError, match=f'{name}: exists already'):
            BagWriter(tmp_path / name).__enter__()
    assert {path.name for path in tmp_path.iterdir()} == {'folder', 'file', 'link'}
    assert (tmp_path / 'file').read_text() == 'kept'


def test_invalid_messages_are_refused(tmp_path):
    bag = tmp_path / 'logs' / 'may' / 'bag'
    with BagWriter(bag) as writer:
        writer.add_topic('/a', 'sensor_msgs/msg/JointState')
        for attempt, cause in (
            (lambda: writer.add_topic('/a', 'sensor_msgs/msg/JointState'), 'added already'),
            (lambda: writer.add_topic('/b', 'my_msgs/msg/Odd'), 'my_msgs/msg/Odd is not of'),
            (lambda: writer.write_all([('/b', 1, b'')]), "'/b' is missing"),
        ):
            with pytest.raises(BagError, match=cause):
                attempt()
        writer.write_all([('/a', 1, b'\0\1\0\0')])
    assert read(bag, ['/a']) == [('/a', 1, b'\0\1\0\0')]
    with pytest.raises(BagError, match=r'metadata\.yaml/bag: Not a directory'):
        write_bag(bag / 'metadata.yaml' / 'bag', [])


# Copies of topics.

ODD = 'float64 value  # with a comment\nmy_msgs/Part[<=3] parts\n' + '=' * 80
ODD += '\nMSG: my_msgs/Part\nint8 a\n'
IDL = '=' * 80 + '\nIDL: my_msgs/msg/Idl\n'
IDL += 'module my_msgs { module msg { struct Idl { double value; }; }; };\n'
QOS = """- history: keep_all
  depth: 3
  reliability: best_effort
  durability: transient_local
  deadline: {sec: 1, nsec: 2}
  lifespan: {sec: 3, nsec: 4}
  liveliness: manual_by_topic
  liveliness_lease_duration: {sec: 5, nsec: 6}
  avoid_ros_namespace_conventions: true
"""
DESCRIBED = (  # topic, type, encoding, syntax, definition, metadata
    ('/full', 'my_msgs/msg/Odd', 'cdr', 'ros2msg', ODD, {'topic_type_hash': 'RIHS01_x'}),
    ('/full_qos', 'my_msgs/msg/Odd', 'cdr', 'ros2msg', ODD, {'offered_qos_profiles': QOS}),
    ('/idl', 'my_msgs/msg/Idl', 'cdr', 'ros2idl', IDL, {}),
    ('/no_text', 'sensor_msgs/msg/JointState', 'cdr', '', '', {}),
    ('/strange', 'my_msgs/msg/A', 'cdr', 'ros2msg', '!?', {'topic_type_hash': 'RIHS01_y'}),
    ('/unknown', 'my_msgs/msg/B', 'cdr', '', '', {}),
    ('/broken', 'my_msgs/msg/C', 'cdr', 'ros2msg', '!?', {}),
    ('/json', 'my_msgs/msg/D', 'json', 'ros2msg', 'int8 a', {}),
    ('/xml', 'my_msgs/msg/E', 'cdr', 'xml', '<a/>', {}),
    ('/bad_qos', 'my_msgs/msg/F', 'cdr', 'ros2msg', 'int8 a', {'offered_qos_profiles': 'a'}),
)


@pytest.fixture
def described(tmp_path) -> Path:
    """A bag with a topic of each kind, without any messages."""
    path = tmp_path / 'described.mcap'
    with path.open('wb') as stream:
        writer = mcap.writer.Writer(stream)
        writer.start(profile='ros2')
        for topic, kind, encoding, syntax, text, metadata in DESCRIBED:
            schema = writer.register_schema(kind, syntax, text.encode())
            writer.register_channel(topic, encoding, schema, metadata)
        writer.finish()
    return path


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_copied_topic_keeps_its_description(described, tmp_path, storage):
    names = ['/full', '/full_qos', '/idl', '/no_text', '/strange', '/unknown', '/broken']
    with Bag(described) as bag:
        with BagWriter(tmp_path / 'copy', storage) as writer:
            for name in names:
                writer.copy_topic(bag, name)
                writer.write_all([(name, 5, b'\0\1\0\0')])
        with Bag(tmp_path / 'copy') as copy, BagWriter(tmp_path / 'again') as again:
            assert list(copy.topics) == names
            assert list(copy.messages(['/full'])) == [('/full', 5, b'\0\1\0\0')]
            for name in names:
                again.copy_topic(copy, name)
                old, new = bag.describe(name), copy.describe(name)
                assert (new.type, new.encoding) == (old.type, 'cdr')
                if name != '/no_text':
                    assert (new.syntax, new.definition) == (old.syntax, old.definition)
                assert parse_qos(new.qos) == parse_qos(old.qos)
            hashes = {name: copy.describe(name).type_hash for name in names}
            assert len(parse_qos(copy.describe('/full_qos').qos)) == 1
            joint_state = copy.describe('/no_text')
    kind = 'sensor_msgs/msg/JointState'
    assert joint_state.definition == definition_of(kind)
    assert hashes['/no_text'] == JAZZY.hash_rihs01(kind)
    assert (hashes['/full'], hashes['/strange']) == ('RIHS01_x', 'RIHS01_y')
    # What the bag lacks is not added.
    assert {hashes[name] for name in ('/full_qos', '/idl', '/broken', '/unknown')} == {''}


@pytest.mark.parametrize(
    ('name', 'cause'),
    [
        ('/nothing', 'no topic /nothing'),
        ('/json', "/json cannot be copied: its messages are 'json', not CDR"),
        ('/xml', "/xml cannot be copied: its type is defined in unknown 'xml'"),
        ('/bad_qos', '/bad_qos cannot be copied: '),
    ],
)
def test_a_topic_that_cannot_be_copied_is_named(described, tmp_path, name, cause):
    with Bag(described) as bag, BagWriter(tmp_path / 'copy') as writer:
        with pytest.raises(BagError, match=re.escape(f'described.mcap: {cause}')) as raised:
            writer.copy_topic(bag, name)
        assert '\n' not in str(raised.value)
        assert isinstance(raised.value, TopicError) == (name != '/nothing')


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_type_that_nobody_defines_is_copied_by_name(tmp_path, storage):
    """As rosbag2 writes it, and others read it: bags of Humble and older have no definitions."""
    data, kind = b'\0\1\0\0nobody knows', 'my_msgs/msg/B'
    source = old_recording(tmp_path / 'old.db3', [('/b', kind)], [('/b', 5, data)])
    with Bag(source) as bag, BagWriter(tmp_path / 'copy', storage) as writer:
        writer.copy_topic(bag, '/b')
        writer.write_all([('/b', 5, data)])
    assert read(tmp_path / 'copy', ['/b']) == [('/b', 5, data)]
    with rosbag2.Reader(tmp_path / 'copy') as reader:
        [connection] = reader.connections
        assert (connection.msgtype, connection.msgdef.data) == (kind, '')
        assert [bytes(data) for _, _, data in reader.messages()] == [data]
    if storage == 'mcap':
        with (tmp_path / 'copy' / 'copy_0.mcap').open('rb') as stream:
            [(schema, _, _)] = mcap.reader.make_reader(stream).iter_messages()
        # By the specification of mcap no schema is known where there is no encoding.
        assert (schema.name, schema.encoding, schema.data) == (kind, '', b'')


def test_topics_of_ros1_are_copied_as_ros2(recorded, tmp_path):
    source = ros1_bag(tmp_path / 'b.bag', recorded)
    with Bag(source) as bag, BagWriter(tmp_path / 'copy') as writer:
        for topic in bag.topics:
            writer.copy_topic(bag, topic)
        writer.write_all(list(bag.messages(bag.topics)))
    with rosbag2.Reader(tmp_path / 'copy') as reader:
        hashes = {topic: JAZZY.hash_rihs01(kind) for topic, kind in TYPES.items()}
        assert {c.topic: c.digest for c in reader.connections} == hashes
        assert all('uint32 seq' not in c.msgdef.data for c in reader.connections)
    assert read_bag(tmp_path / 'copy') == recorded
