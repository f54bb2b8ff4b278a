# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Parameter files for a driver: what the node reads in them, and what is never replaced."""

import re
import shlex
import sys
from dataclasses import replace

import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.parameters import ConfigError, NodeParameters, default_config
from gear_kinematics.parameters.files import write_config
from gear_kinematics.parameters.new_config import new_config, start_command

HALF = GearRatio.parse('-50.5')


@pytest.mark.parametrize(
    ('gear', 'values'),
    [
        ([HALF], {'gear_ratio': '-101/2'}),
        ([GearRatio(-10), (11, 10)], {'ring_teeth': 11, 'satellite_teeth': 10}),
    ],
)
def test_file_is_the_default_one_with_the_joint_of_the_driver_and_the_gear(tmp_path, gear, values):
    path = tmp_path / 'actuator.yaml'
    write_config(path, new_config('/motor/joint_states', 'm1', path.name, *gear))
    assert NodeParameters.load(path) == replace(NodeParameters.load(), rotor_joint='m1', **values)
    text = path.read_text('utf-8')
    assert text.count("rotor_joint: 'm1'\n") == 1
    default = default_config().read_text('utf-8')
    assert set(re.findall('(?m)^ +#.*', text)) == set(re.findall('(?m)^ +#.*', default))
    assert 'only place that defines default values' not in text


@pytest.mark.parametrize(('places', 'program'), [
    (['bin', 'python'], 'gear_state_publisher'), (['python'], '{}/python/gear_state_publisher'),
    ([], 'ros2 run gear_kinematics gear_state_publisher'),
], ids=['on the PATH', 'beside the interpreter', 'of a workspace'])  # fmt: skip
def test_head_says_how_to_start_the_node(tmp_path, monkeypatch, places, program):
    for place in places:
        (tmp_path / place).mkdir()
        (tmp_path / place / 'gear_state_publisher').touch(0o755)
    monkeypatch.setenv('PATH', str(tmp_path / 'bin'))
    monkeypatch.setattr(sys, 'executable', str(tmp_path / 'python' / 'python3'))
    text = new_config('/motor/joint_states', 'm1', 'my actuator.yaml', HALF)
    head = [line for line in text.splitlines() if line.startswith('#')]
    place = 'm1 on /motor/joint_states, with the gear ratio -101/2'
    assert head[:2] == [f'# For the joint {place}.', '# Start the node with']
    command = shlex.split(head[2].removeprefix('#'))
    assert command == [
        *program.format(tmp_path).split(), '--ros-args', '--params-file', 'my actuator.yaml',
        '-r', 'rotor_state:=/motor/joint_states',
    ]  # fmt: skip
    assert start_command('/motor/joint_states', 'my actuator.yaml') == shlex.join(command)


@settings(max_examples=30)
@given(st.text(min_size=1))
@example('0')  # an index, where joints have no names
def test_every_joint_name_survives(joint):
    text = new_config('/driver', joint, 'a.yaml', HALF)
    values = yaml.safe_load(text)['/**']['ros__parameters']
    assert values['rotor_joint'] == joint
    assert values['ring_teeth'] == 80


def test_nothing_is_replaced(tmp_path):
    path = tmp_path / 'actuator.yaml'
    path.write_text('mine')
    with pytest.raises(ConfigError, match=r'actuator\.yaml: exists already'):
        write_config(path, 'theirs')
    assert path.read_text() == 'mine'
    with pytest.raises(ConfigError, match='No such file or directory'):
        write_config(tmp_path / 'nowhere/actuator.yaml', 'theirs')


def test_nothing_is_left_of_a_file_that_does_not_fit(tmp_path):
    path = tmp_path / 'full'
    with pytest.raises(UnicodeEncodeError):
        write_config(path, 'half \ud800')
    assert not path.exists()
