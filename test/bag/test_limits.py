# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A crafted bag must not take more than 300 MB or 20 s beyond what its size explains.

Each bag goes through gearkin in a process of its own, whose processor time and peak of memory
are measured. Bags are put together byte by byte here; most expand to gigabytes.
"""

import json
import re
import struct
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
import zstandard
from blocked_bags import started
from gear_recordings import old_recording
from live import rotor_bytes
from rosbags import rosbag1
from shipped_bags import TYPES

pytestmark = pytest.mark.slow

JOINT_STATE = 'sensor_msgs/msg/JointState'
KB, MB = 10**3, 10**6
MAX_MEMORY = 300 * MB  # of it, the program itself takes 60
MAX_TIME = 20.0  # s
EXPANSION = 20  # recordings compress by as much

# Begun once, it begins each program as a copy of itself, which has imported what all of them need.
MEASURING = """
import json, os, re, resource, sys
from gear_kinematics.commands import compute, validate
from gear_kinematics.commands.cli import main
def measure(result, output, *arguments):
    for stream in (1, 2):
        os.dup2(os.open(output, os.O_WRONLY | os.O_CREAT | os.O_APPEND), stream)
    code = main(arguments)
    sys.stdout.flush()
    usage = resource.getrusage(resource.RUSAGE_SELF)
    with open('/proc/self/status') as status:
        memory = re.search(r'VmHWM:\\s*(\\d+) kB', status.read())[1]
    with open(result, 'w') as file:
        print(usage.ru_utime + usage.ru_stime, 1024 * int(memory), file=file)
    return code
for line in sys.stdin:
    if not os.fork():
        os._exit(measure(*json.loads(line)))
    print(os.waitstatus_to_exitcode(os.wait()[1]), flush=True)
"""


class Measured(NamedTuple):
    """A program that has ended."""

    code: int
    text: str
    """stdout and stderr."""
    seconds: float
    """Time of the processor."""
    memory: int
    """Its peak, bytes."""


@pytest.fixture(scope='module')
def measure() -> Iterator[Callable[..., Measured]]:
    """Run gearkin as a process of its own, given a folder and the arguments."""
    pipes = {'stdin': subprocess.PIPE, 'stdout': subprocess.PIPE}
    with started([sys.executable, '-c', MEASURING], **pipes) as process:

        def measure(folder: Path, *arguments: object) -> Measured:
            result, output = folder / 'measured', folder / 'output'
            words = json.dumps([*map(str, (result, output, *arguments))])
            print(words, file=process.stdin, flush=True)
            code = int(process.stdout.readline())
            said = output.read_text('utf-8')
            output.unlink()
            assert result.exists(), said
            seconds, memory = result.read_text().split()
            return Measured(code, said, float(seconds), int(memory))

        yield measure


# mcap, by its specification.


def text(content: bytes | str) -> bytes:
    data = content if isinstance(content, bytes) else content.encode()
    return struct.pack('<I', len(data)) + data


def record(opcode: int, *parts: bytes) -> bytes:
    body = b''.join(parts)
    return struct.pack('<BQ', opcode, len(body)) + body


def schema(number: int, kind: str, definition: bytes | str = '') -> bytes:
    return record(3, struct.pack('<H', number), text(kind), text('ros2msg'), text(definition))


def channel(number: int, kind: int, topic: str, metadata: bytes = b'') -> bytes:
    return record(4, struct.pack('<HH', number, kind), text(topic), text('cdr'), text(metadata))


def message(number: int, received: int, data: bytes) -> bytes:
    return record(5, struct.pack('<HIQQ', number, 0, received, received), data)


def chunk(*pieces: bytes | tuple[bytes, int]) -> bytes:
    """Make a chunk of records and of records that are repeated."""
    size, compressor, packed = 0, zstandard.ZstdCompressor().compressobj(), []
    for piece in pieces:
        unit, count = piece if isinstance(piece, tuple) else (piece, 1)
        block = max(1, MB // len(unit))
        size += count * len(unit)
        packed += [compressor.compress(block * unit) for _ in range(count // block)]
        packed.append(compressor.compress(count % block * unit))
    packed.append(compressor.flush())
    data = b''.join(packed)
    start = struct.pack('<QQQI', 1, 2, size, 0)
    return record(6, start, text('zstd'), struct.pack('<Q', len(data)), data)


def zeros(size: int) -> tuple[bytes, tuple[bytes, int]]:
    """A message of `size` bytes on /rotor_state, as pieces of a chunk."""
    head = struct.pack('<BQHIQQ', 5, 22 + size, 1, 0, 1, 1)
    return head, (b'\0', size)


TOPICS = b''.join((
    schema(1, JOINT_STATE),
    channel(1, 1, '/rotor_state'),
    channel(2, 1, '/output_state'),
    schema(2, 'geometry_msgs/msg/PoseArray'),
    channel(3, 2, '/body_poses'),
))  # fmt: skip
STATES = b''.join(message(1, k, rotor_bytes(k, ['rotor'], [0.1])) for k in range(1, 4))
MAGIC = b'\x89MCAP0\r\n'


def mcap(path: Path, *records: bytes) -> Path:
    with path.open('wb') as file:
        file.writelines((MAGIC, record(1, text('ros2'), text('')), TOPICS, *records))
        file.writelines((record(15, bytes(4)), record(2, bytes(20)), MAGIC))
    return path


def compressed(path: Path) -> Path:
    packed = path.with_name(f'{path.name}.zstd')
    packed.write_bytes(zstandard.compress(path.read_bytes()))
    path.unlink()
    return packed


def wide_mcap(path: Path, topics: int) -> Path:
    """Write topics, of which an mcap file can have 65 535."""
    topics = (channel(number, 1, f'/{number}/rotor_state') for number in range(4, 1 + topics))
    return mcap(path, *topics, STATES)


def folder(path: Path, files: dict[str, bytes | str]) -> Path:
    path.mkdir()
    for name, content in files.items():
        data = content if isinstance(content, bytes) else content.encode()
        (path / name).write_bytes(data)
    return path


def metadata(path: Path, topics: Iterable[str] = (), files: Iterable[str] = ('a.mcap',)) -> Path:
    listed = ''.join(
        f'    - topic_metadata:\n        name: {topic}\n        type: {JOINT_STATE}\n'
        "        serialization_format: cdr\n        offered_qos_profiles: ''\n"
        '      message_count: 1\n'
        for topic in topics
    )
    return folder(path, {
        'metadata.yaml': 'rosbag2_bagfile_information:\n  message_count: 1\n'
        f'  topics_with_message_count:\n{listed}  relative_file_paths: [{",".join(files)}]\n'
    })  # fmt: skip


# sqlite.


def database(path: Path, topics: Iterable[str], messages: Iterable[bytes]) -> Path:
    """Write further topics, and messages on /rotor_state."""
    types = [*TYPES.items(), *((topic, JOINT_STATE) for topic in topics)]
    return old_recording(path, types, (('/rotor_state', 9, data) for data in messages))


# ROS 1.


def ros1_chunks_in_turns(path: Path) -> Path:
    """Make two chunks of 30 MB whose messages alternate."""
    writer = rosbag1.Writer(path)
    writer.set_compression(rosbag1.Writer.CompressionFormat.LZ4)
    writer.chunk_threshold = 30 * MB
    with writer:
        rotor, *_ = (
            writer.add_connection(topic, kind, msgdef='uint8[10000] a\n', md5sum='0')
            for topic, kind in TYPES.items()
        )
        for received in (*range(0, 6000, 2), *range(1, 6000, 2)):
            writer.write(rotor, received, zeros_of_ros1())
    return path


def zeros_of_ros1() -> bytes:
    """A JointState with 9984 bytes of its frame."""
    return bytes(12) + struct.pack('<I', 9968) + bytes(9968 + 16)


Maker = Callable[[Path], Path]
EXPANDS = 'compressed data expand to more than a bag of this size can hold'
DESCRIBED = 'the descriptions of its topics exceed'
BAGS: dict[str, tuple[str, Maker]] = {
    'chunks of 32 MiB': (EXPANDS, lambda p: mcap(p, 300 * chunk(*zeros(2**25 - 31)))),
    'definitions of 16 MB': (
        DESCRIBED,
        lambda p: mcap(p, *(chunk(schema(k, 'a/msg/A', bytes(16 * MB))) for k in range(3, 9))),
    ),
    'a compressed file of compressed chunks': (
        EXPANDS,
        lambda p: compressed(mcap(p, 300 * chunk((record(0x80, bytes(MB)), 33)))),
    ),
    '65 535 topics': ('no outputs in it', lambda p: wide_mcap(p, 65_535)),
    '5000 topics': ('no outputs in it|more than 4000 topics', lambda p: wide_mcap(p, 5000)),
    'metadata of 100 000 topics': (
        'metadata.yaml: longer than 4194304 bytes',
        lambda p: metadata(p, (f'/{number}' for number in range(100_000))),
    ),
    'messages of 1 GiB': (
        'a compressed message is cut off or too large',
        lambda p: database(p, [], 60 * [zstandard.compress(bytes(2**30))]),
    ),
    '300 000 topics in a database': (
        DESCRIBED,
        lambda p: database(p, (f'/{k}/rotor_state' for k in range(300_000)), ()),
    ),
    'ROS 1 chunks that take turns': (EXPANDS, ros1_chunks_in_turns),
}


@pytest.fixture(scope='module')
def crafted(tmp_path_factory) -> Callable[[str], Path]:
    """Make a bag at its first use."""
    return cache(lambda name: BAGS[name][1](tmp_path_factory.mktemp('bag') / 'b'))


def size_of(path: Path) -> int:
    files = path.iterdir() if path.is_dir() else [path]
    return sum(file.stat().st_size for file in files)


WRITTEN = '5000 topics', 'messages of 1 GiB'
"""Bags for which `compute` may write more than `validate` does, or which it refuses by itself."""


@pytest.mark.parametrize(
    ('name', 'command'),
    [*((name, 'validate') for name in BAGS), *((name, 'compute') for name in WRITTEN)],
)
def test_a_crafted_bag_is_refused_before_it_takes_much(crafted, measure, name, command, tmp_path):
    bag, cause = crafted(name), BAGS[name][0]
    out = [tmp_path / 'out'] if command == 'compute' else []
    measured = measure(tmp_path, command, bag, *out)
    assert measured.code == 2
    assert re.search(cause, measured.text.replace('\n', ' ')), measured.text
    assert max(map(len, measured.text.splitlines())) < KB
    assert measured.memory <= MAX_MEMORY + EXPANSION * size_of(bag)
    assert measured.seconds <= MAX_TIME
    assert {path.name for path in tmp_path.iterdir()} == {'measured'}
