# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A report as JUnit XML, as Jenkins, GitLab and Ant read it."""

from datetime import UTC, datetime
from xml.etree import ElementTree as ET

from gear_kinematics.report.document import Document, Section
from gear_kinematics.report.mark import MARK
from gear_kinematics.report.text import section_lines


def to_junit(document: Document) -> str:
    """Write a test suite for each section of a document whose sections have cases."""
    stamp = datetime.now(UTC).strftime('%Y-%m-%dT%H:%M:%S')
    root = ET.Element('testsuites')
    for number, section in enumerate(document.sections):
        _add_suite(root, section, document.title.replace(' ', '.'), number, stamp)
    ET.indent(root)
    head = f'<?xml version="1.0" encoding="UTF-8"?>\n<!-- {MARK} -->\n'
    return head + ET.tostring(root, encoding='unicode') + '\n'


def _add_suite(root: ET.Element, section: Section, package: str, number: int, stamp: str) -> None:
    failed = [case for case in section.cases if case.faults]
    suite = ET.SubElement(
        root,
        'testsuite',
        # Ant's schema asks for these attributes and this order of elements.
        name=section.name,
        id=str(number),
        package=package,
        hostname='localhost',
        timestamp=stamp,
        time=f'{section.elapsed:.3f}',
        tests=str(len(section.cases)),
        failures=str(sum(case.kind == 'failure' for case in failed)),
        errors=str(sum(case.kind == 'error' for case in failed)),
        skipped='0',
    )
    properties = ET.SubElement(suite, 'properties')
    for _, name, cell in section.tables[0].facts():
        ET.SubElement(properties, 'property', name=name, value=cell.with_unit())
    # A dot would split the name into package and class.
    classname = section.name.replace('.', '_')
    for k, case in enumerate(section.cases):
        # All cases are judged in one pass, whose time is given to the first.
        time = f'{0.0 if k else section.elapsed:.3f}'
        element = ET.SubElement(suite, 'testcase', name=case.name, classname=classname, time=time)
        if case.faults:
            found = ET.SubElement(element, case.kind, message=case.faults[0], type='validation')
            found.text = '\n'.join(case.faults)
    ET.SubElement(suite, 'system-out').text = '\n'.join(section_lines(section))
    ET.SubElement(suite, 'system-err')
