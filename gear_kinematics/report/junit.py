"""The report as JUnit XML, as Jenkins, GitLab and Ant read it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from xml.etree import ElementTree as ET

from gear_kinematics.report import text, wording
from gear_kinematics.validation.report import BagReport, Verdict


@dataclass(frozen=True, slots=True)
class _Case:
    name: str
    faults: tuple[str, ...] = ()
    kind: str = 'failure'


def to_junit(reports: Sequence[BagReport], when: datetime | None = None) -> str:
    """Write a test suite for each bag, with a test case for the input, each topic and each field.

    Args:
        reports: in the order of the suites.
        when: the time of the validation, now by default.
    """
    stamp = (when or datetime.now(UTC)).strftime('%Y-%m-%dT%H:%M:%S')
    root = ET.Element('testsuites')
    for number, report in enumerate(reports):
        _add_suite(root, report, number, stamp)
    ET.indent(root)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding='unicode') + '\n'
    )


def _add_suite(root: ET.Element, report: BagReport, number: int, stamp: str) -> None:
    cases = list(_cases(report))
    name = wording.bag_name(report)
    suite = ET.SubElement(
        root,
        'testsuite',
        # The order of elements and the attributes are those that Ant's schema asks for.
        name=name,
        id=str(number),
        package='gearkin.validate',
        hostname='localhost',
        timestamp=stamp,
        time='0',
        tests=str(len(cases)),
        failures=str(sum(bool(case.faults) and case.kind == 'failure' for case in cases)),
        errors=str(sum(bool(case.faults) and case.kind == 'error' for case in cases)),
        skipped='0',
    )
    properties = ET.SubElement(suite, 'properties')
    for _, key, cell in wording.head(report).facts():
        ET.SubElement(properties, 'property', name=key, value=cell.with_unit())
    # A dot would split the name into package and class.
    classname = name.replace('.', '_')
    for case in cases:
        element = ET.SubElement(suite, 'testcase', name=case.name, classname=classname, time='0')
        if case.faults:
            found = ET.SubElement(element, case.kind, message=case.faults[0], type='validation')
            found.text = '\n'.join(case.faults)
    ET.SubElement(suite, 'system-out').text = '\n'.join(text.bag_lines(report))
    ET.SubElement(suite, 'system-err')


def _cases(report: BagReport) -> Iterator[_Case]:
    parts = list(_parts(report))
    if report.verdict == Verdict.UNUSABLE:
        # Also where the error is not worded: the suite must not look like a passing one.
        error = wording.printable(report.error or 'the bag is unusable')
        yield _Case('bag', (error,), kind='error')
    elif report.verdict == Verdict.FAIL and not any(part.faults for part in parts):
        faults = tuple(wording.remarks(report)) or ('the bag fails',)
        yield _Case('bag', faults)
    else:
        yield _Case('bag')
    yield from parts


def _parts(report: BagReport) -> Iterator[_Case]:
    if report.rotor:
        # Never fails by itself: what makes outputs wrong or missing is told there.
        yield _Case(wording.printable(f'input {report.rotor.topic}'))
    for topic in report.topics:
        yield _Case(wording.printable(topic.topic), tuple(wording.topic_faults(topic, report)))
        for field in topic.fields:
            faults = tuple(wording.field_faults(field, report))
            yield _Case(wording.field_name(topic, field), faults)
