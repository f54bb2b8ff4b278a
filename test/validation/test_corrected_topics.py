# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The corrected output in recordings: the node's passes, and what differs is found and named."""

import math
import struct
from dataclasses import replace
from fractions import Fraction

import pytest
import replaying
import validating
from calibrations import calibration
from live import rotor_bytes
from node_loop import answered
from shipped_bags import BAGS, JOINT_STATE, read_bag
from validating import texts, topic_of

from gear_kinematics.bag import Message
from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict

STATE, INTERVAL = '/corrected_state', '/corrected_interval'
NAMES = {'corrected_state': STATE, 'corrected_interval': INTERVAL}
ALL = ('output_state', 'body_poses', *NAMES)
MADE = replace(calibration(), spans=replace(calibration().spans, speed=(-40.0, 40.0)))
WITHIN_TURN = replace(
    MADE,
    orders=(Order('rotor × 1', Fraction(1), 1e-3, 2e-4),),
    covariance=tuple(tuple(float(k == n) for k in range(5)) for n in range(5)),
)


def corrected(messages, config, made=MADE, topics=tuple(NAMES)) -> list[Message]:
    """Add the corrected output that the node publishes."""
    return answered(config, messages, calibration=made, topics=topics)


@pytest.fixture(scope='module')
def servo(config) -> list[Message]:
    return corrected(read_bag(BAGS / 'servo_point_to_point'), config)


def validate(messages, config, made=MADE, **options):
    return validating.validate(messages, config, further=NAMES, calibration=made, **options)


def changed(messages, topic: str, number: int, **fields):
    """Change numbers of a message of a topic, given by its number."""
    found = [k for k, message in enumerate(messages) if message[0] == topic][number]
    _, received, data = messages[found]
    message = replaying.decode(data, JOINT_STATE)
    for name, by in fields.items():
        setattr(message, name, getattr(message, name) + by)
    changed = topic, received, replaying.encode(message)
    return [*messages[:found], changed, *messages[found + 1 :]]


@pytest.mark.parametrize('share', [0.2, 0.65])
def test_recording_may_begin_at_any_time(config, servo, share):
    begin = [k for k, m in enumerate(servo) if m[0] == '/rotor_state'][round(share * 3000)]
    report = validate(servo[begin:], config)
    assert report.verdict == Verdict.PASS, report.findings
    assert topic_of(report, STATE).compared >= (1.0 - share) * 3000 - 1


@pytest.mark.parametrize(
    ('name', 'samples'),
    [('servo_point_to_point', 3000), ('constant_speed_3000rpm', 3000), ('driver_faults', 1265)],
)
def test_what_the_node_publishes_passes(config, name, samples):
    report = validate(corrected(read_bag(BAGS / name), config), config)
    assert report.verdict == Verdict.PASS, report.findings
    fields = topic_of(report, STATE).fields + topic_of(report, INTERVAL).fields
    assert {topic.compared for topic in report.topics} == {samples}
    assert [field.name for field in fields] == ['position', 'velocity', 'effort', 'half width']
    assert max(field.max_error for field in fields) < 1e-11


@pytest.mark.parametrize(('topic', 'fields', 'name'), [
    (STATE, {'position': 2e-9}, 'position'), (STATE, {'velocity': -2e-9}, 'velocity'),
    (STATE, {'effort': 2e-9}, 'effort'), (INTERVAL, {'position': 2e-9}, 'half width'),
    (INTERVAL, {'position': -2e-9}, 'half width'), (STATE, {'position': math.nan}, 'position'),
])  # fmt: skip
def test_changed_number_is_found_and_located(config, servo, topic, fields, name):
    report = validate(changed(servo, topic, 2000, **fields), config)
    [(where, field)] = [(t.topic, f) for t in report.topics for f in t.fields if not f.passed]
    assert (report.verdict, where, field.name) == (Verdict.FAIL, topic, name)
    stamps = [struct.unpack_from('<iI', m[2], 4) for m in servo if m[0] == topic]
    found = field.first_non_finite if math.isnan(sum(fields.values())) else field.worst_stamp
    assert divmod(found, 10**9) == stamps[2000]
    assert field.max_error == pytest.approx(2e-9, rel=1e-3) or field.non_finite == 1


def test_another_calibration_is_found_and_none_is_named(config, servo):
    report = validate(servo, config, replace(MADE, constant=2e-5))
    assert report.verdict == Verdict.FAIL
    assert topic_of(report, STATE).fields[0].max_error == pytest.approx(1e-5)
    assert topic_of(report, INTERVAL).passed
    report = validate(servo, config, None)
    assert (report.verdict, len(report.topics)) == (Verdict.PASS, 2)
    assert texts(report) == ['the corrected output is not judged: no calibration is given']


@pytest.mark.parametrize('recorded', [[], [STATE]])
def test_only_the_topics_that_were_recorded_are_judged(config, servo, recorded):
    lacking = {STATE, INTERVAL}.difference(recorded)
    report = validate([message for message in servo if message[0] not in lacking], config)
    assert report.verdict == Verdict.PASS
    topics = [topic.topic for topic in report.topics]
    assert topics == ['/output_state', '/body_poses', *recorded]


def test_calibration_that_was_set_later_leaves_the_rest_judged(config, servo):
    set_at = servo[len(servo) // 2][1]
    messages = [
        message for message in servo if message[0] not in NAMES.values() or message[1] > set_at
    ]
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS, report.findings
    assert 1000 < topic_of(report, STATE).compared < 2000
    for k, (topic, number) in enumerate([('/output_state', 1400), (STATE, 1000)]):
        at = [n for n, message in enumerate(messages) if message[0] == topic][number]
        report = validate(messages[:at] + messages[at + 1 :], config)
        assert [found.missing for found in report.topics] == [[1, 0, 0, 0], [0, 0, 1, 0]][k]


def swings(jump: float = 0.0) -> list[Message]:
    """Simulate a rotor that swings, and whose encoder jumps after 2.5 s, rad."""
    messages = []
    for k in range(4000):
        phase = math.tau * k / 1000
        angle, velocity = 5.0 * math.sin(phase), 5.0 * math.tau * math.cos(phase)
        angle += jump * (k >= 2500)
        stamp = 10**18 + k * 10**6
        data = rotor_bytes(stamp, position=[angle], velocity=[velocity], effort=[0.1])
        messages.append(('/rotor_state', stamp, data))
    return messages


def test_lost_inputs_leave_the_history_unknown_and_not_wrong(config):
    """At a turning point, where the play depends on the position that is missing."""
    bag = corrected(swings(), config, topics=ALL)
    stamps = {10**18 + k * 10**6 for k in range(1740, 1761)}
    kept = [m for m in bag if not (m[0] == '/rotor_state' and m[1] in stamps)]
    assert len(kept) == len(bag) - 21
    report = validate(kept, config)
    assert report.verdict == Verdict.PASS, report.findings
    # And once the output has travelled far enough, all is judged again.
    assert validate(changed(kept, STATE, 2500, velocity=1e-8), config).verdict == Verdict.FAIL


def test_turns_that_a_jump_of_the_encoder_made_unknown_are_unknown_here_too(config):
    report = validate(corrected(swings(jump=100.0), config, topics=ALL), config)
    assert report.verdict == Verdict.PASS, report.findings
    assert topic_of(report, INTERVAL).compared > 3900


@pytest.mark.parametrize('changes', [{'frame_prefix': 'left_'}, {'rotor_zero': 0.5}])
def test_prefix_and_zero_are_those_of_the_other_outputs(config, changes):
    rotor = [m for m in read_bag(BAGS / 'servo_point_to_point') if m[0] == '/rotor_state']
    other = replace(config, **changes)
    messages = corrected(rotor, other, topics=ALL)
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS, report.findings
    if 'rotor_zero' in changes:
        assert validate(messages, config, strict=True).verdict == Verdict.FAIL


def test_single_turn_encoder_is_judged_where_its_turns_do_not_matter():
    config = NodeParameters.load(BAGS / 'single_turn_encoder' / 'actuator.yaml')
    bag = read_bag(BAGS / 'single_turn_encoder')
    report = validate(corrected(bag, config, WITHIN_TURN), config, WITHIN_TURN)
    assert report.verdict == Verdict.PASS, report.findings
    assert topic_of(report, STATE).compared == 2500
    report = validate(corrected(bag, config, MADE), config, MADE)
    assert report.verdict == Verdict.PASS
    assert len(report.topics) == 2
    assert any('when a single-turn encoder was referenced' in text for text in texts(report))
