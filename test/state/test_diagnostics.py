# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on the rotor input: levels, messages and values, with a simulated clock."""

import math
import re
import struct
from dataclasses import replace
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.diagnostics import ERROR, OK, WARN, Fault, GraphFaults, InputMonitor
from gear_kinematics.state.plausibility import Jump
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.velocity_field import VelocityMeaning
from gear_kinematics.wire.joint_reader import RejectedInputError

SETTINGS = NodeParameters.load()
START = 1000.0
ROOT = Path(__file__).resolve().parents[2]


class Bench:
    """An input and its monitor, with a clock that the test sets."""

    def __init__(self, settings=SETTINGS) -> None:
        self.input = RotorInput(settings)
        self.monitor = InputMonitor(started=START)

    def feed(self, at, *messages) -> None:
        for data in messages:
            self.monitor.last_input = at
            try:
                self.input.accept(data, lambda: SECOND)
            except RejectedInputError:
                continue
            self.monitor.published += 1

    def report(self, at):
        return self.monitor.report(self.input, at)


def good(stamp=1, position=1.0) -> bytes:
    return rotor_bytes(stamp, position=[position])


def unnormalised(seconds, nanoseconds) -> bytes:
    return good()[:4] + struct.pack('<iI', seconds, nanoseconds) + good()[12:]


DEAF, MUTE, DOUBLE = Fault('deaf', 'Listen.'), Fault('mute', 'Speak.'), Fault('double', 'Stop.')
BAD = rotor_bytes(1, position=[math.nan])
NO_JOINT = rotor_bytes(1, ['wheel'], [1.0])


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_levels_are_those_of_diagnostic_status():
    levels = [DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR]
    assert [bytes([level]) for level in (OK, WARN, ERROR)] == levels


def test_rejects_and_losses_are_a_warning_in_the_next_report_alone(bench):
    bench.feed(START + 0.5, good(), BAD, b'', BAD)
    bench.monitor.lost += 3
    bench.monitor.unsent += 2
    report = bench.report(START + 1.0)
    rejected = 'rejected: position not finite 2, not a JointState 1'
    assert (report.level, report.message) == (WARN, f'{rejected}; lost 3; not sent 2')
    bench.feed(START + 1.5, good(2))
    report = bench.report(START + 2.0)
    assert (report.level, report.message) == (OK, 'ok')
    names = ('rejected: position not finite', 'lost messages', 'not sent')
    assert [report.values[name] for name in names] == ['2', '3', '2']
    bench.feed(START + 2.5, BAD)
    report = bench.report(START + 3.0)
    assert (report.level, report.message) == (WARN, 'rejected: position not finite 1')
    bench.monitor.losses_known = False
    bench.feed(START + 3.5, good(3))
    report = bench.report(START + 4.0)
    assert (report.level, report.message) == (OK, 'losses unknown')
    assert report.values['lost messages'] == 'unknown'


def test_drivers_of_other_joints_are_no_fault(bench):
    bench.feed(START + 0.5, NO_JOINT, good(1), NO_JOINT, good(2))
    bench.monitor.drivers = 3
    report = bench.report(START + 1.0)
    assert (report.level, report.message) == (OK, 'ok')
    assert (report.values['of others'], report.values['rate (Hz)']) == ('2', '2.0')
    bench.feed(START + 1.5, good(3))  # the others are silent, and one of them sends the joint
    assert bench.report(START + 2.0).message == '3 drivers'


def test_silence_beyond_the_timeout_is_an_error(bench):
    assert bench.report(START + 1.0).level == OK
    report = bench.report(START + 1.1)
    assert (report.level, report.message) == (ERROR, 'no input for 1.1 s')
    assert report.values['age of last input (s)'] == 'none'
    bench.feed(START + 10.0, BAD)  # no silence
    report = bench.report(START + 11.0)
    assert (report.level, report.message) == (WARN, 'rejected: position not finite 1')
    assert bench.report(START + 70.0).message == 'no input for 60.0 s'
    bench.feed(START + 70.5, good())
    assert bench.report(START + 71.0).level == OK


def test_time_without_a_reference_is_told_once_with_a_count(bench):
    bench.feed(START + 0.5, good())
    bench.monitor.unreferenced += 77
    report = bench.report(START + 1.0)
    assert (report.level, report.message) == (WARN, 'turns unknown for 77 inputs')
    assert bench.report(START + 1.5).message == 'ok'


@pytest.mark.parametrize(
    ('faults', 'level', 'message', 'advice'),
    [
        (GraphFaults(errors=[DEAF]), ERROR, 'deaf', 'Listen.'),
        (GraphFaults(warnings=[MUTE, DOUBLE]), WARN, 'mute; double', 'Speak. Stop.'),
        (GraphFaults(errors=[DEAF], warnings=[MUTE]), ERROR, 'deaf; mute', 'Listen. Speak.'),
    ],
)
def test_fault_in_the_graph_is_reported_as_long_as_it_lasts(bench, faults, level, message, advice):
    bench.feed(START + 0.5, good())
    bench.monitor.graph = faults
    for _ in range(2):
        report = bench.report(START + 1.0)
        assert (report.level, report.message) == (level, message)
        assert report.values['advice'] == advice
    bench.monitor.graph = GraphFaults()
    report = bench.report(START + 1.0)
    assert (report.level, report.message) == (OK, 'ok')
    assert 'advice' not in report.values


def test_every_fault_is_documented_with_its_level():
    page = (ROOT / 'docs/diagnostics.md').read_text('utf-8')
    documented = re.findall(r'^\| `([^`]+)` \| (WARN|ERROR) \|', page, re.MULTILINE)
    bench = Bench(replace(SETTINGS, rotor_encoder='single_turn'))
    bench.feed(START + 0.8, *12 * [NO_JOINT])
    bench.monitor.drivers, bench.monitor.lost, bench.monitor.unsent = 2, 3, 1
    bench.input.zero_stamps = 12
    bench.input.velocity_field.contradicts = True
    bench.input.velocity_field.finding = VelocityMeaning.RPM
    bench.input.plausibility.jump = Jump(1_700_000_000_500_000_000, 100.0)
    report = bench.report(START + 4.0)
    assert report.message.split('; ') == [
        message
        for message, _ in documented
        if not re.search('QoS|/|turns unknown|output_range', message)
    ]
    assert len(re.findall(r'\.(?: |$)', report.values['advice'])) == 9


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
    values = bench.report(START + 1.25).values
    assert values == {
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
    assert bench.report(START + 1.0).values['rate (Hz)'] == '30.0'
    bench.feed(START + 1.5, *(good(n) for n in range(31, 41)))
    assert bench.report(START + 3.0).values['rate (Hz)'] == '5.0'
    for _ in range(2):  # the second time without any time in between
        assert bench.report(START + 4.0).values['rate (Hz)'] == '0.0'
