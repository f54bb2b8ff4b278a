# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The recording of an arm is judged joint by joint, and by what its messages have in common."""

import json
import math
from dataclasses import replace
from itertools import compress

import jsonschema
import numpy as np
import pytest
from arm_recordings import (
    OUTPUT,
    RATIOS,
    ROTOR,
    START,
    STEP,
    Joints,
    config,
    inputs,
    output,
    recording,
)
from blocked_bags import BAGS, gearkin_here, refusal
from calibrations import calibration
from live import rotor_bytes
from shipped_bags import JOINT_STATE, write_bag
from validating import feed

from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation import Task, explain
from gear_kinematics.validation.arm import ArmValidator, JoinedMessages
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.validate_bag import of_arm, validate, validate_bag
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.batches import JointStateBatch

PAIR, WRIST, ALL = 40, 41, 42
"""Numbers of the messages of two drivers with the same stamp, and of one with all joints."""


def judged(path, messages, size: int = 10_000, **values):
    """The report on messages that come in batches of a size."""
    actuators = load_actuators(config(path / 'arm.yaml', **values))
    task = of_arm([Task(path, each) for each in actuators.values()])
    arm = ArmValidator([Validator(each) for each in task.actuators])
    feed(arm, messages, size)
    return arm.report(task, arm.reports(None, {}))


def test_messages_of_all_joints_and_of_several_drivers_pass_in_batches_of_any_size(tmp_path):
    whole = judged(tmp_path, recording())
    assert whole.passed, explain(whole)
    assert [(each.actuator, each.gear_ratio) for each in whole.actuators] == [
        (name, str(ratio)) for name, ratio in RATIOS.items()
    ]
    for each in whole.actuators:
        assert each.rotor.valid == each.topics[0].compared == 60
    velocities = [each.topics[0].fields[1].compared for each in whole.actuators]
    assert velocities == [60, 60, 0]
    assert [each.topics[0].fields[2].compared for each in whole.actuators] == [40, 0, 0]
    for size in (1, 7):
        assert judged(tmp_path, recording(), size).passed


def test_a_recording_may_begin_with_outputs_of_an_input_that_was_not_recorded(tmp_path):
    rest = judged(tmp_path, recording()[1:], 1)
    assert rest.passed, explain(rest)


@pytest.mark.parametrize(
    ('batches', 'lacking'),
    [
        # Outputs, by stamps and numbers of joints; inputs, by stamps and numbers of valid rotors.
        ([([(5, 70)], [(5, 70)])], 0),
        ([([(5, 69)], [(5, 70)])], 1),
        ([([(5, 69)], [(5, 69)])], 0),
        ([([(5, 69), (5, 70)], [(5, 70), (5, 69)])], 0),
        ([([(5, 68), (5, 70)], [(5, 70), (5, 68), (5, 67)])], 0),
        ([([(5, 69), (6, 69)], []), ([], [(5, 70), (6, 70)])], 2),
        ([([(5, 69)], []), ([], [(4, 70)]), ([], [(5, 70)])], 0),
    ],
)
def test_a_joint_that_an_arm_of_seventy_leaves_out_is_found_if_no_input_lacks_it(batches, lacking):
    names = [f'j{k}' for k in range(70)]
    joints = {name.encode(): k for k, name in enumerate(names)}
    joined = JoinedMessages(joints, range(70), 70, others=False)
    for outputs, given in batches:
        data = [rotor_bytes(t, names[:n], [0.0] * n, [], []) for t, n in outputs]
        stamps = np.array([t for t, _ in given], np.int64)
        valid = np.arange(70).reshape(-1, 1) < np.array([n for _, n in given])
        joined.take(JointStateBatch(data), stamps, valid)
    found = [each for k in range(70) for each in joined.findings(OUTPUT, k)]
    assert [(each.cause, each.count) for each in found] == (
        [(FindingCause.JOINT_LEFT_OUT, lacking)] * bool(lacking)
    )


@pytest.mark.parametrize(('name', 'absolute'), [('elbow', False), ('wrist', True)])
def test_turns_of_an_encoder_that_wraps_are_counted_for_its_actuator_alone(
    name, absolute, tmp_path
):
    """The outputs show three turns more than the encoder, whose zero is at the angle -3 rad."""

    def wrapped(state: Joints) -> Joints:
        wraps = {name: lambda angle: math.remainder(angle + 3.0, math.tau)}
        positions = zip(state.names, state.position, strict=True)
        return state._replace(position=[wraps.get(n, float)(angle) for n, angle in positions])

    given = {f'{name}.rotor_encoder': 'single_turn', f'{name}.rotor_zero': 3.0 - 3 * math.tau}
    messages = recording(400, read=wrapped)
    if absolute:
        given[f'{name}.output_encoder_reference'] = 'absolute'
        found = [(received + 1, data) for topic, received, data in messages if topic == OUTPUT]
        messages += [('/output_encoder', *each) for each in found]
        messages.sort(key=lambda message: message[1])
    topics = dict.fromkeys((ROTOR, OUTPUT, '/output_encoder')[: 2 + absolute], JOINT_STATE)
    bag = write_bag(tmp_path / 'bag', messages, topics)
    report = validate(bag, config(tmp_path / 'arm.yaml', **given))
    assert report.passed, explain(report)
    own = [each == name for each in RATIOS]
    for text, of_it in (
        ('the turns of the single-turn encoder are taken from the outputs', own),
        ('the outputs agree with output_encoder', [each and absolute for each in own]),
    ):
        assert [text in explain(each) for each in report.actuators] == of_it
    del given[f'{name}.rotor_encoder']
    failed = validate(bag, config(tmp_path / 'arm.yaml', **given))
    assert [each.verdict == 'fail' for each in failed.actuators] == own


def without(joints: Joints, name: str) -> Joints:
    k = joints.names.index(name)
    return Joints(*([*values[:k], *values[k + 1 :]] for values in joints))


def reverse(joints: Joints) -> list[Joints]:
    return [Joints(*(values[::-1] for values in joints))]


def change(field: str, name: str, value):
    def edit(joints: Joints) -> list[Joints]:
        values, k = [*getattr(joints, field)], joints.names.index(name)
        values[k] = value(values[k]) if callable(value) else value
        return [joints._replace(**{field: values})]

    return edit


MISSING = '/output_state: the joint is missing although its rotor is valid: 1 message'


@pytest.mark.parametrize(
    ('number', 'edit', 'at_fault', 'text'),
    [
        (ALL, lambda joints: [without(joints, 'elbow')], 'elbow', MISSING),
        (
            ALL,
            lambda joints: [
                without(joints, 'elbow'),
                without(without(joints, 'shoulder'), 'wrist'),
            ],
            'elbow',
            MISSING,
        ),
        (PAIR, lambda joints: [without(joints, 'shoulder')], 'shoulder', MISSING),
        (ALL, reverse, '', 'not in the order of `actuators`, but wrist, elbow, shoulder'),
        (
            WRIST,
            lambda joints: [joints._replace(names=['thumb'])],
            '',
            'the joints are not those of the actuators, but thumb',
        ),
        (
            WRIST,
            lambda joints: [joints._replace(velocity=[math.nan])],
            '',
            'velocity is NaN for all of wrist, and should be empty',
        ),
        (
            ALL,
            lambda joints: [joints._replace(effort=joints.effort[:2])],
            '',
            'effort lacks a value for some of shoulder, elbow, wrist',
        ),
        (
            ALL,
            change('velocity', 'wrist', 0.0),
            'wrist',
            'velocity: 1 value without a counterpart',
        ),
        (ALL, change('velocity', 'elbow', math.nan), 'elbow', 'velocity: 1 value without a'),
        (ALL, change('position', 'elbow', math.nan), 'elbow', 'position: 1 value not finite'),
        (ALL, change('position', 'wrist', lambda x: x + 2e-9), 'wrist', 'exceeds the tolerance'),
        (
            PAIR,
            lambda joints: [
                Joints(*map(list.__add__, joints, (['wrist'], [1 / 30], [math.nan], [])))
            ],
            'wrist',
            '1 message too many',
        ),
    ],
)
def test_a_fault_in_one_message_is_found_and_fails_the_actuator_or_the_arm(
    number, edit, at_fault, text, tmp_path
):
    def edited(k, joints):
        return edit(joints) if k == number else [joints]

    report = judged(tmp_path, recording(edit=edited), 17)  # of 42, the output comes in the next
    assert report.verdict == Verdict.FAIL
    if not at_fault:
        assert text in explain(report).splitlines()[0]
        return
    (found,) = (each for each in report.actuators if each.actuator == at_fault)
    assert found.verdict == Verdict.FAIL
    assert text in explain(found)
    assert f'{at_fault}: ' in explain(report)


def test_outputs_of_another_rotor_are_explained(tmp_path):
    swapped = {'shoulder.rotor_joint': 'elbow', 'elbow.rotor_joint': 'shoulder'}
    bag = write_bag(tmp_path / 'bag', recording(), {ROTOR: JOINT_STATE, OUTPUT: JOINT_STATE})
    report = validate(bag, config(tmp_path / 'arm.yaml', **swapped))
    said = {each.actuator: explain(each) for each in report.actuators}
    for name, other in (('shoulder', 'elbow'), ('elbow', 'shoulder')):
        assert (
            f'the outputs are not those of {other}: they are those of {name}; set '
            f'`{name}.rotor_joint: {name}`'
        ) in said[name]
    assert 'they are those of' not in said['wrist']


def test_actuators_with_the_same_error_are_named_in_one_clause(tmp_path):
    def wrist(_, joints: Joints) -> list[Joints]:  # the last one
        return [Joints(*(of[-1:] for of in joints))] if 'wrist' in joints.names else []

    others = f'{OUTPUT} has only other joints: give the parameters of its node'
    assert judged(tmp_path, recording(edit=wrist)).error == f'shoulder, elbow: {others}'
    none = 'no outputs in it: gearkin compute writes a bag with them'
    assert judged(tmp_path, recording(edit=lambda *_: [])).error == none
    unknown = {'shoulder.rotor_encoder': 'single_turn', 'unreferenced_outputs': 'withhold'}
    withheld = 'no outputs in it: the node withholds them while the turns are not known'
    report = judged(tmp_path, recording(edit=wrist), **unknown)
    assert report.error == f'shoulder: {withheld}; elbow: {others}'


def test_corrected_outputs_that_are_not_judged_are_those_of_their_joints(tmp_path):
    corrected = [
        (topic, stamp + 3000, Joints(['shoulder'], [0.1], [], []).encode(stamp))
        for topic in ('/corrected_state', '/corrected_interval')
        for stamp, _ in inputs(3)
    ]
    messages = sorted(recording() + corrected, key=lambda message: message[1])
    topics = dict.fromkeys((topic for topic, *_ in messages), JOINT_STATE)
    bag = write_bag(tmp_path / 'bag', messages, topics)
    arm = load_actuators(config(tmp_path / 'arm.yaml'))
    tasks = [Task(bag, each) for each in arm.values()]

    def causes(tasks: list[Task]) -> list[list[FindingCause]]:
        found = validate_bag(of_arm(tasks)).actuators
        return [[finding.cause for finding in each.findings] for each in found]

    unjudged = [FindingCause.CORRECTION_UNJUDGED in each for each in causes(tasks)]
    assert unjudged == [True, False, False]
    # The node had none for the elbow, although one is given.
    tasks[1] = replace(tasks[1], calibration=calibration())
    left_out = [FindingCause.JOINT_LEFT_OUT in each for each in causes(tasks)]
    assert left_out == [False, True, False]


@pytest.mark.parametrize(('last', 'expected'), [(100, 1.196), (200, None)])
def test_a_motor_that_stops_before_the_others_is_told_and_fails_nothing(tmp_path, last, expected):
    messages = []
    for stamp, rotors in inputs(400):
        sent = [name != 'wrist' or stamp <= START + last * STEP for name in rotors.names]
        state = Joints(*([*compress(values, sent)] for values in rotors))
        if state.names:
            messages.append((ROTOR, stamp + 1000, state.encode(stamp)))
            messages.append((OUTPUT, stamp + 2000, output(state).encode(stamp)))
    report = judged(tmp_path, messages)
    told = {
        each.actuator: finding.values['seconds']
        for each in report.actuators
        for finding in each.findings
        if finding.cause is FindingCause.STOPPED
    }
    assert report.passed
    assert told == ({'wrist': pytest.approx(expected)} if expected else {})


def test_the_command_reports_each_actuator_and_narrows_to_one(tmp_path):
    changed = change('position', 'elbow', lambda x: x + 2e-9)
    messages = recording(edit=lambda k, joints: changed(joints) if k == ALL else [joints])
    bag = write_bag(tmp_path / 'bag', messages, {ROTOR: JOINT_STATE, OUTPUT: JOINT_STATE})
    options = ['validate', bag, '--config', config(tmp_path / 'arm.yaml'), '--independent']
    done = gearkin_here(*options)
    assert done.returncode == 1
    lines = [line.removeprefix(f'{bag}: ') for line in done.stdout.splitlines()]
    assert lines[0].startswith('verdict: failed: elbow: 60 outputs differ from the matrix method')
    assert '; 3 actuators, 180 inputs, 1 of 180 outputs wrong, largest error 2e-9 rad' in lines[0]
    verdicts = [line.split(';')[0][:30] for line in lines if 'verdict' in line][1:]
    assert verdicts == [
        'elbow: verdict: failed: 60 out', 'shoulder: verdict: passed', 'wrist: verdict: passed',
    ]  # fmt: skip
    content = json.loads(gearkin_here(*options, '--json', '-').stdout)
    schema = json.loads((BAGS.parent / 'docs' / 'report.schema.json').read_text('utf-8'))
    jsonschema.validate(content, schema)
    (arm,) = content['bags']
    assert (arm['verdict'], arm['rotor'], arm['messages']) == ('fail', None, 160)
    assert [each['actuator'] for each in arm['actuators']] == list(RATIOS)
    assert [each['verdict'] for each in arm['actuators']] == ['pass', 'fail', 'pass']
    assert [each['independent']['compared'] for each in arm['actuators']] == [60] * 3
    assert not arm['actuators'][1]['independent']['passed']
    narrowed = gearkin_here(*options, '--actuator', 'wrist', '--json', '-')
    assert narrowed.returncode == 0
    (arm,) = json.loads(narrowed.stdout)['bags']
    assert [each['actuator'] for each in arm['actuators']] == ['wrist']
    for option in (['--plot', tmp_path / 'x.png'], ['--live'], ['--joint', 'wrist']):
        assert '--actuator' in refusal(*options, *option)
