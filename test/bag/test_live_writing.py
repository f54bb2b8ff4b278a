"""Recordings that are written while they happen: readable whatever ends them."""

import subprocess
import sys

import mcap.reader
import pytest
import yaml
from rosbags import rosbag2
from shipped_bags import BAGS, TYPES, read_bag

from gear_kinematics.bag import Bag, BagError, LiveBagWriter

SERVO = BAGS / 'servo_point_to_point'

RECORD_AND_DIE = """
import os, sys
from gear_kinematics.bag import Bag, LiveBagWriter
with Bag(sys.argv[1]) as source, LiveBagWriter(sys.argv[2]) as bag:
    messages = [m for m in source.messages(list(source.topics))]
    for topic in source.topics:
        bag.add_topic(topic, source.type_of(topic))
    for start in range(0, 900, 30):
        bag.write_all(messages[start:start + 30])
        if start % 300 == 0:
            bag.flush()
    os.kill(os.getpid(), 9)
"""


@pytest.fixture(scope='module')
def recorded():
    return read_bag(SERVO)[:900]


def read(path):
    with Bag(path) as bag:
        return list(bag.messages(list(bag.topics)))


def write(bag, messages):
    for topic, kind in TYPES.items():
        bag.add_topic(topic, kind)
    bag.write_all(messages)


def test_what_was_flushed_is_read_after_the_process_was_killed(tmp_path, recorded):
    path = tmp_path / 'killed'
    command = [sys.executable, '-c', RECORD_AND_DIE, SERVO, path]
    assert subprocess.run(command, check=False).returncode == -9
    assert not (path / 'metadata.yaml').exists()
    assert read(path) == recorded[:630]


def test_finished_recording_is_one_to_others(tmp_path, recorded):
    path = tmp_path / 'live'
    with LiveBagWriter(path) as bag:
        write(bag, recorded[:500])
        bag.flush()
        bag.flush()  # nothing new
        bag.write_all(recorded[500:])
    assert read(path) == recorded
    assert sorted(file.name for file in path.iterdir()) == ['live_0.mcap', 'metadata.yaml']
    told = yaml.safe_load((path / 'metadata.yaml').read_text('utf-8'))
    told = told['rosbag2_bagfile_information']
    assert told['relative_file_paths'] == ['live_0.mcap']
    assert told['message_count'] == 900
    with rosbag2.Reader(path) as reader:
        assert [bytes(data) for _, _, data in reader.messages()] == [m[2] for m in recorded]
    with (path / 'live_0.mcap').open('rb') as file:
        summary = mcap.reader.make_reader(file).get_summary()
    assert summary.statistics.message_count == 900
    assert {channel.topic for channel in summary.channels.values()} == set(TYPES)


def test_recording_stays_after_an_error(tmp_path, recorded):
    path = tmp_path / 'live'
    bag = LiveBagWriter(path)
    bag.__enter__()
    write(bag, recorded)
    bag.flush()
    bag.__exit__(ZeroDivisionError, ZeroDivisionError(), None)
    assert read(path) == recorded


@pytest.mark.parametrize('kind', ['folder', 'file', 'broken link'])
def test_recording_replaces_nothing(tmp_path, kind):
    path = tmp_path / 'there'
    if kind == 'folder':
        path.mkdir()
    elif kind == 'file':
        path.write_text('mine')
    else:
        path.symlink_to(tmp_path / 'nowhere')
    with pytest.raises(BagError, match='there: exists already'), LiveBagWriter(path):
        pass
    assert list(tmp_path.iterdir()) == [path]


def test_full_disk_is_told(tmp_path, recorded, monkeypatch):
    with LiveBagWriter(tmp_path / 'live') as bag:
        write(bag, recorded)

        def full():
            raise OSError(28, 'No space left on device')

        monkeypatch.setattr(bag._writer, 'flush', full)
        with pytest.raises(BagError, match='live: No space left on device'):
            bag.flush()
