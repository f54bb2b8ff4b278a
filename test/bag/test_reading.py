# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bags of every kind are read whole; the expected messages are read by rosbags alone."""

import shutil
import sqlite3
import tracemalloc
from contextlib import closing
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from gear_recordings import old_recording
from made_bags import (
    JAZZY,
    chunks,
    file_of,
    folder,
    lz4_file,
    lz4_messages,
    mcap_file,
    read,
    record_ends,
    renamed_folder,
    ros1_bag,
    single_file,
    split,
    split_without_metadata,
)
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType
from replaying import decode, encode
from rosbags import rosbag1, rosbag2
from shipped_bags import TYPES, write_bag

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.mcap import Mcap
from gear_kinematics.bag.runs import starts_of_runs

OTHERS = (
    ('/a', 'my_msgs/msg/Odd', 'cdr', 'ros2msg', b'!! no [definition\xff'),
    ('/b', 'my.Proto', 'protobuf', 'protobuf', b'\x80\x00\xff'),
    ('/c', 'Thing', 'json', 'jsonschema', b'{}'),
    ('/d', 'my_msgs/msg/None', 'cdr', '', b''),
)
NO_INDEX = {'index_types': IndexType.NONE, 'repeat_channels': False, 'repeat_schemas': False}
NO_INDEX |= {'use_statistics': False, 'use_summary_offsets': False}
KINDS = {
    'mcap of chunks': partial(folder, storage='mcap', mode='storage'),
    'names as before version 4': renamed_folder,
    'metadata with nulls': partial(folder, compression_mode=None, files=None),
    'odd name': partial(single_file, storage='sqlite3', name='a?b#c %20.db3'),
    'mcap of lz4 chunks': partial(mcap_file, compression=CompressionType.LZ4),
    'mcap of zstd chunks': mcap_file,
    'mcap without chunks': partial(mcap_file, use_chunking=False),
    'mcap without definitions': partial(mcap_file, definition=False),
    'mcap with types such as sensor_msgs/JointState': partial(mcap_file, shortened=True),
    'other topics, of unknown types': partial(mcap_file, others=OTHERS),
    'sqlite3 of Humble': lambda path, messages: old_recording(path, [*TYPES.items()], messages),
    'ROS 1': ros1_bag,
    'ROS 1 lz4': partial(ros1_bag, compression='LZ4'),
    'ROS 1 bz2': partial(ros1_bag, compression='BZ2'),
}
for _storage in ('mcap', 'sqlite3'):
    for _mode in ('none', 'message', 'file'):
        KINDS[f'{_storage} {_mode}'] = partial(folder, storage=_storage, mode=_mode)
        KINDS[f'{_storage} single {_mode}'] = partial(single_file, storage=_storage, mode=_mode)
    for _maker in (lz4_file, lz4_messages, split, split_without_metadata):
        KINDS[f'{_storage} {_maker.__name__}'] = partial(_maker, storage=_storage)
    KINDS[f'{_storage} split file'] = partial(split, storage=_storage, mode='file')
KINDS |= {
    'mcap without an index': partial(mcap_file, **NO_INDEX),
    'unfinished mcap': partial(mcap_file, finish=False),
    'unfinished mcap without chunks': partial(mcap_file, finish=False, use_chunking=False),
    'mcap with its index cut off': partial(mcap_file, cut=-1),
}


@pytest.mark.parametrize('kind', KINDS)
def test_a_bag_of_every_kind_is_read_whole(kind, recorded, tmp_path):
    path = KINDS[kind](tmp_path / 'b', recorded)
    with Bag(path) as bag:
        assert {name: bag.topics[name] for name in TYPES} == TYPES
        listed = (path / 'metadata.yaml').exists()
        assert bag.message_count == (len(recorded) if listed else None)
        messages = list(bag.messages(TYPES))
        assert messages == recorded
        assert {type(data) for _, _, data in messages} == {bytes}
        assert bag.unclosed == kind.startswith('unfinished')
        # A second time, and only some.
        wanted = [message for message in recorded if message[0] == '/body_poses']
        assert list(bag.messages(['/body_poses', '/nothing'])) == wanted
        assert not list(bag.messages([]))


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_batches_report_progress(recorded, storage, tmp_path):
    messages = sorted(80 * recorded, key=lambda message: message[1])
    told = []
    with Bag(folder(tmp_path / 'b', messages, storage)) as bag:
        batches = list(bag.batches(TYPES, lambda *done: told.append(done)))
    assert [message for batch in batches for message in batch] == messages
    assert 1 < len(batches) < len(messages) / 200
    assert [done for done, _ in told][-1] == len(messages)
    assert {total for _, total in told} == {len(messages)}


def test_big_endian_messages_pass_untouched(recorded, tmp_path):
    swapped = [
        (topic, received, encode(decode(data, TYPES[topic]), little_endian=False))
        for topic, received, data in recorded
    ]
    assert {data[:2] for _, _, data in swapped} == {b'\0\0'}
    for storage in ('mcap', 'sqlite3'):
        assert read(folder(tmp_path / storage, swapped, storage)) == swapped


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'topic', 'count'),
    [
        ('feetech_servos', '/servo/out/state', 954),
        ('pr2_joints/pr1012_sensors.bag', '/joint_states', 1325),
    ],
)
def test_real_recordings_are_read(shared_path, name, topic, count):
    path = shared_path(f'data/bags/{name}')
    messages = read(path, [topic])
    assert len(messages) == count
    with rosbag1.Reader(path) if path.is_file() else rosbag2.Reader(path) as reader:
        connections = [c for c in reader.connections if c.topic == topic]
        original = [(topic, time, bytes(data)) for _, time, data in reader.messages(connections)]
    if path.is_file():
        kind = 'sensor_msgs/msg/JointState'
        original = [(t, n, bytes(JAZZY.ros1_to_cdr(d, kind))) for t, n, d in original]
    assert messages == original


def test_sqlite_of_a_killed_recorder_is_read_with_its_journal_without_messages_of_no_topic(
    recorded, tmp_path
):
    file = single_file(tmp_path / 'bag', recorded, 'sqlite3')
    with closing(sqlite3.connect(file)) as database:
        database.execute('PRAGMA journal_mode=WAL')
        database.execute("INSERT INTO messages SELECT 5000, 1, 2000000000000000000, x'00010000'")
        database.execute("INSERT INTO messages SELECT 5001, 99, 2000000000000000001, x'00'")
        database.commit()
        (tmp_path / 'killed').mkdir()
        for part in (file, file.with_name(f'{file.name}-wal')):
            shutil.copy(part, tmp_path / 'killed')
    messages = read(tmp_path / 'killed')
    assert messages[:-1] == recorded
    assert messages[-1] == ('/rotor_state', 2 * 10**18, b'\0\1\0\0')


@pytest.mark.parametrize('chunk_size', [20_000, 2**20])
def test_messages_of_an_mcap_are_in_the_order_of_reception(recorded, tmp_path, chunk_size):
    """Whatever their order in a chunk, and where chunks overlap."""
    shuffled = list(recorded)
    for start in range(0, len(recorded), 40):  # less than a chunk of 20 kB holds
        piece = shuffled[start : start + 40]
        shuffled[start : start + 40] = sorted(piece, key=lambda m: m[2][::-1])
    assert shuffled != recorded
    path = mcap_file(tmp_path / 'b.mcap', shuffled, chunk_size=chunk_size)
    times = [(chunk.message_start_time, chunk.message_end_time) for chunk in chunks(path)]
    overlap = any(end > start for (_, end), (start, _) in pairwise(times))
    assert overlap == (chunk_size == 20_000)
    assert read(path) == recorded


@pytest.mark.parametrize('options', [{}, NO_INDEX, {'finish': False}])
def test_chunks_that_overlap_are_merged_in_the_order_of_reception(recorded, tmp_path, options):
    by_topic = sorted(recorded, key=lambda message: message[0])
    assert by_topic != recorded
    path = mcap_file(tmp_path / 'b.mcap', by_topic, **options)
    assert read(path) == sorted(by_topic, key=lambda message: message[1])


RECORDERS = {
    'one chunk': partial(mcap_file, chunk_size=2**20),
    'chunks': mcap_file,
    'chunks without an index': partial(mcap_file, **NO_INDEX),
    'chunks of a killed recorder': partial(mcap_file, finish=False),
    'no chunks': partial(mcap_file, use_chunking=False),
    'sqlite3': partial(folder, storage='sqlite3'),
}


@pytest.mark.parametrize('kind', RECORDERS)
def test_runs_stay_in_their_order_where_time_begins_anew(recorded, tmp_path, kind):
    """As of a simulation that is reset while it is recorded with its own time."""
    first = [(topic, 10 * received - 10**19, data) for topic, received, data in recorded]
    assert first[-1][1] - first[0][1] > 2 * 10**9
    again = [(topic, received - 7_000_003, data) for topic, received, data in first]
    runs = first + again + again[:300]
    path = RECORDERS[kind](tmp_path / 'b.mcap', runs)
    assert read(path) == runs
    assert read(path, ['/rotor_state']) == [m for m in runs if m[0] == '/rotor_state']


@pytest.mark.parametrize('first', [1.5, 2.0, 2.75])
def test_a_short_first_run_stays_apart_from_a_long_one(recorded, tmp_path, first):
    """As where a simulation is reset at once, and recorded for 50 minutes."""
    data = next(data for topic, _, data in recorded if topic == '/rotor_state')
    times = [*np.arange(0.0, first, 0.25), *np.arange(0.003, 3000.0, 0.25)]
    runs = [('/rotor_state', 1 + round(time * 1e9), data) for time in times]
    assert read(folder(tmp_path / 'bag', runs, 'sqlite3')) == runs


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_runs_stay_in_their_order_where_one_file_begins_with_the_end_of_another_run(
    recorded, tmp_path, storage
):
    """The last 0.7 s of the first run are in the second file, in which both runs share no time."""
    first = [(topic, 10 * received - 10**19, data) for topic, received, data in recorded]
    again = [(topic, received - 2 * 10**9, data) for topic, received, data in first[:700]]
    runs = first + again
    assert max(received for _, received, _ in again) < first[800][1]
    assert read(split(tmp_path / 'bag', runs, storage, parts=2)) == runs


def test_a_run_that_begins_where_a_piece_of_the_file_does_stays_apart(recorded, tmp_path):
    """Messages outside of chunks are read 4096 at once: eight runs, and then the ninth."""
    first = [(topic, 10 * received - 10**19, data) for topic, received, data in recorded[:512]]
    assert first[-1][1] - first[0][1] > 2 * 10**9
    runs = [(topic, at - 7 * k, data) for k in range(9) for topic, at, data in first]
    assert read(RECORDERS['no chunks'](tmp_path / 'b.mcap', runs)) == runs


def test_runs_are_found_beside_many_topics_of_few_messages():
    """Both runs have the times of 0.3 s at 100 Hz; of 200 latched topics they have one each."""
    times = [*range(2 * 10**9, 4 * 10**9, 10**7), *range(2 * 10**9, 23 * 10**8, 10**7)]
    messages = [('/rotor_state', time) for time in times]
    latched = [(f'/latched_{k}', 2 * 10**9) for k in range(200)]
    (start,) = starts_of_runs([*latched, *messages])
    assert start == 200 + 200
    assert not starts_of_runs([*latched, *sorted(messages)])


@pytest.mark.parametrize('kind', sorted(RECORDERS.keys() - {'no chunks'}))
def test_recordings_in_chunks_that_follow_each_other_are_sorted_by_time(recorded, tmp_path, kind):
    """As where a program writes the later one first."""
    later = [(topic, received + 10**10, data) for topic, received, data in recorded]
    path = RECORDERS[kind](tmp_path / 'b.mcap', later + recorded)
    assert read(path) == recorded + later


def test_an_index_with_further_bytes_is_read(recorded, tmp_path):
    """The specification of mcap lets later versions append fields to a record."""
    by_topic = sorted(recorded, key=lambda message: message[0])
    path = mcap_file(tmp_path / 'b.mcap', by_topic)
    data = path.read_bytes()
    start, end = next(ends for ends in pairwise(record_ends(path)) if data[ends[0]] == 7)
    length = (end - start - 9 + 10).to_bytes(8, 'little')
    path.write_bytes(data[: start + 1] + length + data[start + 9 : end] + bytes(10) + data[end:])
    assert read(path) == sorted(by_topic, key=lambda message: message[1])


def test_chunks_of_a_rewritten_file_are_merged_as_mcap_does(shared_path):
    path = shared_path('data/faults/chunks_not_in_log_order.mcap')
    with path.open('rb') as stream:
        expected = [
            (channel.topic, message.log_time, message.data)
            for _, channel, message in make_reader(stream).iter_messages()
        ]
    assert [received for _, received, _ in expected] == sorted(m[1] for m in expected)
    assert read(path, ['/rotor_state', '/output_encoder']) == expected


@pytest.mark.parametrize('use_chunking', [True, False])
def test_messages_that_are_too_far_out_of_order_are_refused(
    recorded, tmp_path, monkeypatch, use_chunking
):
    monkeypatch.setattr(
        'gear_kinematics.bag.mcap._MAX_OPEN', 2**19 + 50_000
    )  # two chunks of 20 kB
    monkeypatch.setattr('gear_kinematics.bag.mcap._PIECE', 100)
    by_topic = sorted(recorded, key=lambda message: message[0])
    path = mcap_file(tmp_path / 'b.mcap', by_topic, use_chunking=use_chunking)
    with pytest.raises(BagError, match=r'mcap sort INDEXED\.mcap') as raised:
        read(path)
    assert type(raised.value) is BagError


@pytest.mark.slow
@pytest.mark.parametrize('make', [mcap_file, lz4_messages, folder])
def test_reading_takes_little_memory(recorded, tmp_path, make):
    messages = [
        (topic, received + 10**10 * turn, data)
        for turn in range(40)
        for topic, received, data in recorded
    ]
    storage = {} if make is mcap_file else {'storage': 'sqlite3'}
    path = make(tmp_path / 'b', messages, **storage)  # lz4 allocates what it may fill
    tracemalloc.start()
    with Bag(path) as bag:
        assert sum(1 for _ in bag.messages(TYPES)) == len(messages)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < sum(len(data) for _, _, data in messages) / 10


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_a_bag_without_messages_is_written_and_read(tmp_path, storage):
    with Bag(write_bag(tmp_path / 'bag', [], storage=storage)) as bag:
        assert (bag.topics, bag.message_count) == (TYPES, 0)
        assert not list(bag.messages(TYPES))
        assert file_of(bag.path).name.startswith('bag_0.')


def test_the_topics_of_a_file_without_a_summary_are_sought_once(recorded, tmp_path, monkeypatch):
    """Its chunks overlap, so that all topics must be known before messages are read."""
    by_topic = sorted(recorded, key=lambda message: message[0])
    path = mcap_file(tmp_path / 'b.mcap', by_topic, finish=False)
    opened = []
    open_chunk = Mcap._chunk_records
    monkeypatch.setattr(Mcap, '_chunk_records', lambda *a: opened.append(a) or open_chunk(*a))
    with Bag(path) as bag:
        count = len(opened)
        assert count > 1
        for reading in (1, 2):
            assert len([*bag.messages(TYPES)]) == len(recorded)
            assert len(opened) == (1 + reading) * count


def test_a_file_without_a_summary_is_read_in_pieces_to_find_its_topics(recorded, tmp_path):
    without = ('use_statistics', 'use_summary_offsets', 'repeat_channels', 'repeat_schemas')
    options = dict.fromkeys((*without, 'use_chunking'), False)
    path = tmp_path / 'bag.mcap'
    mcap_file(path, recorded * 60, index_types=IndexType.NONE, **options)
    size = path.stat().st_size
    assert path.read_bytes()[-28:-20] == bytes(8)  # where the summary starts
    tracemalloc.start()
    bag = Bag(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert bag.topics == TYPES
    assert peak < size
