# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Commands that read recordings take the file of an arm: all its actuators, or a chosen one."""

import json
from collections import defaultdict

import pytest
from arm_recordings import OUTPUT, ROTOR, config, inputs, output, recording
from blocked_bags import gearkin_here, refusal
from calibrations import calibration
from replaying import decode
from shipped_bags import JOINT_STATE, read_bag, write_bag

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.state.arm_state import ArmState
from gear_kinematics.state.gear_state import GearState


@pytest.fixture
def arm(tmp_path):
    """Make a recording of rotors, and the file of an arm of a whole gear and two ratios."""
    (tmp_path / 'shoulder.yaml').write_text(calibration().text(), 'utf-8')
    own = {'gear_ratio': '', 'calibration': 'shoulder.yaml', 'preload': 3.0}
    own |= {'branch_stiffness': [2000.0]}
    file = config(tmp_path / 'arm.yaml', **{f'shoulder.{name}': own[name] for name in own})
    states = [message for message in recording() if message[0] == ROTOR]
    return write_bag(tmp_path / 'states', states, {ROTOR: JOINT_STATE}), file


def test_the_outputs_of_an_arm_are_those_of_the_node_and_validate_to_the_last_bit(arm, tmp_path):
    source, file = arm
    out = tmp_path / 'out'
    done = gearkin_here('compute', source, out, '--config', file)
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout == f'{out}: 80 outputs for 80 rotor states, 0 other messages copied\n'
    gears = {
        name: GearState(each, Calibration.load(each.calibration) if each.calibration else None)
        for name, each in load_actuators(file).items()
    }
    node, published = ArmState(gears), defaultdict(list)
    node.choose(node.topics)
    for _, _, data in read_bag(source):
        for topic, message in node.encode(node.rotor(data, int)[0]):
            published[f'/{topic}'].append(message)
    computed = defaultdict(list)
    for topic, _, data in read_bag(out):
        computed[topic].append(data)
    assert computed.keys() - {ROTOR} == {
        '/output_state', '/corrected_state', '/corrected_interval', '/branch_loads',
        '/shoulder/body_poses', '/shoulder/joint_loads',
    }  # fmt: skip
    for topic in computed.keys() - {ROTOR}:
        assert computed[topic] == published[topic], topic
    for data, (_, state) in zip(computed[OUTPUT], inputs(60), strict=True):
        found, expected = decode(data, JOINT_STATE), output(state)
        assert found.name == expected.names
        for name in ('position', 'velocity', 'effort'):
            wanted = pytest.approx(getattr(expected, name), rel=1e-14, abs=1e-16, nan_ok=True)
            assert getattr(found, name).tolist() == wanted
    quantities = 'angle', 'position', 'velocity', 'effort'
    exact = [word for name in quantities for word in (f'--tolerance-{name}', '0')]
    done = gearkin_here('validate', out, *exact, '--json', '-')
    assert done.returncode == 0
    (report,) = json.loads(done.stdout)['bags']
    compared = [{t['topic']: t['compared'] for t in a['topics']} for a in report['actuators']]
    assert compared[1:] == [{OUTPUT: 60}] * 2
    assert compared[0].keys() == computed.keys() - {ROTOR}


def test_where_only_one_gear_can_be_meant_the_actuators_are_named(arm, tmp_path):
    source, file = arm
    for command in (
        ['plot', 'output', tmp_path / 'x.svg', '--bag', source],
        ['calibrate', source],
        ['lost-motion', source],
        ['compute', source, tmp_path / 'out', '--joint', 'wrist'],
        ['compute', source, tmp_path / 'out', '--calibration', tmp_path / 'shoulder.yaml'],
    ):
        told = refusal(*command, '--config', file)
        assert 'shoulder, elbow, wrist' in told or 'rotor_joint' in told
        assert '--actuator' in told
    drawn = tmp_path / 'elbow.svg'
    options = ['--bag', source, '--config', file, '--actuator', 'elbow']
    assert gearkin_here('plot', 'output', drawn, *options).returncode == 0
    assert drawn.is_file()


@pytest.mark.parametrize('command', ['info', 'replay'])
def test_an_actuator_is_refused_where_no_file_has_it(command, arm):
    """The file beside a recording is optional to these commands."""
    source, file = arm
    told = refusal(command, source, '--actuator', 'sholder')
    assert told.startswith(f"{source}: no actuator 'sholder' in `actuators`; there are none")
    (source / 'actuator.yaml').write_bytes(file.read_bytes())
    assert 'did you mean `shoulder`?' in refusal(command, source, '--actuator', 'sholder')


def test_loads_and_info_report_on_each_actuator(arm, tmp_path):
    source, file = arm
    done = gearkin_here('loads', source, '--config', file, '-v')
    left_out = 'no loads of elbow, wrist, for which only the ratio is known'
    assert (done.returncode, done.stderr) == (0, f'gearkin: {source}: {left_out}\n')
    lines = done.stdout.splitlines()
    assert {line[: len('states: shoulder: ')] for line in lines} == {'states: shoulder: '}
    assert any('output [N·m]: greatest: 4.75;' in line for line in lines)  # 19 · 0.25 N·m
    ratios = config(tmp_path / 'ratios.yaml', **{'shoulder.gear_ratio': '1457/26'})
    for given, actuator in (ratios, 'shoulder'), (file, 'elbow'):
        chosen = [] if given == ratios else ['--actuator', actuator]
        why = refusal('loads', source, '--config', given, *chosen)  # in one line
        assert why.startswith(f'{source}: {actuator}: gear_ratio is 1457/26: ')
    two = config(
        tmp_path / 'two.yaml',
        **{f'{name}.gear_ratio': '' for name in ('shoulder', 'elbow', 'wrist')},
    )
    once = refusal('loads', source, '--config', two, '--rotor-topic', '/motor')
    assert once.startswith(f'{source}: no topic /motor ')
    stopped = [
        (ROTOR, stamp, state._replace(velocity=[0.0 for _ in state.velocity]).encode(stamp))
        for stamp, state in inputs(300)
    ]
    zeros = write_bag(tmp_path / 'zeros', stopped, {ROTOR: JOINT_STATE})
    question = f'{ROTOR}: elbow: the velocities contradict the positions: they seem to be 0'
    assert question in gearkin_here('info', zeros, '--config', file).stdout
    assert 'contradict' not in gearkin_here('info', zeros).stdout
