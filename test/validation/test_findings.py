# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The sentences of a validation, all in one document."""

from dataclasses import replace
from pathlib import Path

from placeholders import filled
from report_samples import OUTPUT

from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.findings import findings, sentence
from gear_kinematics.validation.input_health import CHECKS
from gear_kinematics.validation.recorder import AFTER, BEFORE, LOST, NO_INPUT
from gear_kinematics.validation.report import Finding, InputReport, unusable

GOLDEN = Path(__file__).with_name('findings.txt')
ROTOR = InputReport(
    '/rotor_state',
    'rotor',
    messages=4013,
    valid=4008,
    jumped="the rotor's encoder jumped by 100 rad at 12.5 s",
    velocity_is='the velocities are in rpm',
    beyond_limits='the speed reaches 700 rad/s',
    jumps=2,
    set_back='the clock was set back by 0.3 s',
    outside='the output, at -10.00°, is outside of output_range, 0.00° to 270.00°',
    effort_is='efforts of up to 1500 N·m',
    of_others=12,
    zero_stamps=3,
    duplicates=2004,
)
VALUES = {
    'topics': ['robot_description', 'markers'],
    'lost': {'/output_state': 2, '/a': 1},
    'complete': ['/body_poses', '/b'],
}


def test_every_cause_has_its_sentence():
    own = 'moment', 'messages', 'items', 'gaps'
    values = {cause: filled(cause.value, own, **VALUES) for cause in FindingCause}
    found = [Finding(cause, stamp=2 * 10**9, count=3, values=values[cause]) for cause in values]
    written = [f'{each.cause.name}: {sentence(each)}' for each in found]
    assert written == GOLDEN.read_text('utf-8').splitlines()


def test_time_of_a_finding_is_that_since_the_start_where_both_are_known():
    found, report = Finding(FindingCause.MISSING, count=1, stamp=2 * 10**9), unusable(Path(), '')
    assert sentence(found, report) == '1 message missing, the first at stamp 2000000000'
    # The inputs had no stamps, and the outputs those of a simulated clock.
    apart = replace(report, rotor=replace(ROTOR, first_stamp=1_700_000_000 * 10**9))
    assert sentence(found, apart) == '1 message missing, the first at stamp 2000000000'
    assert sentence(Finding(FindingCause.MISSING, count=1), report) == '1 message missing'


def test_why_messages_are_skipped_fits_one_and_several():
    report = unusable(Path(), '')
    for count in (1, 2):
        left_out = {BEFORE: count, AFTER: count, NO_INPUT: count, LOST: count}
        topic = replace(OUTPUT, left_out=left_out)
        told = [found.text for found in findings(replace(report, topics=(topic,)))]
        messages = '1 message' if count == 1 else '2 messages'
        assert told[-4:] == [
            f'{messages} skipped: the recording had just begun',
            f'{messages} skipped: the recording ended first',
            f'{messages} skipped: the input was not recorded',
            f'{messages} skipped: lost by the recorder, by its own count',
        ]


def test_one_of_a_kind_is_in_the_singular():
    rotor = replace(ROTOR, jumps=1, of_others=1, zero_stamps=1, duplicates=0)
    told = [sentence(found) for check in CHECKS for found in check(rotor)]
    assert [each.partition(' of /rotor_state')[0] for each in told if each[0] == '1'] == [
        '1 gap',
        '1 message',
        '1 message',
    ]
