# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The facts that are reported of the rotor input, with a simulated clock."""

import math
import struct
from contextlib import suppress
from dataclasses import replace

import pytest
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections, DriverFacts
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.joint_reader import RejectedInputError

SETTINGS = NodeParameters.load()
START = 1000.0


class Bench:
    """An input and its monitor, with a clock that the test sets."""

    def __init__(self) -> None:
        self.gear = GearState(SETTINGS)
        self.monitor = self.gear.monitor
        self.connections = Connections(DriverFacts(since=START))

    def feed(self, at, *messages) -> None:
        for data in messages:
            self.monitor.last_input = at
            with suppress(RejectedInputError):
                self.gear.rotor(data, lambda: SECOND)

    def report(self, at):
        return self.gear.report(at, self.connections)['rotor input']

    def facts(self, at):
        return self.report(at).facts


def good(stamp=1, position=1.0) -> bytes:
    return rotor_bytes(stamp, position=[position])


def unnormalised(seconds, nanoseconds) -> bytes:
    return good()[:4] + struct.pack('<iI', seconds, nanoseconds) + good()[12:]


BAD = rotor_bytes(1, position=[math.nan])
NO_JOINT = rotor_bytes(1, ['wheel'], [1.0])
NOT_FINITE = Condition.REJECTED(counts={'position not finite': 1})


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_counts_are_facts_of_the_next_report_alone_and_faults_of_the_graph_of_all(bench):
    driver, connections = bench.connections.rotor, bench.connections
    listener, fault = (
        condition(topic='out', policy='DURABILITY', node='/other')
        for condition in (Condition.LISTENER_QOS, Condition.DRIVER_QOS)
    )
    bench.feed(START + 0.5, good(), BAD, b'', BAD)
    driver.lost, connections.unsent, bench.monitor.unreferenced = 3, 2, 77
    connections.graph = [listener, fault]
    assert bench.facts(START + 1.0) == [
        fault,  # the only error
        Condition.REJECTED(counts={'position not finite': 2, 'not a JointState': 1}),
        Condition.LOST(count=3),
        Condition.UNSENT(count=2),
        Condition.WERE_UNKNOWN(count=77),
        listener,
    ]
    bench.feed(START + 1.5, good(2))
    report = bench.report(START + 2.0)
    names = 'rejected: position not finite', 'lost messages', 'not sent', 'not referenced'
    assert [report.values[name] for name in names] == [2, 3, 2, 77]
    assert report.facts == [fault, listener]
    connections.graph = []
    bench.feed(START + 2.5, BAD)
    assert bench.facts(START + 3.0) == [NOT_FINITE]
    driver.losses_known = False
    bench.feed(START + 3.5, good(3))
    report = bench.report(START + 4.0)
    assert report.facts == [Condition.LOSSES_UNKNOWN()]
    assert report.values['lost messages'] == 'unknown'


def test_a_jump_from_before_the_reference_is_not_why_turns_are_unknown():
    gear = GearState(replace(SETTINGS, rotor_encoder='single_turn', max_rotor_speed=100.0))
    for time in (*range(40), 140):
        if time == 140:
            jumped, *_ = gear.report(START, Connections())['rotor input'].facts
            gear.input.home(0.0)
        position = (0.1 * time + 3.0 * (time >= 20)) % math.tau
        with suppress(RejectedInputError):
            gear.rotor(good((100 + time) * SECOND // 100, position), int)
    assert jumped.condition is Condition.JUMPED
    gap, *_ = gear.report(START, Connections())['rotor input'].facts
    assert gap == Condition.GAP(gap=pytest.approx(1.01))


def test_drivers_of_other_joints_are_no_fault(bench):
    bench.feed(START + 0.5, NO_JOINT)
    lacking = Condition.JOINT_MISSING(counts={'joint missing': 1}, parameter='rotor_joint')
    assert bench.facts(START + 0.6) == [lacking]
    bench.feed(START + 0.7, good(1), NO_JOINT, good(2))
    bench.connections.rotor.publishers = 3
    report = bench.report(START + 1.6)
    assert (report.facts, report.values['of others']) == ([], 2)
    bench.feed(START + 1.7, good(3))  # the others are silent, as a gripper that does not move
    assert bench.facts(START + 2.0) == []
    bench.feed(START + 1.7, NO_JOINT, NO_JOINT)  # as later ones, which are no input
    [lacking] = bench.facts(START + 3.7)
    assert lacking == Condition.OTHERS_ALONE(age=pytest.approx(2.0), count=2, joint='rotor')


def test_two_drivers_on_the_topic_of_the_encoder_are_no_fault_if_one_sends_other_joints():
    """As on /joint_states of a middleware that gives messages no numbers."""
    gear = GearState(replace(SETTINGS, output_encoder_joint='output'))
    driver = DriverFacts(publishers=2, number=None)
    gear.encoder_monitor.last_input = START

    def facts(at, *messages):
        for data in messages:
            with suppress(RejectedInputError):
                gear.encoder(data, lambda: SECOND)
        return gear.encoder_monitor.report(START + at, driver).facts

    other, own = NO_JOINT, rotor_bytes(1, ['output'], [0.0])
    assert Condition.SEVERAL_DRIVERS() in facts(1.0, own)
    assert Condition.SEVERAL_DRIVERS() not in facts(2.0, own, other)
    assert Condition.SEVERAL_DRIVERS() not in facts(3.0, own)  # the other one sends on a change


def test_a_rotor_that_is_elsewhere_when_a_driver_comes_is_said_once(bench):
    bench.feed(START + 0.5, good())
    bench.monitor.moved = -math.pi
    assert bench.facts(START + 0.6) == [Condition.ELSEWHERE(angle_deg=-180.0)]
    assert bench.facts(START + 0.7) == []


@pytest.mark.parametrize(
    ('numbers', 'several'),
    [
        ([1, 2, 3, 4, 5], False),
        ([900, 901, 1, 2, 3], False),  # a driver that was started again
        ([900, 901, 1, 2, 3, 1, 2], False),  # a driver that was started twice more
        ([900, 1, 2, 3, 1, 2, 3, 4, 1], False),
        ([2, 1, 2, 3, 1, 2, 3, 4, 1], False),  # it ran ever longer
        ([900, 1, 901, 902, 2, 903, 3], True),
        ([1, 1, 2, 2, 3, 3], True),  # both began at the same time
        ([1, 900, 2, 901, 3, 902, 4], True),
        ([900, 1, 500, 901, 2, 501, 902, 3, 502], True),
    ],
)
def test_drivers_that_send_the_same_joint_are_known_by_their_numbers(bench, numbers, several):
    bench.connections.rotor.publishers = 2
    for stamp, number in enumerate(numbers):
        bench.connections.rotor.number = number
        bench.monitor.publishers.note(number)
        bench.feed(START + 0.5, NO_JOINT, good(stamp + 1))  # others share the topic
    [*facts] = bench.facts(START + 1.0)
    assert facts == several * [Condition.SEVERAL_DRIVERS()]
    for second in (2, 3, 4):
        bench.feed(START + second, good(10 * second))
        assert bench.facts(START + second) == facts  # also where one sends every few seconds
    bench.feed(START + 5, good(60))
    assert bench.facts(START + 5) == []


def test_silence_beyond_the_timeout_is_an_error(bench):
    def no_input(age):
        return [Condition.NO_INPUT(age=pytest.approx(age))]

    assert bench.facts(START + 1.0) == []
    report = bench.report(START + 1.1)
    assert (report.facts, report.values['age of last input (s)']) == (no_input(1.1), None)
    bench.feed(START + 10.0, BAD)  # no silence
    assert bench.facts(START + 11.0) == [NOT_FINITE]
    assert bench.facts(START + 70.0) == no_input(60.0)
    bench.feed(START + 70.5, good())
    assert bench.facts(START + 71.0) == []


def test_values_count_what_happened(bench):
    bench.feed(
        START + 1.0,
        rotor_bytes(0, position=[1.0]),  # no stamp: 1 s of the clock
        good(SECOND),  # duplicate
        good(SECOND + 5),
        good(SECOND),  # out of order
        good(20 * SECOND),
        good(5 * SECOND),  # reset
        unnormalised(5, SECOND + 1),
        rotor_bytes(6 * SECOND, position=[1e17]),
        BAD,
        b'garbage',
    )
    assert bench.report(START + 1.25).texts == {
        'rate (Hz)': '8.0',  # 10 messages in 1.25 s
        'received': '10',
        'published': '6',
        'rejected: not a JointState': '1',
        'rejected: out of order': '1',
        'rejected: position not finite': '1',
        'rejected: position too large': '1',
        'lost messages': '0',
        'of others': '0',
        'not sent': '0',
        'not referenced': '0',
        'drivers': '0',
        'duplicate stamps': '1',
        'zero stamps': '1',
        'unnormalised stamps': '1',
        'clock resets': '1',
        'age of last input (s)': '0.250',
        'referenced': 'true',
        'rotor zero (rad)': '0',
        'home file': '',
        'advice': 'docs/diagnostics.md explains why messages are rejected.',
    }


def test_rate_is_that_since_the_last_report(bench):
    bench.feed(START + 0.5, *(good(n) for n in range(1, 31)))
    assert bench.report(START + 1.0).values['rate (Hz)'] == 30.0
    bench.feed(START + 1.5, *(good(n) for n in range(31, 41)))
    assert bench.report(START + 3.0).values['rate (Hz)'] == 5.0
    for _ in range(2):  # the second time without any time in between
        assert bench.report(START + 4.0).values['rate (Hz)'] == 0.0


@pytest.mark.parametrize(('pace', 'clock_set'), [(1, 1), (1, 4), (10, 9), (1000, 9)])
def test_stamps_of_milliseconds_as_seconds_are_named_but_no_clock_that_is_set(
    pace, clock_set, bench
):
    for k in range(6):
        begin = 10**9 + 9000 * (k >= clock_set)
        stamps = [begin * SECOND + (10 * k + n) * pace * SECOND // 10 for n in range(1, 11)]
        bench.feed(START + k, *map(good, stamps))
        named = [Condition.STAMPS_TOO_FAST(factor=pytest.approx(pace))]
        assert bench.facts(START + k + 0.95) == (named if pace == 1000 and k > 1 else [])


def test_stamps_in_ms_at_2_khz_are_no_repeated_stamps():
    gear = GearState(replace(SETTINGS, rotor_encoder='single_turn'))
    found = []
    for first in (0, 1001):
        for k in range(first, first + 1001):
            gear.rotor(good(SECOND + k // 2 * 1_000_000), int)
        found += gear.report(START + first, Connections(DriverFacts(since=START)))[
            'rotor input'
        ].facts
    assert Condition.REPEATED_STAMPS not in {fact.condition for fact in found}
