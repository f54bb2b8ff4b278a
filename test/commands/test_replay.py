# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin replay as a user runs it."""

import re

import pytest
from arm_recordings import RATIOS, config
from blocked_bags import gearkin, refusal
from live import rotor_bytes
from shipped_bags import JOINT_STATE, write_bag

from gear_kinematics.commands.cli import main
from gear_kinematics.ros.replay import Played

SAMPLES = 300


@pytest.mark.live
@pytest.mark.slow
def test_a_replay_tells_what_it_did(bags):
    done = gearkin('replay', bags / 'good', '--no-wait', '--rate', 10)
    assert (done.returncode, done.stderr) == (0, '')
    assert re.fullmatch(rf'{SAMPLES} messages, at most [\d.]+ ms late\n', done.stdout)


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['missing.mcap'], 'missing.mcap: no such file or folder'),
        (['garbage.mcap'], 'garbage.mcap: not a bag of a known kind'),
        (['good', '--rate', '0'], '--rate: must be between 0.001 and 1000, not 0'),
        (['good', '--as', '/x y'], 'Invalid topic name'),
    ],
)
def test_a_replay_that_cannot_be_done_gets_one_line_and_code_2(
    arguments, cause, bags, monkeypatch
):
    monkeypatch.chdir(bags)
    assert cause in refusal('replay', '--no-wait', *arguments)


@pytest.mark.parametrize(('options', 'hint'), [
    ([], 'rotor_state, or end this and give its topic with --as'), (['--as', 'x'], 'x'),
])  # fmt: skip
def test_a_topic_is_asked_for_only_where_none_is_given(options, hint, bags, monkeypatch, capsys):
    monkeypatch.setattr('gear_kinematics.ros.replay.play', lambda *_, **__: Played())
    assert main(['replay', str(bags / 'good'), *options]) == 0
    assert capsys.readouterr() == ('0 messages\n', f'waiting for a subscriber on {hint}\n')


def test_the_file_of_an_arm_finds_the_topic_of_its_rotors(tmp_path, monkeypatch):
    states = {'/arm/motors': ['shoulder', 'elbow'], '/hand/motors': ['thumb', 'finger']}
    messages = [(topic, 1, rotor_bytes(1, names, [0.0, 0.0])) for topic, names in states.items()]
    bag = write_bag(tmp_path / 'bag', messages, dict.fromkeys(states, JOINT_STATE))
    arguments = ['replay', str(bag), '--no-wait']
    played = []

    def play(_bag, topic, *_, **__):
        played.append(topic)
        return Played()

    monkeypatch.setattr('gear_kinematics.ros.replay.play', play)
    assert main(arguments) == 2  # either topic
    assert main([*arguments, '--config', str(config(tmp_path / 'arm.yaml'))]) == 0
    config(bag / 'actuator.yaml')
    assert main(arguments) == 0
    assert played == 2 * ['/arm/motors']
    # The file beside the recording only chooses among the topics.
    assert main([*arguments, '--rotor-topic', '/hand/motors']) == 0
    other = config(
        tmp_path / 'other.yaml', **{f'{name}.rotor_joint': name.upper() for name in RATIOS}
    )
    wrong = '--config', str(other), '--rotor-topic', '/arm/motors'
    assert main([*arguments, *wrong]) == 2
