# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Corrected output, loads and mechanism in recordings: the node's pass, what differs is found."""

import math
import struct
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import pytest
import validating
from calibrations import calibration
from live import rotor_bytes
from node_loop import answered
from shipped_bags import BAGS, OUTPUT, ROTOR, read_bag
from validating import field_of, texts, topic_of

from gear_kinematics.bag import Message
from gear_kinematics.correction.calibration_file import Calibration, Order
from gear_kinematics.kinematics.loads import Bodies
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.findings import explain
from gear_kinematics.wire.cdr import SECOND

STATE, INTERVAL, STATES = '/corrected_state', '/corrected_interval', '/mechanism_joint_states'
BRANCHES, WRENCHES = '/branch_loads', '/joint_loads'
MADE = replace(calibration(), spans=replace(calibration().spans, speed=(-40.0, 40.0)))
WITHIN_TURN = replace(
    MADE,
    orders=(Order('rotor × 1', Fraction(1), 1e-3, 2e-4),),
    covariance=tuple(tuple(float(k == n) for k in range(5)) for n in range(5)),
)
BRACED = replace(NodeParameters.load(), preload=1.5, branch_stiffness=(3000.0,))


class Kind(NamedTuple):
    """Topics that are judged in the same way."""

    topics: tuple[str, ...]
    config: NodeParameters = NodeParameters.load()
    made: Calibration | None = None
    bound: float = 0.0
    """Errors of outputs that the node has published, in the unit of each."""
    judged: float = 0.99
    """Least share of the values that are judged: a gap lets the next ones be unknown."""

    def recorded(self, messages, *, besides=(), **options) -> list[Message]:
        """Add what the node publishes on these topics, and on others besides."""
        topics = [topic[1:] for topic in (*besides, *self.topics)]
        return answered(self.config, messages, calibration=self.made, topics=topics, **options)

    def validate(self, messages, **options):
        further = {topic[1:]: topic for topic in self.topics}
        return validating.validate(
            messages, self.config, further=further, calibration=self.made, **options
        )


CORRECTED = Kind((STATE, INTERVAL), made=MADE, bound=1e-11)
LOADS = Kind((BRANCHES, WRENCHES), BRACED)
HEAVY = LOADS._replace(  # what follows a gap by less than 20 ms is not judged
    config=replace(BRACED, loads=Bodies(0.05, 2e-5, 0.02, 3e-6, 4e-5, 0.4)), judged=0.6
)
KINDS = {'corrected': CORRECTED, 'loads': LOADS, 'heavy': HEAVY, 'mechanism': Kind((STATES,))}
EACH = pytest.mark.parametrize('kind', KINDS.values(), ids=KINDS)


@cache
def published(kind: Kind, name: str = 'servo_point_to_point') -> list[Message]:
    return kind.recorded(read_bag(BAGS / name))


def rows(messages, topic: str) -> list[int]:
    return [k for k, message in enumerate(messages) if message[0] == topic]


@EACH
@pytest.mark.parametrize(
    ('name', 'samples'),
    [('servo_point_to_point', 3000), ('constant_speed_3000rpm', 3000), ('driver_faults', 1265)],
)
def test_what_the_node_publishes_passes(kind, name, samples):
    report = kind.validate(published(kind, name))
    assert report.verdict == Verdict.PASS, report.findings
    for found in (topic_of(report, topic) for topic in kind.topics):
        # Without an effort, nothing is known of the loads.
        least = 1000 if kind.config.preload else samples
        assert samples >= found.compared == found.messages >= least
        assert max(field.max_error for field in found.fields) <= kind.bound
        # Some messages of the faulty driver have no velocity either.
        least = kind.judged * min(found.messages, field_of(report, OUTPUT, 'velocity').compared)
        assert min(field.compared for field in found.fields) >= least > 600


def off(by: float):
    return lambda value: value + by


def flipped(value: float) -> float:
    """Flip a bit in the exponent."""
    (bits,) = struct.unpack('<Q', struct.pack('<d', value))
    return struct.unpack('<d', struct.pack('<Q', bits ^ 1 << 62))[0]


def changed(messages, topic: str, place: int, change, number: int = 2000):
    """Change a number of a message of a topic, which begins at a place from its end, bytes."""
    row = rows(messages, topic)[number]
    name, received, data = messages[row]
    (value,) = struct.unpack_from('<d', data, len(data) + place)
    data = bytearray(data)
    struct.pack_into('<d', data, len(data) + place, change(value))
    return [*messages[:row], (name, received, bytes(data)), *messages[row + 1 :]]


JOINTS = 'angle', 'angle', 'angle', 'slide', 'slide', 'angle'
"""Rotor, satellites, couplings and output shaft of mechanism_joint_states."""
SPEEDS = 'velocity', 'velocity', 'velocity', 'slide velocity', 'slide velocity', 'velocity'
DIFFERING = [
    *((CORRECTED, STATE, -40, off(by), 'position') for by in (2e-9, math.nan)),
    (CORRECTED, STATE, -24, off(-2e-9), 'velocity'), (CORRECTED, STATE, -8, off(2e-9), 'effort'),
    *((CORRECTED, INTERVAL, -16, off(by), 'half width') for by in (2e-9, -2e-9)),
    (LOADS, BRANCHES, -8, flipped, 'torque'), (LOADS, BRANCHES, -32, flipped, 'stand-off'),
    (LOADS, WRENCHES, -48, flipped, 'force'), (LOADS, WRENCHES, -8, flipped, 'couple'),
    *((KINDS['mechanism'], STATES, 8 * k - 108, flipped, name) for k, name in enumerate(JOINTS)),
    *((KINDS['mechanism'], STATES, 8 * k - 52, flipped, name) for k, name in enumerate(SPEEDS)),
]  # fmt: skip


@pytest.mark.parametrize(('kind', 'topic', 'place', 'change', 'name'), DIFFERING)
def test_a_number_that_differs_is_found_and_located(kind, topic, place, change, name):
    messages = published(kind)
    report = kind.validate(changed(messages, topic, place, change))
    [(where, field)] = [(t.topic, f) for t in report.topics for f in t.fields if not f.passed]
    assert (report.verdict, where, field.name) == (Verdict.FAIL, topic, name)
    stamp = struct.unpack_from('<iI', messages[rows(messages, topic)[2000]][2], 4)
    found = field.first_non_finite if field.non_finite else field.worst_stamp
    assert divmod(found, 10**9) == stamp
    if kind is CORRECTED and not field.non_finite:
        assert field.max_error == pytest.approx(2e-9, rel=1e-3)


def test_wrench_out_of_the_plane_is_no_message_of_the_topic():
    report = LOADS.validate(changed(published(LOADS), WRENCHES, -32, flipped))  # the force along z
    assert report.verdict == Verdict.FAIL
    (fault,) = topic_of(report, WRENCHES).faults
    assert (fault.cause, fault.count) == (FindingCause.MALFORMED, 1)


@EACH
def test_missing_messages_are_found(kind):
    dropped = rows(published(kind), kind.topics[-1])[1500:1503]
    report = kind.validate([m for k, m in enumerate(published(kind)) if k not in dropped])
    assert [topic.missing for topic in report.topics] == [0] * (1 + len(kind.topics)) + [3]


@EACH
def test_recording_that_lacks_inputs_passes(kind):
    """The node has seen the messages that a recorder loses, and its acceleration rests on them."""
    inputs = rows(published(kind), ROTOR)
    lost = {*inputs[1000:1010], inputs[2000]}
    report = kind.validate([m for k, m in enumerate(published(kind)) if k not in lost])
    assert report.verdict == Verdict.PASS, report.findings


@EACH
@pytest.mark.parametrize('share', [0.2, 0.65])
def test_recording_may_begin_at_any_time(kind, share):
    begin = rows(published(kind), ROTOR)[round(share * 3000)]
    report = kind.validate(published(kind)[begin:])
    assert report.verdict == Verdict.PASS, report.findings
    assert topic_of(report, kind.topics[0]).compared >= (1.0 - share) * 3000 - 1


@pytest.mark.parametrize('number', [100, 1500])
def test_homing_interrupts_no_loads(number):
    """The acceleration of heavy bodies, which takes 20 ms to find, is that of before.

    The rotor stands at its zero when the message of the first number comes.
    """
    inputs = [m for m in published(HEAVY) if m[0] == ROTOR]
    both = OUTPUT, '/body_poses'
    report = HEAVY.validate(HEAVY.recorded(inputs, besides=both, home_after=number))
    assert report.verdict == Verdict.PASS, report.findings


def test_loads_of_another_preload_fail():
    other = LOADS._replace(config=replace(BRACED, preload=1.6))
    report = other.validate(published(LOADS))
    assert report.verdict == Verdict.FAIL
    assert not topic_of(report, BRANCHES).passed


def test_another_calibration_is_found_and_none_is_named():
    report = CORRECTED._replace(made=replace(MADE, constant=2e-5)).validate(published(CORRECTED))
    assert report.verdict == Verdict.FAIL
    assert topic_of(report, STATE).fields[0].max_error == pytest.approx(1e-5)
    assert topic_of(report, INTERVAL).passed
    report = CORRECTED._replace(made=None).validate(published(CORRECTED))
    assert (report.verdict, len(report.topics)) == (Verdict.PASS, 2)
    assert texts(report) == ['the corrected output is not judged: no calibration is given']


@pytest.mark.parametrize('recorded', [[], [STATE]])
def test_only_the_topics_that_were_recorded_are_judged(recorded):
    lacking = {STATE, INTERVAL}.difference(recorded)
    report = CORRECTED.validate([m for m in published(CORRECTED) if m[0] not in lacking])
    assert report.verdict == Verdict.PASS
    assert [topic.topic for topic in report.topics] == [OUTPUT, '/body_poses', *recorded]


def test_calibration_that_was_set_later_leaves_the_rest_judged():
    recorded = published(CORRECTED)
    set_at = recorded[len(recorded) // 2][1]
    messages = [m for m in recorded if m[0] not in CORRECTED.topics or m[1] > set_at]
    report = CORRECTED.validate(messages)
    assert report.verdict == Verdict.PASS, report.findings
    assert 1000 < topic_of(report, STATE).compared < 2000
    for topic, number, missing in ((OUTPUT, 1400, [1, 0, 0, 0]), (STATE, 1000, [0, 0, 1, 0])):
        at = rows(messages, topic)[number]
        report = CORRECTED.validate(messages[:at] + messages[at + 1 :])
        assert [found.missing for found in report.topics] == missing


def swings(jump: float = 0.0, amplitude: float = 5.0) -> list[Message]:
    """Simulate a rotor that swings, and whose encoder jumps after 2.5 s, rad."""
    messages = []
    for k in range(4000):
        phase = math.tau * k / 1000
        angle, velocity = amplitude * math.sin(phase), amplitude * math.tau * math.cos(phase)
        angle += jump * (k >= 2500)
        stamp = 10**18 + k * 10**6
        data = rotor_bytes(stamp, position=[angle], velocity=[velocity], effort=[0.1])
        messages.append((ROTOR, stamp, data))
    return CORRECTED.recorded(messages, besides=(OUTPUT, '/body_poses'))


def test_outputs_of_a_rotor_beyond_its_limits_are_explained_by_these_after_a_hole():
    """The node believes them from what it had in the hole of the recording."""
    bag = [m for m in swings(amplitude=200.0) if not 1.9 < (m[1] - 10**18) / SECOND < 2.1]
    report = CORRECTED.validate(bag)
    first, second, *_ = explain(report).splitlines()
    assert first.endswith(' rad/s exceed max_rotor_speed')
    assert '2 messages too many' in second
    for place, said in ((-24, 'exceeds the tolerance'), (-16, 'malformed')):
        wrong = explain(CORRECTED.validate(changed(bag, OUTPUT, place, off(1e-3), 1500)))
        assert said in wrong.splitlines()[0]


def test_lost_inputs_leave_the_history_unknown_and_not_wrong():
    """At a turning point, where the play depends on the position that is missing."""
    bag = swings()
    stamps = {10**18 + k * 10**6 for k in range(1740, 1761)}
    kept = [m for m in bag if not (m[0] == ROTOR and m[1] in stamps)]
    assert len(kept) == len(bag) - 21
    report = CORRECTED.validate(kept)
    assert report.verdict == Verdict.PASS, report.findings
    # And once the output has travelled far enough, all is judged again.
    wrong = changed(kept, STATE, -24, off(1e-8), 2500)
    assert CORRECTED.validate(wrong).verdict == Verdict.FAIL


def test_turns_that_a_jump_of_the_encoder_made_unknown_are_unknown_here_too():
    report = CORRECTED.validate(swings(jump=100.0))
    assert report.verdict == Verdict.PASS, report.findings
    assert topic_of(report, INTERVAL).compared > 3900


@pytest.mark.parametrize('changes', [{'frame_prefix': 'left_'}, {'rotor_zero': 0.5}])
def test_prefix_and_zero_are_those_of_the_other_outputs(config, changes):
    rotor = [m for m in read_bag(BAGS / 'servo_point_to_point') if m[0] == ROTOR]
    other = CORRECTED._replace(config=replace(config, **changes))
    messages = other.recorded(rotor, besides=(OUTPUT, '/body_poses'))
    report = CORRECTED.validate(messages)
    assert report.verdict == Verdict.PASS, report.findings
    if 'rotor_zero' in changes:
        assert CORRECTED.validate(messages, strict=True).verdict == Verdict.FAIL


def test_single_turn_encoder_is_judged_where_its_turns_do_not_matter():
    single = NodeParameters.load(BAGS / 'single_turn_encoder' / 'actuator.yaml')
    bag = read_bag(BAGS / 'single_turn_encoder')
    kind = CORRECTED._replace(config=single, made=WITHIN_TURN)
    report = kind.validate(kind.recorded(bag))
    assert report.verdict == Verdict.PASS, report.findings
    assert topic_of(report, STATE).compared == 2500
    kind = kind._replace(made=MADE)
    report = kind.validate(kind.recorded(bag))
    assert report.verdict == Verdict.PASS
    assert len(report.topics) == 2
    assert any('when a single-turn encoder was referenced' in text for text in texts(report))
