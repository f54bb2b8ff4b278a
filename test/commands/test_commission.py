# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin commission as a user runs it."""

import json
import shlex
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from blocked_bags import refusal
from gear_recordings import Samples, write_csv, write_recording
from simulated_encoders import TURN, Drive, ramped_strokes, stamps

from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.commands.cli import main
from gear_kinematics.commands.encoders import ask_for_one_topic
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.wire.cdr import JointStateTemplate

REAL = Path(__file__).resolve().parents[3] / 'shared' / 'data' / 'dual_encoders'
LARA = ['--rotor-counts', '16777216', '--output-counts', '16777216']  # by its README


@pytest.fixture(scope='module')
def positions():
    """Times, s, and positions of rotor and output, rad, of a gear of -19."""
    drive = Drive(errors={1.0: 5e-4}, noise=5e-5)
    return drive.readings(ramped_strokes(15.0, 10.0, 1.0), 40.0, rate=100.0)


@pytest.fixture(scope='module')
def bag(positions, tmp_path_factory):
    times, rotor, output = positions
    path = tmp_path_factory.mktemp('bags') / 'gear'
    return write_recording(path, *(Samples(stamps(times), each) for each in (rotor, output)))


def test_file_is_one_that_the_node_takes(bag, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(['commission', str(bag), '--json', 'report.json', '--html', 'report.html']) == 0
    assert '-19' in (said := capsys.readouterr().out)
    assert 'The gear has the ratio -19 (' in said
    assert 'the only simple fraction). It is written to actuator.yaml.' in said
    assert 'exists already' in refusal('commission', bag)
    file = NodeParameters.load(Path('actuator.yaml'))
    assert (file.gear_ratio, file.rotor_joint) == ('-19', 'rotor')
    assert file.output_encoder_joint == 'output_shaft'
    lines = Path('actuator.yaml').read_text().splitlines()
    remapped = '-r rotor_state:=/rotor_state -r output_encoder:=/output_encoder'
    assert lines[lines.index('/**:') - 1].endswith(f'--params-file actuator.yaml {remapped}')
    values = [k for k, line in enumerate(lines) if line.startswith('    ') and '#' not in line]
    assert values
    assert all(lines[k - 1].startswith('    # ') for k in values)
    document = json.loads(Path('report.json').read_text())
    assert document['schema'] == 'gear_kinematics/commissioning'
    assert document['gear_ratio'] == '-19'
    [teeth] = [each['evidence'] for each in document['values'] if each['name'] == 'gear_ratio']
    assert teeth.endswith(
        '; teeth such as 20/19, 40/38, 60/57, 80/76, 100/95, 120/114, 140/133, '
        '160/152, 180/171, 200/190'
    )
    assert document['ratio']['value'] == pytest.approx(-19.0, abs=1e-3)
    assert main(['commission', str(bag), '--check', 'actuator.yaml']) == 0
    assert 'actuator.yaml agrees.' in capsys.readouterr().out
    Path('other.yaml').write_text(Path('actuator.yaml').read_text().replace("'-19'", "'19'"))
    assert main(['commission', str(bag), '--check', 'other.yaml']) == 1
    said = capsys.readouterr().out
    assert 'other.yaml is contradicted: rotor_direction is 1, not -1' in said


def test_a_hostile_comment_in_the_file_of_an_arm_keeps_no_program_busy(tmp_path, capsys):
    """The first begins a topic 10,000 times; it took 8 s."""
    path = tmp_path / 'arm.yaml'
    comments = '# The joint a' + ' on x, with ' * 10_000, '# The joint b on /b, with the ratio 2.'
    path.write_text(''.join(f'  {comment}\n    rotor_joint: a\n' for comment in comments), 'utf-8')
    begin = time.process_time()
    ask_for_one_topic(path)
    assert time.process_time() - begin < 1.0
    drivers = 'one topic has to have all motors: remap the drivers of /b, x\n'
    assert capsys.readouterr().err == f'gearkin: {drivers}'


def test_actuator_is_added_to_the_file_of_an_arm(bag, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path('arm.yaml').write_text(
        '/**:\n  ros__parameters:\n    actuators: [shoulder]\n    shoulder:  # mine\n'
        "      gear_ratio: '-101'\n      # a joint of /rotor_state\n      rotor_joint: shoulder\n"
        '      # a joint of /lift\n      output_encoder_joint: lift\n'
    )
    one = 'commission', str(bag), '--actuator', 'elbow'
    assert main([*one, '-o', 'arm.yaml']) == 0
    said, asked = capsys.readouterr()
    assert 'It is written to arm.yaml.' in said
    assert '-r output_encoder:=/output_encoder\n' in asked  # the head of the file has none
    drivers = 'remap the drivers of /lift, /output_encoder\n'
    assert asked.endswith(f'gearkin: one topic has to have all encoders: {drivers}')
    text = Path('arm.yaml').read_text()
    assert 'shoulder:  # mine' in text
    assert '      # The gear has the ratio -19 (' in text
    assert load_actuators(Path('arm.yaml'))['shoulder'].gear_ratio == '-101'
    assert main([*one, '--check', 'arm.yaml']) == 0
    assert 'elbow is in it already' in refusal(*one, '-o', 'arm.yaml')
    unread = 'commission', 'none', '--actuator', 'hand', '--joint', 'shoulder', '-o', 'arm.yaml'
    assert "rotor_joint 'shoulder' belongs to shoulder and hand" in refusal(*unread)
    encoder = *unread[:4], '--encoder-joint', 'lift', '-o', 'arm.yaml'
    assert "output_encoder_joint 'lift' belongs to shoulder and hand" in refusal(*encoder)
    assert main([*one, '-o', 'new.yaml']) == 0
    alone = NodeParameters.load(Path('new.yaml'))
    assert alone == replace(
        NodeParameters.load(Path('arm.yaml'), actuator='elbow'), actuators=('elbow',)
    )
    assert (alone.gear_ratio, alone.output_encoder_joint) == ('-19', 'output_shaft')
    remapped = '-r rotor_state:=/rotor_state -r output_encoder:=/output_encoder'
    assert f'--params-file new.yaml {remapped}\n' in Path('new.yaml').read_text()


def test_open_ratio_writes_nothing_unless_it_is_confirmed(positions, tmp_path, capsys):
    times, rotor, output = (
        np.interp(np.arange(300) / 3.0, np.arange(100), each[100:200])  # 9/19 rad
        for each in positions
    )
    rows = {'time': times, 'rotor_deg': np.degrees(rotor), 'output_deg': np.degrees(output)}
    csv = write_csv(tmp_path / 'short.csv', **rows)
    target = tmp_path / 'a.yaml'
    assert main(['commission', str(csv), '-o', str(target)]) == 1
    assert 'short.csv: verdict: failed: The ratio is undetermined: -' in capsys.readouterr().out
    assert main(['commission', str(csv), '-o', str(target), '--quiet']) == 1
    assert 'The ratio is undetermined: -' in capsys.readouterr().out
    assert not target.exists()
    assert main(['commission', str(csv), '-o', str(target), '--teeth', '80/70']) == 1
    assert not target.exists()
    assert main(['commission', str(csv), '-o', str(target), '--teeth', '80/76']) == 0
    assert NodeParameters.load(target).mechanism.satellite_teeth == 76


@pytest.mark.skipif(not REAL.is_dir(), reason='the recordings are not in ../shared')
@pytest.mark.parametrize(
    ('name', 'options', 'ratio', 'direction'),
    [
        ('neura_jogging_final_joint1', [*LARA, '--ratio', '121'], '121', 1),
        ('neura_jogging_joint_mass_joint2', [*LARA, '--ratio', '121'], '121', 1),
        ('sspg_backlash_sine_vel_2.500tps_2.00s', ['--ratio', '7.2'], '36/5', -1),
    ],
)
def test_real_gears_over_a_few_degrees_are_confirmed_only(
    name, options, ratio, direction, tmp_path, capsys
):
    recording, target = str(REAL / f'{name}.csv'), tmp_path / 'a.yaml'
    assert main(['commission', recording, '-o', str(target), *options[:-2]]) == 1
    assert 'The ratio is undetermined' in capsys.readouterr().out
    assert main(['commission', recording, '-o', str(target), *options]) == 0
    file = NodeParameters.load(target)
    assert (file.gear_ratio, file.rotor_direction) == (ratio, direction)
    assert main(['commission', recording, *options[:-2], '--check', str(target)]) == 0
    options[-1] = '-101'
    assert main(['commission', recording, '-o', str(tmp_path / 'b.yaml'), *options]) == 1


def test_counts_without_their_number_and_times_are_needed(positions, tmp_path):
    times, rotor, output = positions
    columns = {'motor_inc': rotor, 'load_inc': output}
    counts = {name: np.floor(each / TURN % 1.0 * 4096) for name, each in columns.items()}
    path = write_csv(tmp_path / 'counts.csv', **counts)
    assert 'no column of times, such as time_s' in refusal('commission', path)
    path = write_csv(tmp_path / 'counts.csv', **counts, time=times)
    said = refusal('commission', path)
    assert 'of the rotor are counts (183 wraps at 4096)' in said
    assert '--rotor-counts and --output-counts' in said


def test_the_command_line_for_a_table_without_names_works(positions, tmp_path):
    path = tmp_path / 'r.csv'
    np.savetxt(path, np.stack(positions).T, '%.6f', ',')
    command = refusal('commission', path, '-o', tmp_path / 'a.yaml').split('for example: ')[1]
    assert command.endswith('--rotor-column 2 --output-column 3 --angle-unit deg --time-column 1')
    assert main(shlex.split(command.replace(' deg ', ' rad '))[1:]) == 0


def joint_states(folder, positions, **topics):
    """Write a bag with topics of joints: of `m`, the rotor; of all others, the output."""
    with BagWriter(folder / 'bag') as writer:
        for topic in topics:
            writer.add_topic(f'/{topic}', 'sensor_msgs/msg/JointState')
        for stamp, rotor, output in zip(
            stamps(positions[0]).tolist(), *positions[1:], strict=True
        ):
            for topic, joints in topics.items():
                template = JointStateTemplate(joints, velocity=False, effort=False)
                values = [rotor if joint == 'm' else output for joint in joints]
                writer.write_all([(f'/{topic}', stamp, template.encode(stamp, values))])
    return folder / 'bag'


ROTOR = 'which joint is the rotor? Repeat with --joint, and its topic if needed: '
ENCODER = 'which joint is the output? Repeat with --encoder-joint, and its topic if needed: '


@pytest.mark.parametrize(('topics', 'options', 'said'), [
    ({'a': ['m', 'o'], 'b': ['p']}, '', ROTOR + 'm, o on /a; p on /b'),
    ({'a': ['m', 'o'], 'b': ['p']}, '--rotor-topic a', ROTOR + 'm, o on /a'),
    ({'a': ['m'], 'b': ['o'], 'c': ['p']}, '--joint m', ENCODER + 'o on /b; p on /c'),
    ({'a': ['m']}, '--joint n', "no joint 'n'. " + ROTOR.partition('? ')[2] + 'm on /a'),
    ({'rotor_state': ['m']}, '', 'There is none on topics of type sensor_msgs/msg/JointState.'),
])  # fmt: skip
def test_topics_and_joints_that_are_missing_or_several_are_named(
    topics, options, said, positions, tmp_path
):
    bag = joint_states(tmp_path, [each[:9] for each in positions], **topics)
    assert refusal('commission', bag, *options.split()).endswith(said)


@pytest.mark.parametrize('topics', [
    {'a': ['m', 'n'], 'b': ['o']}, {'a': ['m', 'o']},
    {'rotor_state': ['m'], 'output_encoder': ['o'], 'output_state': ['s'], 'b': ['p']},
])  # fmt: skip
def test_joints_are_found_and_a_check_takes_those_of_the_file(topics, positions, tmp_path):
    bag = str(joint_states(tmp_path, positions, **topics))
    file = tmp_path / 'a.yaml'
    assert main(['commission', bag, '-o', str(file), '--joint', 'm', '--encoder-joint', 'o']) == 0
    assert NodeParameters.load(file).output_encoder_joint == 'o'
    assert main(['commission', bag, '--check', str(file)]) == 0


def test_a_joint_that_is_taken_as_the_output_unasked_is_named(positions, tmp_path, capsys):
    """It may be the other motor of an arm without encoders at the outputs."""
    bag = str(joint_states(tmp_path, positions, motors=['m', 'o']))
    taken = 'gearkin: o on /motors is taken as the encoder at the output; --encoder-joint names '
    for options, said in ([], f'{taken}another\n'), (['--encoder-joint', 'o'], ''):
        file = tmp_path / f'{len(options)}.yaml'
        assert main(['commission', bag, '-o', str(file), '--joint', 'm', *options]) == 0
        assert capsys.readouterr().err == said


def test_range_of_the_rotor_is_found_and_written(shared_path, positions, tmp_path, capsys):
    """In a table of the protocol of ±12.5 rad, and in a bag."""
    times, rotor, output = positions
    rotor = np.remainder(rotor + 12.5, 25.0) - 12.5
    both = (Samples(stamps(times), each) for each in (rotor, output))
    table = shared_path('data/faults/position_wraps_at_12.5_rad.csv')
    for k, recording in enumerate((table, write_recording(tmp_path / 'bag', *both))):
        path = tmp_path / f'{k}.yaml'
        assert main(['commission', str(recording), '-o', str(path)]) == 0
        assert "The rotor's position repeats after 25 rad." in capsys.readouterr().out
        file = NodeParameters.load(path)
        assert (file.gear_ratio, file.rotor_encoder_range) == ('-19', 25.0)


def test_range_of_the_rotor_is_found_where_the_encoders_are_read_in_turn(tmp_path, capsys):
    """The rotor is interpolated in each wrap then; no motion of a gear looks like that."""
    drive, rate = Drive(errors={1.0: 5e-4}, noise=5e-5, ratio=-7.2), 50.0
    times, rotor, output = drive.readings(ramped_strokes(15.0, 10.0, 1.0), 40.0, rate=rate)
    later = times + 0.4 / rate
    rotor, output = np.remainder(rotor + 12.5, 25.0) - 12.5, np.interp(later, times, output)
    both = Samples(stamps(times), rotor), Samples(stamps(later), output)
    path, bag = tmp_path / 'gear.yaml', str(write_recording(tmp_path / 'bag', *both))
    assert main(['commission', bag, '-o', str(path)]) == 0
    assert "The rotor's position repeats after 25 rad." in capsys.readouterr().out
    file = NodeParameters.load(path)
    assert (file.gear_ratio, file.rotor_encoder_range) == ('-36/5', 25.0)
    measured = ['calibrate', bag, '-o', str(tmp_path / 'calibration.yaml')]
    assert main([*measured, '--ratio=-36/5']) == 2
    said = f'gearkin: {bag}: the positions wrap every 25 rad: set rotor_encoder_range, which '
    assert said in capsys.readouterr().err
    assert main([*measured, '--config', str(path)]) == 0
