# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What diagnostics say: all sentences in one document, and those of the documentation."""

import re
from pathlib import Path

from diagnostic_msgs.msg import DiagnosticStatus
from placeholders import filled

from gear_kinematics.state.statuses import ERROR, OK, WARN, Condition, GearReport

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = Path(__file__).with_name('statuses.txt')
VALUES = {
    'counts': {'joint missing': 12, 'not a JointState': 1},
    'doubt': Condition.VELOCITIES_ARE(meaning='0'),
    'topics': ['output_state', 'body_poses'],
    'which': [
        Condition.BEYOND_SPEED(speed=900.04),
        Condition.BEYOND_ACCELERATION(acceleration=9e4),
    ],
    'why': Condition.NO_SAMPLES(count=60),
}
LEVELS = {OK: 'OK', WARN: 'WARN', ERROR: 'ERROR'}


def test_levels_are_those_of_diagnostic_status():
    assert {getattr(DiagnosticStatus, name): name for name in LEVELS.values()} == {
        bytes([level]): name for level, name in LEVELS.items()
    }


def test_every_condition_has_its_sentence():
    facts = [one(**filled(one.message + one.advice, **VALUES)) for one in Condition]
    written = [
        f'{fact.condition.name}: {LEVELS[fact.condition.level]}: {fact}'
        + (f' -- {fact.advice}' if fact.advice else '')
        for fact in facts
    ]
    assert written == GOLDEN.read_text('utf-8').splitlines()


def test_a_message_has_the_gravest_fact_first_and_each_advice_once():
    driver, listener = (
        condition(topic='out', policy='DURABILITY', node='/other')
        for condition in (Condition.DRIVER_QOS, Condition.LISTENER_QOS)
    )
    unknown, lost = Condition.LOSSES_UNKNOWN(), Condition.LOST(count=3)
    report = GearReport.of([unknown, lost, listener, driver], {})
    assert (report.level, report.message) == (ERROR, f'{driver}; {lost}; {listener}; {unknown}')
    assert report.texts['advice'] == (
        'Change the quality of service of one of the two. '
        'Check the network, and whether the computer is too busy.'
    )
    report = GearReport.of([unknown], {})
    assert (report.level, report.message, report.texts) == (OK, 'losses unknown', {})
    assert GearReport.of([], {})[:] == ([], {})
    assert (GearReport.of([], {}).level, GearReport.of([], {}).message) == (OK, 'ok')


def test_the_documentation_has_every_fault_with_its_level():
    page = (ROOT / 'docs/diagnostics.md').read_text('utf-8')
    page = page.replace('`not referenced: ', '`')
    patterns = {
        condition: re.sub(r'\\{.*?\\}', '.+', re.escape(condition.message))
        for condition in set(Condition) - {Condition.BEYOND_LIMITS, Condition.NOT_FOUND}
    }
    for message, level in re.findall(r'^\| `([^`]+)` \| (WARN|ERROR) \|', page, re.MULTILINE):
        found = [each for each, pattern in patterns.items() if re.fullmatch(pattern, message)]
        assert {LEVELS[each.level] for each in found} == {level}, message
    texts = re.findall('`([^`]+)`', page)
    for condition, pattern in patterns.items():
        said = any(re.fullmatch(pattern, text) for text in texts)
        assert said or condition.level == OK, condition
