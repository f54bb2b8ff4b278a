# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How much gearkin prints: a line on what passed, less with --quiet, all with --verbose."""

import json

import pytest
from blocked_bags import BAGS, gearkin, refusal
from terminals import ENVIRONMENT, Terminal

from gear_kinematics.bag import Bag
from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.commands.cli import main

SINGLE_TURN = BAGS / 'single_turn_encoder'
CONFIG = BAGS.parent / 'config' / 'actuator.yaml'


def without_poses(path):
    with Bag(SINGLE_TURN) as bag, BagWriter(path) as writer:
        for topic in ('/rotor_state', '/output_state'):
            writer.copy_topic(bag, topic)
        writer.write_all(list(bag.messages(['/rotor_state', '/output_state'])))
    writer.path.joinpath('actuator.yaml').write_bytes((SINGLE_TURN / 'actuator.yaml').read_bytes())
    return path


def test_a_bag_is_a_line_in_a_pipe_if_it_passed_and_described_in_full_if_verbose(capsys):
    compared = f'{SINGLE_TURN}: /output_state: messages: 2500; compared: 2500;'
    assert main(['validate', str(SINGLE_TURN)]) == 0
    said = '2500 inputs, 5000 outputs compared, largest error 0 (tolerance 1e-9)'
    assert capsys.readouterr().out == f'{SINGLE_TURN}: verdict: passed; {said}\n'
    for words, verdict in (([], 'passed'), (['--config', str(CONFIG)], 'failed')):
        assert main(['validate', str(SINGLE_TURN), '-v', *words]) == (verdict == 'failed')
        out = capsys.readouterr().out
        assert out.startswith(f'{SINGLE_TURN}: verdict: {verdict}')
        # A wrap is no motion of a multi-turn encoder.
        assert compared in out or verdict == 'failed'


def test_quiet_shows_only_what_failed(tmp_path, capsys):
    report = tmp_path / 'report.json'
    assert main(['validate', '-q', str(SINGLE_TURN), '--json', str(report)]) == 0
    assert capsys.readouterr() == ('', '')
    assert json.loads(report.read_text())['verdict'] == 'pass'
    other = BAGS / 'driver_faults'
    words = ['validate', '-q', str(SINGLE_TURN), str(other), '--config', str(CONFIG)]
    assert main(words) == 1
    summary, *lines = capsys.readouterr().out.splitlines()
    assert summary == 'summary: 2 bags: 1 passed, 1 failed, 0 unusable'
    assert lines[0].startswith(f'{SINGLE_TURN}: verdict: failed: ')
    assert all(line.startswith(f'{SINGLE_TURN}: ') for line in lines)


@pytest.mark.parametrize(
    'command', [f'compute {BAGS}/driver_faults out', 'describe --json a.json']
)
def test_quiet_commands_do_their_work_and_print_nothing(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with Terminal() as shown, Terminal() as progress:
        done = gearkin(
            *command.split(), '-q', stdout=shown.other, stderr=progress.other, env=ENVIRONMENT
        )
        assert (shown.text(), progress.text()) == ('', '')
    assert done.returncode == 0
    assert len(list(tmp_path.iterdir())) == 1


def test_without_poses_the_output_alone_is_validated_and_that_is_said(tmp_path, capsys):
    path = without_poses(tmp_path / 'bag')
    assert main(['validate', str(path)]) == 0
    said = 'no poses are recorded: /output_state alone is compared'
    assert capsys.readouterr().out.endswith(f'; {said}\n')
    assert main(['validate', str(path), '--json', '-']) == 0
    (bag,) = json.loads(capsys.readouterr().out)['bags']
    assert [topic['topic'] for topic in bag['topics']] == ['/output_state']
    assert bag['topics'][0]['compared'] == 2500
    assert main(['validate', str(path), '--config', str(CONFIG)]) == 1
    assert said in capsys.readouterr().out
    error = refusal('validate', path, '--poses-topic', '/body_poses', report='.*')
    assert 'no topic /body_poses of type geometry_msgs/msg/PoseArray' in error
