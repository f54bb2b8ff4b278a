# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A report as plain lines, for a pipe."""

from collections.abc import Iterator
from dataclasses import replace

from gear_kinematics.report import document as doc
from gear_kinematics.report.document import OUTCOME, Verdict


def lines(document: doc.Document, *, brief: bool = False) -> Iterator[str]:
    """Yield a row of a table per line, each with the section it belongs to.

    A brief report has of each section its verdict, findings and answer; a section that passed is a
    single line.
    """
    if document.totals:
        yield f'summary: {document.totals}'
    for section in document.in_order().sections:
        name = f'{section.name}: ' if section.name else ''
        findings = [finding.text for finding in section.findings]
        if brief and section.verdict is None:
            yield from (f'{name}{text}' for text in findings)
        elif brief and section.verdict == Verdict.PASS:
            verdict = OUTCOME[section.verdict]
            for text in filter(None, [section.answer, *findings]):
                verdict = _joined(verdict, text)
            yield f'{name}verdict: {verdict}'
        else:
            yield from section_lines(section, brief=brief)


def section_lines(section: doc.Section, *, brief: bool = False) -> Iterator[str]:
    """Yield one section line by line; a brief one is without values."""
    name = f'{section.name}: ' if section.name else ''
    findings, answer = list(section.findings), section.answer
    if section.verdict:
        verdict = f'{name}verdict: {OUTCOME[section.verdict]}'
        if section.verdict != Verdict.PASS and findings:
            gravest = findings.pop(0).text.removesuffix('.')
            if name:  # an error begins with it, on a cluster as an absolute path
                gravest = gravest.rpartition(name)[2]
            verdict += f': {gravest}'
        yield _joined(verdict, answer) if answer else verdict
    for finding in findings:
        yield f'{name}{finding.kind}: {finding.text}'
    if answer and not section.verdict:
        yield f'{name}result: {answer}'
    for table in () if brief else section.tables:
        yield from (f'{name}{line}' for line in _table_lines(table))
    for remark in () if brief else section.remarks:
        yield f'{name}remark: {remark}'


def _joined(text: str, more: str) -> str:
    """Join two texts after a semicolon, or after a full stop if the second is a sentence."""
    return f'{text.removesuffix(".")}{"." if more[0].isupper() else ";"} {more}'


def _table_lines(table: doc.Table) -> Iterator[str]:
    """Yield a line for each row, or for each fact."""
    for row in table.rows:
        facts = list(replace(table, rows=(row,)).facts())
        if table.layout == doc.Layout.LINES:
            yield from (f'{column}: {cell.with_unit()}' for _, column, cell in facts)
        elif facts:
            values = '; '.join(f'{column}: {cell.with_unit()}' for _, column, cell in facts)
            yield ': '.join(filter(None, [facts[0][0], values]))
