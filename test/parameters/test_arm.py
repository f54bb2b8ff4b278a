# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The file of an arm: what holds for which actuator, and every fault of its names at once."""

import argparse
from dataclasses import replace

import pytest
import yaml
from refusals import refused

from gear_kinematics.commands import arguments
from gear_kinematics.kinematics import Branch
from gear_kinematics.parameters import ConfigError, NodeParameters
from gear_kinematics.parameters.arm import as_file, load_actuators

ARM = {'actuators': ['shoulder', 'elbow']}


def write(folder, **values):
    path = folder / 'arm.yaml'
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': ARM | values}}), 'utf-8')
    return path


def test_a_parameter_is_that_of_one_actuator_or_the_default_of_all(tmp_path):
    own = {'gear_ratio': '-58/3', 'rotor_joint': 'm2', 'branches': ['c'], 'c.cam_phase': 0.5}
    common = {'rotor_zero': 0.25, 'a.cam_phase': 0.125, 'input_timeout': 2.0, 'home_file': 'h'}
    path = write(tmp_path, elbow=own, **common, **{'shoulder.input_timeout': 3.0})
    found = load_actuators(path)
    assert list(found) == ['shoulder', 'elbow']
    default = replace(
        NodeParameters.load(),
        actuators=('shoulder', 'elbow'),
        rotor_zero=0.25,
        home_file=str(tmp_path / 'h'),
    )
    a, b = default.branches
    joints = ('rotor_joint', 'output_joint', 'output_encoder_joint')
    shoulder = dict.fromkeys(joints, 'shoulder') | {'actuator': 'shoulder'}
    assert found['shoulder'] == replace(
        default,
        **shoulder,
        frame_prefix='shoulder_',
        branches=(replace(a, cam_phase=0.125), b),
        input_timeout=3.0,
    )
    assert found['elbow'] == replace(
        default,
        **dict.fromkeys(joints, 'elbow') | {'actuator': 'elbow', 'rotor_joint': 'm2'},
        frame_prefix='elbow_',
        gear_ratio='-58/3',
        branches=(Branch('c', 0.5),),
        input_timeout=2.0,
    )
    written = tmp_path / 'written.yaml'
    written.write_text(as_file(found.values()), 'utf-8')
    assert load_actuators(written) == found
    written.write_text(found['elbow'].as_file(), 'utf-8')
    assert NodeParameters.load(written) == replace(found['elbow'], actuators=('elbow',))
    assert load_actuators() == {'': NodeParameters.load()}


@pytest.mark.parametrize(('given', 'output', 'inner'), [
    ({}, 'shoulder', 'shoulder_rotor'), ({'output_joint': 'pan'}, 'pan', 'shoulder_rotor'),
    ({'frame_prefix': 'left_'}, 'left_shoulder', 'left_rotor'),
    ({'frame_prefix': '', 'output_joint': 'pan'}, 'pan', 'rotor'),
])  # fmt: skip
def test_only_a_prefix_that_is_given_is_before_the_output_joint(tmp_path, given, output, inner):
    parameters = load_actuators(write(tmp_path, shoulder=given))['shoulder']
    assert parameters.output_name == parameters.joint_names[-1] == output
    assert parameters.joint_names[0] == inner
    assert f'<joint name="{output}" type="continuous">' in parameters.urdf()


FAULTS = [
    ({'actuators': ['a1', 'a1']}, '`a1` is listed 2 times'),
    ({'actuators': ['a b', '1x']}, "'a b' must be", "'1x' must be at most"),
    ({'actuators': [65 * 'x']}, "xxx' must be at most 64 letters, digits and _"),
    ({'shoulder': None}, 'give the parameters of shoulder below it'),
    ({'actuators': {'shoulder': {'rotor_zero': 1.0}}}, 'write `shoulder.rotor_zero` beside it'),
    ({'actuators': ['a', 'loads']}, '`a` is also the name of a branch', '`loads` is also the'),
    ({'actuators': ['rotor_zero']}, '`rotor_zero` is also the name of a parameter'),
    ({'actuators': 'shoulder'}, 'actuators must be of type list'),
    (
        {'shoulder.rotor_joint': 'm', 'elbow.rotor_joint': 'm'},
        "rotor_joint 'm' belongs to shoulder and elbow: give each its own",
    ),
    ({'output_joint': 'x'}, "output_joint 'x' belongs to shoulder and elbow"),
    ({'frame_prefix': 'l_'}, "frame_prefix 'l_' belongs to shoulder and elbow"),
    ({'elbow.output_joint': 'shoulder_rotor'}, "two actuators have a joint 'shoulder_rotor'"),
    ({'rotor_joint': ''}, 'shoulder.rotor_joint and elbow.rotor_joint must name one of'),
    (
        {'sholder.gear_ratio': '5', 'elbow.rotor_jiont': 'm', 'nothing_like_it': 1},
        '`sholder.gear_ratio`; did you mean `shoulder.gear_ratio`?',
        '`elbow.rotor_jiont`; did you mean `elbow.rotor_joint`?',
        'and for each actuator such as `shoulder.ring_teeth`',
    ),
    ({'wrist.a.cam_phase': 0.5, 'wrist.rotor_zero': 1.0}, '_zero`; `wrist` is not in `actuators`'),
    ({'elbow.c.cam_phase': 0.5, 'shoulder.branches': ['c']}, '`c` is not in `elbow.branches`'),
    (
        {'elbow.executor': 'auto', 'elbow.home_file': 'x'},
        'give `executor` without `elbow.`',
        'give `home_file` without',
    ),
    (
        {'shoulder.ring_teeth': 1, 'elbow.a.cam_phase': 7.0, 'elbow.bad': 1, 'rotor_joint': 'm'},
        "rotor_joint 'm' belongs to shoulder and elbow",
        'shoulder.ring_teeth must be between',
        'elbow.a.cam_phase must be',
        '`elbow.bad`',
    ),
    (
        {'shoulder.ring_teeth': 5, 'elbow.output_joint': 'a\nb'},
        'shoulder: ',
        'elbow: output_joint must be printable',
    ),
]


@pytest.mark.parametrize(('given', *['texts']), [(given, texts) for given, *texts in FAULTS])
def test_every_fault_of_an_arm_is_named_in_one_line(tmp_path, given, texts):
    path = write(tmp_path, **given)
    with refused(ConfigError, path, *texts):
        load_actuators(path)


def test_of_very_many_unknown_parameters_some_are_named(tmp_path):
    path = write(tmp_path, **{f'x{k}.y': 1 for k in range(10, 70)})
    with refused(ConfigError, path, '`x59.y`; and 10 more; there are: ring_teeth, '):
        load_actuators(path)


def test_an_arm_without_an_inner_joint_may_share_a_prefix(tmp_path):
    values = {'frame_prefix': 'arm_', 'elbow.gear_ratio': '-50'}
    found = load_actuators(write(tmp_path, **values))
    assert [each.output_name for each in found.values()] == ['arm_shoulder', 'arm_elbow']


def test_a_command_takes_all_actuators_or_the_chosen_one(tmp_path):
    parser = argparse.ArgumentParser()
    arguments.add_mechanism(parser)
    given = ['--config', str(write(tmp_path, **{'elbow.rotor_direction': -1}))]

    def options(*more):
        return parser.parse_args([*given, *more])

    assert list(arguments.load_configs(options())) == ['shoulder', 'elbow']
    narrowed = options('--actuator', 'elbow', '--ring-teeth', '90')
    assert arguments.load_configs(narrowed) == {'elbow': arguments.load_config(narrowed)}
    assert arguments.load_config(narrowed).ring_teeth == 90
    one, every = arguments.load_config, arguments.load_configs
    for load, more, text in (
        (one, (), 'than one actuator: shoulder, elbow; choose one with --actuator'),
        (every, ('--ring-teeth', '90'), 'ring_teeth, gear_ratio can be replaced for one actuator'),
        (every, ('--actuator', 'elbo'), "no actuator 'elbo'.*; did you mean `elbow`"),
    ):
        with pytest.raises(ValueError, match=text):
            load(options(*more))
