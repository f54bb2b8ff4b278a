# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What gearkin advises: what is missing, which names there are, and which bag it is about."""

import shutil
import sys
from pathlib import Path

import pytest
from blocked_bags import BAGS, refusal
from live import rotor_bytes
from shipped_bags import JOINT_STATE, write_bag

from gear_kinematics.bag import Bag
from gear_kinematics.commands.cli import main

SERVO = BAGS / 'servo_point_to_point'
EXTRAS = {'rclpy': 'ros', 'plotly': 'html', 'matplotlib': 'plot', 'tornado': 'watch'}


# Packages that are missing.

LAZY = tuple(f'gear_kinematics.{name}' for name in ('ros.live', 'ros.replay', 'watch.'))
"""Imported where ROS or a page is needed."""
READERS = ('validate', 'lost-motion', 'calibrate')
MISSING = {
    'rclpy': ['demo', 'replay SERVO', 'validate --live SERVO', 'init', 'record out'],
    'plotly': [f'{command} SERVO --html a.html' for command in READERS],
    'matplotlib': [
        *('validate SERVO --plot a.png', 'lost-motion SERVO --plot a.png'),
        *('plot output a.png --bag SERVO', 'plot scheme a.png', 'animate a.gif --bag SERVO'),
        'preload --degrees 1 --branch-stiffness 3000 --shaft-stiffness 1000 --plot a.png',
    ],
    'tornado': ['watch'],
}
"""Commands that need a package."""


@pytest.mark.parametrize(
    ('package', 'command'),
    [(package, command) for package, commands in MISSING.items() for command in commands],
)
def test_a_missing_package_is_named_before_any_work(package, command, tmp_path, monkeypatch):
    for name in [name for name in sys.modules if name.split('.')[0] == package]:
        monkeypatch.delitem(sys.modules, name)
    for name in [name for name in sys.modules if name.startswith(LAZY)]:
        room, _, module = name.rpartition('.')
        monkeypatch.delattr(sys.modules[room], module, raising=False)
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.setattr(Bag, 'messages', None)  # no work
    monkeypatch.chdir(tmp_path)
    instead = 'source a ROS 2 installation, or ' if package == 'rclpy' else ''
    assert refusal(*command.replace('SERVO', str(SERVO)).split()) == (
        f"{package} is not installed: {instead}pip install 'gear_kinematics[{EXTRAS[package]}]'"
    )
    assert list(tmp_path.iterdir()) == []


# Names.


@pytest.fixture
def motor(tmp_path, monkeypatch):
    """A bag of a driver of two motors, in which nothing has the default name."""
    monkeypatch.chdir(tmp_path)
    messages = []
    for k in range(100):
        stamp = 10**18 + 10**7 * k
        data = rotor_bytes(stamp, ['left', 'wheel_1'], [0.0, 0.5 * k], [0.0, 50.0], [0.1, 0.2])
        messages.append(('/motor/states', stamp, data))
        messages.append(('/output_encoder', stamp, rotor_bytes(stamp, ['out'], [-0.5 / 19 * k])))
    return write_bag(Path('motor'), messages, {topic: JOINT_STATE for topic, *_ in messages})


READING = [
    ['compute', 'motor', 'out'],
    ['replay', 'motor', '--no-wait'],
    ['lost-motion', 'motor'],
    ['calibrate', 'motor'],
    ['plot', 'output', 'a.png', '--bag', 'motor'],
    ['animate', 'a.gif', '--bag', 'motor'],
    ['validate', 'motor', '--output-topic', '/output_encoder'],
]


@pytest.mark.parametrize('command', READING, ids=lambda command: ' '.join(command[:2]))
def test_every_command_names_the_bag_and_what_is_in_it(command, motor):
    error = refusal(*command, '--joint', 'wheel', report='.*')
    assert error.startswith('motor: ')
    assert "no joint 'wheel' in it; did you mean `wheel_1`? there are: left, wheel_1" in error
    words = command[:2] if command[0] == 'validate' else command
    assert refusal(*words, '--rotor-topic', '/motor/state', report='.*') == (
        'motor: no topic /motor/state of type sensor_msgs/msg/JointState in it; '
        'did you mean `/motor/states`? there are: /motor/states, /output_encoder'
    )
    assert {path.name for path in motor.absolute().parent.iterdir()} == {'motor'}


@pytest.mark.parametrize('command', ['calibrate', 'lost-motion'])
def test_a_missing_joint_of_the_output_is_answered_with_those_that_there_are(command, motor):
    Path('my.yaml').write_text('/**: {ros__parameters: {output_encoder_joint: outer}}')
    assert refusal(command, motor, '--joint', 'wheel_1', '--config', 'my.yaml') == (
        "motor: /output_encoder: no joint 'outer' in it; did you mean `out`? there are: out"
    )


def test_the_joint_chooses_among_topics(tmp_path, capsys):
    messages = [
        (topic, k + 1, rotor_bytes(10**18 + k, [joint], [1.0 * k]))
        for topic, joint in (('/left', 'm1'), ('/right', 'm2'))
        for k in range(3)
    ]
    kinds = dict.fromkeys(('/left', '/right'), JOINT_STATE)
    bag = write_bag(tmp_path / 'two', messages, kinds)
    words = ['compute', str(bag), str(tmp_path / 'out')]
    choice = 'which topic is rotor_state? /left (joint m1), /right (joint m2); name it with'
    assert choice in refusal(*words)
    assert main([*words, '--joint', 'm2']) == 0
    with Bag(tmp_path / 'out') as bag:
        assert sum(topic == '/output_state' for topic, *_ in bag.messages(bag.topics)) == 3
    capsys.readouterr()


@pytest.mark.parametrize(
    ('command', 'error'),
    [
        ('valdate a', "'valdate'; did you mean `validate`? there are: animate, calibrate, "),
        ('plot sheme a', "'sheme'; did you mean `scheme`? there are: output, roses, "),
        ('compute a b --storage mcp', "'mcp'; did you mean `mcap`? there are: mcap"),
        ('replay a --lopp', '--lopp; did you mean `--loop`? there are: --actuator, --as, '),
        ('plot scheme a --degres', '--degres; did you mean `--degrees`? there are: --actuator'),
        ('plot scheme -o a.png', ' --torque; without an option: figure, FILE; see gearkin plot'),
        ('replay a b', 'unrecognized arguments: b; see gearkin replay --help'),
        ('urdf --config my.yaml', 'unknown parameter `modul`; did you mean `module`?'),
        ('urdf --config two.yaml --node /lift/x', 'only of /left/x, /right/x; did '),
        ('plot scheme a.png --joint m', '--joint needs --bag'),
    ],
)
def test_unknown_names_are_answered_with_those_that_there_are(command, error, motor):
    Path('my.yaml').write_text('/**: {ros__parameters: {modul: 1.0}}')
    Path('two.yaml').write_text(
        '/left/x: {ros__parameters: {module: 0.1}}\n/right/x: {ros__parameters: {module: 0.1}}'
    )
    assert error in refusal(*command.split())
    assert motor.exists()


# What cannot be read, among others.


def test_files_beside_a_bag_that_cannot_be_used_do_not_stop_the_others(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    for name in ('broken', 'sound', 'uncalibrated'):
        shutil.copytree(BAGS / 'single_turn_encoder', name)
    Path('broken/actuator.yaml').write_text('{')
    Path('uncalibrated/calibration.yaml').write_text('schema: none')
    assert main(['validate', 'broken', 'sound', 'uncalibrated', 'nowhere']) == 2
    printed = capsys.readouterr()
    assert 'sound: verdict: passed; ' in printed.out
    assert printed.out.startswith('summary: 4 bags: 1 passed, 0 failed, 3 unusable\n')
    broken, uncalibrated, nowhere = printed.err.splitlines()
    assert broken.startswith('gearkin: broken/actuator.yaml: not YAML')
    assert uncalibrated.startswith('gearkin: uncalibrated/calibration.yaml: ')
    assert nowhere.startswith('gearkin: nowhere: no bag there')


def test_the_error_about_a_part_of_a_bag_names_it(motor):
    words = ['plot', 'output', 'a.png', '--bag', motor, '--joint', 'wheel_1']
    error = 'motor: no rotor states from 9 s on; they are from 0 s to 0.99 s'
    assert refusal(*words, '--start-offset', '9') == error
