"""Recordings with one thing changed: each change is found, named and located."""

import math
import struct
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import replaying
from replaying import SECOND, edited, encode
from shipped_bags import BAGS, CONFIGS, JOINT_STATE, OUTPUT, POSES, ROTOR, TYPES, read_bag

from gear_kinematics.bag import Message
from gear_kinematics.bag.roles import Topics
from gear_kinematics.kinematics import matrix_method
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.matching import WINDOW
from gear_kinematics.validation.output_topics import Tolerances
from gear_kinematics.validation.report import BagReport, TopicReport
from gear_kinematics.validation.validator import Validator
from gear_kinematics.validation.wording import findings

CHANGED = 100
"""Number of the changed message of a topic."""


@pytest.fixture(scope='module')
def recorded() -> list[Message]:
    """The first 300 samples of a servo's move, and their outputs."""
    return read_bag(BAGS / 'servo_point_to_point')[:900]


def validate(messages: list[Message], config: dict, **options) -> BagReport:
    validator = Validator(config, **options)
    validator.feed(messages)
    return validator.report('bag')


def topic_of(report: BagReport, topic: str) -> TopicReport:
    (found,) = (t for t in report.topics if t.topic == topic)
    return found


def field_of(report: BagReport, topic: str, name: str):
    (found,) = (f for f in topic_of(report, topic).fields if f.name == name)
    return found


def change_one(messages: list[Message], topic: str, edit: Callable) -> tuple[list[Message], int]:
    """Change one message of a topic; also return its original stamp."""
    changed, count, stamp = [], 0, 0
    for name, received, data in messages:
        if name == topic:
            count += 1
            if count == CHANGED:
                stamp = replaying.stamp_of(replaying.decode(data, TYPES[topic]))
                data = edited(data, TYPES[topic], edit)  # noqa: PLW2901
        changed.append((name, received, data))
    assert stamp
    return changed, stamp


def change_all(messages: list[Message], topic: str, edit: Callable) -> list[Message]:
    return [
        (name, received, edited(data, TYPES[topic], edit) if name == topic else data)
        for name, received, data in messages
    ]


def index_of(messages: list[Message], topic: str, number: int = CHANGED) -> int:
    return [k for k, (name, _, _) in enumerate(messages) if name == topic][number - 1]


def set_stamp(message, stamp: int) -> None:
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)


@pytest.mark.parametrize(
    ('name', 'single_turn', 'messages', 'compared'),
    [
        ('servo_point_to_point', False, 9000, 3000),
        ('constant_speed_3000rpm', False, 9000, 3000),
        ('single_turn_encoder', True, 7500, 2500),
        ('driver_faults', False, 1314 + 2 * 1265, 1265),
    ],
)
@pytest.mark.parametrize('tolerance', [1e-9, 1e-12])
def test_shipped_recordings_pass(name, single_turn, messages, compared, tolerance, config):
    if single_turn:
        config = NodeParameters.load(CONFIGS / 'single_turn.yaml')
    tolerances = Tolerances(tolerance, tolerance * 0.0011)
    for solver in ({}, {'solver': matrix_method.solve}):
        report = validate(read_bag(BAGS / name), config, tolerances=tolerances, **solver)
        assert report.verdict == Verdict.PASS
        assert report.messages == messages
        assert [t.compared for t in report.topics] == [compared, compared]
        assert [t.missing + t.extra + t.out_of_order for t in report.topics] == [0, 0]
        assert report.gear_ratio == '-19'


def test_the_input_is_described(config):
    rotor = validate(read_bag(BAGS / 'driver_faults'), config).rotor
    assert rotor.rejected == {
        'out of order': 12,
        'position not finite': 12,
        'joint missing': 12,
        'position missing': 13,
    }
    assert (rotor.messages, rotor.valid, rotor.duplicates) == (1314, 1265, 12)
    assert rotor.rate == pytest.approx(500.0, rel=0.01)
    assert rotor.duration == pytest.approx(3.0, abs=0.01)
    assert rotor.gaps == 2
    assert [gap.seconds for gap in rotor.longest_gaps] == pytest.approx([0.302, 0.122], abs=0.004)


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
        (OUTPUT, 'position', add('position', -2e-9), 2e-9),
        (OUTPUT, 'velocity', add('velocity', 2e-9), 2e-9),
        (OUTPUT, 'effort', add('effort', 2e-9), 2e-9),
        (POSES, 'position', move(0, 'x', 2e-9), 2e-9),
        (POSES, 'position', move(1, 'y', -2e-9), 2e-9),
        (POSES, 'position', move(2, 'z', 2e-9), 2e-9),
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
    assert validate(changed, config, tolerances=Tolerances(3e-9, 3e-9)).passed


def test_a_negated_quaternion_is_the_same_rotation(recorded, config):
    def negate(message) -> None:
        q = message.poses[1].orientation
        q.x, q.y, q.z, q.w = -q.x, -q.y, -q.z, -q.w

    changed, stamp = change_one(recorded, POSES, negate)
    report = validate(changed, config)
    assert report.verdict == Verdict.PASS
    (finding,) = report.findings
    assert finding.startswith('orientations with w < 0')
    assert finding.endswith(f'1 message, the first at stamp {stamp}')


@pytest.mark.parametrize('value', [math.nan, math.inf])
def test_a_value_that_is_not_finite_is_found(recorded, config, value):
    for topic, field, edit in (
        (OUTPUT, 'position', lambda m: m.position.__setitem__(0, value)),
        (POSES, 'position', lambda m: setattr(m.poses[2].position, 'y', value)),
        (POSES, 'orientation', lambda m: setattr(m.poses[2].orientation, 'w', value)),
    ):
        changed, stamp = change_one(recorded, topic, edit)
        report = validate(changed, config)
        assert report.verdict == Verdict.FAIL
        found = field_of(report, topic, field)
        assert (found.non_finite, found.first_non_finite) == (1, stamp)


@pytest.mark.parametrize('value', [1.4e154, -1e200, 1.7976931348623157e308, 5e-324])
@pytest.mark.parametrize('topic', [ROTOR, OUTPUT])
@pytest.mark.parametrize('field', ['position', 'velocity', 'effort'])
def test_garbage_in_one_number_is_an_error_of_that_number(recorded, config, topic, field, value):
    """As from a flipped bit: nothing overflows, and everything else is compared."""

    def spoil(message) -> None:
        getattr(message, field)[0] = value

    changed, stamp = change_one(recorded, topic, spoil)
    for name in ('servo', 'allowed'):
        report = validate(changed, config, allow_offset=name == 'allowed')
        assert report.verdict == Verdict.FAIL
        assert sum(t.compared for t in report.topics) >= 598
        worst = {f.worst_stamp for t in report.topics for f in t.fields if not f.passed}
        assert worst <= {stamp, None}


@pytest.mark.parametrize('value', [1e17, 1e100])
def test_garbage_in_the_first_output_gives_no_turns(value):
    """The turns of the single-turn encoder are then taken from the next output."""
    config = NodeParameters.load(CONFIGS / 'single_turn.yaml')
    messages = read_bag(BAGS / 'single_turn_encoder')
    index = index_of(messages, OUTPUT, 1)
    topic, received, data = messages[index]
    messages[index] = topic, received, edited(data, TYPES[topic], lambda m: m.position.fill(value))
    report = validate(messages, config)
    assert report.verdict == Verdict.FAIL
    assert [t.compared for t in report.topics] == [2500, 2500]
    errors = field_of(report, OUTPUT, 'position')
    assert errors.max_error == pytest.approx(value)
    assert errors.rms_error == pytest.approx(value / math.sqrt(2500))
    assert not any('turns' in finding for finding in report.findings)


@pytest.mark.parametrize('value', [1e17, 1e300])
def test_garbage_in_the_only_output_is_no_offset(recorded, config, value):
    changed = change_all(recorded[:3], OUTPUT, lambda m: m.position.fill(value))
    report = validate(changed, config, allow_offset=True)
    assert report.verdict == Verdict.FAIL
    assert not any('accepted' in finding for finding in report.findings)


@pytest.mark.parametrize('value', [1.4e154, 1e300])
def test_garbage_in_one_pose_is_an_error_of_that_pose(recorded, config, value):
    for edit in (
        lambda m: setattr(m.poses[2].position, 'y', value),
        lambda m: setattr(m.poses[2].position, 'z', -value),
        lambda m: setattr(m.poses[0].orientation, 'w', value),
    ):
        changed, stamp = change_one(recorded, POSES, edit)
        report = validate(changed, config)
        (failed,) = (f for f in topic_of(report, POSES).fields if not f.passed)
        assert failed.worst_stamp == stamp
        assert failed.max_error == pytest.approx(value, rel=1.1)


def test_a_missing_field_is_found(recorded, config):
    def without_effort(message) -> None:
        message.effort = np.zeros(0)

    changed, stamp = change_one(recorded, OUTPUT, without_effort)
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    found = field_of(report, OUTPUT, 'effort')
    assert (found.absent, found.first_absent) == (1, stamp)
    report = validate(change_one(recorded, ROTOR, without_effort)[0], config)
    assert field_of(report, OUTPUT, 'effort').absent == 1


@pytest.mark.parametrize('topic', [OUTPUT, POSES])
def test_a_message_that_was_dropped_is_missing(recorded, config, topic):
    index = index_of(recorded, topic)
    _, stamp = change_one(recorded, topic, lambda _: None)
    report = validate(recorded[:index] + recorded[index + 1 :], config)
    found = topic_of(report, topic)
    assert (found.missing, found.extra, found.compared) == (1, 0, 299)
    assert found.first_missing == stamp
    assert report.verdict == Verdict.FAIL


@pytest.mark.parametrize('topic', [OUTPUT, POSES])
def test_a_message_that_is_there_twice_is_extra(recorded, config, topic):
    index = index_of(recorded, topic)
    _, stamp = change_one(recorded, topic, lambda _: None)
    report = validate(recorded[: index + 1] + recorded[index:], config)
    found = topic_of(report, topic)
    assert (found.missing, found.extra, found.duplicates) == (0, 1, 1)
    assert found.first_extra == stamp
    assert report.verdict == Verdict.FAIL


@pytest.mark.parametrize('topic', [OUTPUT, POSES])
def test_two_messages_that_were_swapped_are_out_of_order(recorded, config, topic):
    one, other = index_of(recorded, topic), index_of(recorded, topic, CHANGED + 1)
    swapped = list(recorded)
    swapped[one], swapped[other] = swapped[other], swapped[one]
    report = validate(swapped, config)
    found = topic_of(report, topic)
    assert (found.missing, found.extra, found.out_of_order) == (0, 0, 1)
    assert found.first_out_of_order == change_one(recorded, topic, lambda _: None)[1]
    assert report.verdict == Verdict.FAIL


@pytest.mark.parametrize('topic', [OUTPUT, POSES])
def test_a_stamp_that_is_off_by_1_ns_is_missing_and_extra(recorded, config, topic):
    _, stamp = change_one(recorded, topic, lambda _: None)
    changed, _ = change_one(recorded, topic, lambda m: set_stamp(m, stamp + 1))
    found = topic_of(validate(changed, config), topic)
    assert (found.missing, found.extra, found.compared) == (1, 1, 299)
    assert (found.first_missing, found.first_extra) == (stamp, stamp + 1)


def test_a_flipped_sign_is_named(recorded, config):
    def flip(message) -> None:
        message.position[0] *= -1.0

    report = validate(change_all(recorded, OUTPUT, flip), config)
    assert report.verdict == Verdict.FAIL
    assert any('sign is flipped' in finding for finding in report.findings)


def test_another_direction_of_the_encoder_is_named(recorded, config):
    report = validate(recorded, replace(config, rotor_direction=-1))
    assert any('sign is flipped' in finding for finding in report.findings)


@pytest.mark.parametrize(
    ('assumed', 'named'),
    [
        ({'ring_teeth': 81}, ('ring_teeth 80, satellite_teeth 76', '-19')),
        ({'satellite_teeth': 77}, ('ring_teeth 80, satellite_teeth 76', '-19')),
        ({'ring_teeth': 61, 'satellite_teeth': 58}, ('-19',)),
    ],
)
def test_another_tooth_pair_is_named(recorded, config, assumed, named):
    report = validate(recorded, replace(config, **assumed))
    assert report.verdict == Verdict.FAIL
    (finding,) = (f for f in report.findings if 'recorded ratio' in f)
    assert all(words in finding for words in named)


def test_a_ratio_of_no_tooth_pair_is_named_as_it_is(recorded, config):
    def scale(message) -> None:
        message.position[0] *= math.pi

    report = validate(change_all(recorded, OUTPUT, scale), config)
    (finding,) = (f for f in report.findings if 'recorded ratio' in f)
    assert float(finding.split()[4].rstrip(',')) == pytest.approx(-19.0 / math.pi, rel=1e-6)


def test_a_constant_offset_is_named_and_accepted_on_request(recorded, config):
    def offset(message) -> None:
        message.position[0] += 0.125

    changed = change_all(recorded, OUTPUT, offset)
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    assert any('constant 0.125 rad' in finding for finding in report.findings)
    accepted = validate(changed, config, allow_offset=True)
    assert accepted.verdict == Verdict.PASS
    assert any('accepted' in f and 'constant 0.125 rad' in f for f in accepted.findings)
    assert field_of(accepted, OUTPUT, 'position').max_error < 1e-12


def test_the_offset_that_homing_leaves_is_accepted_with_its_poses(recorded, config):
    """A node that was homed before the recording has another zero than the configuration."""
    homed = replace(config, rotor_zero=0.75)
    report = validate(recorded, homed)
    assert any('constant' in f for f in report.findings)
    assert not topic_of(report, POSES).passed
    accepted = validate(recorded, homed, allow_offset=True)
    assert accepted.verdict == Verdict.PASS


def test_no_offset_is_invented(recorded, config):
    report = validate(recorded, config, allow_offset=True)
    assert report.verdict == Verdict.PASS
    assert report.findings == ()
    changed, _ = change_one(recorded, OUTPUT, add('position', 0.1))
    assert validate(changed, config, allow_offset=True).verdict == Verdict.FAIL


def test_another_order_of_the_poses_is_named(recorded, config):
    def swap(message) -> None:
        message.poses[1], message.poses[2] = message.poses[2], message.poses[1]

    report = validate(change_all(recorded, POSES, swap), config)
    assert report.verdict == Verdict.FAIL
    (finding,) = (f for f in report.findings if 'order' in f)
    assert finding == (
        'the poses are in another order: satellite_a, oldham_a, satellite_b, oldham_b'
    )


def test_a_single_message_in_another_order_is_reported_as_such(recorded, config):
    def swap(message) -> None:
        message.poses[0], message.poses[1] = message.poses[1], message.poses[0]

    changed, stamp = change_one(recorded, POSES, swap)
    (finding,) = (f for f in validate(changed, config).findings if 'order' in f)
    assert finding == (
        'in 1 of 300 messages the poses are in another order: satellite_b, satellite_a, '
        f'oldham_a, oldham_b; one is at stamp {stamp}'
    )


def test_another_frame_is_named(recorded, config):
    def rename(message) -> None:
        message.header.frame_id = 'base'

    changed, stamp = change_one(recorded, POSES, rename)
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    (fault,) = topic_of(report, POSES).faults
    assert "'base'" in fault
    assert "'stator'" in fault
    assert f'1 message, the first at stamp {stamp}' in fault


def test_another_joint_name_is_named(recorded, config):
    def rename(message) -> None:
        message.name = ['shaft']

    changed, stamp = change_one(recorded, OUTPUT, rename)
    report = validate(changed, config)
    assert report.verdict == Verdict.FAIL
    assert topic_of(report, OUTPUT).faults == (
        f"no joint 'output_shaft': 1 message, the first at stamp {stamp}",
    )


def test_a_prefix_of_the_configuration_is_expected(recorded, config):
    report = validate(recorded, replace(config, frame_prefix='left_'))
    assert report.verdict == Verdict.FAIL
    assert all(topic.faults for topic in report.topics)


def test_a_prefix_that_the_outputs_agree_on_is_taken_from_them(recorded, config):
    def prefixed(message) -> None:
        message.header.frame_id = 'left_stator'

    def renamed(message) -> None:
        message.name = ['left_output_shaft']

    with_frames = change_all(recorded, POSES, prefixed)
    with_both = change_all(with_frames, OUTPUT, renamed)
    report = validate(with_both, config)
    assert report.verdict == Verdict.PASS
    assert report.findings == ("frame_prefix 'left_' is taken from the outputs",)
    report = validate(with_frames, config)
    assert report.verdict == Verdict.FAIL
    assert "no joint 'left_output_shaft'" in topic_of(report, OUTPUT).faults[0]
    assert validate(with_both, replace(config, frame_prefix='right_')).verdict == Verdict.FAIL


def test_poses_that_lack_a_body_are_malformed(recorded, config):
    changed, _ = change_one(recorded, POSES, lambda m: m.poses.pop())
    found = topic_of(validate(changed, config), POSES)
    assert (found.missing, found.compared) == (1, 299)
    assert 'malformed' in found.faults[0]


def test_bytes_that_are_no_message_are_malformed(recorded, config):
    broken = list(recorded)
    index = index_of(recorded, OUTPUT)
    broken[index] = (OUTPUT, broken[index][1], b'\x00\x01garbage')
    found = topic_of(validate(broken, config), OUTPUT)
    assert found.missing == 1
    assert 'malformed' in found.faults[0]


def test_nothing_to_validate_is_unusable(recorded, config):
    for messages, word in (
        ([], 'rotor states'),
        ([m for m in recorded if m[0] != ROTOR], 'rotor states'),
        ([m for m in recorded if m[0] == ROTOR], 'outputs'),
    ):
        report = validate(messages, config)
        assert report.verdict == Verdict.UNUSABLE
        assert word in report.error


def test_a_topic_without_messages_fails(recorded, config):
    report = validate([m for m in recorded if m[0] != POSES], config)
    assert report.verdict == Verdict.FAIL
    assert topic_of(report, POSES).missing == 300


def test_messages_before_damage_are_validated(recorded, config):
    def cut_short():
        yield from recorded[:600]
        raise OSError('the disk is gone')

    validator = Validator(config)
    with pytest.raises(OSError, match='disk'):
        validator.feed(cut_short())
    report = validator.report('bag', error='the disk is gone')
    assert report.messages == 600
    assert report.verdict == Verdict.UNUSABLE
    assert report.error == 'the disk is gone'
    assert [t.compared for t in report.topics] == [200, 200]
    assert all(field.max_error < 1e-12 for t in report.topics for field in t.fields)


def test_outputs_recorded_before_their_inputs_match(recorded, config):
    """Messages in a bag are in the order of reception, which depends on the network."""
    early = sorted(recorded, key=lambda m: (m[1] // 20_000_000, m[0]))
    assert [m[0] for m in early] != [m[0] for m in recorded]
    assert validate(early, config).passed


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
    messages = repeated(recorded, 40, 1)
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS
    assert [t.compared for t in report.topics] == [12_000, 12_000]
    assert report.rotor.gaps == 39


def test_a_bag_that_loops_restarts(config):
    messages = read_bag(BAGS / 'servo_point_to_point')
    looped = messages + messages
    report = validate(looped, config)
    assert report.verdict == Verdict.PASS
    assert report.rotor.resets == 1
    assert [t.compared for t in report.topics] == [6000, 6000]


def test_a_message_later_than_the_window_is_missing_and_extra(recorded, config):
    messages = repeated(recorded, WINDOW // 300 + 40, 1)
    late = messages.pop(index_of(messages, OUTPUT))
    found = topic_of(validate([*messages, late], config), OUTPUT)
    assert (found.missing, found.extra) == (1, 1)


@pytest.mark.slow
def test_missing_messages_are_counted_exactly_in_long_recordings(recorded, config):
    messages = repeated(recorded, 100, 1)
    dropped = [k for k, m in enumerate(messages) if m[0] == OUTPUT][::97]
    kept = [m for k, m in enumerate(messages) if k not in set(dropped)]
    found = topic_of(validate(kept, config, strict=True), OUTPUT)
    assert (found.missing, found.extra) == (len(dropped), 0)
    assert all(f.max_error < 1e-11 for f in found.fields)


def test_gaps_that_could_hide_a_turn_are_named(config):
    single = replace(config, rotor_encoder='single_turn', max_rotor_speed=2000.0)
    report = validate(read_bag(BAGS / 'driver_faults'), single)
    assert report.rotor.jumps > 0
    assert not report.rotor.referenced
    assert any('hide a turn' in finding for finding in report.findings)


def test_overspeed_is_named(recorded, config):
    report = validate(recorded, replace(config, max_rotor_speed=10.0))
    assert report.verdict == Verdict.PASS
    assert report.rotor.overspeed > 0
    assert any('max_rotor_speed' in finding for finding in report.findings)


def test_inputs_without_stamps_are_named(recorded, config):
    changed, _ = change_one(recorded, ROTOR, lambda m: set_stamp(m, 0))
    report = validate(changed, config)
    assert report.rotor.zero_stamps == 1
    assert any('no stamp' in finding for finding in report.findings)


def restamped(data: bytes, seconds: int = 1) -> bytes:
    """Move a number of seconds of the stamp to its nanoseconds."""
    sec, nanosec = struct.unpack_from('<iI', data, 4)
    return data[:4] + struct.pack('<iI', sec - seconds, nanosec + seconds * SECOND) + data[12:]


def test_unnormalised_stamps_match_their_outputs_and_are_named(recorded, config):
    changed = [
        (topic, received, restamped(data) if topic == ROTOR else data)
        for topic, received, data in recorded
    ]
    report = validate(changed, config)
    assert report.verdict == Verdict.PASS
    assert report.rotor.unnormalised_stamps == report.rotor.valid == 300
    assert [topic.compared for topic in report.topics] == [300, 300]
    assert any('300 stamps of /rotor_state' in finding for finding in report.findings)


@pytest.mark.parametrize(
    ('bad', 'verdict'),
    [(150, Verdict.PASS), (151, Verdict.FAIL), (299, Verdict.FAIL), (300, Verdict.UNUSABLE)],
)
def test_a_recording_of_which_most_is_rejected_does_not_pass(recorded, config, bad, verdict):
    """Although the remaining outputs are right, as rejected messages have none."""
    wrong = set(np.random.default_rng(0).permutation(300)[:bad].tolist())
    counts, changed = Counter(), []
    for topic, received, data in recorded:
        number, counts[topic] = counts[topic], counts[topic] + 1
        if number not in wrong:
            changed.append((topic, received, data))
        elif topic == ROTOR:
            changed.append((topic, received, data[:-1]))
    report = validate(changed, config)
    assert report.rotor.rejected == {'not a JointState': bad}
    assert [topic.missing + topic.extra for topic in report.topics] == [0, 0]
    assert report.verdict == verdict
    named = [finding for finding in report.findings if 'were rejected' in finding]
    assert len(named) == (bad > 150)
    for finding in named:
        assert f'{bad} of 300 messages of /rotor_state' in finding
        assert f'not a JointState {bad}' in finding


def test_topics_may_have_other_names(recorded, config):
    renamed = [(f'/left{topic}', received, data) for topic, received, data in recorded]
    topics = Topics(*(f'/left{topic}' for topic in (ROTOR, OUTPUT, POSES)))
    report = validate(renamed, config, topics=topics)
    assert report.verdict == Verdict.PASS
    assert [t.topic for t in report.topics] == ['/left/output_state', '/left/body_poses']


def test_big_endian_recordings_pass(recorded, config):
    swapped = [
        (topic, received, encode(replaying.decode(data, TYPES[topic]), little_endian=False))
        for topic, received, data in recorded
    ]
    assert swapped[0][2][:2] == b'\x00\x00'
    assert validate(swapped, config).passed


def test_layouts_may_change_in_mid_recording(recorded, config):
    def more_joints(message) -> None:
        message.name = ['brake', *message.name]
        for field in ('position', 'velocity', 'effort'):
            setattr(message, field, np.array([7.0, *getattr(message, field)]))

    half = change_all(recorded[450:], ROTOR, more_joints)
    assert validate(recorded[:450] + half, config).passed


def test_the_series_shows_the_worst_deviation(recorded, config):
    messages = repeated(recorded, 60, 1)
    changed, stamp = change_one(messages, OUTPUT, add('position', 1e-3))
    report = validate(changed, config)
    output, poses = report.series
    assert (output.topic, poses.topic) == (OUTPUT, POSES)
    assert 1000 <= len(output.time) <= 2000
    assert [curve.field for curve in output.curves] == ['position', 'velocity', 'effort']
    for series in report.series:
        lists = [values for c in series.curves for values in (c.recorded, c.expected, c.error)]
        assert {len(values) for values in (series.rotor_angle, *lists)} == {len(series.time)}
        assert series.time == sorted(series.time)
    position = output.curves[0]
    worst = int(np.argmax(np.abs(position.error)))
    assert position.error[worst] == pytest.approx(1e-3)
    assert position.recorded[worst] - position.expected[worst] == position.error[worst]
    # Of the sample itself, not of a neighbour in its interval.
    first = replaying.stamp_of(replaying.decode(recorded[0][2], JOINT_STATE))
    assert output.time[worst] == pytest.approx((stamp - first) / SECOND, abs=1e-9)
    assert output.rotor_angle[worst] == field_of(report, OUTPUT, 'position').worst_rotor_angle


@pytest.mark.parametrize(
    ('field', 'edit', 'part', 'error'),
    [
        ('position', move(3, 'y', 2e-4), 'oldham_b y', 2e-4),
        ('position', move(0, 'z', -3e-4), 'satellite_a z', -3e-4),
        ('orientation', turn(2, 0.01), 'oldham_a', 0.01),
    ],
)
def test_the_curve_of_poses_is_that_of_what_is_farthest_off(
    recorded, config, field, edit, part, error
):
    changed, _ = change_one(recorded, POSES, edit)
    [curve] = (c for c in validate(changed, config).series[1].curves if c.field == field)
    worst = int(np.argmax(curve.error))
    assert curve.part == part
    assert curve.recorded[worst] - curve.expected[worst] == pytest.approx(error, rel=1e-6)
    # The error of an orientation is that of the worst number of the quaternion.
    assert math.sqrt(0.5) * abs(error) <= curve.error[worst] <= abs(error) * (1.0 + 1e-9)


def test_lanes_tell_when_something_happened(config):
    """The faulty driver, and two messages of output_state missing, one twice, two swapped."""
    messages = read_bag(BAGS / 'driver_faults')
    places = [k for k, (topic, *_) in enumerate(messages) if topic == OUTPUT]
    stamps = [replaying.stamp_of(replaying.decode(messages[k][2], JOINT_STATE)) for k in places]
    a, b = places[700], places[701]
    messages[a], messages[b] = messages[b], messages[a]
    del messages[places[1000]]
    messages.insert(places[900], messages[places[900]])
    del messages[places[400]]
    report = validate(messages, config)
    lanes = {(lane.topic, lane.event): lane for lane in report.lanes}
    assert {key: lane.count for key, lane in lanes.items()} == {
        (ROTOR, 'gaps'): 2,
        (ROTOR, 'rejected'): 49,
        (OUTPUT, 'missing'): 2,
        (OUTPUT, 'extra'): 1,
        (OUTPUT, 'out of order'): 1,
    }
    assert {key for key, lane in lanes.items() if not lane.fails} == {
        (ROTOR, 'gaps'),
        (ROTOR, 'rejected'),
    }

    def seconds(number: int) -> float:
        return (stamps[number] - report.rotor.first_stamp) / SECOND

    missing = lanes[OUTPUT, 'missing'].spans
    assert missing == [(pytest.approx(seconds(k)),) * 2 for k in (400, 1000)]
    assert lanes[OUTPUT, 'extra'].spans == [(pytest.approx(seconds(900)),) * 2]
    assert lanes[OUTPUT, 'out of order'].spans == [(pytest.approx(seconds(700)),) * 2]
    gaps = [end - start for start, end in lanes[ROTOR, 'gaps'].spans]
    assert sorted(gaps) == pytest.approx([0.122, 0.302], abs=0.004)


def test_lanes_tell_which_values_are_absent_or_not_finite(recorded, config):
    changed, _ = change_one(recorded, OUTPUT, lambda m: m.velocity.fill(math.nan))
    changed, stamp = change_one(changed, OUTPUT, lambda m: setattr(m, 'effort', np.zeros(0)))
    report = validate(changed, config)
    moment = pytest.approx((stamp - report.rotor.first_stamp) / SECOND)
    assert [(lane.event, lane.count, lane.spans) for lane in report.lanes] == [
        ('velocity not finite', 1, [(moment, moment)]),
        ('effort absent', 1, [(moment, moment)]),
    ]


@pytest.mark.parametrize(
    ('dropped', 'told'),
    [
        ([(OUTPUT, 100), (OUTPUT, 150)], f'2 messages of {OUTPUT} missing, but none of {POSES}'),
        ([(POSES, 150)], f'1 message of {POSES} missing, but none of {OUTPUT}'),
        ([(OUTPUT, 100), (POSES, 100)], f'1 message of {ROTOR} without any output'),
        ([(OUTPUT, 100), (POSES, 101)], None),
        ([(OUTPUT, 100), (POSES, 100), (POSES, 150)], None),
        ([], None),
    ],
)
def test_who_lost_messages_is_told_by_those_that_are_there(recorded, config, dropped, told):
    places = {index_of(recorded, topic, number) for topic, number in dropped}
    left = [message for k, message in enumerate(recorded) if k not in places]
    causes = validate(left, config).causes
    assert [cause[: len(told or '')] for cause in causes] == ([told] if told else [])


def test_a_field_that_is_always_absent_has_a_curve_of_what_was_expected(recorded, config):
    changed = change_all(recorded, OUTPUT, lambda m: setattr(m, 'effort', np.zeros(0)))
    report = validate(changed, config)
    assert not field_of(report, OUTPUT, 'effort').passed
    [effort] = (curve for curve in report.series[0].curves if curve.field == 'effort')
    assert np.isnan(effort.recorded).all()
    assert np.isfinite(effort.expected).all()
    neither = change_all(changed, ROTOR, lambda m: setattr(m, 'effort', np.zeros(0)))
    fields = [curve.field for curve in validate(neither, config).series[0].curves]
    assert fields == ['position', 'velocity']


@pytest.mark.parametrize(
    ('field', 'factor', 'told'),
    [
        (
            'velocity',
            180.0 / math.pi,
            '57.2958 times the expected one: it is in degrees per second',
        ),
        (
            'velocity',
            30.0 / math.pi,
            '9.5493 times the expected one: it is in revolutions per min',
        ),
        ('velocity', -19.0, '-19 times the expected one: it is that of the rotor'),
        ('effort', 1.0 / 19.0, ': it is that of the rotor, with the sign flipped'),
        ('effort', -1.0, '-1 times the expected one: the sign is flipped'),
        ('effort', 1.25, 'is 1.25 times the expected one'),
    ],
)
def test_a_constant_factor_is_told_with_its_reason(recorded, config, field, factor, told):
    changed = change_all(recorded, OUTPUT, lambda m: getattr(m, field).__imul__(factor))
    [cause] = validate(changed, config).causes
    assert cause.startswith(f'the recorded {field} is ')
    assert told in cause


@pytest.mark.parametrize('value', [2e-9, 1.0, math.nan, 1e300])
def test_a_factor_that_is_not_constant_is_not_told(recorded, config, value):
    changed, _ = change_one(recorded, OUTPUT, lambda m: m.velocity.__iadd__(value))
    assert validate(changed, config).causes == ()


def test_the_cause_is_told_before_its_effects(recorded, config):
    changed = change_all(recorded, OUTPUT, lambda m: m.position.__imul__(-1.0))
    report = validate(changed, config)
    first, *others = findings(report)
    assert first.text.startswith('the sign is flipped')
    assert report.causes == (first.text,)
    assert any('exceeds the tolerance' in finding.text for finding in others)
    assert [f.text for f in (first, *others)].count(first.text) == 1


def test_progress_is_reported(recorded, config):
    told = []
    validator = Validator(config)
    messages = repeated(recorded, 20, 1)
    validator.feed(messages, lambda done, total: told.append((done, total)), total=20_000)
    assert told == sorted(told)
    assert told[-1] == (18_000, 20_000)
    assert len(told) > 1


# A gear of which only the ratio is known.


@pytest.mark.parametrize('name', ['servo_point_to_point', 'single_turn_encoder', 'driver_faults'])
def test_of_a_gear_with_only_a_ratio_the_output_alone_is_validated(name):
    """The node recorded these outputs of a mechanism with this ratio."""
    file = 'single_turn' if name == 'single_turn_encoder' else 'actuator'
    config = replace(NodeParameters.load(CONFIGS / f'{file}.yaml'), gear_ratio='-19')
    report = validate(read_bag(BAGS / name), config, tolerances=Tolerances(1e-12))
    assert report.verdict == Verdict.PASS
    assert [topic.topic for topic in report.topics] == [OUTPUT]
    assert report.topics[0].compared > 1000
    assert (report.gear_ratio, report.mechanism) == ('-19', None)


def test_another_ratio_is_named(recorded, config):
    report = validate(recorded, replace(config, gear_ratio='-58/3'))
    assert report.verdict == Verdict.FAIL
    (finding,) = (f for f in report.findings if 'recorded ratio' in f)
    assert finding.startswith('the recorded ratio is -19 ± ')
    assert finding.endswith(', not -58/3')


def test_offset_of_the_only_output_is_accepted(recorded, config):
    config = replace(config, gear_ratio='-19')
    changed = change_all(recorded, OUTPUT, add('position', 0.125))
    assert validate(changed, config).verdict == Verdict.FAIL
    report = validate(changed, config, allow_offset=True)
    assert report.verdict == Verdict.PASS
    assert any('accepted' in found and '0.125 rad' in found for found in report.findings)


def test_missing_outputs_of_a_gear_with_only_a_ratio_are_counted(recorded, config):
    left = recorded[: index_of(recorded, OUTPUT)] + recorded[index_of(recorded, OUTPUT) + 1 :]
    report = validate(left, replace(config, gear_ratio='-19'), strict=True)
    assert report.verdict == Verdict.FAIL
    assert [topic.missing for topic in report.topics] == [1]
