# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The contents of a report, independent of how it is rendered.

Texts are safe to print on a terminal, but not escaped for markup, HTML or XML.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.report.mechanism import MovingMechanism

Array = NDArray[np.float64]

MOST_POINTS = 2000  #: of a line that is reduced


class Verdict(StrEnum):
    """The outcome of a check, from best to worst."""

    PASS = 'pass'  # noqa: S105, no password
    FAIL = 'fail'
    UNUSABLE = 'unusable'


def worst(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the worst of some verdicts; UNUSABLE if there is none."""
    return max(verdicts, key=[*Verdict].index, default=Verdict.UNUSABLE)


OUTCOME = {Verdict.PASS: 'passed', Verdict.FAIL: 'failed', Verdict.UNUSABLE: 'unusable'}


class Tone(StrEnum):
    """Emphasis of a value."""

    PLAIN = ''
    NONE = 'none'  #: for a count of zero, which is left out among others
    NOTABLE = 'notable'
    BAD = 'bad'


_CLOSE = ('°', '′', '″')  # units without a space before them


@dataclass(frozen=True, slots=True)
class Cell:
    """A value of a table, as text."""

    text: str
    tone: Tone = Tone.PLAIN
    unit: str = ''  #: unit of the value; the unit of a row's first cell applies to all its values

    @property
    def says(self) -> bool:
        """Whether the cell has anything to read."""
        return bool(self.text) and self.tone != Tone.NONE

    def with_unit(self) -> str:
        """Return the value with its unit."""
        space = '' if self.unit in _CLOSE else ' '
        return f'{self.text}{space}{self.unit}' if self.text and self.unit else self.text


def _cell(value: str | Cell) -> Cell:
    return value if isinstance(value, Cell) else Cell(value)


class Layout(StrEnum):
    """Layout of a table if there is room for it."""

    ROWS = 'rows'  #: below headings
    INLINE = 'inline'  #: a single row, as labelled values side by side
    LINES = 'lines'  #: a single row, as labelled values, one per line


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of values; the first value of a row is its subject."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    words: tuple[str, ...] = ('',)  # columns of words, '' for the first; others hold numbers
    layout: Layout = Layout.ROWS

    @classmethod
    def of_items(
        cls,
        columns: Mapping[str, Callable[[Any], str | Cell]],
        items: Iterable[Any],
        words: tuple[str, ...] = ('',),
    ) -> Self:
        """Return a table with a row for each item, from functions that return a column's cell."""
        rows = (tuple(_cell(value(item)) for value in columns.values()) for item in items)
        return cls(tuple(columns), tuple(rows), words)

    @classmethod
    def of_values(
        cls, layout: Layout, *values: tuple[str, str | Cell], about: tuple[str, str] = ('', '')
    ) -> Self:
        """Return a table of one row: a subject with its heading, then labels and values."""
        heading, subject = about
        cells = (_cell(value) for _, value in values)
        labels = (label for label, _ in values)
        return cls((heading, *labels), ((Cell(subject), *cells),), layout=layout)

    def is_words(self, index: int) -> bool:
        """Return whether a column holds words."""
        return ('' if index == 0 else self.columns[index]) in self.words

    def facts(self) -> Iterator[tuple[str, str, Cell]]:
        """Yield the subject of the row, the column and the cell of every value."""
        for subject, *cells in self.rows:
            about = subject.text if self.is_words(0) else f'{self.columns[0]} {subject.text}'
            for column, cell in zip(self.columns[1:], cells, strict=True):
                if cell.text:
                    yield about, column, cell

    def below_headings(self) -> Self:
        """Return the table with units in the texts, and without empty columns."""
        kept = [k for k in range(len(self.columns)) if any(row[k].says for row in self.rows)]
        rows = (_with_units(row) for row in self.rows)
        columns = tuple(self.columns[k] for k in kept)
        shown = tuple(tuple(row[k] for k in kept) for row in rows)
        return replace(self, columns=columns, rows=shown)


def _with_units(row: tuple[Cell, ...]) -> tuple[Cell, ...]:
    """Return a row with its common unit in the first cell, and other units after their values."""
    subject, *cells = row
    named = replace(subject, text=f'{subject.text} [{subject.unit}]') if subject.unit else subject
    others = (c if c.unit == subject.unit else replace(c, text=c.with_unit()) for c in cells)
    return named, *others


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence that explains the verdict."""

    kind: Literal['error', 'finding']
    text: str
    time: float | None = None  #: position on the x axis of the figure to which the sentence refers


class Pen(StrEnum):
    """Style of a line; the names of the colours in page.css."""

    FIRST = 'first'
    SECOND = 'second'
    THIRD = 'third'
    FOURTH = 'fourth'
    FIFTH = 'fifth'
    SIXTH = 'sixth'
    MODEL = 'text'  # dashed line
    FAINT = 'faint'


PENS = Pen.FIRST, Pen.SECOND, Pen.THIRD, Pen.FOURTH, Pen.FIFTH, Pen.SIXTH
"""Pens of lines that are compared."""


@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """A line of a panel."""

    name: str  #: lines of the same name share an entry in the legend
    pen: Pen
    x: Array
    y: Array  #: NaN leaves a gap
    points: bool = False  #: whether to draw only points

    @classmethod
    def reduced(cls, name: str, pen: Pen, x: Array, y: Array, *, points: bool = False) -> Self:
        """Return a line over ascending x; of more than a plot shows, the minima and maxima."""
        order = np.argsort(x, kind='stable')
        x, y = x[order], y[order]
        if len(x) > MOST_POINTS:
            begins = np.linspace(0, len(x), MOST_POINTS // 2, endpoint=False, dtype=np.intp)
            bounds = np.minimum.reduceat(y, begins), np.maximum.reduceat(y, begins)
            x, y = np.repeat(x[begins], 2), np.stack(bounds, axis=1).ravel()
        return cls(name, pen, x, y, points)


@dataclass(frozen=True, eq=False, slots=True)
class Panel:
    """A plot."""

    title: str
    x_label: str
    y_label: str  #: label of the y axis with its unit, as text
    lines: tuple[Line, ...]
    marks: tuple[tuple[float, str], ...] = ()  #: positions on the x axis, each with a text
    levels: tuple[tuple[float, str], ...] = ()  #: positions on the y axis, each with a text
    scale: Literal['linear', 'log'] = 'linear'  #: scale of the y axis
    equal: bool = False  #: whether both axes have the same scale, as in a drawing

    @property
    def unit(self) -> str:
        """The unit of y."""
        return self.y_label.partition('[')[2].rstrip(']')

    @property
    def has_legend(self) -> bool:
        """Whether a legend names the lines; the axis names a single one."""
        return len({line.name for line in self.lines}) > 1


@dataclass(frozen=True, eq=False, slots=True)
class Figure:
    """Panels side by side, or stacked over the same x axis."""

    panels: tuple[Panel, ...]
    stacked: bool = False
    columns: int | None = None  # most panels side by side in an image; None for all of them

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns of the panels."""
        count = max(len(self.panels), 1)
        columns = 1 if self.stacked else min(self.columns or count, count)
        return -(-count // columns), columns


@dataclass(frozen=True, slots=True)
class Case:
    """A test case of JUnit, failed if it has faults."""

    name: str
    faults: tuple[str, ...] = ()
    kind: Literal['failure', 'error'] = 'failure'


@dataclass(frozen=True, eq=False, slots=True)
class Section:
    """The report on one recording, or on one mechanism."""

    name: str  #: name of the section, which may be empty if it is the only one
    tables: tuple[Table, ...]  #: tables, of which the first describes the subject of the report
    verdict: Verdict | None = None
    findings: tuple[Sentence, ...] = ()
    remarks: tuple[str, ...] = ()  #: notes on the interpretation of the values
    figure: Figure | None = None
    mechanism: MovingMechanism | None = None
    below: Figure | None = None  #: on a page, below the other figure and the mechanism
    key: Table | None = None  #: table that a page shows above the figure
    leads: bool = False  #: whether a page begins with it, such as a comparison of the others
    cases: tuple[Case, ...] = ()
    answer: str = ''  #: the result in one line
    elapsed: float = 0.0  #: duration of the check, s

    @property
    def image(self) -> Figure | None:
        """Figure that an image file shows."""
        if not (self.figure and self.below):
            return self.figure
        return Figure((*self.figure.panels, *self.below.panels), columns=self.below.columns)


@dataclass(frozen=True, slots=True)
class Origin:
    """The origin of a report: program, time, command and parameter files."""

    version: str
    date: str
    command: str  #: command as typed in a shell
    configs: tuple[tuple[str, str], ...] = ()  #: parameter files with their SHA-256


@dataclass(frozen=True, eq=False, slots=True)
class Document:
    """A whole report."""

    title: str  #: title such as `gearkin validate`
    sections: tuple[Section, ...]
    data: Mapping[str, Any] = field(default_factory=dict)  #: contents of the JSON
    summary: Table | None = None  #: a row for each section; shown if there are several
    totals: str = ''  #: summary of the sections in one line
    origin: Origin | None = None

    @property
    def verdict(self) -> Verdict | None:
        """The worst verdict of the sections; None if these have none."""
        known = [section.verdict for section in self.sections if section.verdict]
        return None if self.sections and not known else worst(known)

    def of_failed(self) -> Self:
        """Return the document with only those sections that failed or are unusable."""
        sections = tuple(s for s in self.sections if s.verdict not in {None, Verdict.PASS})
        return replace(self, sections=sections, summary=None, totals=self.totals * bool(sections))

    def in_order(self) -> Self:
        """Return the document in reading order: a comparison first, then failed sections."""
        ranks = [Verdict.FAIL, Verdict.UNUSABLE, Verdict.PASS, None]
        keys = [(not section.leads, ranks.index(section.verdict)) for section in self.sections]
        order, summary = sorted(range(len(keys)), key=keys.__getitem__), self.summary
        if summary:  # it has no rows for comparisons
            rows = tuple(summary.rows[k] for k in order if k < len(summary.rows))
            summary = replace(summary, rows=rows)
        return replace(self, sections=tuple(self.sections[k] for k in order), summary=summary)


def printable(text: str) -> str:
    """Escape what is unsafe in terminals, logs and XML files, such as control characters."""
    return ''.join(
        char if char.isprintable() else char.encode('unicode_escape').decode() for char in text
    )


def number(value: float, digits: int = 3) -> str:
    """Write a measured value to significant digits; from a million on, with an exponent."""
    rounded = float(f'{value:.{digits}g}')
    mantissa, e, exponent = f'{rounded:.{max(digits, 6)}g}'.partition('e')
    return f'{mantissa}{e}{int(exponent)}' if e else mantissa


def hertz(rate: float) -> str:
    """Write a rate, Hz, without decimals unless it is low."""
    return f'{rate:.2g} Hz' if len(f'{rate:.0f}') == 1 else f'{rate:.0f} Hz'


def counted(count: int, noun: str) -> str:
    """Write a count with its noun."""
    return f'{count} {noun}' if count == 1 else f'{count} {noun}s'
