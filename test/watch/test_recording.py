# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings of `gearkin watch` without ROS: what is counted as lost, and what ends them."""

import struct
import threading
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType, SimpleNamespace

import pytest
from blocked_bags import wait_until
from watching import Source

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.writing import LiveBagWriter
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.watch import recording, watcher
from gear_kinematics.watch.polled import Taken
from gear_kinematics.watch.recording import Recording
from gear_kinematics.watch.watcher import Watcher

JOINT_STATE = 'sensor_msgs/msg/JointState'


@pytest.fixture
def source(monkeypatch):
    monkeypatch.setattr(recording, 'PolledSubscription', Source)
    monkeypatch.setattr(Source, 'waiting', {'/a': [], '/b': []}, raising=False)
    return Source


def begin(path: Path, answers=MappingProxyType({})) -> Recording:
    ongoing = Recording(path)
    ongoing.add(None, dict.fromkeys(('/a', '/b'), JOINT_STATE), answers)
    return ongoing


def count(ongoing: Recording) -> int:
    return sum(ongoing.status().counts.values())


def put(source, topic, *numbers, received=100, stamps=()) -> None:
    """Put messages there, with their numbers and with stamps, s."""
    source.waiting[topic] = [
        Taken(struct.pack('<4xiI12x', stamp, 0), received + k, number)
        for k, (number, stamp) in enumerate(zip(numbers, stamps or range(1, 9), strict=False))
    ]


def test_messages_of_all_topics_are_written_in_the_order_of_their_reception(source, tmp_path):
    put(source, '/a', 7, 8, received=200)
    put(source, '/b', 3, 4, received=199)
    recorded = begin(tmp_path / 'bag').stop()
    assert recorded.counts == {'/a': 2, '/b': 2}
    assert str(recorded) == '4 messages, 0 lost'
    assert recorded.error == ''
    with Bag(tmp_path / 'bag') as bag:
        messages = [(topic, received) for topic, received, _ in bag.messages(['/a', '/b'])]
    assert sorted(messages, key=lambda m: m[1]) == messages
    assert messages[0] == ('/b', 199)
    assert messages[-1] == ('/a', 201)


@pytest.mark.parametrize(
    ('later', 'drivers', 'lost'),
    [((5, 6), 1, '2 lost'), ((5, 6), 2, '0 lost, not counted on /a'),
     ((None, 4), 1, '0 lost, not counted on /a')],
)  # fmt: skip
def test_losses_are_counted_over_all_rounds_unless_they_are_unknown(
    source, tmp_path, monkeypatch, later, drivers, lost
):
    ongoing = begin(tmp_path / 'bag')
    put(source, '/a', 1, 2)
    wait_until(lambda: count(ongoing) == 2, '2 messages')
    monkeypatch.setattr(source, 'drivers', drivers)
    put(source, '/a', *later)
    wait_until(lambda: count(ongoing) == 4, '4 messages')
    assert str(ongoing.stop()) == f'4 messages, {lost}'


def test_last_inputs_are_answered_before_a_recording_ends(source, tmp_path):
    ongoing = begin(tmp_path / 'bag', answers={'/b': '/a'})
    put(source, '/a', 1, 2)
    put(source, '/b', 1)
    wait_until(lambda: count(ongoing) == 3, '3 messages')
    stop = threading.Thread(target=ongoing.stop)
    stop.start()
    put(source, '/b', 2, stamps=[2])
    stop.join()
    assert ongoing.status().counts == {'/a': 2, '/b': 2}


def test_full_disk_ends_a_recording_and_what_was_written_stays(source, tmp_path, monkeypatch):
    path = tmp_path / 'bag'
    monkeypatch.setattr(recording, '_FLUSH_PERIOD', 0.0)
    ongoing = begin(path)
    put(source, '/a', 1, 2)
    file = path / 'bag_0.mcap'
    wait_until(lambda: count(ongoing) == 2 and file.stat().st_size > 500, '2 messages')

    def full(*_):
        raise BagError(f'{path}: No space left on device')

    monkeypatch.setattr(LiveBagWriter, 'write_all', full)
    put(source, '/a', 3)
    wait_until(lambda: ongoing.status().error, 'the error')
    recorded = ongoing.stop()
    assert recorded.error == f'{path}: No space left on device'
    assert not (path / 'metadata.yaml').exists()
    with Bag(path) as bag:
        assert len(list(bag.messages(['/a']))) == 2


def test_topic_that_appears_later_is_recorded_from_then_on(source, tmp_path):
    ongoing = begin(tmp_path / 'bag')
    put(source, '/a', 1)
    wait_until(lambda: count(ongoing) == 1, 'a message')
    source.waiting['/later'] = []
    ongoing.add(None, {'/later': 'diagnostic_msgs/msg/DiagnosticArray'}, {})
    put(source, '/later', 1, 2)
    assert ongoing.stop().counts == {'/a': 1, '/b': 0, '/later': 2}
    with Bag(tmp_path / 'bag') as bag:
        assert len(list(bag.messages(['/later']))) == 2


def test_topic_on_which_nothing_came_is_told(source, tmp_path):
    stopped = Watcher()
    stopped._gear = SimpleNamespace(heard=['/a', '/b'])
    stopped._recording = begin(tmp_path / 'bag')
    put(source, '/a', 1)
    assert stopped._stop().text == 'Recorded 1 messages, 0 lost; nothing came on /b:'


@pytest.mark.parametrize('broken', [Source, LiveBagWriter], ids=['take', 'write_all'])
@pytest.mark.usefixtures('source')
def test_fault_in_a_thread_ends_a_recording_with_its_cause(tmp_path, monkeypatch, broken):
    def fail(*_):
        raise OverflowError('too odd')

    ongoing = begin(tmp_path / 'bag')
    monkeypatch.setattr(broken, 'take' if broken is Source else 'write_all', fail)
    wait_until(lambda: ongoing.status().error, 'the error')
    assert ongoing.stop().error == 'OverflowError: too odd'


@pytest.mark.live
def test_watcher_goes_on_after_what_it_cannot_show(monkeypatch):
    def broken(*_):
        raise OverflowError('too odd')

    with Watcher() as going_on:
        monkeypatch.setattr(watcher, 'state_of', broken)
        wait_until(lambda: going_on.view.state == 'fault', 'the fault')
        assert going_on.view.message == 'What came cannot be shown: OverflowError: too odd'
        monkeypatch.undo()
        wait_until(lambda: going_on.view.state == 'no node', 'its end')


@pytest.mark.live
def test_watcher_tells_what_has_ended_it(monkeypatch):
    def broken(_):
        raise RuntimeError('the middleware is gone')

    monkeypatch.setattr(watcher.graph, 'gear_nodes', broken)
    ended = Watcher()
    with pytest.raises(RuntimeError, match='the middleware is gone'), ended:
        wait_until(lambda: ended.ended, 'the end')


def test_watcher_that_cannot_join_says_why(monkeypatch):
    def broken(_):
        raise RuntimeError('no shared memory')

    monkeypatch.setattr(watcher, 'replay_node', broken)
    with pytest.raises(RuntimeError, match='no shared memory'), Watcher():
        pass


@pytest.mark.parametrize('absolute', [True, False])
def test_parameters_of_the_node_are_kept_beside_the_data(tmp_path, absolute):
    given = NodeParameters.load()
    calibration = str(tmp_path / 'gear.yaml') if absolute else 'gear.yaml'
    told = replace(given, ring_teeth=61, satellite_teeth=58, calibration=calibration)
    note = watcher._keep_parameters(replace(told, home_file='home.yaml'), tmp_path)
    kept = NodeParameters.load(tmp_path / 'actuator.yaml')
    assert kept == replace(told, calibration=calibration if absolute else '')
    words = ' Give its calibration to gearkin validate: gear.yaml.'
    assert note == ('' if absolute else words)
