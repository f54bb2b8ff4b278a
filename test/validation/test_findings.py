# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The sentences of a validation, all in one document."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

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
    of_others=12,
    zero_stamps=3,
    duplicates=2004,
)
VALUES = {
    'rotor': ROTOR,
    'rejected': 3000,
    'causes': 'joint missing 3000',
    'topic': '/rotor_state',
    'output': '/output_state',
    'poses': '/body_poses',
    'topics': ['robot_description', 'markers'],
    'detail': 'no joint in it',
    'name': 'left',
    'expected': '-19',
    'received': 1_700_000_000_000_000_000,
    'error': '0.002',
    'tolerance': '1e-9',
    'unit': 'rad',
    'quantity': ' of the angle',
    'where': ' at rotor angle 785.398163 rad',
    'offset': 0.1 + 0.2,
    'angle': 0.125,
    'mean': '0.1 ± 0.002',
    'lowest': -0.123456,
    'highest': 1.0,
    'ratio': '-29',
    'ring': '60',
    'satellite': '58',
    'flipped': '',
    'field': 'velocity',
    'factor': 57.29578,
    'joint': 'motor',
    'other': 'wheel',
    'prefix': 'left_',
    'why': 'no calibration is given',
    'disagreement': 'output_encoder disagrees',
    'seconds': 1.23456,
    'lost': {'/output_state': 2, '/a': 1},
    'complete': ['/body_poses', '/b'],
    'actuator': 'elbow',
    'sentence': 'the last output alone is off',
    'joints': 'wrist, elbow',
    'independent': SimpleNamespace(text='40 outputs agree with the matrix method'),
}


def test_every_cause_has_its_sentence():
    found = [Finding(cause, stamp=2 * 10**9, count=3, values=VALUES) for cause in FindingCause]
    written = [f'{each.cause.name}: {sentence(each)}' for each in found]
    assert written == GOLDEN.read_text('utf-8').splitlines()


def test_time_of_a_finding_is_that_since_the_start_where_both_are_known():
    found, report = Finding(FindingCause.MISSING, count=1, stamp=2 * 10**9), unusable(Path(), '')
    assert sentence(found, report) == '1 message missing, the first at stamp 2000000000'
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
