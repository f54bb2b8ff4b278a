# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on a terminal and in a pipe."""

import io
import re
from dataclasses import replace

import pytest
import report_samples as samples
from rich.console import Console

from gear_kinematics.report.document import Document, Section, Sentence, Verdict, hertz, number
from gear_kinematics.report.text import lines, render
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.document import document
from gear_kinematics.validation.findings import answer, faults, field_name, findings, sentence

ESCAPES = re.compile(r'\x1b\[[0-9;]*m')


def piped(*reports, encoding='utf-8', **options):
    raw = io.BytesIO()
    with io.TextIOWrapper(raw, encoding) as file:
        render(document(reports), Console(file=file, **options))
        file.flush()
        return raw.getvalue().decode(encoding)


def shown(*reports, width=100):
    file = io.StringIO()
    render(
        document(reports),
        Console(file=file, force_terminal=True, width=width, color_system='standard'),
    )
    return file.getvalue()


def visible(*reports, width=100):
    return ESCAPES.sub('', shown(*reports, width=width))


def test_pipe_has_one_row_per_line_in_the_order_of_the_report():
    lines = piped(samples.FAILING).splitlines()
    first = f'{samples.FAILING.bag}: verdict: failed: the recorded ratio is -29, not -19: '
    assert lines[0].startswith(first)
    name = f'{samples.FAILING.bag}: '
    tables = [line.removeprefix(name) for line in lines if f'{name}/rotor_state' in line]
    assert tables[0].startswith('/rotor_state: joint: rotor; messages: 4013; valid: 4008; ')
    assert tables[0].endswith(
        'gaps: 2; rate: 1000 Hz; duration: 3.999 s; max speed: 314.159 rad/s'
    )
    assert len(tables) == 1


def test_every_fault_is_a_sentence_that_names_and_locates_it():
    """By gravity: wrong numbers and names before missing messages, and a cause before both."""
    cause, note = samples.FAILING.findings
    assert [finding.text for finding in findings(samples.FAILING)] == [
        sentence(cause),
        (
            "/output_state: no joint 'shaft' (output_joint?), but wheel: 3 messages, the first at "
            f'stamp {samples.START}'
        ),
        (
            '/output_state position: error 0.002 rad at rotor angle 785.398163 rad exceeds the '
            'tolerance of the angle, 1e-9 rad, at stamp 1700000002623456789'
        ),
        '/output_state velocity: 5 values not finite',
        '/output_state effort: 1 value without a counterpart',
        '/output_state: 11 messages missing, the first at stamp 1700000001123456789',
        '/output_state: 8 messages too many, the first at stamp 1700000001123456790',
        '/output_state: 1 message out of order',
        '/body_poses: no message could be compared',
        '/body_poses: 4008 messages missing',
        sentence(note),
    ]
    # A cause of missing messages is less grave than a wrong number, too.
    lost = samples.Finding(FindingCause.NO_OUTPUT, count=1, values={'topic': '/a'}, explains=True)
    order = [f.text for f in findings(replace(samples.FAILING, findings=(lost,)))]
    assert order.index(sentence(lost)) == 4


def test_sentences_are_joined_by_one_full_stop():
    held = Sentence('finding', 'The limit is met.')
    section = Section('a', (), verdict=Verdict.PASS, answer='There is play.', findings=(held,))
    (line,) = lines(Document('', (section,), {}), brief=True)
    assert line == 'a: verdict: passed. There is play. The limit is met.'


def test_a_brief_report_is_verdict_findings_and_one_line_of_numbers():
    passing, failing, unusable = samples.EXACT, samples.FAILING, samples.UNUSABLE
    report = document([passing, unusable, failing])
    cause, *others = (finding.text for finding in findings(failing))
    found = list(lines(report, brief=True))
    assert found == [
        'summary: 3 bags: 1 passed, 1 failed, 1 unusable',
        (
            f'{failing.bag}: verdict: failed: {cause}; 4008 inputs, 12 of 3997 '
            'outputs wrong, largest error 0.002 rad (tolerance 1e-9 rad), 5 values not finite'
        ),
        *(f'{failing.bag}: finding: {text}' for text in others),
        # The error names the bag, which is not named twice.
        unusable.error.replace(': ', ': verdict: unusable: ', 1),
        (
            f'{passing.bag}: verdict: passed; 4000 inputs, 8000 outputs compared, '
            'largest error 0 (tolerance 1e-9)'
        ),
    ]
    assert list(lines(report.of_failed(), brief=True)) == found[:-1]
    file = io.StringIO()
    render(
        report, Console(file=file, force_terminal=True, width=100, color_system=None), brief=True
    )
    shown = file.getvalue()
    assert 'not finite' not in shown.split('messages missing')[-1]
    assert shown.count(passing.bag) == 1  # a bag that passed is a row of the table alone
    totals = '3 bags: 1 passed, 1 failed, 1 unusable'
    assert [shown.splitlines()[k] for k in (0, -1)] == [totals, totals]


@pytest.mark.parametrize('report', samples.ALL, ids=lambda report: ascii(report.bag))
def test_sentences_tell_a_fault_wherever_a_part_fails_and_nowhere_else(report):
    for topic in report.topics:
        at_fault = {fault.topic for fault in faults(report)}
        fields_passed = [field_name(topic, field) not in at_fault for field in topic.fields]
        assert fields_passed == [field.passed for field in topic.fields]
        whole = topic.topic not in at_fault
        assert (whole and all(fields_passed)) == topic.passed


def test_pipe_is_neither_wrapped_nor_decorated():
    text = piped(*samples.ALL, width=40)
    assert '\x1b' not in text
    assert not set(text) & set('─━│┃┏•')
    assert max(map(len, text.splitlines())) > 100
    assert all(': ' in line for line in text.splitlines())


@pytest.mark.parametrize('render_one', [piped, visible])
def test_names_cannot_control_the_terminal(render_one):
    text = render_one(samples.UNPRINTABLE)
    assert not [char for char in text if not char.isprintable() and char != '\n']
    assert r'run\x1b[31m\x00\n\u202e\ud800\ufffe' in text


@pytest.mark.parametrize('render_one', [piped, visible])
def test_names_are_no_markup(render_one):
    report = replace(samples.UNUSABLE, bag='[red]a[/red] :smile:', error='[/] 100 %')
    text = render_one(report)
    assert '[red]a[/red] :smile:' in text
    assert '[/] 100 %' in text


@pytest.mark.parametrize('width', [40, 80, 100, 160])
def test_terminal_cuts_nothing_off(width):
    long = replace(samples.FAILING, bag='/very/long/' * 20)
    topic = replace(samples.OUTPUT, topic='/left/arm' * 5)
    text = visible(long, samples.PASSING, replace(samples.PASSING, topics=(topic,)), width=width)
    assert '…' not in text
    assert max(map(len, text.splitlines())) <= width
    # What is longer than a line is broken at its edge, and no other word or number.
    assert long.bag in text.replace('\n', '')
    words = set(visible(samples.FAILING, width=1000).split())
    assert set(re.sub('─+', '', visible(samples.FAILING, width=width)).split()) <= words
    for value in ('1700000002623456789', '785.398163 rad', '4.3e-19', '4.4e-14'):
        assert value in text


def test_counts_of_zero_have_no_column_on_a_terminal():
    assert ' missing' in visible(replace(samples.FAILING, findings=()))
    assert ' missing' not in visible(samples.PASSING)
    assert 'missing: 0' in piped(samples.PASSING)


def test_colours_tell_what_is_bad():
    failing, passing = shown(samples.FAILING), shown(samples.PASSING)
    assert '\x1b[1;31mFAILED' in failing
    assert re.search(r'\x1b\[1;31m *11\x1b', failing)
    assert '\x1b[1;32mPASSED' in passing
    assert '31m' not in passing


@pytest.mark.parametrize(
    ('value', 'written'),
    [
        (0.0, '0'),
        (3.21e-15, '3.21e-15'),
        (1e-9, '1e-9'),
        (2e8, '2e8'),
        (float('inf'), 'inf'),
        (2914.0, '2910'),
        (9000.0, '9000'),
        (-123456.0, '-123000'),
    ],
)
def test_numbers_are_short(value, written):
    assert number(value) == written


@pytest.mark.parametrize(
    ('rate', 'written'),
    [(1003.4, '1003 Hz'), (9.6, '10 Hz'), (9.4, '9.4 Hz'), (1.0, '1 Hz'), (0.33, '0.33 Hz')],
)
def test_a_low_rate_is_not_0(rate, written):
    assert hertz(rate) == written


def test_zero_tolerance_is_used_up_by_any_error():
    exact = replace(samples.POSITION, tolerance=0.0, max_error=0.0)
    assert exact.budget_used == 0
    assert replace(exact, max_error=1e-300).budget_used == float('inf')


def test_not_a_number_is_the_worst_of_all():
    position, effort = samples.POSITION, samples.NOT_FINITE.topics[0].fields[2]
    topic = replace(samples.OUTPUT, fields=(position, effort))
    (row,) = document([replace(samples.NOT_FINITE, topics=(topic,))]).summary.rows
    assert [cell.text for cell in row][:4] == ['logs/nan', 'failed', '4000', 'nan']
    assert any(fault.topic == '/output_state effort' for fault in faults(samples.NOT_FINITE))


def test_values_that_are_no_numbers_are_counted_beside_the_largest_error():
    assert answer(samples.NOT_FINITE).endswith(', 4000 values not finite')


def test_worst_verdict_counts():
    passing, failing, unusable = samples.PASSING, samples.FAILING, samples.UNUSABLE
    assert document([passing, passing]).verdict == Verdict.PASS
    assert document([failing, passing]).verdict == Verdict.FAIL
    assert document([failing, unusable, passing]).verdict == Verdict.UNUSABLE
    assert document([]).verdict == Verdict.UNUSABLE


def test_bag_without_a_name_or_anything_else():
    assert piped(samples.EMPTY) == '(no name): verdict: failed\n(no name): messages: 0\n'
    assert visible(samples.EMPTY).startswith('FAILED (no name)\n')
