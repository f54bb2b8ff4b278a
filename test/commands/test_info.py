# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin info as a user runs it."""

import math
import shutil
from pathlib import Path

import pytest
from blocked_bags import BAGS, gearkin, refusal
from live import rotor_bytes
from shipped_bags import JOINT_STATE, ROTOR, write_bag
from terminals import ENVIRONMENT, Terminal

from gear_kinematics.commands.cli import main

CONSTANT = BAGS / 'constant_speed_3000rpm'


def test_a_bag_is_a_line(capsys):
    assert main(['info', str(CONSTANT)]) == 0
    told = capsys.readouterr()
    assert told.out == (
        f'{CONSTANT}: 3.00 s, 9000 messages; rotor /rotor_state (joint rotor) 1000 Hz; '
        'output /output_state (joint output_shaft) 1000 Hz; poses /body_poses 1000 Hz; no gaps\n'
    )
    assert told.err == ''


@pytest.mark.parametrize(('others', 'said'), [(1, '1 message '), (2, '2 messages ')])
def test_messages_of_other_joints_are_counted(others, said, tmp_path, capsys):
    own = [(ROTOR, 10**9 + k, rotor_bytes(10**9 + k, position=[0.1])) for k in range(20)]
    more = [
        (ROTOR, 10**9 + 20 + k, rotor_bytes(10**9 + 20 + k, ['wheel'], position=[0.1]))
        for k in range(others)
    ]
    write_bag(tmp_path / 'bag', own + more, {ROTOR: JOINT_STATE})
    assert main(['info', str(tmp_path / 'bag'), '--joint', 'rotor']) == 0
    verb = 'is' if others == 1 else 'are'
    told = capsys.readouterr().out
    assert (
        f'(joints rotor, wheel) 1e9 Hz of rotor; {said}on {ROTOR} {verb} of other joints;' in told
    )


@pytest.mark.parametrize(('known', 'said'), [
    ('rotor_encoder: multi_turn', 'the positions wrap every 25 rad: set rotor_encoder_range'),
    ('rotor_encoder_range: 25.0', 'no gaps\n'),
])  # fmt: skip
def test_positions_are_judged_by_the_given_parameters(known, said, tmp_path, capsys):
    """The rotor turns at 50 rad/s, and its positions wrap every 25 rad."""
    times = [k * 3_000_000 for k in range(1, 1500)]
    angles = [math.fmod(50e-9 * t + 3.0, 25.0) for t in times]
    messages = [
        (ROTOR, t, rotor_bytes(t, position=[a])) for t, a in zip(times, angles, strict=True)
    ]
    bag = write_bag(tmp_path / 'bag', messages, {ROTOR: JOINT_STATE})
    file = tmp_path / 'gear.yaml'
    file.write_text(f'gear_state_publisher: {{ros__parameters: {{{known}}}}}')
    assert main(['info', str(bag), '--config', str(file)]) == 0
    assert said in capsys.readouterr().out


def test_a_terminal_breaks_no_word(capsys):
    narrow = {**ENVIRONMENT, 'COLUMNS': '40'}
    with Terminal() as terminal:
        gearkin('info', 'constant_speed_3000rpm', stdout=terminal.other, env=narrow, cwd=BAGS)
        shown = terminal.text()
    assert max(map(len, shown.splitlines())) <= 40
    assert main(['info', str(CONSTANT)]) == 0
    told = capsys.readouterr().out
    assert ' '.join(shown.split()) == told.removeprefix(f'{BAGS}/').strip()


def test_every_bag_is_a_line_even_if_others_are_unreadable(tmp_path, monkeypatch, capsys):
    for name in ('driver_faults', 'single_turn_encoder'):
        shutil.copytree(BAGS / name, tmp_path / name)
    (tmp_path / 'garbage.mcap').write_bytes(b'garbage' * 9)
    monkeypatch.chdir(tmp_path)
    assert main(['info', '.', 'nowhere']) == 2
    told = capsys.readouterr()
    assert [line.partition(':')[0] for line in told.out.splitlines()] == [
        'driver_faults',
        'single_turn_encoder',
    ]
    assert '2 gaps on /rotor_state, up to 0.302 s' in told.out
    nowhere, garbage = told.err.splitlines()
    assert nowhere == 'gearkin: nowhere: no bag there'
    assert garbage == 'gearkin: garbage.mcap: not a bag of a known kind'
    assert f'gearkin: {refusal("info", "-q", ".")}' == garbage
    Path('garbage.mcap').rename('ramps.csv')
    assert refusal('info', 'ramps.csv').endswith(
        'tables are read by calibrate, commission, loads and lost-motion'
    )


def test_every_topic_is_listed_on_demand(capsys):
    assert main(['info', '-v', str(CONSTANT)]) == 0
    line, *facts = capsys.readouterr().out.splitlines()
    assert line.startswith(f'{CONSTANT}: 3.00 s')
    rates = '1000 Hz, 1000 Hz on average'
    row = f'output /output_state (joint output_shaft) {JOINT_STATE}, {rates}, 3000 messages'
    assert row in map(str.strip, facts)


def test_topics_that_are_not_cdr_are_counted(shared_path, capsys):
    """The file has 131, 35 and 34 messages of CDR, and 200 of JSON."""
    assert main(['info', '-v', str(shared_path('data/faults/rec_cdr_and_json.mcap'))]) == 0
    line, rotor, output, poses, battery, *_ = capsys.readouterr().out.splitlines()
    assert line.endswith(': 2.60 s, 400 messages')
    counts = [row.rpartition(', ')[2] for row in (rotor, output, poses, battery)]
    assert counts == ['131 messages', '35 messages', '34 messages', '200 messages']
    assert battery.startswith('  /battery ')


def test_messages_with_a_header_of_ros_1_have_no_rate(tmp_path, capsys):
    """Converters leave its `seq`, which then stands where the stamp of ROS 2 begins."""
    times = range(10**18, 10**18 + 10**9, 10**7)
    states = [(k, time, rotor_bytes(time)) for k, time in enumerate(times)]
    messages = [('/motor', time, d[:4] + k.to_bytes(4, 'little') + d[4:]) for k, time, d in states]
    path = write_bag(tmp_path / 'bag', messages, {'/motor': JOINT_STATE})
    assert main(['info', str(path)]) == 0
    said = capsys.readouterr().out
    assert '; 100 of 100 messages on /motor cannot be read as JointState of ROS 2; ' in said
    assert 'Hz' not in said
    assert 'no gaps' not in said


def test_messages_with_arrays_of_unequal_length_are_counted(shared_path, capsys):
    bag = str(shared_path('data/faults/four_names_three_positions.mcap'))
    assert main(['info', bag, '--joint', 'm1']) == 0
    assert '/joint_states: 300 messages rejected: array sizes' in capsys.readouterr().out


@pytest.mark.slow
def test_real_recordings_are_described(shared_path, capsys):
    """Bags of others: servos of Feetech in ROS 2, and joints of a PR2 in ROS 1."""
    folder = shared_path('data/bags')
    assert main(['info', str(folder)]) == 0
    servos, pr2 = capsys.readouterr().out.splitlines()
    assert '; which topic is rotor_state? /servo/in/state (joints q0, q1, ' in servos
    assert '; rotor /joint_states (joints bl_caster_l_wheel_joint, ' in pr2
    assert ' and 41 more) 100.1 Hz; ' in pr2
    bag = str(folder / 'feetech_servos')
    assert main(['info', bag, '--rotor-topic', '/servo/out/state']) == 0
    assert '; rotor /servo/out/state (joints q0, ' in capsys.readouterr().out


def test_the_joints_of_a_parameter_file_beside_a_bag_are_examined(tmp_path, capsys):
    """The velocities of both motors are 0; five messages come at once, 50 each second."""
    times = [10**9 + 100_000_000 * (k // 5) + 1_000_000 * (k % 5) for k in range(100)]
    sent = [(ROTOR, t, rotor_bytes(t, ['m1', 'm2'], [math.sin(k), k], [0.0, 0.0]))
            for k, t in enumerate(times)]  # fmt: skip
    bag = write_bag(tmp_path / 'arm', sent, {ROTOR: JOINT_STATE})
    motors = '{actuators: [m1, m2], gear_ratio: "-50"}'
    file = bag / 'actuator.yaml'
    for text, joints in ('/**: {ros__parameters: ' + motors + '}', ['m1', 'm2']), ('{', []):
        file.write_text(text)
        assert main(['info', str(bag)]) == 0
        line = capsys.readouterr().out
        assert '; rotor /rotor_state (joints m1, m2) 52 Hz on average; ' in line  # 99 in 1.904 s
        zero = 'the velocities contradict the positions: they seem to be 0'
        assert [joint for joint in ('m1', 'm2') if f'{ROTOR}: {joint}: {zero}' in line] == joints
