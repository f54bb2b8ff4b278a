# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A validation as a document."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from typing import Any

from gear_kinematics.report.document import (
    OUTCOME,
    Case,
    Document,
    Section,
    Verdict,
    counted,
    printable,
)
from gear_kinematics.validation.figure import figure, moving
from gear_kinematics.validation.findings import answer, described, faults, field_name, findings
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.tables import bag_name, summary, tables

SCHEMA = 'gear_kinematics/report'
VERSION = 1


def document(reports: Sequence[BagReport]) -> Document:
    """Return the document of a validation, with a section for each bag."""
    count = {verdict: sum(report.verdict == verdict for report in reports) for verdict in Verdict}
    counts = ', '.join(f'{count[verdict]} {OUTCOME[verdict]}' for verdict in Verdict)
    # No bags at all count as unusable.
    verdict = next((v for v in reversed(Verdict) if count[v]), Verdict.UNUSABLE)
    return Document(
        'gearkin validate',
        tuple(map(_section, reports)),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'verdict': verdict,
            'bags': [_bag(report) for report in reports],
        },
        verdict,
        summary(reports),
        f'{counted(len(reports), "bag")}: {counts}' if len(reports) != 1 else '',
    )


def _section(report: BagReport) -> Section:
    drawn = figure(report)
    return Section(
        bag_name(report),
        tables(report),
        report.verdict,
        tuple(findings(report)),
        figure=drawn,
        mechanism=moving(report) if drawn else None,
        cases=tuple(_cases(report)),
        answer=answer(report),
        elapsed=report.elapsed,
    )


def _bag(report: BagReport) -> dict[str, Any]:
    """Return the JSON content about a bag; docs/report.schema.json describes it."""
    content = asdict(replace(report, series=(), lanes=(), mechanism=None))
    for left_out in ('series', 'lanes', 'mechanism', 'module', 'elapsed'):
        del content[left_out]
    content['findings'] = [one.text for one in findings(report) if one.kind == 'finding']
    content['causes'] = [described(finding, report) for finding in report.causes]
    for topic, written in zip(report.topics, content['topics'], strict=True):
        written['faults'] = [described(fault, report) for fault in topic.faults]
        written['passed'] = topic.passed
        for field, values in zip(topic.fields, written['fields'], strict=True):
            values |= {'passed': field.passed, 'budget_used': field.budget_used}
    return content


def _cases(report: BagReport) -> Iterator[Case]:
    """Yield the test cases of JUnit: the bag, its input, and each topic and field."""
    # Even without a finding, the suite must not look as if it passed.
    texts = tuple(one.text for one in findings(report)) or (f'the bag {OUTCOME[report.verdict]}',)
    unusable = report.verdict == Verdict.UNUSABLE
    yield Case('bag', () if report.passed else texts, 'error' if unusable else 'failure')
    if report.rotor:
        # Never fails by itself: its faults appear as wrong or missing outputs.
        yield Case(printable(f'input {report.rotor.topic}'))
    for topic in report.topics:
        for name in (topic.topic, *(field_name(topic, field) for field in topic.fields)):
            at_fault = (described(one, report) for one in faults(report) if one.topic == name)
            yield Case(printable(name), tuple(at_fault))
