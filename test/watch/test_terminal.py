# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin watch` and `gearkin init` in a terminal and in a pipe, beside a driver at 1 kHz."""

import contextlib
import re
from pathlib import Path

import pytest
from blocked_bags import wait_until
from terminals import Person
from watching import (
    DEADLINE,
    ENCODER,
    MOTOR,
    OTHER,
    assert_is_whole,
    driving,
    gearkin,
    node,
)

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.writing import LiveBagWriter
from gear_kinematics.watch.watcher import Answer, Watcher

pytestmark = pytest.mark.live


@pytest.fixture(scope='module', autouse=True)
def driver():
    with driving():
        yield


@pytest.fixture(scope='module')
def running(tmp_path_factory):
    with node(tmp_path_factory.mktemp('node'), OTHER):
        yield


@pytest.mark.usefixtures('running')
def test_table_in_a_terminal_homes_and_records_with_keys(tmp_path):
    with Person(tmp_path, 'watch', '--text', '--node', OTHER) as terminal:
        terminal.wait_for(f'gearkin watch {OTHER} connected')
        terminal.wait_for(r'output angle +-?\d+\.\d+° ')
        terminal.wait_for(r'rotor input +healthy')
        terminal.type('r')
        terminal.wait_for('● recording to gearkin_')
        terminal.type('h')
        terminal.wait_for('Stop the recording first')
        terminal.type('r')
        terminal.wait_for(r'Recorded \d+ messages, 0 lost')
        terminal.type('h')
        terminal.wait_for(r'The output is at -?\d+\.\d°\. Set it to 0\.0°\?   y yes   n no')
        terminal.type('ny')  # which no question precedes
        terminal.type('h')
        terminal.wait_for('y yes   n no')
        terminal.type('y')
        terminal.wait_for(r'the shaft was at -?\d+\.\d° and is now 0\.0° \(rotor_zero ')
        terminal.wait_for('u undo: rotor_zero 0 again')
        terminal.type('u')
        terminal.wait_for(r'Undone: rotor_zero 0 again\.')
        terminal.type('q')
        assert terminal.end() == 0


@pytest.mark.usefixtures('running')
def test_commands_that_cannot_be_done_are_answered_with_the_cause(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'there').mkdir()
    with Watcher(OTHER) as watcher:
        wait_until(lambda: watcher.view.state == 'connected' and watcher.view.drivers, 'a node')
        for asked, cause in (
            (watcher.stop(), 'Nothing is being recorded.'),
            (watcher.configure(MOTOR, 'm2'), f'There is no joint m2 on {MOTOR}.'),
            (watcher.record(Path('there')), 'there: exists already'),
        ):
            assert asked.result(DEADLINE) == Answer(cause, done=False)
        assert watcher.record(Path('full')).result(DEADLINE).done
        assert watcher.record().result(DEADLINE).text == 'full is being recorded.'

        def full(*_):
            raise BagError('full: No space left on device')

        monkeypatch.setattr(LiveBagWriter, 'write_all', full)
        words = wait_until(lambda: watcher.view.failure, 'a failure')
        assert words == 'The recording has ended: full: No space left on device'


def test_drivers_are_recorded_where_there_is_no_node(tmp_path):
    with Watcher('/nobody/gear_state_publisher') as watcher:
        wait_until(lambda: watcher.view.drivers, 'drivers')
        assert watcher.home().result(DEADLINE).text == 'There is no node.'
        path = tmp_path / 'drivers'
        assert watcher.record(path).result(DEADLINE).done
        wait_until(lambda: ', 1' in watcher.view.recording, 'messages')
    assert watcher.exit_message.endswith(f' 0 lost: gearkin validate {path}')
    with Bag(path) as bag:
        # The outputs of another node may be discovered before that node.
        beside = OTHER.rpartition('/')[0]
        assert {t for t in bag.topics if not t.startswith(beside)} <= {MOTOR, ENCODER}
        assert MOTOR in bag.topics


def test_init_lists_the_joints_and_asks_in_a_terminal(tmp_path):
    with Person(tmp_path, 'init', '--topic', MOTOR, '-o', 'mine.yaml') as terminal:
        terminal.wait_for(rf'{MOTOR} +brake, m1 +[1-9]\d+ Hz')
        choice = terminal.wait_for(rf'\d  m1 on {MOTOR}')
        terminal.wait_for('Number of the joint of the rotor: ')
        terminal.type(f'{choice[0]}\n')
        terminal.wait_for(f'mine.yaml is for the joint m1 on {MOTOR}')
        assert terminal.end() == 0
        assert "rotor_joint: 'm1'\n" in (tmp_path / 'mine.yaml').read_text('utf-8')


# The last, as a process that is killed leaves its part of the shared memory behind.
@pytest.mark.usefixtures('running')
def test_recordings_in_a_pipe_are_whole_also_after_the_process_was_killed(tmp_path):
    paths = {name: tmp_path / name for name in ('ended', 'killed')}
    with contextlib.ExitStack() as stack:
        programs = {}
        for name, path in paths.items():
            path.with_suffix('.folder').mkdir()
            arguments = ['watch', '--text', '--node', OTHER, '--record', str(path)]
            programs[name] = stack.enter_context(gearkin(path.with_suffix('.folder'), *arguments))
        for program in programs.values():
            program.wait_for(r'recording \S+: .* s, (?:[4-9]\d{3}|\d{5,}) messages, 0 lost')
        programs['killed'].process.kill()
        programs['ended'].process.terminate()
        assert programs['ended'].process.wait(DEADLINE) == 130
    text = programs['ended'].text()
    listed, *_ = text.splitlines()
    assert listed.startswith(f'{MOTOR}: joints: brake, m1; rate: ')
    assert re.search(
        rf'^[\d-]+T[\d:]+\S* {OTHER} connected \| output angle \S+° .*; rotor angle .*; '
        r'input \d+ Hz \(last message .* ago\); transmission error .* \| rotor input healthy',
        text,
        re.MULTILINE,
    )
    assert re.search(r'^Recorded \d+ messages, 0 lost: gearkin validate ', text, re.MULTILINE)
    assert not (paths['killed'] / 'metadata.yaml').exists()
    assert_is_whole(paths['ended'], least=600)
    assert_is_whole(paths['killed'], least=300)
