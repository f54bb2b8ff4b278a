# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bytes as bags: messages or a BagError, whatever they are, and little memory for few bytes.

An input is a file of a bag. One that begins like none is the metadata.yaml of a folder, in which
it stands beside a sound file.
"""

from pathlib import Path
from resource import RUSAGE_SELF, getrusage
from tempfile import TemporaryDirectory

from gear_kinematics.bag import Bag, BagError, DamagedBagError
from gear_kinematics.bag.storage import UnsortedError

_MAGICS = (
    *(b'\x89MCAP0\r\n', b'SQLite format 3\0', b'#ROSBAG V2.0'),
    *(b'\x28\xb5\x2f\xfd', b'\x04\x22\x4d\x18'),  # zstd, lz4
)
_SOUND = Path(__file__).resolve().parents[1] / 'test' / 'corpus' / 'bags' / 'sound.mcap'
_SOUND_MESSAGES = 3
_TOPIC, _OUTSIDE = '/rotor_state', '/out_of_here'  # of the sound file, and of one elsewhere
_MAX_MEMORY = 300_000  # kB


def check(data: bytes) -> None:
    """Read all that there is in a bag.

    Raises:
        AssertionError: if that is not what a reader may give, or took too much memory.
    """
    before = getrusage(RUSAGE_SELF).ru_maxrss
    with TemporaryDirectory() as folder:
        path = Path(folder, 'bag')
        if data.startswith(_MAGICS):
            path.write_bytes(data)
            _check_reading(path)
        else:
            sound = _SOUND.read_bytes()
            elsewhere = sound.replace(_TOPIC.encode(), _OUTSIDE.encode())
            path.mkdir()
            Path(path, 'metadata.yaml').write_bytes(data)
            Path(path, 'sound.mcap').write_bytes(sound)
            Path(folder, 'outside.mcap').write_bytes(elsewhere)
            assert _check_reading(path) <= _SOUND_MESSAGES
    assert getrusage(RUSAGE_SELF).ru_maxrss - before < _MAX_MEMORY


def _check_reading(path: Path) -> int:
    """Read a bag up to its end or its damage, and give the number of messages."""
    read, failure = 0, None
    try:
        with Bag(path) as bag:
            assert bag.message_count is None or 0 <= bag.message_count < 2**64
            for topic in bag.topics:
                bag.describe(topic)
            for topic, received, data in bag.messages({*bag.topics, _OUTSIDE}):
                assert topic in bag.topics.keys() - {_OUTSIDE}
                assert type(received) is int
                assert type(data) is bytes
                read += 1
    except BagError as error:
        failure = error
    if failure:
        # Messages that cannot be sorted make all of a recording unusable, also those before.
        usable = read > 0 and not isinstance(failure.__cause__, UnsortedError)
        assert isinstance(failure, DamagedBagError) == usable
        assert '\n' not in str(failure)
        assert str(path) in str(failure)
    return read
