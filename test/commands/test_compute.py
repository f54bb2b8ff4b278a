# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin compute as a user or a CI job runs it."""

import math
import re
import sqlite3
from contextlib import closing

import pytest
import yaml
from blocked_bags import BAGS, gearkin_here, refusal
from gear_recordings import old_recording
from live import rotor_bytes
from shipped_bags import CONFIGS, JOINT_STATE, POSE_ARRAY, ROTOR, write_bag

from gear_kinematics.bag import Bag
from gear_kinematics.commands.cli import main
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.wire.batches import decode_joint_states

SINGLE_TURN = BAGS / 'single_turn_encoder'


@pytest.mark.slow
@pytest.mark.parametrize(('bad', 'code'), [(0, 0), (5, 0), (6, 1)])
def test_of_a_recording_mostly_rejected_compute_tells_and_gives_code_1(bad, code, tmp_path):
    positions = [1e17] * bad + [1.0] * (10 - bad)
    messages = [(ROTOR, k, rotor_bytes(k + 1, position=[p])) for k, p in enumerate(positions)]
    source = write_bag(tmp_path / 'source', messages, {ROTOR: JOINT_STATE})
    done = gearkin_here('compute', source, tmp_path / 'out')
    assert done.returncode == code
    assert f'{10 - bad} outputs for 10 rotor states' in done.stdout
    complaint = f'gearkin: {source}: most messages on /rotor_state were rejected\n'
    assert done.stderr == (complaint if code else '')
    with Bag(tmp_path / 'out') as bag:
        assert bag.message_count == 10 + 2 * (10 - bad)


def test_compute_says_that_stamps_are_missing(tmp_path, capsys):
    messages = [(ROTOR, 5 + k, rotor_bytes((5 + k) * (k < 8), position=[1.0])) for k in range(10)]
    source = write_bag(tmp_path / 'source', messages, {ROTOR: JOINT_STATE})
    assert main(['compute', str(source), str(out := tmp_path / 'out')]) == 0
    told = '2 messages without a stamp: outputs have the time of reception'
    assert capsys.readouterr().err == f'gearkin: {out}: {told}\n'


def test_compute_says_that_milliseconds_are_sent_as_seconds(tmp_path, capsys):
    """Recorded at 100 Hz, the stamps rise by 10 s from one message to the next."""
    times = [k * 10_000_000 for k in range(20)]
    messages = [(ROTOR, t, rotor_bytes(1000 * t + 1, position=[1.0])) for t in times]
    source = write_bag(tmp_path / 'source', messages, {ROTOR: JOINT_STATE})
    assert main(['compute', str(source), str(out := tmp_path / 'out')]) == 0
    told = 'the stamps run 1000 times as fast as the clock'
    assert capsys.readouterr().err == f'gearkin: {out}: {told}\n'


@pytest.mark.slow
def test_compute_says_what_it_left_out(tmp_path):
    """What was not wanted, and what a rosbag2 cannot hold."""
    types = [('/rotor_state', JOINT_STATE), ('/grip', 'a/msg/Grip'), ('/text', 'a/msg/Text')]
    messages = [('/rotor_state', 1, rotor_bytes(1, position=[1.0])), ('/grip', 2, b'who knows')]
    bag = old_recording(tmp_path / 'b.db3', types, messages)
    with closing(sqlite3.connect(bag)) as rows, rows:
        rows.execute("UPDATE topics SET serialization_format = 'json' WHERE name = '/text'")
    for copied, options, left_out in ((1, [], '/text'), (0, ['--topics'], '/grip, /text')):
        out = tmp_path / f'out {copied}'
        done = gearkin_here('compute', bag, out, *options)
        assert (done.returncode, done.stderr) == (0, '')
        assert done.stdout.splitlines() == [
            f'{out}: 1 outputs for 1 rotor states, {copied} other messages copied',
            f'left out: {left_out}',
        ]


@pytest.mark.slow
@pytest.mark.parametrize(('others', 'topics'), [
    ((), {'/motor/output_state', '/motor/body_poses'}),
    (('/output_state', '/body_poses'), {'/output_state', '/body_poses'}),
    (('/a/output_state', '/b/output_state'), {'/a/output_state', '/b/output_state',
                                              '/motor/output_state', '/motor/body_poses'}),
    (('/output_state', '/mechanism_joint_states', '/corrected_state', '/transmission_error'),
     {'/output_state', '/body_poses'}),
], ids=['none', 'recorded', 'several', 'of a calibrated node'])  # fmt: skip
def test_recorded_outputs_are_replaced_and_the_only_joint_is_taken(others, topics, tmp_path):
    topic, out = '/motor/joints', tmp_path / 'out'
    kinds = {name: POSE_ARRAY if 'poses' in name else JOINT_STATE for name in (topic, *others)}
    stamps = range(10**9, 2 * 10**9, 10**7)
    messages = [(topic, stamp, rotor_bytes(stamp, ['m1'], [1.0])) for stamp in stamps]
    bag = write_bag(tmp_path / 'monday', messages, kinds)
    words = ('--rotor-topic', topic)
    assert 'there are: m1; give the right --config or --joint' in refusal(
        'compute', bag, out, *words, '--joint', 'rotor'
    )
    done = gearkin_here('compute', bag, out, *words)
    assert done.stdout.endswith('\nm1, the only joint on /motor/joints, is taken\n')
    left = ', '.join(sorted({*others} - topics))
    assert (f'\nleft out: {left}\n' in done.stdout) == bool(left)
    with Bag(out) as computed:
        assert set(computed.topics) == {topic, *topics}
    (out / 'actuator.yaml').unlink()
    done = gearkin_here('validate', out)
    assert (done.returncode, done.stderr) == (0, '')
    assert 'm1, the only joint on /motor/joints, is taken' in done.stdout


def test_compute_uses_the_config_beside_the_bag(tmp_path):
    out = tmp_path / 'out'
    assert gearkin_here('compute', SINGLE_TURN, out).returncode == 0
    assert gearkin_here('validate', out).returncode == 0
    assert gearkin_here('validate', out, '--config', CONFIGS / 'actuator.yaml').returncode == 1
    given = NodeParameters.load(SINGLE_TURN / 'actuator.yaml')
    assert NodeParameters.load(out / 'actuator.yaml') == given


@pytest.mark.slow
@pytest.mark.parametrize(('name', 'out', 'cause'), [
    ('good', 'there', 'there: exists already'), ('good', 'there/file/out', 'Not a directory'),
    ('garbage.mcap', 'out', 'garbage.mcap: not a bag of a known kind'),
    ('missing', 'out', 'missing: no such file or folder'),
    ('left_and_right', 'out', 'left_and_right: which topic is rotor_state? /left/rotor_state'),
])  # fmt: skip
def test_what_cannot_be_computed_gets_one_line_and_code_2(name, out, cause, bags, tmp_path):
    (tmp_path / 'there').mkdir()
    (tmp_path / 'there' / 'file').touch()
    assert cause in refusal('compute', bags / name, tmp_path / out)
    assert {*tmp_path.rglob('*')} == {tmp_path / 'there', tmp_path / 'there' / 'file'}


def test_other_joints_on_the_topic_are_no_fault(shared_path, tmp_path, capsys):
    bag, out = shared_path('data/faults/grippers_share_joint_states.mcap'), tmp_path / 'out'
    assert main(['compute', str(bag), str(out), '--joint', 'm1']) == 0
    assert '300 outputs for 300 rotor states, 0 other' in capsys.readouterr().out
    assert main(['validate', str(out)]) == 0
    assert '600 messages of /joint_states for other joints' in capsys.readouterr().out


def test_a_joint_of_270_degrees_is_at_250(shared_path, tmp_path):
    """Its encoder, absolute within a turn, leaves 250° and -110° open."""
    bag = shared_path('data/faults/parked_at_250_degrees_of_270.mcap')
    text = bag.with_suffix('.yaml').read_text()
    for ends, found in (('', -110.0), ('[0.0, 4.712389]', 250.0), ('[-4.0, -1.0]', -110.0)):
        out, config = tmp_path / f'out{found}{ends}', tmp_path / 'config.yaml'
        config.write_text(text + (f'    output_range: {ends}\n' if ends else ''))
        assert main(['compute', str(bag), str(out), '--config', str(config)]) == 0
        with Bag(out) as computed:
            *_, (_, _, last) = next(computed.batches(['/output_state']))
        angle = decode_joint_states([last], 'output_shaft').values[0, 0]
        assert math.degrees(angle) == pytest.approx(found, abs=0.01)
        assert main(['validate', str(out), '--config', str(config)]) == 0


def test_an_encoder_whose_topic_was_remapped_tells_the_turns(shared_path, tmp_path, capsys):
    """Compute needs it, and validate judges by it; both find it by its joint."""
    topics = {'/rotor_state': '/motor/states', '/output_encoder': '/shaft/states'}
    with Bag(shared_path('data/faults/parked_at_250_degrees_of_270.mcap')) as bag:
        messages = [(topics[topic], *rest) for topic, *rest in bag.messages(bag.topics)]
    source = write_bag(tmp_path / 'bag', messages, dict.fromkeys(topics.values(), JOINT_STATE))
    given = {'output_encoder_reference': 'absolute', 'output_encoder_joint': 'shaft'}
    (source / 'actuator.yaml').write_text(yaml.safe_dump({'/**': {'ros__parameters': given}}))
    assert main(['compute', str(source), str(tmp_path / 'out')]) == 0
    assert capsys.readouterr().err == ''  # nothing of unknown turns
    assert main(['validate', str(tmp_path / 'out')]) == 0
    assert 'the outputs agree with output_encoder' in capsys.readouterr().out


def test_outputs_outside_of_their_range_are_named(tmp_path):
    config, out = tmp_path / 'config.yaml', tmp_path / 'out'
    config.write_text('/**:\n  ros__parameters:\n    output_range: [1.0, 2.0]\n')
    done = gearkin_here('compute', BAGS / 'servo_point_to_point', out, '--config', config)
    assert done.returncode == 0
    said = r'the output, at -?\d+\.\d\d°, is outside of output_range, 57\.30° to 114\.59°'
    assert re.search(f'gearkin: .*: {said}', done.stderr)
    done = gearkin_here('validate', out, '--config', config)
    assert re.search(said, done.stdout)


@pytest.mark.parametrize(
    ('name', 'config', 'said'),
    [
        (
            'multi_turn_drive_restarts',
            None,
            "the rotor's encoder jumped by -104.2 rad at 1790000001.000 s",
        ),
        (
            'single_turn_velocity_field_is_zero',
            'single_turn.yaml',
            'the velocities contradict the positions: they seem to be 0',
        ),
        (
            'clock_set_back_by_0.3_s',
            None,
            'the clock was set back by at least 0.28 s just after 1790000005.480 s',
        ),
        (
            'effort_is_current_in_mA',
            None,
            'efforts of up to 1000 N·m at the rotor are more than the motor of a geared drive has',
        ),
    ],
)
def test_what_cannot_be_true_is_said(shared_path, tmp_path, capsys, name, config, said):
    bag, out = shared_path(f'data/faults/{name}.mcap'), tmp_path / 'out'
    options = ['--config', str(shared_path(f'data/faults/{config}'))] if config else []
    assert main(['compute', str(bag), str(out), *options]) == 0
    told = capsys.readouterr().err
    assert f'gearkin: {out}: {said}' in told
    known = 'the turns of the rotor are not known at the end' not in told
    assert known is name.startswith(('effort', 'clock'))
