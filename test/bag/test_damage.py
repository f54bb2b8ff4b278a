# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Damaged bags are read up to the damage, which is named with its place."""

import random
import re
import struct
from functools import partial
from pathlib import Path

import lz4.frame
import pytest
import zstandard
from harnesses import harness
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_bags import (
    chunks,
    database,
    edited,
    file_of,
    folder,
    mcap_file,
    read,
    record_ends,
    ros1_bag,
    single_file,
    split,
)
from mcap.writer import CompressionType, Writer
from shipped_bags import BAGS, TYPES

from gear_kinematics.bag import Bag, BagError, DamagedBagError, Message
from gear_kinematics.bag.codecs import ReadLimits

CORPUS = BAGS.parent / 'test' / 'corpus' / 'bags'


CUT_OFF = 'cut off within a record; mcap recover saves what is before it'


def read_up_to_damage(path: Path) -> tuple[list[Message], BagError | None]:
    """Return the messages, and the error that ended reading, after checking its type."""
    messages: list[Message] = []
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


def noise(seed: int, size: int) -> bytes:
    return random.Random(seed).randbytes(size)  # noqa: S311, no cryptography


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
def test_a_cut_mcap_gives_every_whole_record_before_the_cut(recorded, tmp_path, use_chunking):
    form = {'use_chunking': use_chunking, 'compression': CompressionType.NONE}
    original = mcap_file(tmp_path / 'whole.mcap', recorded, **form)
    data, ends = original.read_bytes(), offsets_of_messages(original)
    assert len(ends) == len(recorded)
    boundaries = record_ends(original)
    clean = 0
    sizes = [*range(0, boundaries[-1], 9973), *ends[::200], *boundaries[::200]]
    for size in sizes + [size - 1 for size in sizes[1:]]:
        path = tmp_path / 'cut.mcap'
        path.write_bytes(data[:size])
        messages, error = read_up_to_damage(path)
        whole = max((boundary for boundary in boundaries if boundary <= size), default=0)
        assert messages == recorded[: sum(end <= whole for end in ends)]
        # An unfinished file may end between records.
        assert (error is None) == (size in boundaries)
        clean += error is None
        if messages and error:
            assert str(error) == f'{path}: at byte {whole}: {CUT_OFF}'
    assert clean > 0


def test_a_cut_compressed_file_is_read_up_to_the_cut(recorded, tmp_path):
    random_data = [(t, n, data + noise(n, 400)) for t, n, data in recorded]
    path = mcap_file(tmp_path / 'b.mcap', random_data)
    data = zstandard.compress(path.read_bytes())
    for share in (0.6, 0.999):
        path.write_bytes(data[: int(share * len(data))])
        messages, error = read_up_to_damage(path)
        assert messages == random_data[: len(messages)]
        assert len(messages) > 0.9 * share * len(recorded) - 128 * 1024 / 500
        assert 'ended before' in str(error)


@pytest.mark.parametrize('compress', [zstandard.compress, lz4.frame.compress])
def test_a_compressed_file_that_ends_between_records_is_damaged(recorded, tmp_path, compress):
    path = mcap_file(tmp_path / 'b.mcap', recorded, finish=False)
    path.write_bytes(compress(path.read_bytes()) + compress(b'more')[:-2])
    messages, error = read_up_to_damage(path)
    assert messages == recorded
    assert 'ended before' in str(error)


def test_a_cut_sqlite_file_is_read_up_to_the_cut(recorded, tmp_path):
    """Within a page, sqlite would pad messages with zeros."""
    path = single_file(tmp_path / 'bag', recorded, 'sqlite3')
    data = path.read_bytes()
    for share in (0.5, 0.83):
        size = int(share * len(data)) // 4096 * 4096
        path.write_bytes(data[:size])
        messages, error = read_up_to_damage(path)
        assert messages == recorded[: len(messages)]
        assert len(messages) > 0.8 * share * len(recorded)
        malformed = 'database disk image is malformed'
        assert str(error) == f'{path}: after message {len(messages)}: {malformed}'
    path.write_bytes(data[: size - 100])
    messages, error = read_up_to_damage(path)
    assert not messages
    assert str(error) == f'{path}: cut off within a page'


def test_a_damaged_chunk_is_located(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded)
    index = chunks(path)[5]
    edited(path, index.chunk_start_offset + index.chunk_length // 2, bytes(20))
    messages, error = read_up_to_damage(path)
    assert messages == [m for m in recorded if m[1] < index.message_start_time]
    assert len(messages) > len(recorded) // 4
    assert str(error).startswith(f'{path}: at byte {index.chunk_start_offset}: ')


def test_a_checksum_that_does_not_match_is_damage(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded, compression=CompressionType.NONE)
    last = chunks(path)[-1]
    end = last.chunk_start_offset + last.chunk_length
    edited(path, end - 1, bytes([path.read_bytes()[end - 1] ^ 1]))
    messages, error = read_up_to_damage(path)
    assert messages == [m for m in recorded if m[1] < last.message_start_time]
    assert f'at byte {last.chunk_start_offset}: a chunk does not match its checksum' in str(error)


@pytest.mark.parametrize('loss', ['missing', 'cut'])
def test_a_lost_file_of_a_split_bag_ends_it_there(recorded, tmp_path, loss):
    path = split(tmp_path / 'bag', recorded, 'mcap', parts=3)
    lost = path / 'bag_1.mcap'
    if loss == 'missing':
        lost.unlink()
    else:
        lost.write_bytes(lost.read_bytes()[:20_000])
    messages, error = read_up_to_damage(lost.parent)
    assert messages == recorded[: len(recorded) // 3]
    assert str(error).startswith(f'{lost}: ')


def test_a_record_that_is_too_large_is_not_loaded(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr(ReadLimits, 'max_record', 2000)
    large = (*recorded[-1][:2], bytes(2000))
    path = mcap_file(tmp_path / 'b.mcap', [*recorded[:-1], large], use_chunking=False)
    messages, error = read_up_to_damage(path)
    assert messages == recorded[:-1]
    place = record_ends(path)[-2]
    assert str(error) == f'{path}: at byte {place}: a record of 2022 bytes is too large'


def test_zeros_at_the_end_after_a_power_failure_are_damage(recorded, tmp_path):
    path = mcap_file(tmp_path / 'b.mcap', recorded, finish=False)
    end = path.stat().st_size
    edited(path, end, bytes(900))
    messages, error = read_up_to_damage(path)
    assert messages == recorded
    assert str(error) == f'{path}: at byte {end}: there is no record'


@pytest.mark.parametrize('received', [2**63, 2**64 - 1])
def test_a_time_out_of_range_of_ros_is_damage(tmp_path, received):
    times = (1, 2**63 - 1, received)
    path = mcap_file(tmp_path / 'b.mcap', [('/rotor_state', time, b'data') for time in times])
    messages, error = read_up_to_damage(path)
    assert [message[1] for message in messages] == [1, 2**63 - 1]
    assert 'a time of reception is out of range' in str(error)


@pytest.mark.parametrize('change', ["data = 'text'", 'data = 5', "timestamp = X'FF'"])
def test_a_row_of_another_type_is_damage(recorded, tmp_path, change):
    path = single_file(tmp_path / 'bag', recorded, 'sqlite3')
    database(path, f'UPDATE messages SET {change} WHERE id = 500')  # noqa: S608, from above
    messages, error = read_up_to_damage(path)
    others = [message for message in recorded if message is not recorded[499]]
    assert messages == (others if 'timestamp' in change else recorded[:499])
    cause = f'after message {len(messages)}: a message without a time or data'
    assert str(error) == f'{path}: {cause}'


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
    places = [found.start() for found in re.finditer(text, path.read_bytes())]
    edited(path, places[40] + offset, b'\xff' * 4)
    messages, error = read_up_to_damage(path)
    assert messages == recorded[: len(messages)]
    assert sum(message[0] == topic for message in messages) == 40
    assert f'after message {len(messages)}: ' in str(error)


# What cannot be read at all. Each maker is given a new path and the messages.


def content(path: Path, _, data: bytes) -> Path:
    path.write_bytes(data)
    return path


def metadata(path: Path, _, data: str | bytes) -> Path:
    path.mkdir()
    (path / 'metadata.yaml').write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def two_recordings(path: Path, messages: list[Message]) -> Path:
    path.mkdir()
    for name in ('a', 'b'):
        mcap_file(path / f'{name}_0.mcap', messages)
    return path


def cut_folder(path: Path, messages: list[Message], storage: str, size: int) -> Path:
    file = single_file(path, messages, storage)
    file.write_bytes(file.read_bytes()[:size])
    return file


def claiming_chunk(path: Path, messages: list[Message], claim: int) -> Path:
    mcap_file(path, messages)
    return edited(path, chunks(path)[0].chunk_start_offset + 9 + 16, struct.pack('<Q', claim))


def unknown_compression(path: Path, messages: list[Message]) -> Path:
    data = mcap_file(path, messages).read_bytes()
    return content(path, messages, data.replace(b'zstd', b'zstx'))


def without_index(path: Path, messages: list[Message]) -> Path:
    data = ros1_bag(path, messages).read_bytes()
    return edited(path, data.index(b'index_pos=') + len(b'index_pos='), bytes(8))


def mcap_of_ros1(path: Path, messages: list[Message]) -> Path:
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros1')
        schema = writer.register_schema('sensor_msgs/JointState', 'ros1msg', b'')
        channel = writer.register_channel('/rotor_state', 'ros1', schema)
        writer.add_message(channel, messages[0][1], messages[0][2], messages[0][1])
        writer.finish()
    return path


NO_CDR = (('/json', 'T', 'json', '', b''),)
NOT_A_BAG = 'not a bag of a known kind'
UNREADABLE = {
    'nothing there': ('no such file or folder', lambda path, _: path),
    'empty file': ('the file is empty', partial(content, data=b'')),
    'empty folder': ('neither metadata.yaml nor', lambda path, _: path.mkdir() or path),
    'two recordings': ('several recordings', two_recordings),
    'text': (NOT_A_BAG, partial(content, data=b'hello ' * 100)),
    'a pointer of Git LFS': (
        'only a pointer of Git LFS',
        partial(content, data=b'version https://git-lfs.github.com/spec/v1\n'),
    ),
    'an old ROS 1 bag': (NOT_A_BAG, partial(content, data=b'#ROSBAG V1.2\n' + bytes(100))),
    'a ROS 1 bag without its index': ('not indexed', without_index),
    'another database': (
        'no such table: topics',
        lambda path, _: database(path, 'CREATE TABLE t(a); INSERT INTO t VALUES (1);'),
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
        partial(cut_folder, storage='mcap', size=40),
    ),
    'metadata is no YAML': ('metadata.yaml: ', partial(metadata, data='{a: [')),
    'metadata is nested without end': (
        'nested deeper than 20 levels|maximum nesting depth',  # ours, or that of PyYAML 6.0.4
        partial(metadata, data=10**6 * '['),
    ),
    'no files': ('no files are listed', partial(folder, relative_file_paths=[])),
    'a file outside': (
        r"'\.\./other\.mcap' leads outside",
        partial(folder, relative_file_paths=['../other.mcap']),
    ),
    'a file twice': (
        'listed more than once',
        partial(folder, relative_file_paths=['b.mcap', './b.mcap']),
    ),
    'a file that is missing': (
        r'other\.mcap: No such file or directory; metadata.yaml lists it',
        partial(folder, relative_file_paths=['other.mcap']),
    ),
    'unknown compression of messages': (
        "unsupported compression 'xz'",
        partial(folder, compression_mode='MESSAGE', compression_format='xz'),
    ),
    'unknown compression of chunks': ("unsupported compression 'zstx'", unknown_compression),
    'chunk that claims too much': (
        r'at byte \d+: a chunk of 1099511627776 bytes is too large',
        partial(claiming_chunk, claim=2**40),
    ),
    'chunk that claims too little': (
        'does not have the size that it states',
        partial(claiming_chunk, claim=100),
    ),
    'file that grows': (
        r'b: it expands to more than 3\d{7} bytes',
        partial(content, data=zstandard.compress(bytes(2**27))),
    ),
    'mcap of ROS 1': ('it holds messages of ROS 1; give the .bag', mcap_of_ros1),
    'no CDR': ("messages on /json are 'json', not CDR", partial(mcap_file, others=NO_CDR)),
}


@pytest.mark.parametrize('kind', UNREADABLE)
def test_what_cannot_be_read_is_named_with_its_cause(kind, recorded, tmp_path):
    cause, make = UNREADABLE[kind]
    path = make(tmp_path / 'b', recorded)
    with pytest.raises(BagError, match=cause) as raised:
        read(path, [*TYPES, '/json'])
    assert not isinstance(raised.value, DamagedBagError)
    assert '\n' not in str(raised.value)
    assert str(path) in str(raised.value)


# Random bytes.


def listing(path: Path, messages: list[Message]) -> bytes:
    return (
        folder(path, messages, relative_file_paths=['sound.mcap']) / 'metadata.yaml'
    ).read_bytes()


FUZZED = {
    'mcap': folder,
    'mcap of chunks': partial(folder, mode='storage'),
    'mcap of lz4': partial(mcap_file, chunk_size=2000, compression=CompressionType.LZ4),
    'mcap without chunks': partial(mcap_file, use_chunking=False),
    'sqlite3': partial(folder, storage='sqlite3'),
    'sqlite3 of messages': partial(folder, storage='sqlite3', mode='message'),
    'file': partial(folder, mode='file'),
    'ROS 1': partial(ros1_bag, compression='LZ4'),
    'metadata': listing,
}


@pytest.fixture(scope='module', params=FUZZED)
def fuzzed(request, recorded, tmp_path_factory) -> bytes:
    made = FUZZED[request.param](tmp_path_factory.mktemp('fuzz') / 'bag', recorded[:60])
    if isinstance(made, bytes):
        return made
    return (made if made.is_file() else file_of(made)).read_bytes()


@pytest.mark.slow
@settings(
    max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None
)
@given(draw=st.data())
def test_no_bytes_on_disk_raise_anything_else(fuzzed, draw):
    data = bytearray(fuzzed)
    for _ in range(draw.draw(st.integers(0, 3))):
        place = draw.draw(st.integers(0, len(data) - 1))
        width = draw.draw(st.integers(1, 8))
        data[place : place + width] = draw.draw(st.binary(min_size=width, max_size=width))
    if draw.draw(st.booleans()):
        del data[draw.draw(st.integers(0, len(data))) :]
    harness('bags').check(bytes(data))
