# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings with one thing changed: each change is found, named and located."""

import math
import re
import struct
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import replaying
from live import rotor_bytes
from made_bags import folder, mcap_file
from node_loop import answered
from replaying import SECOND, edited
from shipped_bags import BAGS, JOINT_STATE, OUTPUT, POSES, ROTOR, TYPES, config_of, read_bag
from validating import feed, field_of, texts, topic_of, validate

from gear_kinematics.bag import Message
from gear_kinematics.bag.roles import Topics
from gear_kinematics.report.document import Verdict
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.document import moving
from gear_kinematics.validation.findings import findings, sentence
from gear_kinematics.validation.matching import WINDOW
from gear_kinematics.validation.task import Task, Tolerances
from gear_kinematics.validation.validate_bag import validate_bag
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.batches import FIELDS

CHANGED = 100
"""Number of the changed message of a topic."""


def change_one(messages: list[Message], topic: str, edit: Callable) -> tuple[list[Message], int]:
    """Change one message of a topic; also return its original stamp."""
    place = index_of(messages, topic)
    _, received, data = messages[place]
    changed = topic, received, edited(data, TYPES[topic], edit)
    stamp = replaying.stamp_of(replaying.decode(data, TYPES[topic]))
    return [*messages[:place], changed, *messages[place + 1 :]], stamp


def change_all(messages: list[Message], topic: str, edit: Callable) -> list[Message]:
    return [
        (name, received, edited(data, TYPES[topic], edit) if name == topic else data)
        for name, received, data in messages
    ]


def index_of(messages: list[Message], topic: str, number: int = CHANGED) -> int:
    return [k for k, (name, _, _) in enumerate(messages) if name == topic][number - 1]


@pytest.mark.parametrize('make', [
    folder,
    partial(folder, storage='sqlite3'),
    partial(mcap_file, use_chunking=False),  # as with --storage-preset-profile fastwrite
], ids=['mcap', 'sqlite3', 'fastwrite'])  # fmt: skip
def test_a_simulation_that_is_reset_while_it_is_recorded_is_judged_as_the_node_saw_it(
    tmp_path, make
):
    """Its stamps and, with --use-sim-time, the times of reception begin anew."""
    first = read_bag(BAGS / 'servo_point_to_point')
    back = 5_003_000  # ns: the second run begins so much earlier than the first

    def shifted(message) -> None:
        set_stamp(message, replaying.stamp_of(message) - back)

    again = [
        (topic, received - back, edited(data, TYPES[topic], shifted))
        for topic, received, data in first
    ]
    path = make(tmp_path / 'bag', first + again)
    report = validate_bag(Task(path, config_of('servo_point_to_point')))
    assert (report.verdict, report.rotor.resets) == (Verdict.PASS, 1)
    assert [topic.compared for topic in report.topics] == [6000, 6000]
    duration = (first[-1][1] - first[0][1] + back) / SECOND
    (found,) = [text for text in texts(report) if 'the clock was set back' in text]
    assert float(found.split('at least ')[1].split(' s')[0]) == pytest.approx(duration, rel=0.01)


@pytest.mark.parametrize('topic', [ROTOR, OUTPUT])
@pytest.mark.parametrize('anew', ['by reception', 'in µs'])
def test_topics_that_were_stamped_anew_are_named(topic, anew):
    """As by a program that converts, relays or filters one of the two."""
    messages = [m for m in read_bag(BAGS / 'servo_point_to_point')[:900] if m[0] != POSES]

    def stamped(message, received) -> None:
        stamp = replaying.stamp_of(message)
        set_stamp(message, received if anew == 'by reception' else stamp // 1000 * 1000)

    changed = [
        (name, received, edited(data, TYPES[name], partial(stamped, received=received)))
        if name == topic
        else (name, received, data)
        for name, received, data in messages
    ]
    report = validate(changed, config_of('servo_point_to_point'), Topics(poses=''))
    assert report.verdict == Verdict.FAIL
    first, *_ = findings(report)
    assert 'no message has the stamp of an input on /rotor_state' in first.text


def set_stamp(message, stamp: int) -> None:
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)


@pytest.mark.parametrize(
    ('name', 'messages', 'compared'),
    [
        ('servo_point_to_point', 9000, 3000),
        ('constant_speed_3000rpm', 9000, 3000),
        ('single_turn_encoder', 7500, 2500),
        ('driver_faults', 1314 + 2 * 1265, 1265),
    ],
)
def test_shipped_recordings_pass(name, messages, compared):
    config = config_of(name)
    tolerances = Tolerances(1e-12, 1e-12 * 0.0011, 1e-12, 1e-12)
    recorded = read_bag(BAGS / name)
    report = validate(recorded, config, tolerances=tolerances)
    assert report.verdict == Verdict.PASS
    assert report.messages == messages
    assert [t.compared for t in report.topics] == [compared, compared]
    assert [t.missing + t.extra + t.out_of_order for t in report.topics] == [0, 0]
    assert report.gear_ratio == '-19'
    # The node recorded these outputs of a mechanism with this ratio, which is enough.
    report = validate(recorded, replace(config, gear_ratio='-19'), tolerances=tolerances)
    assert report.verdict == Verdict.PASS
    assert [(t.topic, t.compared) for t in report.topics] == [(OUTPUT, compared)]
    assert report.mechanism is None


def test_the_input_is_described(config):
    rotor = validate(read_bag(BAGS / 'driver_faults'), config).rotor
    assert (rotor.messages, rotor.valid, rotor.of_others) == (1314, 1265, 12)
    assert rotor.rate == pytest.approx(500.0, rel=0.01)
    assert rotor.duration == pytest.approx(3.0, abs=0.01)
    assert rotor.gaps == 2
    assert [gap.seconds for gap in rotor.longest_gaps] == pytest.approx([0.302, 0.122], abs=0.004)
    single = replace(config, rotor_encoder='single_turn', max_rotor_speed=2000.0)
    report = validate(read_bag(BAGS / 'driver_faults'), single)
    assert report.rotor.jumps > 0
    assert not report.rotor.referenced
    assert any('hide a turn' in text for text in texts(report))


def add(field: str, difference: float):
    def edit(message) -> None:
        getattr(message, field)[0] += difference

    return edit


def move(body: int, axis: str, difference: float):
    def edit(message) -> None:
        position = message.poses[body].position
        setattr(position, axis, getattr(position, axis) + difference)

    return edit


def turn(body: int, angle: float):
    def edit(message) -> None:
        q = message.poses[body].orientation
        half = math.atan2(q.z, q.w) + 0.5 * angle
        q.z, q.w = math.sin(half), math.cos(half)

    return edit


@pytest.mark.parametrize(
    ('topic', 'field', 'edit', 'error'),
    [
        (OUTPUT, 'position', add('position', 2e-9), 2e-9),
        (OUTPUT, 'velocity', add('velocity', 2e-9), 2e-9),
        (OUTPUT, 'effort', add('effort', 2e-9), 2e-9),
        (POSES, 'position', move(0, 'x', 2e-9), 2e-9),
        (POSES, 'position', move(2, 'z', -2e-9), 2e-9),
        (POSES, 'position', move(3, 'x', 2e-9), 2e-9),
        (POSES, 'orientation', turn(3, 2e-9), 2e-9),
    ],
)
def test_a_value_that_is_off_by_2e_9_is_found_and_located(
    recorded, config, topic, field, edit, error
):
    changed, stamp = change_one(recorded, topic, edit)
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    found = field_of(report, topic, field)
    assert not found.passed
    assert found.max_error == pytest.approx(error, rel=0.05)
    assert found.rms_error == pytest.approx(error / math.sqrt(found.compared), rel=0.05)
    assert found.worst_stamp == stamp
    index = index_of(recorded, ROTOR)
    rotor = replaying.decode(recorded[index][2], JOINT_STATE)
    assert found.worst_rotor_angle == rotor.position[0]
    failed = [f.name for t in report.topics for f in t.fields if not f.passed]
    assert failed == [field]
    assert not report.causes
    [said] = [f.text for f in findings(report)]
    [quantity] = re.findall(r'exceeds the tolerance of the (\w+), 1e-9 \S+, at ', said)
    # One tolerance for each quantity, which loosens no other.
    loose = Tolerances(*[1.0] * 4)
    assert validate(changed, config, tolerances=Tolerances()._replace(**{quantity: 3e-9})).passed
    assert not validate(changed, config, tolerances=loose._replace(**{quantity: 1e-9})).passed


def fill(field: str, value: float):
    return lambda message: getattr(message, field).fill(value)


def without_effort(message) -> None:
    message.effort = np.zeros(0)


@pytest.mark.parametrize(
    ('topic', 'field', 'edit', 'event'),
    [
        (OUTPUT, 'position', fill('position', math.nan), 'not finite'),
        (OUTPUT, 'velocity', fill('velocity', math.inf), 'not finite'),
        (POSES, 'position', move(2, 'y', math.nan), 'not finite'),
        (POSES, 'position', move(2, 'y', math.inf), 'not finite'),
        (POSES, 'orientation', turn(2, math.nan), 'not finite'),
        (OUTPUT, 'effort', without_effort, 'absent'),
        (ROTOR, 'effort', without_effort, 'absent'),
    ],
)
def test_a_value_that_is_not_finite_or_absent_is_found(
    recorded, config, topic, field, edit, event
):
    changed, stamp = change_one(recorded, topic, edit)
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    topic = OUTPUT if topic == ROTOR else topic
    found = field_of(report, topic, field)
    expected = [(1, stamp), (0, None)] if event == 'not finite' else [(0, None), (1, stamp)]
    assert [
        (found.non_finite, found.first_non_finite),
        (found.absent, found.first_absent),
    ] == expected
    shown = moving(report)
    moment = (stamp - report.rotor.first_stamp) / SECOND
    assert shown.time[shown.start] == pytest.approx(moment)


def without_velocity(message) -> None:
    message.velocity = np.zeros(0)


def with_velocity_0(message) -> None:
    message.velocity = np.zeros(1)


def in_rpm(message) -> None:
    message.velocity = message.velocity * 30.0 / math.pi


@pytest.mark.parametrize(('name', 'rotor', 'outputs', 'passes'), [
    # An effort of 0: the node saw a motion without effort before, or a torque.
    ('servo_point_to_point', fill('effort', 0.0), without_effort, True),
    ('servo_point_to_point', fill('effort', 0.0), fill('effort', -0.0), True),
    ('servo_point_to_point', fill('effort', 0.0), fill('effort', 1.0), False),
    ('servo_point_to_point', fill('effort', 1.0), without_effort, False),
    # Velocities that contradict: the node saw a steady motion before.
    ('constant_speed_3000rpm', in_rpm, without_velocity, True),
    ('constant_speed_3000rpm', in_rpm, in_rpm, False),
    ('constant_speed_3000rpm', lambda _: None, without_velocity, False),
])  # fmt: skip
def test_what_values_mean_can_be_known_from_before_the_recording(
    config, name, rotor, outputs, passes
):
    changed = change_all(read_bag(BAGS / name), ROTOR, rotor)
    report = validate(change_all(changed, OUTPUT, outputs), config)
    assert (report.verdict == Verdict.PASS) is passes


@pytest.mark.parametrize(
    ('topic', 'edit', 'passes'),
    [
        (OUTPUT, without_velocity, True),
        (OUTPUT, with_velocity_0, False),
        (ROTOR, fill('velocity', 1e-6), False),
    ],
)
def test_zeros_for_velocities_may_have_been_known_from_before_a_short_recording(
    recorded, config, topic, edit, passes
):
    """The node saw the rotor move before, without a velocity; one message is edited."""
    zeros = change_all(recorded[:600], ROTOR, fill('velocity', 0.0))
    changed, _ = change_one(change_all(zeros, OUTPUT, without_velocity), topic, edit)
    report = validate(changed, config)
    assert not report.rotor.velocity_is
    assert (report.verdict == Verdict.PASS) is passes


@pytest.mark.parametrize(('effort', 'named'), [
    (0.0, 'the effort is 0 throughout the motion, and is taken as absent'),
    (-1500.0, 'efforts of up to 1500 N·m at the rotor'), (5.0, ''),
])  # fmt: skip
def test_efforts_that_are_no_torques_are_named(recorded, config, effort, named):
    report = validate(change_all(recorded, ROTOR, fill('effort', effort)), config)
    assert report.rotor.effort_is[: len(named) or None] == named


@pytest.mark.parametrize('value', [1.4e154, -1e200, 1.7976931348623157e308, 5e-324])
@pytest.mark.parametrize('topic', [ROTOR, OUTPUT])
@pytest.mark.parametrize('field', FIELDS)
def test_garbage_in_one_number_is_an_error_of_that_number(recorded, config, topic, field, value):
    """As from a flipped bit: nothing overflows, and everything else is compared."""
    changed, stamp = change_one(recorded, topic, fill(field, value))
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    assert sum(t.compared for t in report.topics) >= 598
    worst = {f.worst_stamp for t in report.topics for f in t.fields if not f.passed}
    assert worst <= {stamp, None}
    assert not any('times the expected one' in text for text in texts(report))


def swapped(messages: list[Message], one: int, other: int) -> list[Message]:
    swapped = list(messages)
    swapped[one], swapped[other] = messages[other], messages[one]
    return swapped


@pytest.mark.parametrize('topic', [OUTPUT, POSES])
def test_messages_that_were_lost_repeated_swapped_or_restamped_are_counted(
    recorded, config, topic
):
    index, after = index_of(recorded, topic), index_of(recorded, topic, CHANGED + 1)
    _, stamp = change_one(recorded, topic, lambda _: None)
    restamped, _ = change_one(recorded, topic, lambda m: set_stamp(m, stamp + 1))
    none = {'missing': 0, 'extra': 0, 'duplicates': 0, 'out_of_order': 0}
    for changed, counts in (
        (recorded[:index] + recorded[index + 1 :], {'missing': 1, 'first_missing': stamp}),
        (
            recorded[: index + 1] + recorded[index:],
            {'extra': 1, 'duplicates': 1, 'first_extra': stamp},
        ),
        (swapped(recorded, index, after), {'out_of_order': 1, 'first_out_of_order': stamp}),
        (restamped, {'missing': 1, 'extra': 1, 'first_missing': stamp, 'first_extra': stamp + 1}),
    ):
        report = validate(changed, config)
        found = topic_of(report, topic)
        assert {name: getattr(found, name) for name in none | counts} == none | counts
        assert found.compared == 300 - counts.get('missing', 0)
        assert report.verdict == Verdict.FAIL


def test_outputs_for_inputs_without_stamps_are_matched_in_their_order(recorded, config):
    """The node gives both outputs the time at which it takes the input, here up to 3 ms later."""
    late = iter(np.random.default_rng(1).integers(0, 3_000_000, 300).cumsum() // 100)
    stamps = {}

    def by_the_node(message) -> None:
        stamp = message.header.stamp.sec * SECOND + message.header.stamp.nanosec
        set_stamp(message, stamps.get(stamp) or stamps.setdefault(stamp, stamp + int(next(late))))

    live = change_all(recorded, ROTOR, lambda message: set_stamp(message, 0))
    live = change_all(change_all(live, OUTPUT, by_the_node), POSES, by_the_node)
    rotor, output, poses = (index_of(live, topic) for topic in (ROTOR, OUTPUT, POSES))
    wrong, stamp = change_one(live, OUTPUT, lambda message: message.position.__setitem__(0, 3.0))
    for messages, compared, missing in (
        (live, 300, 0),
        (live[:rotor] + live[rotor + 1 :], 299, 0),
        ([m for k, m in enumerate(live) if k not in {output, poses}], 299, 1),
        (wrong, 300, 0),
    ):
        for size in (8192, 50):
            validator = Validator(Task(Path('bag'), config))
            feed(validator, messages, size)
            report = validator.report()
            for topic in report.topics:
                found = topic.compared, topic.missing, topic.extra
                assert found == (compared, missing, 0)
            assert report.passed == (messages is not wrong and not missing)
            assert 'in their order' in ' '.join(texts(report))
    assert field_of(report, OUTPUT, 'position').worst_stamp == stamp


@pytest.mark.parametrize('unit', [10**3, 10**6])
def test_nanoseconds_that_are_in_another_unit_are_named(recorded, config, unit):
    first = struct.unpack_from('<i', recorded[0][2], 4)[0]

    def over_seconds(message):
        stamp = message.header.stamp
        set_stamp(message, 10 * (SECOND * (stamp.sec - first) + stamp.nanosec))

    def in_unit(message):
        over_seconds(message)
        message.header.stamp.nanosec //= unit

    spread, whole = recorded, recorded
    for topic in TYPES:
        spread, whole = change_all(spread, topic, over_seconds), change_all(whole, topic, in_unit)
    text = 'never reach a thousandth of a second'
    assert text in ' '.join(texts(validate(whole, config)))
    assert text not in ' '.join(texts(validate(spread, config)))


def test_stamps_that_lost_their_nanoseconds_are_named_as_the_cause(recorded, config):
    whole = recorded
    for topic in TYPES:
        whole = change_all(whole, topic, lambda m: set_stamp(m, m.header.stamp.sec * SECOND))
    seconds = {struct.unpack_from('<i', data, 4) for _, _, data in recorded}
    text = f'{300 - len(seconds)} of 300 stamps of /rotor_state repeat the one before, as if'
    report = validate(whole, config)
    assert report.passed
    assert not report.causes
    assert text in texts(report)[0]
    lost = range(index_of(whole, OUTPUT), index_of(whole, OUTPUT, CHANGED + 10))
    kept = [message for k, message in enumerate(whole) if k not in lost or message[0] != OUTPUT]
    report = validate(kept, config)
    assert not report.passed
    assert report.causes[0].cause == FindingCause.REPEATED_STAMPS
    assert text in texts(report)[0]
    assert not any('repeat' in text for text in texts(validate(recorded, config)))


@pytest.mark.parametrize(
    ('topic', 'edit', 'text'),
    [
        (
            POSES,
            lambda message: setattr(message.header, 'frame_id', 'base'),
            "frame 'base', not 'stator': 1 message, the first at {time:+.3f} s",
        ),
        (
            POSES,
            lambda message: message.poses.pop(),
            'malformed: 1 message, the first received at {received}',
        ),
    ],
)
def test_what_is_wrong_with_one_message_is_named(recorded, config, topic, edit, text):
    changed, stamp = change_one(recorded, topic, edit)
    report = validate(changed, config)
    assert not report.passed
    received = recorded[index_of(recorded, topic)][1]
    time = (stamp - report.rotor.first_stamp) / SECOND
    text = text.format(time=time, received=received)
    (found,) = (f for f in findings(report) if f.text.removeprefix(f'{topic}: ') == text)
    assert found.time == (pytest.approx(time) if f'{time:+.3f} s' in text else None)


@pytest.mark.parametrize(
    ('changes', 'verdict', 'words'),
    [
        ({'rotor_direction': -1}, Verdict.FAIL, 'the sign is flipped'),
        ({'ring_teeth': 81}, Verdict.FAIL, 'ratio is -19, not -76/5: it is that of ring_teeth 80'),
        (
            {'satellite_teeth': 77},
            Verdict.FAIL,
            'ratio is -19, not -77/3: it is that of ring_teeth',
        ),
        ({'ring_teeth': 61, 'satellite_teeth': 58}, Verdict.FAIL, 'the recorded ratio is -19'),
        ({'gear_ratio': '-58/3'}, Verdict.FAIL, ', not -58/3'),
        ({'max_rotor_speed': 10.0}, Verdict.FAIL, 'max_rotor_speed'),
    ],
)
def test_what_does_not_fit_the_parameters_is_named(recorded, config, changes, verdict, words):
    report = validate(recorded, replace(config, **changes))
    assert report.verdict == verdict
    others = re.compile('is not judged|: rejected: implausible')
    assert {words in text for text in texts(report) if not others.search(text)} == {True}


def scale(field: str, factor: float):
    return lambda message: getattr(message, field).__imul__(factor)


@pytest.mark.parametrize(
    ('topic', 'edit', 'words'),
    [
        (OUTPUT, scale('position', -1.0), 'the sign is flipped: the recorded output turns'),
        (OUTPUT, scale('position', math.pi), f'the recorded ratio is {-19.0 / math.pi:.8f}'),
        (OUTPUT, scale('velocity', 180.0 / math.pi), 'velocity is 57.2958 times the expected one'),
        (OUTPUT, scale('effort', -1.0), 'the recorded effort is -1 times the expected one'),
    ],
)
def test_what_is_wrong_with_all_messages_is_named(recorded, config, topic, edit, words):
    report = validate(change_all(recorded, topic, edit), config)
    assert report.verdict == Verdict.FAIL
    (cause,) = report.causes
    assert words in sentence(cause)
    # The cause comes before its effects, and once.
    first, *others = [finding.text for finding in findings(report)]
    assert first.startswith(sentence(cause))
    assert first not in others
    assert any('exceeds the tolerance' in text for text in others)


def test_an_offset_of_the_output_angle_alone_is_named(recorded, config):
    report = validate(change_all(recorded, OUTPUT, add('position', 0.125)), config)
    assert not report.passed
    moved = 'from the start, output angles are shifted by 0.125 rad, as by another rotor_zero'
    assert texts(report) == [moved]
    assert [topic.passed for topic in report.topics] == [True, False]


def test_a_prefix_is_that_of_the_parameters_or_the_one_that_all_outputs_have(recorded, config):
    def prefixed(message) -> None:
        message.header.frame_id = 'left_stator'

    def renamed(message) -> None:
        message.name = ['left_output_shaft']

    with_frames = change_all(recorded, POSES, prefixed)
    with_both = change_all(with_frames, OUTPUT, renamed)
    report = validate(with_both, config)
    assert report.verdict == Verdict.PASS
    assert texts(report) == ["frame_prefix 'left_' is taken from the outputs"]
    (output, poses) = validate(with_frames, config).topics
    assert (len(output.faults), poses.passed) == (1, True)
    assert "no joint 'left_output_shaft' (output_joint?), but " in sentence(output.faults[0])
    assert output.wrong == output.compared > 0
    for messages, prefix in ((with_both, 'right_'), (recorded, 'left_')):
        report = validate(messages, replace(config, frame_prefix=prefix))
        assert report.verdict == Verdict.FAIL
        assert all(topic.faults for topic in report.topics)


@pytest.mark.parametrize('changes', [{}, {'gear_ratio': '-19'}])
def test_the_offset_that_homing_leaves_passes_and_is_said(recorded, config, changes):
    """A node that was homed before the recording has another zero than the configuration."""
    homed = replace(config, rotor_zero=0.75, rotor_direction=1, **changes)
    report = validate(recorded, homed)
    assert report.verdict == Verdict.PASS
    *unjudged, said = texts(report)
    poses = f'{POSES} is not judged: only the ratio of the gear is known'
    assert unjudged == [poses] * bool(changes)
    assert said.startswith(f'from the start, output angles are shifted by {-0.75 / 19:.9g}')
    assert said.endswith(' rad, as by another rotor_zero')
    failed = validate(recorded, homed, strict=True)
    assert failed.verdict == Verdict.FAIL
    assert not any(topic.passed for topic in failed.topics)
    # A step at half time, as by homing during the recording, is no constant offset.
    step = change_all(recorded[450:], OUTPUT, add('position', 0.125))
    failed = validate(recorded[:450] + step, homed)
    assert failed.verdict == Verdict.FAIL
    causes = [finding.cause for finding in failed.findings if finding.explains]
    assert causes == [FindingCause.CHANGED]


@pytest.mark.parametrize('moved', [0.0, 1.0])
def test_outputs_are_in_the_range_in_which_homing_before_the_recording_put_them(
    recorded, config, moved
):
    """By the zero of the configuration, they would be outside of it by 1 rad."""
    messages = [data for topic, _, data in recorded if topic == OUTPUT]
    angles = [replaying.decode(data, JOINT_STATE).position[0] for data in messages]
    span = min(angles) + moved, max(angles) + moved
    report = validate(recorded, replace(config, rotor_zero=19.0, output_range=span))
    assert bool(report.rotor.outside) == bool(moved)
    assert report.passed


@pytest.mark.parametrize('change', [{'rotor_direction': -1}, {'rotor_zero': 2.0}])
def test_a_parameter_that_was_changed_while_the_node_ran_is_the_likely_cause(
    recorded, config, change
):
    rotor = [message for message in recorded if message[0] == ROTOR]
    before, after = (answered(each, rotor) for each in (config, replace(config, **change)))
    begin = rotor[200][1]
    messages = [m for m in before if m[1] < begin] + [m for m in after if m[1] >= begin]
    stamp = replaying.stamp_of(replaying.decode(rotor[200][2], JOINT_STATE))
    for given, expected in (
        (config, FindingCause.CHANGED),
        (replace(config, **change), FindingCause.CHANGED_TO_GIVEN),
    ):
        report = validate(messages, given, strict=True)
        assert not report.passed
        [cause] = [finding for finding in report.findings if finding.explains]
        assert (cause.cause, cause.stamp) == (expected, stamp)
    assert validate(before, config).passed


@pytest.mark.parametrize('encoder', ['multi_turn', 'single_turn'])
@pytest.mark.parametrize('place', [1, 100, 200, 299])
def test_homing_during_a_recording_passes_and_is_said(recorded, config, encoder, place):
    """In a batch and between two of them, at the first and at the last outputs."""
    config = replace(config, rotor_encoder=encoder, home_angle=0.25)
    rotor = [message for message in recorded if message[0] == ROTOR]
    messages = answered(config, rotor, home_after=place)
    validator = Validator(Task(Path('bag'), config))
    feed(validator, messages, 300)
    report = validator.report()
    assert report.verdict == Verdict.PASS
    position = replaying.decode(rotor[place - 1][2], JOINT_STATE).position[0]
    zero = position + 19 * 0.25  # there, the output is at the angle of homing
    [said] = [finding.text for finding in findings(report)]
    time = (rotor[place][1] - rotor[0][1]) / SECOND
    assert said.endswith(f' later outputs have the new zero, at {time:+.3f} s')
    assert not validate(messages, config, strict=True).passed
    # A step to another angle is no homing, nor is one of the output alone.
    assert not validate(messages, replace(config, home_angle=0.2)).passed
    position = add('position', zero / 19)
    outputs_alone = recorded[: 3 * place] + change_all(recorded[3 * place :], OUTPUT, position)
    assert not validate(outputs_alone, config).passed


def test_turns_that_a_loss_hid_after_homing_are_taken_from_the_outputs(config):
    """In one batch: the recorder misses 1 s, in which the rotor turns twice."""
    config = replace(config, rotor_encoder='single_turn', home_angle=0.25)
    driver = []
    for k in range(1500):
        stamp = 1_700_000_000 * SECOND + k * SECOND // 500
        position = [k * 0.8 * math.pi / 100 % math.tau]
        driver.append((ROTOR, stamp, rotor_bytes(stamp, position=position)))
    lost = {stamp for _, stamp, _ in driver[600:1100]}
    messages = [m for m in answered(config, driver, home_after=400) if m[1] not in lost]
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS
    assert 'the turns of the single-turn encoder are taken from the outputs' in texts(report)
    assert not validate(messages, replace(config, home_angle=0.2)).passed


def test_homing_that_ends_a_time_of_withheld_outputs_passes_and_is_said(config):
    """The turns are lost in a gap of 0.5 s, in which the rotor turns on at 2 rad/s."""
    config = replace(
        config, rotor_encoder='single_turn', unreferenced_outputs='withhold', home_angle=0.25
    )
    driver = []
    for k in [*range(300), *range(550, 900)]:
        stamp = 1_700_000_000 * SECOND + k * SECOND // 500
        position = [(3.0 + 0.004 * min(max(k - 150, 0), 500)) % math.tau]
        driver.append((ROTOR, stamp, rotor_bytes(stamp, position=position)))
    gear = GearState(config)
    messages = answered(config, driver[:400], home_after=100, gear=gear)
    messages += answered(config, driver[400:], home_after=500, gear=gear)
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS
    assert topic_of(report, OUTPUT).compared == 200 + 150
    assert any(text.startswith('the node was homed, and later') for text in texts(report))
    assert not validate(messages, replace(config, home_angle=0.15)).passed


def test_nothing_to_validate_is_unusable(recorded, config):
    for messages, word in (
        ([], 'rotor states'),
        ([m for m in recorded if m[0] != ROTOR], 'rotor states'),
        ([m for m in recorded if m[0] == ROTOR], 'no outputs in it: gearkin compute writes'),
    ):
        report = validate(messages, config)
        assert report.verdict == Verdict.UNUSABLE
        assert word in report.error


def test_outputs_recorded_before_their_inputs_match(recorded, config):
    """Messages in a bag are in the order of reception, which depends on the network."""
    early = sorted(recorded, key=lambda m: (m[1] // 20_000_000, m[0]))
    assert [m[0] for m in early] != [m[0] for m in recorded]
    assert validate(early, config).passed


@pytest.mark.parametrize('size', [50, 8192])
@pytest.mark.parametrize('later', [0, -15_000_000, 1])
def test_other_joints_on_the_topic_of_the_outputs_are_no_fault(recorded, config, later, size):
    """A gripper's driver on a shared /joint_states, by the stamps of the motor's or by its own."""
    shared = [
        (
            OUTPUT,
            received + k % 3,
            rotor_bytes(
                replaying.stamp_of(replaying.decode(data, JOINT_STATE)) + later, ['gripper'], [1.0]
            ),
        )
        for k, (topic, received, data) in enumerate(recorded)
        if topic == ROTOR
    ]
    missing = index_of(recorded, OUTPUT, 200)
    for messages, passes in (
        (recorded, True),
        (recorded[:missing] + recorded[missing + 1 :], False),
    ):
        validator = Validator(Task(Path('bag'), config))
        feed(validator, sorted(messages + shared, key=lambda message: message[1]), size)
        report = validator.report()
        assert report.passed is passes
        assert texts(report) == texts(validate(messages, config))
        assert topic_of(report, OUTPUT).compared == 299 + passes


def repeated(messages: list[Message], times: int, seconds: int) -> list[Message]:
    """Repeat a recording with increasing stamps."""
    long = []
    for k in range(times):
        for topic, received, data in messages:
            (second,) = struct.unpack_from('<i', data, 4)
            shifted = data[:4] + struct.pack('<i', second + k * seconds) + data[8:]
            long.append((topic, received + k * seconds * SECOND, shifted))
    return long


def test_batches_leave_no_seams(recorded, config):
    """With every 97th message lost, and one later than the window, which is missing and extra."""
    messages = repeated(recorded, WINDOW // 300 + 40, 1)
    own = [k for k, message in enumerate(messages) if message[0] == OUTPUT]
    dropped = set(own[::97])
    kept = [message for k, message in enumerate(messages) if k not in dropped]
    report = validate([*kept, messages[own[97]]], config, strict=True)
    assert report.rotor.gaps == len(own) // 300 - 1
    output, poses = report.topics
    assert (output.missing, output.extra) == (len(dropped), 1)
    assert (poses.missing, poses.compared) == (0, len(own))
    assert all(f.max_error < 1e-11 for t in report.topics for f in t.fields)


@pytest.mark.parametrize(
    ('bad', 'verdict'),
    [(150, Verdict.PASS), (151, Verdict.FAIL), (299, Verdict.FAIL), (300, Verdict.UNUSABLE)],
)
def test_a_recording_of_which_most_is_rejected_does_not_pass(recorded, config, bad, verdict):
    """Although the remaining outputs are right, as rejected messages have none."""
    wrong = set(np.random.default_rng(0).permutation(300)[:bad].tolist())
    number = dict.fromkeys(TYPES, -1)
    changed = []
    for topic, received, data in recorded:
        number[topic] += 1
        if number[topic] not in wrong:
            changed.append((topic, received, data))
        elif topic == ROTOR:
            changed.append((topic, received, data[:-1]))
    report = validate(changed, config)
    assert (report.verdict, report.rotor.rejected) == (verdict, {'not a JointState': bad})
    assert [topic.missing + topic.extra for topic in report.topics] == [0, 0]
    named = f'{bad} of 300 messages of /rotor_state were rejected (not a JointState {bad}): '
    assert [text.startswith(named) for text in texts(report)] == [bad > 150]


def test_the_series_shows_the_worst_deviation(recorded, config):
    messages = repeated(recorded, 60, 1)
    changed, stamp = change_one(messages, OUTPUT, add('position', 1e-3))
    report = validate(changed, config)
    output, poses = report.series
    assert (output.topic, poses.topic) == (OUTPUT, POSES)
    assert 1000 <= len(output.time) <= 2000
    assert [*output.errors] == ['position', 'velocity', 'effort']
    for series in report.series:
        lists = series.rotor_angle, *series.errors.values()
        assert {len(values) for values in lists} == {len(series.time)}
        assert series.time == sorted(series.time)
    error = output.errors['position']
    worst = int(np.argmax(np.abs(error)))
    assert error[worst] == pytest.approx(1e-3)
    # Of the sample itself, not of a neighbour in its interval.
    first = replaying.stamp_of(replaying.decode(recorded[0][2], JOINT_STATE))
    assert output.time[worst] == pytest.approx((stamp - first) / SECOND, abs=1e-9)
    assert output.rotor_angle[worst] == field_of(report, OUTPUT, 'position').worst_rotor_angle


@pytest.mark.parametrize(
    ('dropped', 'told'),
    [
        ([(OUTPUT, 100), (OUTPUT, 150)], f'2 messages of {OUTPUT} missing, but none of {POSES}'),
        ([(POSES, 150)], f'1 message of {POSES} missing, but none of {OUTPUT}'),
        ([(OUTPUT, 100), (POSES, 100)], f'1 message of {ROTOR} without any output'),
        ([(OUTPUT, 100), (POSES, 100), (POSES, 150)], None),
    ],
)
def test_who_lost_messages_is_told_by_those_that_are_there(recorded, config, dropped, told):
    places = {index_of(recorded, topic, number) for topic, number in dropped}
    left = [message for k, message in enumerate(recorded) if k not in places]
    causes = validate(left, config).causes
    assert [sentence(cause)[: len(told or '')] for cause in causes] == ([told] if told else [])
