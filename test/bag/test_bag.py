"""Bags of every kind read back whole, damaged ones up to the damage, written ones by others.

The expected messages come from a shipped bag by way of rosbags. The bags under test are made by
rosbags, by the `mcap` package, by the compression libraries and by cutting files.
"""

import os
import random
import re
import shutil
import sqlite3
import struct
import subprocess
import sys
import tracemalloc
from collections.abc import Callable, Iterable
from contextlib import closing
from itertools import pairwise
from pathlib import Path

import lz4.frame
import mcap.reader
import mcap.writer
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, IndexType
from rosbags import rosbag1, rosbag2
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2.metadata import parse_qos
from rosbags.typesys import Stores, get_typestore
from shipped_bags import BAGS, read_bag, write_bag

from gear_kinematics.bag import (
    Bag,
    BagError,
    BagWriter,
    DamagedBagError,
    TopicError,
    writing,
)
from gear_kinematics.wire.topics import RECORDED_TOPICS

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

ROOT = BAGS.parent
JAZZY = get_typestore(Stores.ROS2_JAZZY)
NOETIC = get_typestore(Stores.ROS1_NOETIC)
COUNT = 900
"""Messages in the bags under test."""

Messages = list[tuple[str, int, bytes]]


@pytest.fixture(scope='module')
def recorded() -> Messages:
    messages = read_bag(BAGS / 'servo_point_to_point')
    assert len(messages) == 9000
    assert {topic for topic, _, _ in messages} == set(RECORDED_TOPICS)
    return messages[:COUNT]


def read(path: Path, topics: Iterable[str] = RECORDED_TOPICS) -> Messages:
    with Bag(path) as bag:
        return list(bag.messages(list(topics)))


def read_up_to_damage(path: Path) -> tuple[Messages, BagError | None]:
    """Return the messages, and the error that ended reading, after checking its type."""
    messages: Messages = []
    error = None
    try:
        with Bag(path) as bag:
            messages.extend(bag.messages(set(bag.topics)))
    except BagError as caught:
        error = caught
    if error:
        assert isinstance(error, DamagedBagError) == bool(messages)
        assert '\n' not in str(error)
        assert str(path) in str(error)
    return messages, error


def definition_of(kind: str) -> str:
    return JAZZY.generate_msgdef(kind, ros_version=2)[0]


# Makers of bags: each gives the path to open.


def rosbags_bag(
    path: Path,
    messages: Messages,
    storage: str = 'mcap',
    mode: str = 'none',
    *,
    types: dict[str, str] = RECORDED_TOPICS,
) -> Path:
    writer = rosbag2.Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()])
    writer.set_compression(CompressionMode[mode.upper()], CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=JAZZY)
            for topic, kind in types.items()
        }
        for topic, received, data in messages:
            writer.write(connections[topic], received, data)
    return path


def mcap_file(
    path: Path,
    messages: Messages,
    *,
    finish: bool = True,
    definition: bool = True,
    others: tuple[tuple[str, str, str, str, bytes], ...] = (),
    **options,
) -> Path:
    """Write with the mcap package; `others` are topic, type, encoding, syntax and definition."""
    with path.open('wb') as stream:
        writer = mcap.writer.Writer(stream, **{'chunk_size': 20_000, **options})
        writer.start(profile='ros2')
        for topic, kind, encoding, syntax, text in others:
            schema = writer.register_schema(kind, syntax, text)
            channel = writer.register_channel(topic, encoding, schema)
            writer.add_message(channel, messages[0][1], b'\x80\xff other', messages[0][1])
        channels = {}
        for topic, kind in RECORDED_TOPICS.items():
            text, syntax = definition_of(kind) if definition else '', 'ros2msg'
            schema = writer.register_schema(kind, syntax if definition else '', text.encode())
            channels[topic] = writer.register_channel(topic, 'cdr', schema)
        for number, (topic, received, data) in enumerate(messages):
            writer.add_message(channels[topic], received, data, received, number)
        writer.finish()
    if not finish:
        path.write_bytes(path.read_bytes()[: data_end(path)])
    return path


def data_end(path: Path) -> int:
    """Find the offset of the record that ends the data."""
    return record_ends(path)[-1]


def chunks(path: Path) -> list[mcap.reader.ChunkIndex]:
    with path.open('rb') as stream:
        return mcap.reader.make_reader(stream).get_summary().chunk_indexes


def change_metadata(folder: Path, **changes) -> None:
    path = folder / 'metadata.yaml'
    document = yaml.safe_load(path.read_text())
    document['rosbag2_bagfile_information'].update(changes)
    path.write_text(yaml.safe_dump(document))


def lz4_files(path: Path, messages: Messages, storage: str) -> Path:
    rosbags_bag(path, messages, storage)
    (file,) = (p for p in path.iterdir() if p.suffix != '.yaml')
    packed = file.with_name(f'{file.name}.lz4')
    packed.write_bytes(lz4.frame.compress(file.read_bytes()))
    file.unlink()
    change_metadata(
        path,
        compression_format='lz4',
        compression_mode='FILE',
        relative_file_paths=[packed.name],
    )
    return path


def lz4_messages(path: Path, messages: Messages, storage: str) -> Path:
    packed = [(topic, received, lz4.frame.compress(data)) for topic, received, data in messages]
    rosbags_bag(path, packed, storage)
    change_metadata(path, compression_format='lz4', compression_mode='MESSAGE')
    return path


def split(path: Path, messages: Messages, storage: str, mode: str, parts: int = 11) -> Path:
    """Write files _0 to _10, whose order is not that of their names."""
    path.mkdir()
    size = -(-len(messages) // parts)
    names = []
    for number in range(parts):
        piece = path.parent / f'{path.name}_{number}'
        rosbags_bag(piece, messages[number * size : (number + 1) * size], storage, mode)
        (file,) = (p for p in piece.iterdir() if p.suffix != '.yaml')
        names.append(file.rename(path / file.name).name)
        (piece / 'metadata.yaml').rename(path / 'metadata.yaml')
    change_metadata(path, relative_file_paths=names, message_count=len(messages))
    return path


def noise(seed: int, size: int) -> bytes:
    return random.Random(seed).randbytes(size)  # noqa: S311, no cryptography


def single(folder: Path) -> Path:
    (file,) = (p for p in folder.iterdir() if p.suffix != '.yaml')
    return file


def without_metadata(folder: Path) -> Path:
    (folder / 'metadata.yaml').unlink()
    return folder


def renamed(folder: Path) -> Path:
    """Name files as before version 4: with their folder, which has been renamed."""
    change_metadata(folder, version=3, relative_file_paths=[f'old_name/{single(folder).name}'])
    return folder


def ros1_bag(path: Path, messages: Messages, compression: str | None = None) -> Path:
    writer = rosbag1.Writer(path)
    if compression:
        writer.set_compression(rosbag1.Writer.CompressionFormat[compression])
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=NOETIC)
            for topic, kind in RECORDED_TOPICS.items()
        }
        for topic, received, data in messages:
            message = JAZZY.cdr_to_ros1(data, RECORDED_TOPICS[topic])
            writer.write(connections[topic], received, message)
    return path


KINDS: dict[str, tuple[int | None, Callable[[Path, Messages], Path]]] = {
    f'{storage} {mode}': (COUNT, lambda p, m, s=storage, c=mode: rosbags_bag(p / 'b', m, s, c))
    for storage, modes in (
        ('mcap', ('none', 'storage', 'message', 'file')),
        ('sqlite3', ('none', 'message', 'file')),
    )
    for mode in modes
}
for _storage in ('mcap', 'sqlite3'):
    KINDS |= {
        f'{_storage} lz4 file': (COUNT, lambda p, m, s=_storage: lz4_files(p / 'b', m, s)),
        f'{_storage} lz4 message': (COUNT, lambda p, m, s=_storage: lz4_messages(p / 'b', m, s)),
        f'{_storage} split': (COUNT, lambda p, m, s=_storage: split(p / 'b', m, s, 'none')),
        f'{_storage} split file': (COUNT, lambda p, m, s=_storage: split(p / 'b', m, s, 'file')),
        f'{_storage} split without metadata': (
            COUNT,
            lambda p, m, s=_storage: without_metadata(split(p / 'b', m, s, 'none')),
        ),
    } | {
        f'{_storage} single {mode}': (
            COUNT,
            lambda p, m, s=_storage, c=mode: single(rosbags_bag(p / 'b', m, s, c)),
        )
        for mode in ('none', 'message', 'file')
    }
KINDS |= {
    'names as before version 4': (COUNT, lambda p, m: renamed(rosbags_bag(p / 'b', m))),
    'odd name': (
        COUNT,
        lambda p, m: single(rosbags_bag(p / 'b', m, 'sqlite3')).rename(p / 'a?b#c %20.db3'),
    ),
    'mcap of lz4 chunks': (
        COUNT,
        lambda p, m: mcap_file(p / 'b.mcap', m, compression=CompressionType.LZ4),
    ),
    'mcap of zstd chunks': (COUNT, lambda p, m: mcap_file(p / 'b.mcap', m)),
    'mcap without chunks': (COUNT, lambda p, m: mcap_file(p / 'b.mcap', m, use_chunking=False)),
    'mcap without definitions': (COUNT, lambda p, m: mcap_file(p / 'b.mcap', m, definition=False)),
    'mcap without an index': (
        None,
        lambda p, m: mcap_file(
            p / 'b.mcap',
            m,
            index_types=IndexType.NONE,
            repeat_channels=False,
            repeat_schemas=False,
            use_statistics=False,
            use_summary_offsets=False,
        ),
    ),
    'unfinished mcap': (None, lambda p, m: mcap_file(p / 'b.mcap', m, finish=False)),
    'unfinished mcap without chunks': (
        None,
        lambda p, m: mcap_file(p / 'b.mcap', m, finish=False, use_chunking=False),
    ),
    'mcap with its index cut off': (
        None,
        lambda p, m: cut(mcap_file(p / 'b.mcap', m), lambda path: path.stat().st_size - 1),
    ),
    'other topics, of unknown types': (
        COUNT + 4,
        lambda p, m: mcap_file(
            p / 'b.mcap',
            m,
            others=(
                ('/a', 'my_msgs/msg/Odd', 'cdr', 'ros2msg', b'!! no [definition\xff'),
                ('/b', 'my.Proto', 'protobuf', 'protobuf', b'\x80\x00\xff'),
                ('/c', 'Thing', 'json', 'jsonschema', b'{}'),
                ('/d', 'my_msgs/msg/None', 'cdr', '', b''),
            ),
        ),
    ),
    'ROS 1': (COUNT, lambda p, m: ros1_bag(p / 'b.bag', m)),
    'ROS 1 lz4': (COUNT, lambda p, m: ros1_bag(p / 'b.bag', m, 'LZ4')),
    'ROS 1 bz2': (COUNT, lambda p, m: ros1_bag(p / 'b.bag', m, 'BZ2')),
}


def cut(path: Path, size: Callable[[Path], int]) -> Path:
    path.write_bytes(path.read_bytes()[: size(path)])
    return path


@pytest.mark.parametrize('kind', KINDS)
def test_a_bag_of_every_kind_is_read_whole(kind, recorded, tmp_path):
    count, make = KINDS[kind]
    path = make(tmp_path, recorded)
    with Bag(path) as bag:
        assert {name: bag.topics[name] for name in RECORDED_TOPICS} == RECORDED_TOPICS
        assert bag.message_count == count
        messages = list(bag.messages(RECORDED_TOPICS))
        assert len(messages) == COUNT
        assert messages == recorded
        assert {type(data) for _, _, data in messages} == {bytes}
        # A second time, and only some.
        wanted = [message for message in recorded if message[0] == '/body_poses']
        assert list(bag.messages(['/body_poses', '/nothing'])) == wanted
        assert not list(bag.messages([]))


def test_big_endian_messages_pass_untouched(recorded, tmp_path):
    swapped = [
        (topic, received, bytes(JAZZY.serialize_cdr(message, kind, little_endian=False)))
        for topic, received, data in recorded
        for kind in [RECORDED_TOPICS[topic]]
        for message in [JAZZY.deserialize_cdr(data, kind)]
    ]
    assert {data[:2] for _, _, data in swapped} == {b'\0\0'}
    for storage in ('mcap', 'sqlite3'):
        assert read(rosbags_bag(tmp_path / storage, swapped, storage)) == swapped


@pytest.mark.slow
def test_real_recordings_are_read(shared_path):
    for name, topic, count in (
        ('feetech_servos', '/servo/out/state', 954),
        ('pr2_joints/pr1012_sensors.bag', '/joint_states', 1325),
    ):
        path = shared_path(f'data/bags/{name}')
        messages = read(path, [topic])
        assert len(messages) == count
        reader = rosbag1.Reader(path) if path.is_file() else rosbag2.Reader(path)
        with reader:
            connections = [c for c in reader.connections if c.topic == topic]
            original = [
                (topic, time, bytes(data)) for _, time, data in reader.messages(connections)
            ]
        if path.is_file():
            kind = 'sensor_msgs/msg/JointState'
            original = [(t, n, bytes(JAZZY.ros1_to_cdr(d, kind))) for t, n, d in original]
        assert messages == original


def test_sqlite_without_hashes_definitions_and_qos_is_read(recorded, tmp_path):
    """The first schema."""
    with closing(sqlite3.connect(tmp_path / 'old.db3')) as database:
        database.executescript(
            'CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT,'
            ' serialization_format TEXT);'
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER,'
            ' data BLOB);'
        )
        names = list(RECORDED_TOPICS)
        rows = [(7 + k, name, RECORDED_TOPICS[name], 'cdr') for k, name in enumerate(names)]
        database.executemany('INSERT INTO topics VALUES (?, ?, ?, ?)', rows)
        database.executemany(
            'INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)',
            [(7 + names.index(topic), received, data) for topic, received, data in recorded],
        )
        database.commit()
    assert read(tmp_path / 'old.db3') == recorded


def test_sqlite_that_a_killed_recorder_left_with_its_journal_is_read(recorded, tmp_path):
    file = single(rosbags_bag(tmp_path / 'bag', recorded, 'sqlite3'))
    with closing(sqlite3.connect(file)) as database:
        database.execute('PRAGMA journal_mode=WAL')
        database.execute("INSERT INTO messages SELECT 5000, 1, 2000000000000000000, x'00010000'")
        database.commit()
        (tmp_path / 'killed').mkdir()
        for part in (file, file.with_name(f'{file.name}-wal')):
            shutil.copy(part, tmp_path / 'killed')
    messages = read(tmp_path / 'killed')
    assert messages[:-1] == recorded
    assert messages[-1] == ('/rotor_state', 2 * 10**18, b'\0\1\0\0')


def test_messages_of_an_mcap_are_in_the_order_of_reception(recorded, tmp_path):
    """Whatever their order in a chunk, and where chunks overlap."""
    shuffled = list(recorded)
    for start in range(0, COUNT, 40):  # less than a chunk of 20 kB holds
        piece = shuffled[start : start + 40]
        shuffled[start : start + 40] = sorted(piece, key=lambda m: m[2][::-1])
    assert shuffled != recorded
    path = mcap_file(tmp_path / 'b.mcap', shuffled)
    times = [(chunk.message_start_time, chunk.message_end_time) for chunk in chunks(path)]
    assert any(end > start for (_, end), (start, _) in pairwise(times))
    assert read(path) == recorded
    path = mcap_file(tmp_path / 'one_chunk.mcap', shuffled, chunk_size=2**20)
    assert len(chunks(path)) == 1
    assert read(path) == recorded


@pytest.mark.slow
def test_reading_takes_little_memory(recorded, tmp_path):
    messages = [
        (topic, received + 10**10 * turn, data)
        for turn in range(40)
        for topic, received, data in recorded
    ]
    for path in (
        mcap_file(tmp_path / 'b.mcap', messages),
        single(rosbags_bag(tmp_path / 'bag', messages, 'sqlite3')),
        lz4_messages(tmp_path / 'lz4', messages, 'sqlite3'),  # lz4 allocates what it may fill
    ):
        tracemalloc.start()
        with Bag(path) as bag:
            assert sum(1 for _ in bag.messages(RECORDED_TOPICS)) == 40 * COUNT
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert peak < sum(len(data) for _, _, data in messages) / 10


# Damage.


def record_ends(path: Path) -> list[int]:
    """Find the ends of the records in the data of an mcap, and the start of the first."""
    data, ends = path.read_bytes(), [8]
    while data[ends[-1]] != 15:
        ends.append(ends[-1] + 9 + struct.unpack_from('<Q', data, ends[-1] + 1)[0])
    return ends


def offsets_of_messages(path: Path) -> list[int]:
    """Find the ends of the messages of an uncompressed mcap, in chunks or not."""
    data, offset, ends = path.read_bytes(), 8, []
    while data[offset] != 15:
        (length,) = struct.unpack_from('<Q', data, offset + 1)
        if data[offset] == 6:  # its records begin behind 40 bytes; the compression has no name
            offset += 9 + 40
            continue
        offset += 9 + length
        if data[offset - 9 - length] == 5:
            ends.append(offset)
    return ends


@pytest.mark.slow
@pytest.mark.parametrize('use_chunking', [True, False])
def test_a_cut_mcap_gives_every_whole_message_before_the_cut(recorded, tmp_path, use_chunking):
    original = mcap_file(
        tmp_path / 'whole.mcap',
        recorded,
        use_chunking=use_chunking,
        compression=CompressionType.NONE,
    )
    data, ends = original.read_bytes(), offsets_of_messages(original)
    assert len(ends) == COUNT
    boundaries = record_ends(original)
    clean = 0
    sizes = [*range(0, data_end(original), 997), *ends[::50], *boundaries[::50]]
    for size in sizes + [size - 1 for size in sizes[1:]]:
        path = tmp_path / 'cut.mcap'
        path.write_bytes(data[:size])
        messages, error = read_up_to_damage(path)
        assert messages == recorded[: sum(end <= size for end in ends)]
        # An unfinished file may end between records.
        assert (error is None) == (size in boundaries)
        clean += error is None
        if messages and error:
            start = max(boundary for boundary in boundaries if boundary < size)
            assert str(error) == f'{path}: at byte {start}: cut off within a record'
    assert clean > 0


@pytest.mark.parametrize(
    ('storage', 'mode', 'least'), [('mcap', 'file', 0.9), ('sqlite3', 'file', 0.4)]
)
def test_a_cut_compressed_file_is_read_up_to_the_cut(recorded, tmp_path, storage, mode, least):
    random_data = [(t, n, data + noise(n, 400)) for t, n, data in recorded]
    path = single(rosbags_bag(tmp_path / 'bag', random_data, storage, mode))
    data = path.read_bytes()
    for share in (0.6, 0.999):
        path.write_bytes(data[: int(share * len(data))])
        messages, error = read_up_to_damage(path)
        assert messages == random_data[: len(messages)]
        assert len(messages) > least * share * COUNT - 128 * 1024 / 500
        assert 'ended before' in str(error)


def test_a_cut_sqlite_file_is_read_up_to_the_cut(recorded, tmp_path):
    """Sizes are such that pages, and messages on several pages, are cut."""
    for extra in (0, 9000):
        original = [(t, n, data + noise(n, extra)) for t, n, data in recorded]
        path = single(rosbags_bag(tmp_path / f'bag_{extra}', original, 'sqlite3'))
        data = path.read_bytes()
        for share in (0.5, 0.61, 0.72, 0.83, 0.94):
            path.write_bytes(data[: int(share * len(data))])
            messages, error = read_up_to_damage(path)
            assert messages == original[: len(messages)]
            assert len(messages) > 0.8 * share * COUNT
            malformed = 'database disk image is malformed'
            assert str(error) == f'{path}: after message {len(messages)}: {malformed}'


def test_a_damaged_chunk_is_located(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded)
    index = chunks(path)[5]
    before = [m for m in recorded if m[1] < index.message_start_time]
    assert len(before) > COUNT // 4
    data = bytearray(path.read_bytes())
    middle = index.chunk_start_offset + index.chunk_length // 2
    data[middle : middle + 20] = bytes(20)
    path.write_bytes(data)
    messages, error = read_up_to_damage(path)
    assert messages == before
    assert str(error).startswith(f'{path}: at byte {index.chunk_start_offset}: ')


def test_a_chunk_that_is_skipped_is_reported_as_missing(recorded, tmp_path):
    """With its opcode damaged, it looks like an unknown record, but the index lists it."""
    path = mcap_file(tmp_path / 'b.mcap', recorded)
    data = bytearray(path.read_bytes())
    assert data[chunks(path)[3].chunk_start_offset] == 6
    data[chunks(path)[3].chunk_start_offset] = 0x46
    path.write_bytes(data)
    messages, error = read_up_to_damage(path)
    assert 0 < len(messages) < COUNT
    assert f'the index lists {COUNT} messages, there are {len(messages)}' in str(error)


@pytest.mark.parametrize('loss', ['missing', 'cut', 'empty'])
def test_a_lost_file_of_a_split_bag_ends_it_there(recorded, tmp_path, loss):
    path = split(tmp_path / 'bag', recorded, 'mcap', 'none', parts=3)
    lost = path / 'bag_1.mcap'
    if loss == 'missing':
        lost.unlink()
    else:
        lost.write_bytes(lost.read_bytes()[: 20_000 if loss == 'cut' else 0])
    messages, error = read_up_to_damage(lost.parent)
    assert messages == recorded[: len(messages)]
    assert (len(messages) == COUNT // 3) == (loss != 'cut')
    assert COUNT // 3 <= len(messages) < 2 * COUNT // 3
    assert str(error).startswith(f'{lost}: ')


def write(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path


def edited(path: Path, change: Callable[[bytes], bytes]) -> Path:
    return write(path, change(path.read_bytes()))


def metadata_bag(path: Path, messages: Messages, **changes) -> Path:
    change_metadata(rosbags_bag(path, messages), **changes)
    return path


def text_metadata(path: Path, text: str) -> Path:
    path.mkdir()
    write(path / 'metadata.yaml', text.encode())
    return path


def two_recordings(path: Path, messages: Messages) -> Path:
    path.mkdir()
    for name in ('a', 'b'):
        mcap_file(path / f'{name}_0.mcap', messages)
    return path


def claiming_chunk(path: Path, messages: Messages, claim: int) -> Path:
    mcap_file(path, messages)
    start = chunks(path)[0].chunk_start_offset + 9 + 16
    return edited(path, lambda data: data[:start] + struct.pack('<Q', claim) + data[start + 8 :])


def database(path: Path, script: str) -> Path:
    with closing(sqlite3.connect(path)) as connection:
        connection.executescript(script)
    return path


CORPUS = ROOT / 'test' / 'corpus' / 'bags'
BOMB = zstd.compress(bytes(2**27))
UNREADABLE: dict[str, tuple[str, Callable[[Path, Messages], Path]]] = {
    'nothing there': ('no such file or folder', lambda p, _: p / 'b'),
    'not a file': ('no such file or folder', lambda _p, _: Path('/dev/null')),
    'empty file': ('the file is empty', lambda p, _: write(p / 'b.mcap', b'')),
    'empty folder': ('neither metadata.yaml nor', lambda p, _: p),
    'two recordings': ('several recordings', lambda p, m: two_recordings(p / 'b', m)),
    'text': ('not a bag of a known kind', lambda p, _: write(p / 'b.mcap', b'hello ' * 100)),
    'compressed text': (
        'not a bag of a known kind',
        lambda p, _: write(p / 'b.db3.zstd', zstd.compress(b'hello')),
    ),
    'an old ROS 1 bag': (
        'not a bag of a known kind',
        lambda p, _: write(p / 'b.bag', b'#ROSBAG V1.2\n' + bytes(100)),
    ),
    'a ROS 1 bag without its index': (
        'not indexed',
        lambda p, m: edited(
            ros1_bag(p / 'b.bag', m),
            lambda data: data.replace(
                b'index_pos=' + data.split(b'index_pos=')[1][:8], b'index_pos=' + bytes(8)
            ),
        ),
    ),
    'another database': (
        'no such table: topics',
        lambda p, _: database(p / 'b.db3', 'CREATE TABLE t(a); INSERT INTO t VALUES (1);'),
    ),
    'a column that is computed': (
        'messages has computed columns',
        lambda p, m: database(
            single(rosbags_bag(p / 'b', m, 'sqlite3')),
            'ALTER TABLE messages ADD COLUMN more AS (zeroblob(1000000000));',
        ),
    ),
    'pages that refer to the same pages again and again': (
        'more rows than a file of this size can hold',
        lambda *_: CORPUS / 'repeated_pages.db3',
    ),
    'chunk of zeros': (
        r'at byte \d+: there is no record',
        lambda *_: CORPUS / 'chunk_of_zeros.mcap',
    ),
    'mcap cut before any message': (
        'at byte 8: cut off within a record',
        lambda p, m: cut(single(rosbags_bag(p / 'b', m)), lambda _: 40),
    ),
    'sqlite3 cut before any message': (
        'malformed',
        lambda p, m: cut(single(rosbags_bag(p / 'b', m, 'sqlite3')), lambda _: 5000),
    ),
    'metadata is empty': ('no metadata in it', lambda p, _: text_metadata(p / 'b', '')),
    'metadata is of something else': (
        "'rosbag2_bagfile_information' is missing",
        lambda p, _: text_metadata(p / 'b', 'a: 1'),
    ),
    'metadata is no YAML': ('metadata.yaml: ', lambda p, _: text_metadata(p / 'b', '{a: [')),
    'metadata is nested without end': (
        'nested deeper than 20 levels',
        lambda p, _: text_metadata(p / 'b', '[' * 10_000),
    ),
    'metadata is no text': (
        "metadata.yaml: 'utf-8' codec",
        lambda p, _: write(text_metadata(p / 'b', '') / 'metadata.yaml', b'\xff').parent,
    ),
    'no files': (
        'no files are listed',
        lambda p, m: metadata_bag(p / 'b', m, relative_file_paths=[]),
    ),
    'a file outside': (
        r"'\.\./other\.mcap' leads outside",
        lambda p, m: metadata_bag(p / 'b', m, relative_file_paths=['../other.mcap']),
    ),
    'a file far outside': (
        "'/etc/passwd' leads outside",
        lambda p, m: metadata_bag(p / 'b', m, relative_file_paths=['/etc/passwd']),
    ),
    'a file twice': (
        'listed more than once',
        lambda p, m: metadata_bag(p / 'b', m, relative_file_paths=['b.mcap', './b.mcap']),
    ),
    'fewer messages than none': (
        'message count is out of range',
        lambda p, m: metadata_bag(p / 'b', m, message_count=-1),
    ),
    'more messages than any file can hold': (
        'message count is out of range',
        lambda p, m: metadata_bag(p / 'b', m, message_count=2**63),
    ),
    'a file that is missing': (
        r'other\.mcap: No such file',
        lambda p, m: metadata_bag(p / 'b', m, relative_file_paths=['other.mcap']),
    ),
    'unknown compression of messages': (
        "unsupported compression 'xz'",
        lambda p, m: metadata_bag(p / 'b', m, compression_mode='MESSAGE', compression_format='xz'),
    ),
    'unknown compression of chunks': (
        "unsupported compression 'zstx'",
        lambda p, m: edited(
            mcap_file(p / 'b.mcap', m), lambda data: data.replace(b'zstd', b'zstx')
        ),
    ),
    'chunk that claims too much': (
        r'at byte \d+: a chunk of 1099511627776 bytes is too large',
        lambda p, m: claiming_chunk(p / 'b.mcap', m, 2**40),
    ),
    'chunk that claims too little': (
        'does not have the size that it states',
        lambda p, m: claiming_chunk(p / 'b.mcap', m, 100),
    ),
    'file that grows': (
        r'b\.mcap\.zstd: it expands to more than 3\d{7} bytes',
        lambda p, _: write(p / 'b.mcap.zstd', BOMB),
    ),
    'no CDR': (
        "messages on /json are 'json', not CDR",
        lambda p, m: mcap_file(p / 'b.mcap', m, others=(('/json', 'T', 'json', '', b''),)),
    ),
}


@pytest.mark.parametrize('kind', UNREADABLE)
def test_what_cannot_be_read_is_named_with_its_cause(kind, recorded, tmp_path):
    cause, make = UNREADABLE[kind]
    path = make(tmp_path, recorded)
    with pytest.raises(BagError, match=cause) as raised:
        read(path, [*RECORDED_TOPICS, '/json'])
    assert not isinstance(raised.value, DamagedBagError)
    assert '\n' not in str(raised.value)
    assert str(path) in str(raised.value)


def test_a_record_that_is_too_large_is_not_loaded(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr('gear_kinematics.bag.mcap.MAX_RECORD', 2000)
    path = mcap_file(
        tmp_path / 'b.mcap', [*recorded[:-1], (*recorded[-1][:2], bytes(2000))], use_chunking=False
    )
    messages, error = read_up_to_damage(path)
    assert messages == recorded[:-1]
    assert (
        str(error)
        == f'{path}: at byte {record_ends(path)[-2]}: a record of 2022 bytes is too large'
    )


def test_zeros_at_the_end_after_a_power_failure_are_damage(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded, finish=False)
    end = path.stat().st_size
    edited(path, lambda data: data + bytes(900))
    messages, error = read_up_to_damage(path)
    assert messages == recorded
    assert str(error) == f'{path}: at byte {end}: there is no record'


def test_a_compressed_file_that_breaks_off_between_records_is_damaged(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded, finish=False)
    data = path.read_bytes()
    for compress in (zstd.compress, lz4.frame.compress):
        path.write_bytes(compress(data) + compress(b'more')[:-2])
        messages, error = read_up_to_damage(path)
        assert messages == recorded
        assert 'ended before' in str(error)


@pytest.mark.parametrize('change', ["data = 'text'", 'data = 5', "timestamp = X'FF'"])
def test_a_row_of_another_type_is_damage(recorded, tmp_path, change):
    path = single(rosbags_bag(tmp_path / 'bag', recorded, 'sqlite3'))
    database(path, f'UPDATE messages SET {change} WHERE id = 500')  # noqa: S608, from above
    messages, error = read_up_to_damage(path)
    others = [message for message in recorded if message is not recorded[499]]
    assert messages == (others if 'timestamp' in change else recorded[:499])
    cause = f'after message {len(messages)}: a message without a time or data'
    assert str(error) == f'{path}: {cause}'


def test_a_checksum_that_does_not_match_is_damage(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded, compression=CompressionType.NONE)
    last = chunks(path)[-1]
    end = last.chunk_start_offset + last.chunk_length
    edited(path, lambda data: data[: end - 1] + bytes([data[end - 1] ^ 1]) + data[end:])
    messages, error = read_up_to_damage(path)
    assert messages == [m for m in recorded if m[1] < last.message_start_time]
    assert f'at byte {last.chunk_start_offset}: a chunk does not match its checksum' in str(error)


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_message_that_grows_is_damage(recorded, tmp_path, storage, monkeypatch):
    monkeypatch.setattr('gear_kinematics.bag.storage._SPARE_SIZE', 2**20)
    packed = [(topic, received, zstd.compress(data)) for topic, received, data in recorded]
    packed[700] = (*packed[700][:2], zstd.compress(bytes(2**21)))
    path = rosbags_bag(tmp_path / 'bag', packed, storage)
    messages, error = read_up_to_damage(path)
    assert messages == recorded[:700]
    assert 'a compressed message is cut off or too large' in str(error)


@pytest.mark.parametrize(
    ('topic', 'text', 'offset'),
    [
        ('/rotor_state', b'\5\0\0\0rotor', 0),  # the length of the name
        ('/body_poses', b'\6\0\0\0stator', 10),  # the number of poses
    ],
)
def test_a_malformed_message_of_ros1_is_damage(recorded, tmp_path, topic, text, offset):
    """A length in the 41st message is out of bounds, which is found without counting that far."""
    path = ros1_bag(tmp_path / 'b.bag', recorded)
    data = path.read_bytes()
    place = [found.start() for found in re.finditer(text, data)][40] + offset
    path.write_bytes(data[:place] + b'\xff' * 4 + data[place + 4 :])
    messages, error = read_up_to_damage(path)
    assert messages == recorded[: len(messages)]
    assert sum(message[0] == topic for message in messages) == 40
    assert f'after message {len(messages)}: ' in str(error)


# Random bytes.

FUZZED: dict[str, Callable[[Path, Messages], Path]] = {
    'mcap': rosbags_bag,
    'mcap of chunks': lambda p, m: rosbags_bag(p, m, mode='storage'),
    'mcap of mcap': lambda p, m: mcap_file(p.with_suffix('.mcap'), m, chunk_size=2000),
    'mcap of lz4': lambda p, m: mcap_file(
        p.with_suffix('.mcap'), m, chunk_size=2000, compression=CompressionType.LZ4
    ),
    'mcap without chunks': lambda p, m: mcap_file(p.with_suffix('.mcap'), m, use_chunking=False),
    'sqlite3': lambda p, m: rosbags_bag(p, m, 'sqlite3'),
    'sqlite3 of messages': lambda p, m: rosbags_bag(p, m, 'sqlite3', 'message'),
    'file': lambda p, m: rosbags_bag(p, m, mode='file'),
    'ROS 1': lambda p, m: ros1_bag(p.with_suffix('.bag'), m, 'LZ4'),
}


@pytest.fixture(scope='module', params=FUZZED)
def fuzzed(request, recorded, tmp_path_factory) -> tuple[Path, dict[Path, bytes]]:
    """A bag, and its files with their contents."""
    path = FUZZED[request.param](tmp_path_factory.mktemp('fuzz') / 'bag', recorded[:60])
    return path, {p: p.read_bytes() for p in ([path] if path.is_file() else path.iterdir())}


@pytest.mark.slow
@settings(
    max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None
)
@given(draw=st.data())
def test_no_bytes_on_disk_raise_anything_else(fuzzed, draw):
    path, files = fuzzed
    file = draw.draw(st.sampled_from(sorted(files)))
    data = bytearray(files[file])
    for _ in range(draw.draw(st.integers(0, 3))):
        place = draw.draw(st.integers(0, len(data) - 1))
        width = draw.draw(st.integers(1, 8))
        data[place : place + width] = draw.draw(st.binary(min_size=width, max_size=width))
    if draw.draw(st.booleans()):
        del data[draw.draw(st.integers(0, len(data))) :]
    try:
        file.write_bytes(data)
        messages, error = read_up_to_damage(path)
        if data == files[file]:
            assert (len(messages), error) == (60, None)
        for topic, received, content in messages:
            assert (type(topic), type(received), type(content)) == (str, int, bytes)
        with Bag(path) as bag:
            for topic in bag.topics:
                bag.describe(topic)
    except BagError:
        pass
    finally:
        file.write_bytes(files[file])


@pytest.mark.parametrize('name', ['servo_point_to_point', 'driver_faults'])
def test_a_shipped_bag_is_read_up_to_a_cut_anywhere(name, tmp_path):
    shutil.copytree(BAGS / name, tmp_path / name)
    topics = list(RECORDED_TOPICS)
    whole = read(tmp_path / name, topics)
    file = single(tmp_path / name)
    data = file.read_bytes()
    lengths = []
    for size in range(0, len(data), len(data) // 12):
        file.write_bytes(data[:size])
        messages, error = read_up_to_damage(tmp_path / name)
        assert messages == whole[: len(messages)]
        assert str(error).startswith(f'{file}: ') if error else messages == whole
        lengths.append(len(messages))
    assert lengths == sorted(lengths)
    assert lengths[-1] > 0.8 * len(whole)


# Writing.

WRITTEN = pytest.mark.parametrize(
    ('storage', 'compression'),
    [('mcap', 'none'), ('mcap', 'zstd'), ('sqlite3', 'none'), ('sqlite3', 'zstd')],
)


@WRITTEN
def test_others_read_what_is_written(recorded, tmp_path, storage, compression):
    path = write_bag(tmp_path / 'bag', recorded, storage=storage, compression=compression)
    assert read(path) == recorded
    packed = (storage, compression) == ('sqlite3', 'zstd')
    name = {'mcap': 'bag_0.mcap', 'sqlite3': 'bag_0.db3'}[storage] + '.zstd' * packed
    assert {p.name for p in path.iterdir()} == {'metadata.yaml', name}
    definitions = {k: definition_of(k) for k in RECORDED_TOPICS.values()}
    if storage == 'mcap':
        with (path / name).open('rb') as stream:
            reader = mcap.reader.make_reader(stream, validate_crcs=True)
            found = list(reader.iter_messages())
            assert {c.compression for c in reader.get_summary().chunk_indexes} == {
                'zstd' if compression == 'zstd' else ''
            }
        assert [(c.topic, m.log_time, m.data) for _, c, m in found] == recorded
        for schema, channel, _ in found:
            assert (schema.name, schema.encoding) == (RECORDED_TOPICS[channel.topic], 'ros2msg')
            assert schema.data.decode() == definitions[schema.name]
            assert channel.message_encoding == 'cdr'
    else:
        file = path / name
        if packed:
            file = write(tmp_path / 'plain.db3', zstd.decompress(file.read_bytes()))
        with closing(sqlite3.connect(file)) as rows:
            query = (
                'SELECT name, timestamp, data FROM messages JOIN topics'
                ' ON topic_id = topics.id ORDER BY messages.id'
            )
            assert rows.execute(query).fetchall() == recorded
            topics = dict(rows.execute('SELECT name, type FROM topics'))
            assert topics == RECORDED_TOPICS
            query = 'SELECT topic_type, encoded_message_definition FROM message_definitions'
            assert dict(rows.execute(query)) == definitions


@pytest.mark.slow
@WRITTEN
@pytest.mark.parametrize('count', [1, 1000, 10**6])
def test_files_are_those_of_rosbags(recorded, tmp_path, storage, compression, count):
    """For any number of messages written at a time, over several chunks."""
    messages = [
        (topic, received + turn, data)
        for turn in range(12)
        for topic, received, data in [*recorded, ('/rotor_state', 7, bytes(2**18))]
    ]
    assert sum(len(data) for _, _, data in messages) > 4 * 2**20
    mode = {'mcap': 'storage', 'sqlite3': 'file'}[storage] if compression == 'zstd' else 'none'
    source = rosbags_bag(tmp_path / 'source' / 'bag_0', messages, storage, mode)
    expected = {path.name: path.read_bytes() for path in source.iterdir()}
    with Bag(source) as bag, BagWriter(tmp_path / 'bag', storage, compression) as writer:
        for topic in bag.topics:
            writer.copy_topic(bag, topic)
        for start in range(0, len(messages), count):
            writer.write_all(messages[start : start + count])
    assert {path.name: path.read_bytes() for path in (tmp_path / 'bag').iterdir()} == expected


@WRITTEN
def test_the_metadata_is_what_ros2_bag_info_shows(recorded, tmp_path, storage, compression):
    path = write_bag(tmp_path / 'bag', recorded, storage=storage, compression=compression)
    document = yaml.safe_load((path / 'metadata.yaml').read_text())
    metadata = document['rosbag2_bagfile_information']
    packed = (storage, compression) == ('sqlite3', 'zstd')
    (file,) = metadata['files']
    assert metadata['relative_file_paths'] == [file['path']] == [single(path).name]
    assert metadata['version'] == 9
    assert metadata['storage_identifier'] == storage
    assert metadata['compression_mode'].upper() == ('FILE' if packed else '')
    assert metadata['compression_format'] == ('zstd' if packed else '')
    for part in (metadata, file):
        assert part['message_count'] == COUNT
        assert part['starting_time'] == {'nanoseconds_since_epoch': recorded[0][1]}
        assert part['duration'] == {'nanoseconds': recorded[-1][1] - recorded[0][1]}
    found = {}
    for topic in metadata['topics_with_message_count']:
        about = topic['topic_metadata']
        found[about['name']] = about['type']
        assert topic['message_count'] == sum(m[0] == about['name'] for m in recorded)
        assert about['serialization_format'] == 'cdr'
        assert about['type_description_hash'] == JAZZY.hash_rihs01(about['type'])
        (qos,) = about['offered_qos_profiles']
        assert (qos['reliability'], qos['durability']) == ('reliable', 'volatile')
    assert found == RECORDED_TOPICS


WRITE_AGAIN = """
import sys
from pathlib import Path
from gear_kinematics.bag import Bag, BagWriter
with Bag(sys.argv[1]) as bag, BagWriter(*sys.argv[2:]) as writer:
    for topic in bag.topics:
        writer.copy_topic(bag, topic)
    for message in bag.messages(bag.topics):
        writer.write(*message)
"""


@pytest.mark.slow
@WRITTEN
def test_the_same_messages_give_the_same_bytes(recorded, tmp_path, storage, compression):
    """In any folder and process, and for the copy of a copy."""
    source = write_bag(tmp_path / 'bag', recorded, storage=storage, compression=compression)
    files = {path.name: path.read_bytes() for path in source.iterdir()}
    assert len(files) == 2
    for seed in ('1', '2'):
        folder = tmp_path / seed
        folder.mkdir()
        command = [sys.executable, '-c', WRITE_AGAIN, source, folder / 'bag', storage, compression]
        subprocess.run(command, check=True, cwd=ROOT, env={**os.environ, 'PYTHONHASHSEED': seed})
        source = folder / 'bag'
        assert {path.name: path.read_bytes() for path in source.iterdir()} == files


@WRITTEN
@pytest.mark.parametrize('error', [ValueError, KeyboardInterrupt])
def test_an_interruption_leaves_nothing(recorded, tmp_path, storage, compression, error):
    def interrupted() -> Iterable[tuple[str, int, bytes]]:
        yield from recorded[:5]
        assert not (tmp_path / 'bag').exists()
        assert len(list(tmp_path.iterdir())) == 1
        raise error

    with pytest.raises(error):
        write_bag(tmp_path / 'bag', interrupted(), storage=storage, compression=compression)
    assert not list(tmp_path.iterdir())


def test_a_bag_that_cannot_be_finished_leaves_nothing(tmp_path, monkeypatch):
    def rename(*_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(Path, 'rename', rename)
    with pytest.raises(BagError, match=r'/bag: No space left on device$'):
        write_bag(tmp_path / 'bag', [])
    assert not list(tmp_path.iterdir())


def test_a_bag_without_messages_is_written_and_read(tmp_path):
    for storage in ('mcap', 'sqlite3'):
        with Bag(write_bag(tmp_path / storage, [], storage=storage)) as bag:
            assert (bag.topics, bag.message_count) == (RECORDED_TOPICS, 0)
            assert not list(bag.messages(RECORDED_TOPICS))


def test_an_existing_target_is_left_alone(recorded, tmp_path):
    (tmp_path / 'folder').mkdir()
    (tmp_path / 'file').write_text('kept')
    (tmp_path / 'link').symlink_to('nowhere')
    for name in ('folder', 'file', 'link'):
        with pytest.raises(BagError, match=f'{name}: exists already'):
            write_bag(tmp_path / name, recorded)
    assert {path.name for path in tmp_path.iterdir()} == {'folder', 'file', 'link'}
    assert (tmp_path / 'file').read_text() == 'kept'
    with pytest.raises(BagError, match='nowhere/bag: No such file'):
        write_bag(tmp_path / 'nowhere' / 'bag', recorded)


def test_invalid_messages_are_refused(tmp_path):
    with BagWriter(tmp_path / 'bag') as writer:
        writer.add_topic('/a', 'sensor_msgs/msg/JointState')
        for attempt, cause in (
            (lambda: writer.add_topic('/a', 'sensor_msgs/msg/JointState'), 'added already'),
            (lambda: writer.add_topic('/b', 'my_msgs/msg/Odd'), 'my_msgs/msg/Odd is not of'),
            (lambda: writer.write('/b', 1, b''), '/b has not been added'),
            (lambda: writer.write('/a', -1, b''), 'bag: the time of reception -1 is out'),
        ):
            with pytest.raises(BagError, match=cause):
                attempt()
        writer.write('/a', 1, b'\0\1\0\0')
    assert read(tmp_path / 'bag', ['/a']) == [('/a', 1, b'\0\1\0\0')]


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


def described_mcap(path: Path) -> Path:
    """Write a topic of each kind, without any messages."""
    with path.open('wb') as stream:
        writer = mcap.writer.Writer(stream)
        writer.start(profile='ros2')
        for topic, kind, encoding, syntax, text, metadata in (
            ('/full', 'my_msgs/msg/Odd', 'cdr', 'ros2msg', ODD, {'topic_type_hash': 'RIHS01_x'}),
            ('/full_qos', 'my_msgs/msg/Odd', 'cdr', 'ros2msg', ODD, {'offered_qos_profiles': QOS}),
            ('/idl', 'my_msgs/msg/Idl', 'cdr', 'ros2idl', IDL, {}),
            ('/no_text', 'sensor_msgs/msg/JointState', 'cdr', '', '', {}),
            ('/strange', 'my_msgs/msg/A', 'cdr', 'ros2msg', '!?', {'topic_type_hash': 'RIHS01_y'}),
            ('/unknown', 'my_msgs/msg/B', 'cdr', '', '', {}),
            ('/broken', 'my_msgs/msg/C', 'cdr', 'ros2msg', '!?', {}),
            ('/json', 'my_msgs/msg/D', 'json', 'ros2msg', 'int8 a', {}),
            ('/xml', 'my_msgs/msg/E', 'cdr', 'xml', '<a/>', {}),
            (
                '/bad_qos',
                'my_msgs/msg/F',
                'cdr',
                'ros2msg',
                'int8 a',
                {'offered_qos_profiles': 'a'},
            ),
        ):
            schema = writer.register_schema(kind, syntax, text.encode())
            writer.register_channel(topic, encoding, schema, metadata)
        writer.finish()
    return path


@pytest.mark.parametrize('received', [2**63, 2**64 - 1])
def test_a_time_out_of_range_of_ros_is_damage(tmp_path, received):
    path = tmp_path / 'b.mcap'
    with path.open('wb') as stream:
        writer = mcap.writer.Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema('my_msgs/msg/Odd', 'ros2msg', ODD.encode())
        channel = writer.register_channel('/t', 'cdr', schema)
        for time in (1, 2**63 - 1, received):
            writer.add_message(channel, time, b'data', time)
        writer.finish()
    taken = []
    with Bag(path) as bag, pytest.raises(DamagedBagError, match='reception is out of range'):
        taken.extend(bag.messages(['/t']))
    assert [message[1] for message in taken] == [1, 2**63 - 1]


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_copied_topic_keeps_its_description(tmp_path, storage):
    names = ['/full', '/full_qos', '/idl', '/no_text', '/strange', '/unknown', '/broken']
    with Bag(described_mcap(tmp_path / 'b.mcap')) as bag:
        with BagWriter(tmp_path / 'copy', storage) as writer:
            for name in names:
                writer.copy_topic(bag, name)
                writer.write(name, 5, b'\0\1\0\0')
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
def test_a_topic_that_cannot_be_copied_is_named(tmp_path, name, cause):
    with Bag(described_mcap(tmp_path / 'b.mcap')) as bag, BagWriter(tmp_path / 'copy') as writer:
        with pytest.raises(BagError, match=re.escape(f'b.mcap: {cause}')) as raised:
            writer.copy_topic(bag, name)
        assert '\n' not in str(raised.value)
        assert isinstance(raised.value, TopicError) == (name != '/nothing')


UNKNOWN = b'\0\1\0\0nobody knows'


@pytest.mark.parametrize('source', ['mcap', 'sqlite3'])
@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_type_that_nobody_defines_is_copied_by_name(recorded, tmp_path, source, storage):
    """As rosbag2 writes it, and others read it: bags of Humble and older have no definitions."""
    if source == 'mcap':
        path = described_mcap(tmp_path / 'b.mcap')
    else:
        path = single(rosbags_bag(tmp_path / 'b', recorded[:3], 'sqlite3'))
        database(
            path,
            'DROP TABLE message_definitions;'
            "INSERT INTO topics VALUES (9, '/unknown', 'my_msgs/msg/B', 'cdr', '', '');",
        )
    with Bag(path) as bag, BagWriter(tmp_path / 'copy', storage) as writer:
        topic = writer.copy_topic(bag, '/unknown')
        assert (topic.type, topic.syntax, topic.definition) == ('my_msgs/msg/B', '', '')
        writer.write('/unknown', 5, UNKNOWN)
    assert read(tmp_path / 'copy', ['/unknown']) == [('/unknown', 5, UNKNOWN)]
    with rosbag2.Reader(tmp_path / 'copy') as reader:
        [connection] = reader.connections
        assert (connection.msgtype, connection.msgdef.data) == ('my_msgs/msg/B', '')
        assert [bytes(data) for _, _, data in reader.messages()] == [UNKNOWN]
    file = single(tmp_path / 'copy')
    if storage == 'mcap':
        with file.open('rb') as stream:
            [(schema, _, message)] = mcap.reader.make_reader(stream).iter_messages()
        # By the specification of mcap no schema is known where there is no encoding.
        assert (schema.name, schema.encoding, schema.data) == ('my_msgs/msg/B', '', b'')
        assert message.data == UNKNOWN
    else:
        with closing(sqlite3.connect(file)) as rows:
            assert not rows.execute('SELECT * FROM message_definitions').fetchall()


def test_too_many_topics_are_not_copied(tmp_path, monkeypatch):
    monkeypatch.setattr(writing, '_MAX_ENTRIES', 100)  # of 4000, which take long to write
    path = tmp_path / 'b.mcap'
    with path.open('wb') as stream:
        writer = mcap.writer.Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema('my_msgs/msg/A', 'ros2msg', b'int8 a')
        qos = {'offered_qos_profiles': 30 * QOS}
        for number in range(4):
            writer.register_channel(f'/{number}', 'cdr', schema, qos)
        writer.finish()
    with Bag(path) as bag, BagWriter(tmp_path / 'copy') as writer:
        for number in range(3):  # 31 entries of metadata each
            writer.copy_topic(bag, f'/{number}')
        with pytest.raises(TopicError, match='/3 cannot be copied: there are more than 100 '):
            writer.copy_topic(bag, '/3')


def test_topics_of_ros1_are_copied_as_ros2(recorded, tmp_path):
    with (
        Bag(ros1_bag(tmp_path / 'b.bag', recorded)) as bag,
        BagWriter(tmp_path / 'copy') as writer,
    ):
        for topic in bag.topics:
            writer.copy_topic(bag, topic)
        for message in bag.messages(bag.topics):
            writer.write(*message)
    with rosbag2.Reader(tmp_path / 'copy') as reader:
        assert {c.topic: c.digest for c in reader.connections} == {
            topic: JAZZY.hash_rihs01(kind) for topic, kind in RECORDED_TOPICS.items()
        }
        assert all('uint32 seq' not in c.msgdef.data for c in reader.connections)
    assert read_bag(tmp_path / 'copy') == recorded


def test_written_messages_are_read_again(recorded, tmp_path):
    for storage, compression in (('mcap', 'zstd'), ('sqlite3', 'none')):
        with BagWriter(tmp_path / storage, storage, compression) as writer:
            for topic, message_type in RECORDED_TOPICS.items():
                writer.add_topic(topic, message_type)
            writer.write_all(recorded)
        with Bag(tmp_path / storage) as bag:
            assert list(bag.messages(RECORDED_TOPICS)) == recorded
            with pytest.raises(BagError, match=f'{storage}: no topic /a in it; there are: '):
                bag.type_of('/a')
