# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Actuators that are added to the parameter file of an arm: nothing that was in it is lost."""

import pytest
import yaml
from refusals import refused

from gear_kinematics.parameters import ConfigError
from gear_kinematics.parameters.arm import as_file, load_actuators
from gear_kinematics.parameters.arm_file import add_actuators

ELBOW = {'elbow': ['# é: of the nameplate', "gear_ratio: '-51'", '# after it']}

BLOCK = """\
# 🙂 mine
/**:
  ros__parameters:
    input_timeout: 2.0
    actuators: ['shoulder'] # left
    shoulder:
      gear_ratio: '-101'  # of the shoulder
      # also of the shoulder

/other: {ros__parameters: {rate: 3}}
# end"""
LIST = """\
gear_state_publisher:
  ros__parameters:
    shoulder: {gear_ratio: '-101'}
    actuators:
    - shoulder # left
    # nothing below"""


@pytest.mark.parametrize('before', [BLOCK, LIST])
def test_all_that_was_in_the_file_stays(tmp_path, before):
    path = tmp_path / 'arm.yaml'
    path.write_text(before, 'utf-8')
    path.chmod(0o640)
    add_actuators(path, ELBOW, [])
    after = path.read_text('utf-8')
    remaining = iter(after.splitlines())
    kept = (line for line in before.splitlines() if 'actuators: [' not in line)
    assert all(line in remaining for line in kept)
    assert after.count('# left') == 1
    assert {name: each.gear_ratio for name, each in load_actuators(path).items()} == {
        'shoulder': '-101',
        'elbow': '-51',
    }
    [block] = [each for each in yaml.safe_load(after).values() if 'actuators' in str(each)]
    assert block['ros__parameters']['elbow'] == {'gear_ratio': '-51'}
    assert path.stat().st_mode & 0o777 == 0o640
    add_actuators(path, {'on': ["rotor_joint: 'm3'"]}, [])
    assert [*load_actuators(path)] == ['shoulder', 'elbow', 'on']


def test_a_new_file_begins_with_its_head(tmp_path):
    path = tmp_path / 'arm.yaml'
    add_actuators(path, ELBOW, ['# An arm.'])
    assert path.read_text('utf-8').startswith('# An arm.\n/**:\n')
    assert [*load_actuators(path)] == ['elbow']
    with pytest.raises(ConfigError, match=r'none/arm\.yaml: No such file or directory'):
        add_actuators(tmp_path / 'none/arm.yaml', ELBOW, [])


@pytest.mark.parametrize(
    ('before', 'block', 'cause'),
    [
        (BLOCK.replace('shoulder', 'elbow'), ELBOW['elbow'], 'elbow is in it already: delete'),
        (
            "/**: {ros__parameters: {gear_ratio: '3'}}",
            ELBOW['elbow'],
            'it is not the file of one arm',
        ),
        (
            '/**:\n  ros__parameters:\n    actuators: []\n    rotor_joint: m1\n',
            ELBOW['elbow'],
            'it is the file of a single gear: give another name with -o',
        ),
        (
            f'{LIST}\n/b: {{ros__parameters: {{actuators: [a]}}}}',
            ELBOW['elbow'],
            'it is not the file of one',
        ),
        ('/**: {ros__parameters: {actuators: [b1]}}', ELBOW['elbow'], 'on a line of its own'),
        (BLOCK, ["rotor_joint: 'shoulder'"], "rotor_joint 'shoulder' belongs to shoulder and elb"),
        (BLOCK, ['gear_ratio: 3'], "quote it: '3'"),
        ('/**: {ros__parameters: {actuators: 3}}', ELBOW['elbow'], 'has a list of'),
        ('a: [', [], 'not YAML'),
    ],
)
def test_what_cannot_be_extended_stays_as_it_is(tmp_path, before, block, cause):
    path = tmp_path / 'arm.yaml'
    path.write_text(before, 'utf-8')
    with refused(ConfigError, path, cause):
        add_actuators(path, {'elbow': block}, [])
    assert path.read_text('utf-8') == before


def test_names_that_ros_takes_for_truth_values_are_quoted(tmp_path):
    """For rcl, unlike PyYAML, y and n are among them."""
    path, block = tmp_path / 'arm.yaml', ["gear_ratio: '3'"]
    add_actuators(path, dict.fromkeys('xyn', block), [])
    assert "    actuators: [x, 'y', 'n']\n" in path.read_text('utf-8')
    assert "\n    'y':\n" in path.read_text('utf-8')
    arm = load_actuators(path)
    assert [*arm] == ['x', 'y', 'n']
    written = as_file(arm.values())
    assert written.count("y.rotor_joint: 'y'\n") == written.count("\n    - 'n'\n") == 1
    path.write_text(written, 'utf-8')
    assert load_actuators(path) == arm
