# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report as JUnit XML."""

from dataclasses import replace
from pathlib import Path

import pytest
import report_samples as samples
from lxml import etree

from gear_kinematics.report.document import Verdict
from gear_kinematics.report.junit import to_junit
from gear_kinematics.validation.document import document
from gear_kinematics.validation.findings import sentence


@pytest.fixture(scope='module')
def schema():
    return etree.XMLSchema(file=Path(__file__).parents[1] / 'support' / 'junit.xsd')


def parse(*reports):
    return etree.fromstring(to_junit(document(reports)).encode())


def outcomes(suite):
    """Give name and outcome of each test case."""
    return [
        (case.get('name'), *(f'{child.tag}: {child.get("message")}' for child in case))
        for case in suite.iter('testcase')
    ]


def test_every_report_is_valid(schema):
    for reports in ([], *([report] for report in samples.ALL), samples.ALL):
        root = parse(*reports)
        schema.assertValid(root)
        assert [suite.get('id') for suite in root] == [str(k) for k in range(len(reports))]
    del root[0].attrib['tests']
    assert not schema.validate(root)


def test_passing_bag_has_a_case_for_each_topic_and_field():
    (suite,) = parse(samples.PASSING)
    assert outcomes(suite) == [
        ('bag',),
        ('input /rotor_state',),
        ('/output_state',),
        ('/output_state position',),
        ('/output_state velocity',),
        ('/output_state effort',),
        ('/body_poses',),
        ('/body_poses position',),
        ('/body_poses orientation',),
    ]
    counts = {name: suite.get(name) for name in ('tests', 'failures', 'errors', 'skipped')}
    assert counts == {'tests': '9', 'failures': '0', 'errors': '0', 'skipped': '0'}
    assert suite.get('name') == 'bags/servo'


def test_failing_parts_fail_with_a_message():
    (suite,) = parse(replace(samples.FAILING, elapsed=1.25))
    first = 'the first at stamp 1700000001123456789'
    assert outcomes(suite) == [
        ('bag', f'failure: {sentence(samples.FAILING.causes[0])}'),
        ('input /rotor_state',),
        ('/output_state', f'failure: 11 messages missing, {first}'),
        (
            '/output_state position',
            (
                'failure: error 0.002 rad at rotor angle 785.398163 rad exceeds the tolerance '
                'of the angle, 1e-9 rad, at stamp 1700000002623456789'
            ),
        ),
        ('/output_state velocity', 'failure: 5 values not finite'),
        ('/output_state effort', 'failure: 1 value without a counterpart'),
        ('/body_poses', 'failure: no message could be compared'),
    ]
    assert suite.get('failures') == '6'
    assert suite.findall('testcase/failure')[1].text.count('\n') == 3
    # All cases are judged at once, in the time of the first.
    assert [suite.get('time'), *(case.get('time') for case in suite.iter('testcase'))][:3] == [
        '1.250',
        '1.250',
        '0.000',
    ]
    assert f'{samples.FAILING.bag}: verdict: failed: ' in suite.findtext('system-out')


def test_unusable_bag_is_an_error_and_keeps_what_was_readable():
    (suite,) = parse(samples.DAMAGED)
    assert outcomes(suite)[0] == ('bag', f'error: {samples.DAMAGED.error}')
    assert suite.get('errors') == '1'
    assert suite.get('failures') == '0'
    assert suite.get('tests') == '9'
    # A dot would split the class.
    assert suite.find('testcase').get('classname') == 'logs/power_cut_mcap'
    (unexplained,) = parse(replace(samples.UNUSABLE, error=None))
    assert unexplained.get('errors') == '1'


def test_failing_bag_is_red_even_if_no_part_of_it_fails():
    (suite,) = parse(
        replace(
            samples.PASSING,
            verdict=Verdict.FAIL,
            findings=(samples.Finding(samples.FindingCause.LAST_ALONE),),
        )
    )
    assert outcomes(suite)[0] == ('bag', 'failure: only the last output is off')
    (suite,) = parse(samples.EMPTY)
    assert outcomes(suite) == [('bag', 'failure: the bag failed')]
    assert suite.get('failures') == '1'


def test_characters_that_xml_forbids_are_spelled_out():
    (suite,) = parse(samples.UNPRINTABLE)
    assert suite.get('name') == r'run\x1b[31m\x00\n\u202e\ud800\ufffe'
    (suite,) = parse(samples.HOSTILE_NAMES)
    assert suite.get('name') == samples.HOSTILE
