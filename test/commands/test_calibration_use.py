# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin validate, compute and plot with a calibration, as a user runs them."""

import json
from fractions import Fraction

import pytest
from blocked_bags import BAGS, refusal
from calibrations import calibration

from gear_kinematics.bag import Bag
from gear_kinematics.commands.cli import main
from gear_kinematics.parameters import NodeParameters

SERVO = BAGS / 'servo_point_to_point'
CORRECTED = ('/corrected_state', '/corrected_interval')


@pytest.fixture
def file(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text(calibration().text(), 'utf-8')
    return path


@pytest.fixture
def computed(file, tmp_path):
    out = tmp_path / 'computed'
    assert main(['compute', str(SERVO), str(out), '--calibration', str(file)]) == 0
    return out


def topics_of(path, capsys, *options) -> dict[str, dict]:
    """Validate a bag; gives what is reported of its topics, by name."""
    assert main(['validate', str(path), '--json', '-', *map(str, options)]) == 0
    (bag,) = json.loads(capsys.readouterr().out)['bags']
    return {topic['topic']: topic for topic in bag['topics']}


def test_calibration_beside_the_bag_is_used(computed, file, tmp_path, capsys):
    beside = computed / 'calibration.yaml'
    assert beside.read_bytes() == file.read_bytes()
    assert NodeParameters.load(computed / 'actuator.yaml').calibration == str(beside)
    capsys.readouterr()
    assert set(CORRECTED) < set(topics_of(next(computed.glob('*.mcap')), capsys))
    again = tmp_path / 'again'
    assert main(['compute', str(computed), str(again)]) == 0
    with Bag(again) as bag, Bag(computed) as before:
        assert list(bag.messages(CORRECTED)) == list(before.messages(CORRECTED))
    capsys.readouterr()
    for path in beside, computed / 'actuator.yaml':
        path.unlink()
    assert not set(CORRECTED) & set(topics_of(computed, capsys))


def test_calibration_that_the_config_names_is_used(computed, file, tmp_path, capsys):
    config = tmp_path / 'actuator.yaml'
    config.write_text(f'/**:\n  ros__parameters:\n    calibration: {file.name}\n', 'utf-8')
    capsys.readouterr()
    assert set(CORRECTED) < set(topics_of(computed, capsys, '--config', config))


@pytest.mark.parametrize('command', ['validate', 'compute'])
def test_calibration_of_another_gear_is_refused(command, tmp_path):
    path, out = tmp_path / 'other.yaml', tmp_path / 'out.svg'
    other = calibration(ring_teeth=61, satellite_teeth=58, gear_ratio=Fraction(-58, 3))
    path.write_text(other.text(), 'utf-8')
    words = {'validate': ['validate', SERVO], 'compute': ['compute', SERVO, out]}[command]
    assert f'{path}: calibrated for gear ratio -58/3' in refusal(*words, '--calibration', path)
    assert not out.exists()
