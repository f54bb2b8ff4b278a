# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as text, in the dialects that benches write: where names, units and numbers are."""

import codecs
import io
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import takewhile
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.measurement.cells import Element, cells_of, elements_of, numbers, weight
from gear_kinematics.measurement.columns import known_units, time_among

_MOST_ROWS = 1_000_000
"""A quarter of an hour at 1 kHz: measuring takes up to 250 bytes a row, beside pandas itself."""
_HEAD, _BLOCK = 2**16, 2**23
"""Bytes in which the dialect shows, and that are read at once."""
_ROWS, _BEGIN = 100, 3
"""Rows of the head that show what the columns contain; rows of numbers that begin a table."""
_LONG = 2**16
"""Bytes that have some rows in them."""
_SEPARATORS = ';', '\t', ',', '|', ' '
_COMMENT = ('#', '//', '%', 'sep=', 'SEP=')
_BOMS = {b'\xef\xbb\xbf': 'utf-8-sig', b'\xff\xfe': 'utf-16', b'\xfe\xff': 'utf-16'}
_MISSING = {'', 'nan', '-nan', 'inf', '-inf', 'null', 'none', 'n/a', 'na', '-', '[]'}
_TOPICS, _VALUE = (
    ('topic', 'message path', 'series', 'signal', 'channel', 'label', 'name'),
    'value',
)
"""Columns of a table with a row for each value."""


class TableFile(NamedTuple):
    """Columns that can be loaded."""

    names: Sequence[str]
    units: Mapping[str, str]
    """Units that the file gives elsewhere than in the names."""
    clocks: Mapping[str, str]
    """The columns of times of those that have their own."""
    first: Mapping[str, str]
    """The first values, as they are written."""
    load: Callable[[Sequence[str]], tuple[dict[str, Any], int]]
    """Returns columns as numbers or datetime64, by name, and of how many rows these are one."""


def loaded(
    columns: Mapping[str, Any],
    units: Mapping[str, str] | None = None,
    clocks: Mapping[str, str] | None = None,
) -> TableFile:
    """Return a table of columns that are in memory."""
    first = {name: str(values[0]) for name, values in columns.items() if len(values)}
    load = lambda names: ({name: columns[name] for name in names}, 1)  # noqa: E731
    return TableFile([*columns], units or {}, clocks or {}, first, load)


class _Layout(NamedTuple):
    """What is where in a text."""

    encoding: str
    separator: str
    point: str
    start: int
    """Lines before the first row with numbers."""
    row: list[str]
    """That row."""
    names: list[str]
    units: dict[str, str]
    clocks: dict[str, str]


def open_text(path: Path) -> TableFile:
    """Find out the dialect of a text.

    Raises:
        OSError: if it cannot be read.
        ValueError: if it is no table.
    """
    with path.open('rb') as file:
        head = file.read(_HEAD)
    encoding = _encoding(head)
    lines = codecs.getincrementaldecoder(encoding)('replace').decode(head).splitlines()
    if len(head) == _HEAD and not (lines := lines[:-1]):
        raise ValueError(f'the first row is longer than {_HEAD} characters')
    layout = _layout(lines, encoding)
    lower = [name.lower() for name in layout.names]
    if _VALUE in lower and (topics := [name for name in _TOPICS if name in lower]):
        columns = (layout.names[lower.index(name)] for name in (topics[0], _VALUE))
        return _long(path, layout, *columns)
    elements = elements_of(lines[layout.start :][:_ROWS], layout.names, layout.separator)
    arrays = {element.place for element in elements.values()}
    names = [name for k, name in enumerate(layout.names) if k not in arrays] + [*elements]

    def load(wanted: Sequence[str]) -> tuple[dict[str, Any], int]:
        rows = path.stat().st_size / len(head) * len(lines)
        every = 2 ** max(0, math.ceil(math.log2(rows / _MOST_ROWS)))
        sources = [elements.get(name) or layout.names.index(name) for name in wanted]
        places = {k for one in sources for k in (one[:2] if isinstance(one, Element) else [one])}
        parts: list[list[Any]] = [[] for _ in wanted]
        for frame in _frames(path, layout, sorted(places), every):
            for part, one in zip(parts, sources, strict=True):
                column = one.of(frame) if isinstance(one, Element) else frame[one]
                part.append(numbers(column, layout.point))
        return {name: _joined(part) for name, part in zip(wanted, parts, strict=True)}, every

    first = dict(zip(layout.names, layout.row, strict=False))
    units = layout.units | {name: 'rad' for name, one in elements.items() if one.is_position}
    return TableFile(names, units, layout.clocks, first, load)


def _joined(parts: Sequence[Any]) -> Any:
    """Join numbers, or times where there are any."""
    if 'M' in {part.dtype.kind for part in parts}:
        none = np.datetime64('NaT', 'ns')
        parts = [part if part.dtype.kind == 'M' else np.full(len(part), none) for part in parts]
    return np.concatenate(parts)


def _encoding(head: bytes) -> str:
    """The encoding of a text; ValueError if it is none."""
    if encoding := next((_BOMS[mark] for mark in _BOMS if head.startswith(mark)), ''):
        return encoding
    if 0 in head:
        if head[::2].count(0) == 0 and head[1::2].count(0) > len(head) // 4:
            return 'utf-16-le'
        raise ValueError('not text')
    try:
        codecs.getincrementaldecoder('utf-8')().decode(head)
    except UnicodeDecodeError:
        return 'cp1252'
    return 'utf-8'


def _blocks(path: Path, layout: _Layout, every: int) -> Iterator[bytes]:
    """Yield one row of so many as UTF-8, some at a time; a last one that was cut as nan."""
    decoder = codecs.getincrementaldecoder(layout.encoding)('replace')
    skip, row, rest = layout.start, 0, b''
    with path.open('rb') as file:
        block = file.read(_BLOCK)
        while block:
            following = file.read(_BLOCK)
            if not layout.encoding.startswith('utf-8'):
                block = decoder.decode(block).encode()
            end = block.rfind(b'\n') + 1
            lines, rest = (rest + block[:end], block[end:]) if end else (b'', rest + block)
            lines = lines.split(b'\n', skip)[-1] if skip else lines
            if rest and not following:
                before = lines[-_LONG:].split(b'\n')[1:-1]
                cut = before and len(rest) < min(map(len, before))
                none = layout.separator.join(['nan'] * len(layout.names)).encode()
                lines += (none if cut else rest) + b'\n'
            if every > 1:
                ends = 1 + np.flatnonzero(np.frombuffer(lines, np.uint8) == ord('\n'))
                chosen = slice(-row % every, None, every)
                row += len(ends)
                starts = np.append(0, ends[:-1])[chosen].tolist()
                spans = zip(starts, ends[chosen].tolist(), strict=True)
                lines = b''.join([lines[start:end] for start, end in spans])
            block, skip = following, 0
            yield lines


def _frames(path: Path, layout: _Layout, places: Sequence[int], every: int) -> Iterator[Any]:
    """Read some columns of one row of so many, some rows at a time."""
    import pandas as pd  # noqa: PLC0415, of an extra

    for block in _blocks(path, layout, every):
        if block.strip():
            yield pd.read_csv(
                io.BytesIO(block),
                sep=r'\s+' if layout.separator == ' ' else layout.separator,
                decimal=layout.point if layout.point != layout.separator else '.',
                header=None,
                names=range(len(layout.names)),
                usecols=places,
                index_col=False,
                skipinitialspace=True,
                encoding_errors='replace',
            )


def _layout(lines: list[str], encoding: str) -> _Layout:
    """Find separator, decimal point, names and units.

    Raises:
        ValueError: if there are no rows of numbers, or no names.
    """
    filled = [k for k, line in enumerate(lines) if line.strip() and not line.startswith(_COMMENT)]
    last = [lines[k] for k in filled[-_ROWS:]]
    last = last[len(last) // 2 :]
    choices = [(one, point) for one in _SEPARATORS for point in '.,']
    separator, point = max(choices, key=lambda choice: _score(last, *choice))
    rows = {k: cells_of(lines[k], separator) for k in filled}
    known = [rows[k] for k in filled[-len(last) :]] if filled else []
    width = max(Counter(map(len, known)).items(), key=itemgetter(1), default=(0, 0))[0]
    kinds: list[list[float]] = [[] for _ in range(width)]
    for cells in known:
        for kind, cell in zip(kinds, cells, strict=False):
            kind.extend([weight(cell, point)] * (cell.lower() not in _MISSING))
    shares = [sum(map(bool, kind)) / len(kind) if kind else 0.0 for kind in kinds]
    least = 1.0 if 1.0 in shares else 0.5  # texts among numbers, as of states, are no names
    numeric = [k for k, share in enumerate(shares) if share >= least]

    def has_numbers(place: int) -> bool:
        cells = [rows[place][k] for k in numeric if k < len(rows[place])]
        weights = [weight(cell, point) for cell in cells if cell.lower() not in _MISSING]
        return bool(weights) and all(weights)

    begins = (k for k, place in enumerate(filled) if all(map(has_numbers, filled[k : k + _BEGIN])))
    if not numeric or (first := next(begins, None)) is None:
        raise ValueError('no samples in it')
    start = filled[first]
    above = [line for line in lines[:start] if line.strip() and line[:4].lower() != 'sep=']
    row = rows[start]
    if above:
        found = _names(above, separator, max(width, len(row)), 1 + max(numeric))
    else:
        found = _joint_state(row)
    return _Layout(encoding, separator, point, start, row, *found)


def _score(lines: Sequence[str], separator: str, point: str) -> float:
    """How many numbers lines have if they are divided so, less what is none."""
    cells = (cell for line in lines for cell in cells_of(line, separator) if cell)
    return sum(weight(cell, point) or -1.0 for cell in cells)


def _names(
    above: Sequence[str], separator: str, width: int, numbers: int
) -> tuple[list[str], dict[str, str], dict[str, str]]:
    """Find names of columns, units and clocks in the lines above rows of a width.

    Raises:
        ValueError: if they do not name each of the numbers of a row, or more.
    """
    rows = [cells_of(line.lstrip('#%/ '), separator) for line in above]
    keyed = {row[0].lower(): row[1::2] for row in rows if row[2:] and len({*row[::2]}) == 1}
    if 'name' in keyed:  # TwinCAT Scope, with the times of each channel before it
        names = keyed['name']
        clocks = {name: f'time of {name} [ms]' for name in names}
        given = dict(zip(names, known_units(keyed.get('unit', [])), strict=False))
        return [one for name in names for one in (clocks[name], name)], given, clocks
    units: list[str] = []
    at = -1
    if len(rows) > 1 and len(rows[-2]) > 1:
        units = known_units(rows[-1])
        at = -2 if units else -1
        units = units or known_units(rows[-2])  # they are above the names
    line, names = above[at], rows[at]
    if len(names) != width:  # names in a comment may be separated otherwise
        others = [cells_of(line.lstrip('#%/ '), one) for one in _SEPARATORS]
        others += [re.split(r'\s{2,}', line.strip('#%/ '))]
        names = next((cells for cells in others if len(cells) == width), names)
    filled, groups = [*filter(None, names)], rows[at - 1] if len(rows) >= 1 - at else []
    if len({*filled}) < len(filled) and len(groups) == len(names):  # such as Motor,,Load,
        for k in range(1, len(groups)):
            groups[k] = groups[k] or groups[k - 1]
        names = [f'{group} {name}'.strip() for group, name in zip(groups, names, strict=True)]
    if len(names) < numbers or (separator == ' ' and len(names) > width):
        raise ValueError(f'rows of {width} cells are below {len(names)} names: {", ".join(names)}')
    return [*names, *[''] * (width - len(names))], dict(zip(names, units, strict=False)), {}


def _joint_state(row: Sequence[str]) -> tuple[list[str], dict[str, str], dict[str, str]]:
    """Name the columns that `ros2 topic echo --csv` writes of sensor_msgs/JointState.

    Raises:
        ValueError: if these are others.
    """
    joints = [*takewhile(lambda cell: cell and not weight(cell, '.'), row[3:])]
    fields = (len(row) - 3) / max(len(joints), 1) - 1.0
    if fields not in {1.0, 2.0, 3.0} or not all(map(str.isdecimal, row[:2])):
        raise ValueError('the first row has numbers: put a row of names above them')
    names = ['stamp_s', 'stamp_ns', 'frame', *(f'name of {joint}' for joint in joints), *joints]
    kinds = {2.0: ('{} velocity or effort',), 3.0: ('{} velocity', '{} effort')}.get(fields, ())
    names += [kind.format(joint) for kind in kinds for joint in joints]
    return names, dict.fromkeys(joints, 'rad'), {}


def _long(path: Path, layout: _Layout, topic: str, value: str) -> TableFile:
    """Return the series in a table with a row for each value, as exports of plots have them."""
    import pandas as pd  # noqa: PLC0415, of an extra

    places = range(len(layout.names))
    frame = pd.concat([*_frames(path, layout, places, 1)]).set_axis(layout.names, axis=1)
    clock, unit = time_among(layout.names)
    columns, clocks = {}, {}
    for name, series in frame.groupby(topic, sort=False):
        columns[str(name)] = numbers(series[value], layout.point)
        if clock:
            clocks[str(name)] = own = f'{clock} of {name}'
            columns[own] = numbers(series[clock], layout.point)
    return loaded(columns, dict.fromkeys(clocks.values(), f'={unit}'), clocks)
