# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings of nodes whose count an encoder at the output referenced, rightly or not."""

import math
import random
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
from blocked_bags import gearkin_here, refusal
from live import rotor_bytes
from node_loop import ENCODER, answered
from replaying import SECOND, edited
from rosbag2_recorder import Message, record
from shipped_bags import BAGS, JOINT_STATE, OUTPUT, POSES, ROTOR, TYPES, read_bag, write_bag
from validating import texts, validate

from gear_kinematics.bag import MessagesByTopic
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.ros.live import live_messages
from gear_kinematics.state.statuses import Condition
from gear_kinematics.validation.findings import sentence
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validate_bag import validate_bag
from gear_kinematics.validation.validator import Validator

START, MS = 1_700_000_000 * SECOND, SECOND // 1000
TIMES = np.arange(1000) * 4e-3
STEP = math.tau / 19  # rad of the output: a turn of the rotor
MULTI = replace(NodeParameters.load(), output_encoder_reference='absolute')
SINGLE = replace(MULTI, rotor_encoder='single_turn')
BOTH = pytest.mark.parametrize('config', [SINGLE, MULTI], ids=['single', 'multi'])
AGREES = 'the outputs agree with output_encoder'


def disagrees(encoder, rotor):
    encoder, rotor = (pytest.approx(degrees, abs=5e-3) for degrees in (encoder, rotor))
    return Condition.DISAGREES(encoder_deg=encoder, rotor_deg=rotor)


@cache
def recorded(config, *, start=0.2, error=0.0, gap=0.0):
    """Messages of a node beside a gear that rests and swings, twice; after a gap, turned unseen.

    The node has heard an encoder that is off by an error; the one that is recorded is not.
    """
    messages, noise = [], np.random.default_rng(1).uniform(-1e-4, 1e-4, len(TIMES))
    for k, time in enumerate(TIMES):
        late = k >= len(TIMES) // 2
        swung = 0.4 * math.sin(math.pi * max(0.0, time % 2.0 - 1.0)) ** 2
        angle = start + swung + 3.3 * STEP * late * (gap > 0.0)
        stamp = START + round((time + gap * late) * SECOND)
        rotor = -19.0 * angle + (77.0 if not config.single_turn else 0.0)
        rotor = rotor if not config.single_turn else rotor % math.tau
        measured = float(angle + noise[k]) % math.tau
        messages.append((ROTOR, stamp, rotor_bytes(stamp, position=[rotor])))
        messages.append((ENCODER, stamp, rotor_bytes(stamp, ['shaft'], [measured + error])))
    outputs = answered(config, messages)
    if error:
        true = recorded(config, start=start, gap=gap)
        outputs = [t if t[0] == ENCODER else o for t, o in zip(true, outputs, strict=True)]
    return outputs


UNJUDGED = 'the reference is not judged: no recorded output_encoder determines the turns'


def judge(messages, config, encoder=ENCODER, **options):
    if not encoder:
        messages = [message for message in messages if message[0] != ENCODER]
    return validate(messages, config, encoder=encoder, **options)


def part(messages, begin, end=6.0):
    """Return what is recorded from one time to another, s."""
    return [m for m in messages if begin <= (m[1] - START) / SECOND < end]


@BOTH
def test_outputs_on_another_topic_are_not_their_own_encoder(tmp_path, config):
    """Those of an actuator of an arm have the name of the encoder's joint by default."""
    config = replace(config, output_encoder_joint=config.output_joint)
    types = {ROTOR: JOINT_STATE, '/arm/states': JOINT_STATE, POSES: TYPES[POSES]}
    messages = [
        (topic.replace(OUTPUT, '/arm/states'), *rest)
        for topic, *rest in recorded(config, error=STEP)
        if topic in {ROTOR, OUTPUT, POSES}
    ]
    bag = write_bag(tmp_path / 'bag', messages, types)
    assert texts(validate_bag(Task(bag, config, output_topic='/arm/states'))) == [UNJUDGED]


def test_of_two_encoders_it_is_that_in_the_namespace_of_the_outputs(tmp_path):
    """The rotors of both nodes are in another one."""
    messages = []
    for topic, *rest in recorded(SINGLE):
        messages.append(('/motors/left' if topic == ROTOR else f'/left{topic}', *rest))
        if topic == ENCODER:
            off = rotor_bytes(rest[0], ['shaft'], [0.2 - STEP])
            messages.append((f'/right{ENCODER}', rest[0], off))
    types = {topic: TYPES.get(topic.removeprefix('/left'), JOINT_STATE) for topic, *_ in messages}
    bag = write_bag(tmp_path / 'bag', messages, types)
    assert texts(validate_bag(Task(bag, SINGLE))) == [AGREES]
    assert not validate_bag(Task(bag, SINGLE, encoder_topic=f'/right{ENCODER}')).passed


@pytest.mark.parametrize(
    ('start', 'strict'),
    [
        (float(start), k % 2 > 0)
        for k, start in enumerate(np.random.default_rng(3).uniform(-3.0, 3.0, 4))
    ],
)
@BOTH
def test_the_turn_of_the_recorded_encoder_passes(config, start, strict):
    messages = recorded(config, start=start)
    report = judge(messages, config, strict=strict)
    assert (report.verdict, texts(report)) == (Verdict.PASS, [AGREES])
    assert judge(messages, config, strict=strict, independent=True).passed
    # So does a recording that begins later, whose outputs were referenced before.
    report = judge(part(messages, 1.0), config, strict=strict, independent=True)
    assert report.verdict == Verdict.PASS
    assert AGREES in texts(report)
    # Without the parameter, the change has no reason.
    assert not judge(messages, replace(config, output_encoder_reference='none')).passed


@BOTH
def test_the_range_of_the_output_decides_which_turn_is_right(config):
    start = math.radians(250.0)
    limited = replace(config, output_range=(0.0, math.radians(275.0)))
    report = judge(recorded(limited, start=start), limited)
    assert (report.verdict, texts(report)) == (Verdict.PASS, [AGREES])
    report = judge(recorded(config, start=start), limited)
    [found] = [f.values['disagreement'] for f in report.findings if f.fails]
    assert found == disagrees(250.0, -110.0)


@BOTH
def test_a_second_reference_after_a_gap_passes(config):
    report = judge(recorded(config, gap=1.5), config)
    assert report.verdict == Verdict.PASS
    assert AGREES in texts(report)


@BOTH
def test_without_the_recorded_encoder_the_reference_is_not_judged(config):
    for error in (0.0, STEP):
        report = judge(recorded(config, error=error), config, encoder='')
        assert report.verdict == Verdict.PASS
        assert UNJUDGED in texts(report)
    few = [m for m in recorded(config) if m[0] != ENCODER or (m[1] - START) % (300 * MS) == 0]
    report = judge(few, config)
    assert report.verdict == Verdict.PASS
    assert texts(report) == [UNJUDGED]


def spliced(config):
    """A node that is referenced rightly, and jumps by a turn at 2 s."""
    messages, wrong = recorded(config), recorded(config, error=STEP)
    return [m if m[1] < START + 2 * SECOND else w for m, w in zip(messages, wrong, strict=True)]


def last_one_off(config):
    *others, (topic, received, data), poses, measured = recorded(config)
    data = edited(data, JOINT_STATE, lambda m: setattr(m, 'position', m.position + 1e-6))
    return [*others, (topic, received, data), poses, measured]


def never_referenced(config):
    return answered(
        replace(config, output_encoder_reference='none'), both_encoders(recorded(config))
    )


LAST = 'only the last output is off'
wrong_turn, wrong_zero = partial(recorded, error=STEP), partial(recorded, error=0.5)


@pytest.mark.parametrize(
    ('config', 'make', 'begin', 'faults'),
    [  # The output rests at 0.2 rad = 11.46°; a turn of the rotor is 18.95° of it.
        (SINGLE, wrong_turn, 0.0, [disagrees(11.46, 30.41)]),
        (SINGLE, wrong_turn, 1.9, [disagrees(11.46, 30.41)]),
        (SINGLE, partial(wrong_turn, gap=1.5), 0.0, [disagrees(11.46, 30.41)]),
        (SINGLE, spliced, 0.0, []),  # it jumps again, without a gap
        (SINGLE, spliced, 1.95, [disagrees(11.46, 30.41)]),
        (MULTI, wrong_zero, 0.0, [disagrees(11.46, 40.11)]),
        (MULTI, wrong_zero, 0.9, [disagrees(11.46, 40.11)]),
        (SINGLE, never_referenced, 0.0, [disagrees(11.46, -7.49)]),
        (MULTI, never_referenced, 0.0, [disagrees(-348.54, -220.74)]),
        (MULTI, last_one_off, 0.5, [LAST]),
    ],
)
def test_what_the_recorded_encoder_contradicts_fails(config, make, begin, faults):
    report = judge(part(make(config), begin), config)
    assert report.verdict == Verdict.FAIL
    failing = [found for found in report.findings if found.fails]
    assert [f.values.get('disagreement') or sentence(f) for f in failing] == faults


def test_a_second_jump_differs_independently():
    assert not judge(spliced(SINGLE), SINGLE, independent=True).independent.passed


def test_a_jump_by_no_turn_of_the_rotor_differs_independently():
    off = partial(
        edited, kind=JOINT_STATE, edit=lambda m: setattr(m, 'position', m.position + 0.3)
    )
    messages = [
        (topic, received, off(data) if topic == OUTPUT and received > START + 2 * SECOND else data)
        for topic, received, data in part(recorded(SINGLE), 1.5)
        if topic != POSES
    ]
    assert not judge(messages, SINGLE, independent=True).independent.passed


@pytest.mark.parametrize('strict', [False, True])
@BOTH
def test_a_driver_that_starts_again_is_referenced_again(config, strict):
    """By the time since its start, and a multi-turn encoder at another zero."""

    def again(message):
        message.header.stamp.sec -= START // SECOND - 10
        if message.name[0] != 'shaft' and not config.single_turn:
            message.position += 200.0

    messages = [
        (
            topic,
            received,
            data if received < START + 2 * SECOND else edited(data, JOINT_STATE, again),
        )
        for topic, received, data in both_encoders(recorded(config))
    ]
    report = judge(answered(config, messages), config, strict=strict, independent=True)
    assert report.passed
    assert report.independent.passed


@pytest.mark.parametrize('seed', range(8))
@BOTH
def test_losses_of_the_recorder_fail_nothing(config, seed):
    rng = random.Random(seed)  # noqa: S311, of faults, not of secrets
    messages = [
        Message(topic, received + rng.randrange(MS) * (topic != ROTOR), data)
        for topic, received, data in recorded(config, gap=1.5)
    ]
    messages.sort(key=lambda message: message.received)
    begin, late = START + rng.choice([-SECOND, 0, SECOND]), rng.choice([0.004, 0.03, 0.4])
    end = messages[-1].received - rng.choice([SECOND // 3, -SECOND])
    report = judge(record(messages, rng, begin=begin, end=end, late=late), config)
    assert report.verdict == Verdict.PASS
    assert AGREES in texts(report)


@BOTH
def test_a_pose_recorded_before_its_output_is_not_judged_by_the_zero_before(config):
    """A batch ends between pose and output of the first sample that is referenced."""
    messages = recorded(config)
    others = answered(replace(config, output_encoder_reference='none'), both_encoders(messages))
    first = next(
        k for k, pair in enumerate(zip(messages, others, strict=True)) if len(set(pair)) > 1
    )
    assert (messages[first][0], messages[first + 1][0]) == (OUTPUT, POSES)
    swapped = [*messages[:first], messages[first + 1], messages[first], *messages[first + 2 :]]
    validator = Validator(Task(Path('bag'), config), encoder=ENCODER)
    for part in (swapped[: first + 1], swapped[first + 1 :]):
        validator.take(MessagesByTopic(validator.topics, part))
    report = validator.report()
    assert (report.verdict, texts(report)) == (Verdict.PASS, [AGREES])


def both_encoders(messages):
    return [message for message in messages if message[0] in (ROTOR, ENCODER)]


def inputs(folder, config, **motion):
    """Write a bag of both encoders, and the parameters beside it."""
    kinds = dict.fromkeys((ROTOR, ENCODER), JOINT_STATE)
    write_bag(folder / 'inputs', both_encoders(recorded(config, **motion)), types=kinds)
    (folder / 'inputs' / 'actuator.yaml').write_text(config.as_file(), 'utf-8')
    return folder / 'inputs'


@BOTH
def test_a_computed_bag_has_the_outputs_of_the_node_and_passes(tmp_path, config):
    gearkin_here('compute', inputs(tmp_path, config, gap=1.5), tmp_path / 'out')
    computed, messages = read_bag(tmp_path / 'out'), recorded(config, gap=1.5)
    for topic in (*TYPES, ENCODER):
        assert [m for m in computed if m[0] == topic] == [m for m in messages if m[0] == topic]
    done = gearkin_here('validate', tmp_path / 'out')
    assert (done.returncode, AGREES in done.stdout) == (0, True)


def test_of_two_other_encoders_one_is_named(tmp_path):
    """That of another shaft comes first."""
    one, other = '/bench/output_encoder', '/arm/output_encoder'
    messages = []
    for topic, *rest in both_encoders(recorded(SINGLE)):
        if topic == ENCODER:
            stamp = rest[0]
            messages.append((other, stamp, rotor_bytes(stamp, ['shaft'], [0.2 - STEP])))
        messages.append((one if topic == ENCODER else topic, *rest))
    types = dict.fromkeys((ROTOR, one, other), JOINT_STATE)
    bag, out = write_bag(tmp_path / 'bag', messages, types), tmp_path / 'out'
    (bag / 'actuator.yaml').write_text(SINGLE.as_file(), 'utf-8')
    assert f'{other}, {one}; name it with --encoder-topic' in refusal('compute', bag, out)
    assert gearkin_here('compute', bag, out, '--encoder-topic', one).returncode == 0
    for given, agrees in (one, True), (other, False):
        done = gearkin_here('validate', out, '--encoder-topic', given)
        assert (done.returncode == 0, AGREES in done.stdout) == (agrees, agrees)


@pytest.mark.parametrize('command', ['compute', 'validate'])
def test_an_encoder_topic_that_is_not_recorded_is_refused(tmp_path, command):
    """Even where the parameters need none."""
    bags = [BAGS / 'servo_point_to_point', tmp_path / 'out'][: 1 + (command == 'compute')]
    done = gearkin_here(command, *bags, '--encoder-topic', '/none')
    assert done.returncode == 2
    assert 'no topic /none of type' in done.stdout + done.stderr


@pytest.mark.live
@BOTH
def test_a_live_node_is_played_both_encoders_and_judged(tmp_path, config):
    task = Task(inputs(tmp_path, config, gap=1.5), config)
    report = validate_bag(task, play=live_messages)
    assert (report.verdict, report.error) == (Verdict.PASS, None)
    assert AGREES in texts(report)
