# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin watch` and `gearkin init` in a terminal and in a pipe, beside a driver."""

import re
from types import SimpleNamespace

import pytest
from blocked_bags import refusal, wait_until
from terminals import Person
from watching import DEADLINE, MOTOR, NODE, OTHER, gearkin, node

from gear_kinematics.commands.cli import main
from gear_kinematics.watch import homing

pytestmark = [pytest.mark.live, pytest.mark.usefixtures('driver')]


@pytest.fixture(scope='module')
def running(tmp_path_factory):
    with node(tmp_path_factory.mktemp('node'), OTHER):
        yield


@pytest.mark.usefixtures('running')
def test_table_in_a_terminal_homes_with_keys(tmp_path):
    with Person(tmp_path, 'watch', '--text', '--node', OTHER) as terminal:
        terminal.wait_for(f'{OTHER} +connected')
        terminal.wait_for(r'output angle +-?\d+\.\d+° ')
        terminal.wait_for(r'rotor input +healthy')
        # Keys ask for nothing while outputs are old, as they are now and then on a busy machine.
        question = r'The output is at -?\d+\.\d°\. Set it to 0\.0°\?   y yes   n no'
        terminal.wait_for(question, keys='h')
        terminal.type('ny')  # which no question precedes
        terminal.wait_for(r'the shaft was at -?\d+\.\d° and is now at 0\.0° ', keys='hy')
        terminal.wait_for(r'u undo: back to rotor_zero \S+')
        terminal.wait_for(r'Undone: back to rotor_zero \S+\.', keys='u')
        terminal.type('q')
        assert terminal.end() == 0


@pytest.mark.usefixtures('running')
def test_home_says_where_the_shaft_was_and_is(capsys):
    wait_until(lambda: main(['home', '--node', OTHER]) == 0, 'a node that does not refuse')
    moved = rf'^{OTHER}: the shaft was at -?\d+\.\d° and is now at 0\.0° \(rotor_zero '
    assert re.search(moved, capsys.readouterr().out, re.MULTILINE)
    service = f'there is no service {OTHER}/elbow/home, as it has one gear: leave --actuator out'
    assert service in refusal('home', '--node', OTHER, '--actuator', 'elbow')


@pytest.mark.parametrize(('gears', 'wanted', 'error'), [
    ([], '', 'no gear_state_publisher is running with this ROS_DOMAIN_ID'),
    (['/a/gear', '/b/gear'], '', 'which node is to be homed? Repeat with --node: /a/gear, /b/g'),
    (['/a/gear'], 'a/gaer', '/a/gaer is not running; did you mean `/a/gear`?'),
])  # fmt: skip
def test_home_needs_to_know_the_node(gears, wanted, error, monkeypatch):
    monkeypatch.setattr(homing, '_SEARCH', 0.2)
    monkeypatch.setattr(homing, 'Graph', lambda _: SimpleNamespace(gears=gears))
    assert refusal('home', '--node', wanted).startswith(error)


@pytest.mark.usefixtures('running')
def test_key_shows_the_next_node_and_a_mistyped_one_is_corrected(tmp_path):
    with (
        node(tmp_path, NODE),
        Person(tmp_path, 'watch', '--text', '--node', f'{OTHER}s') as terminal,
    ):
        terminal.wait_for(r'did\s+you\s+mean')
        terminal.wait_for('n next node')
        for name in (NODE, OTHER):
            terminal.wait_for(f'{name} +connected', keys='n')
        terminal.type('\4')  # Ctrl-D
        assert terminal.end() == 0


def test_terminal_lists_drivers_and_refuses_to_home_without_a_node(tmp_path):
    with Person(tmp_path, 'watch', '--text', '--node', '/nobody') as terminal:
        terminal.wait_for('/nobody is not running')
        terminal.wait_for(rf'{MOTOR} +brake, m1 +[1-9]\d+ Hz')
        terminal.type('h')
        terminal.wait_for('No node is ready')
        terminal.interrupt()
        assert terminal.end() == 130


@pytest.mark.usefixtures('running')
def test_lines_in_a_pipe_say_what_there_is(tmp_path):
    with gearkin(tmp_path, 'watch', '--text', '--node', OTHER) as program:
        program.wait_for(
            rf'[\d-]+T[\d:]+\S* {OTHER} connected; output angle \S+° .*; rotor angle .*; '
            r'output rate \d+ Hz; .*; transmission error .*; rotor input healthy'
        )
        program.process.terminate()
        assert program.process.wait(DEADLINE) == 130


def test_init_lists_the_joints_and_asks_in_a_terminal(tmp_path):
    with Person(tmp_path, 'init', '--topic', MOTOR, '-o', 'mine.yaml') as terminal:
        terminal.wait_for('starting ROS')  # before all that takes seconds on a busy computer
        terminal.wait_for(rf'{MOTOR}: brake, m1 at [1-9]\d+ Hz')
        choice = terminal.wait_for(rf'\d  m1 on {MOTOR}')
        terminal.wait_for('Number of the joint of the rotor; gearkin init --arm sets up all: ')
        terminal.type(f'{choice[0]}\n')
        terminal.wait_for('ratio of the gear, .*: ')
        terminal.type('50.5\n')
        terminal.wait_for(f'mine.yaml is for the joint m1 on {MOTOR}, with the gear ratio 101/2')
        assert terminal.end() == 0
        assert "gear_ratio: '101/2'\n" in (tmp_path / 'mine.yaml').read_text('utf-8')
