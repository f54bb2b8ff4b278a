# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as text in the dialects of test benches: where names, units and numbers are."""

import codecs
import csv
import io
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import chain, takewhile, zip_longest
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics.measurement.cells import (
    MISSING,
    MOMENT,
    are_arrays,
    are_divided,
    are_words_below,
    cells_of,
    checked,
    elements_of,
    key_of,
    may_be_divided,
    numbers,
    unit_of,
    weight,
)
from gear_kinematics.measurement.channel_times import interval_of, named, with_times
from gear_kinematics.measurement.names import FOREIGN, known_units, meaning, usual_unit
from gear_kinematics.measurement.series import series_of
from gear_kinematics.measurement.texts import BLOCK, Rows, encoding_of, plainer

_MOST_ROWS = 1_000_000  # 15 minutes at 1 kHz; a row takes up to 250 bytes besides those of pandas
_HEAD = 2**16  # bytes that show the dialect
_ROWS, _BEGIN = 100, 3  # rows that show the kinds of columns; rows of numbers that begin a table
_SEPARATORS = ';', '\t', ',', '|', ' '
_COMMENT = ('#', '//', '%', 'sep=', 'SEP=')
_WRAPPED = re.compile(r'(?<![^,;\t\n])"[^"\n]*(\n[^"\n]*){1,3}"(?=[,;\t\n])')
"""Cells with line breaks, as of names in workbooks."""
_PADDED = re.compile(r'(?<=[,;|\t]) +(?=")')  # which would hide quotation marks
_TYPES = re.compile(r'(?i)[iuf]\d+|(float|double|u?int)\d*|(type|interp|blockpath|portindex): *.+')
"""Cells of rows that give types, as INCA and Simulink write them."""
_NO_TABLES = {
    r'\s*(\(\d+\.\d+\)\s+)?(\w+\s+)?[\dA-F]{3,8}(#|\s+\[\d+\]\s+[\dA-F]{2}\b)|;\$FILEVERSION|'
    r'date \w{3} \w{3} \d': 'a log of CAN frames: decode the signals to columns, as by cantools',
    r'header:\s*$|---\s*$': 'the YAML of ros2 topic echo: add --csv to it, or record the topic',
    r'\[?\s*\{"': 'lines of JSON: name it .jsonl, with an object in each line',
    '# Created by Octave': 'a text of Octave: save the variables with the option -v7, as a .mat',
}
"""Beginnings of texts that are no tables, as of candump, PCAN-View and CANoe, and what to do."""
_CODESYS = '[key]; [value]'  # begins a trace of CODESYS, whose variables are below each other
_NO_NAMES = re.compile(r'(?i)[-+|:=\s]*|sep=.*\s*')  # lines without names, as of psql


class TableFile(NamedTuple):
    """Columns that can be loaded."""

    names: Sequence[str]
    units: Mapping[str, str]
    """Units that the file gives elsewhere than in the names, by name."""
    clocks: Mapping[str, str]
    """Columns of times, by the names of columns that have their own."""
    first: Mapping[str, str]
    """First values as written, by name."""
    load: Callable[[Sequence[str]], tuple[dict[str, Any], int]]
    """Returns columns by name as numbers or datetime64, with one row in n; and that n."""
    remark: str = ''
    """Titles and comments above the names."""


def loaded(
    columns: Mapping[str, Any],
    units: Mapping[str, str] | None = None,
    clocks: Mapping[str, str] | None = None,
) -> TableFile:
    """Return a table of columns in memory."""
    first = {name: str(values[0]) for name, values in columns.items() if len(values)}
    load = lambda names: ({name: columns[name] for name in names}, 1)  # noqa: E731
    return TableFile([*columns], units or {}, clocks or {}, first, load)


class _Layout(NamedTuple):
    """Names and units in a text, and where its numbers are."""

    separator: str
    point: str
    start: int  # lines before the first row with numbers
    row: list[str]  # that row
    names: list[str]
    units: dict[str, str]
    clocks: dict[str, str]
    remark: str = ''
    interval: float = 0.0  # s, of samples without times


def open_text(path: Path, content: bytes | None = None) -> TableFile:
    """Open a text, which may be compressed, or the `content` of a workbook, in its dialect.

    Raises:
        OSError: if it cannot be read.
        ValueError: if it is not a table.
    """
    import pandas as pd  # noqa: PLC0415, of an extra
    from pandas.io.common import get_handle  # noqa: PLC0415, which decompresses

    def opened(**how: Any) -> Any:
        return get_handle(path if content is None else io.BytesIO(content), **how)

    with opened(mode='rb', compression='infer', is_text=False) as file:
        head = file.handle.read(_HEAD)
        size = len(head) + sum(map(len, iter(partial(file.handle.read, BLOCK), b'')))
    encoding = encoding_of(head)
    decoded = partial(opened, mode='r', compression='infer', encoding=encoding, errors='replace')
    text = codecs.getincrementaldecoder(encoding)('replace').decode(head)
    text = _WRAPPED.sub(lambda name: name[0].replace('\n', '\v'), text.replace('\r\n', '\n'))
    plain, labels = plainer(text, _SEPARATORS)
    lines = [','.join(labels) + '\n'] * bool(labels)
    lines += io.StringIO(plain(text), newline=None)
    if size > _HEAD and not (lines := lines[:-1]):
        raise ValueError(f'the first row is longer than {_HEAD} characters: write a row a moment')
    if lines and lines[0].startswith(_CODESYS):
        with decoded() as file:
            how: Any = {'sep': ';', 'names': ['key', 'time', 'value'], 'skipinitialspace': True}
            how |= {'quoting': csv.QUOTE_NONE, 'on_bad_lines': 'skip'}  # for comments of any kind
            frame = pd.read_csv(file.handle, dtype=str, **how)
        key = frame['time'].where(frame['key'].str.endswith('.Variable', na=False)).ffill()
        rows = frame.assign(key=key)[frame['key'].isna()]
        return loaded(*series_of(rows, '.', 'key', 'value', {}))
    layout = _layout([_PADDED.sub('', line.replace('\v', ' ')) for line in lines])
    start = layout.start - bool(labels) + ''.join(lines[: layout.start]).count('\v')

    def read(places: Sequence[int], every: int, kind: Any = None) -> Any:
        with decoded() as file:
            for _ in range(start):  # pandas would heed quotation marks in them
                file.handle.readline()
            return pd.read_csv(
                Rows(file.handle, every, plain),
                sep=r'\s+' if layout.separator == ' ' else layout.separator,
                decimal=layout.point,
                header=None,
                names=range(len(layout.names)),
                usecols=places,
                index_col=False,
                skipinitialspace=True,
                low_memory=False,
                dtype=kind,
            )

    rows = [cells_of(line, layout.separator) for line in lines[layout.start :][:_ROWS]]
    columns = dict(enumerate(zip_longest(*rows)))  # None where a row is short
    places = range(len(layout.names))
    sample = pd.DataFrame(columns).reindex(columns=places)
    cells = [[one for one in columns.get(k, ()) if one is not None] for k in places]
    key, value = key_of(layout.names, cells)
    if key:
        frame = read(places, 1).set_axis(layout.names, axis=1)
        return loaded(*series_of(frame, layout.point, key, value, layout.units))
    arrays = [place for place in places if are_arrays(cells[place])]
    elements = elements_of(sample, layout.names, arrays)
    names = [name for k, name in enumerate(layout.names) if k not in arrays] + [*elements]
    beside = {k for k, name in enumerate(layout.names) if name.endswith('name')} | {*arrays}

    def load(wanted: Sequence[str]) -> tuple[dict[str, Any], int]:
        every = 2 ** max(0, math.ceil(math.log2(size / len(head) * len(lines) / _MOST_ROWS)))
        own = {name: layout.names.index(name) for name in wanted if name not in elements}
        places = sorted({0, *own.values()} | (beside if len(own) < len(wanted) else set()))
        filled = sample[places].fillna('') != ''
        usual = filled.any().tolist()
        # Of series that take turns, other steps leave out all but one.
        steps = range(every, 2 * every)
        every = next((n for n in steps if filled[::n].any().tolist() == usual), every)
        frame = read(places, every)
        if 0 not in own.values() and (words := are_words_below(frame[0])).any():
            frame = frame.mask(words)
        for place in filter(lambda place: may_be_divided(frame[place]), places):
            if are_divided(read([place], every, str)[place], layout.point):
                raise ValueError(
                    f'{layout.names[place]} has three decimals or none, as if points divided '
                    'thousands: write the numbers without these points'
                )
        columns = {name: frame[place] for name, place in own.items()}
        if divided := [name for name in wanted if name in elements]:
            # Below the sample, an array may have more elements than one, or none of a joint.
            found = elements_of(frame, layout.names, arrays)
            nothing = pd.Series('nan', frame.index)
            columns |= {k: found.get(k, found.get(f'{k}[0]', nothing)) for k in divided}
        values = {}
        for name in wanted:
            column = columns[name]
            if layout.interval and own.get(name) == 0:
                if column.notna().any():  # such as Delta_X, in a further head
                    raise ValueError(
                        'has several segments, with unknown pauses: save it with times (X values)'
                    )
                column = layout.interval * every * pd.Series(range(len(column)))
            column = checked(column, name, layout.names, layout.units.get(name, ''))
            values[name] = numbers(column, layout.point)
        return values, every

    first = dict(zip(layout.names, layout.row, strict=False))
    of_joints = (name for k in arrays for name in elements if name.endswith(f' {layout.names[k]}'))
    units = layout.units | dict.fromkeys(of_joints, 'rad')
    return TableFile(names, units, layout.clocks, first, load, layout.remark)


def _layout(lines: Sequence[str]) -> _Layout:
    """Find separator, decimal point, names and units; ValueError without numbers or names."""
    for pattern, cause in _NO_TABLES.items():
        if re.match(pattern, ''.join(lines[:1])):
            raise ValueError(cause)
    filled = [k for k, line in enumerate(lines) if line.strip() and not line.startswith(_COMMENT)]
    last = [lines[k] for k in filled[-_ROWS:]]
    last = last[len(last) // 2 :]
    divided = {
        one: [*filter(None, chain(*(cells_of(k, one) for k in last)))] for one in _SEPARATORS
    }
    choices = [(one, point) for one in _SEPARATORS for point in '.,']
    separator, point = max(choices, key=lambda choice: _score(divided[choice[0]], choice[1]))
    rows = {k: cells_of(lines[k], separator) for k in filled}
    known = [rows[k] for k in filled[-len(last) :]] if filled else []
    width = max(Counter(map(len, known)).items(), key=itemgetter(1), default=(0, 0))[0]

    def numbers_in(cells: Iterable[str]) -> float:
        found = [weight(cell, point) > 0.0 for cell in cells if cell.lower() not in MISSING]
        return sum(found) / max(len(found), 1)

    shares = [numbers_in(cells[k] for cells in known if k < len(cells)) for k in range(width)]
    least = 1.0 if 1.0 in shares else 0.5  # words among numbers, such as states, are no names
    numeric = [k for k, share in enumerate(shares) if share >= least]

    def is_whole(place: int) -> bool:
        return numbers_in(rows[place][k] for k in numeric if k < len(rows[place])) == 1.0

    begins = (k for k in range(len(filled)) if all(map(is_whole, filled[k : k + _BEGIN])))
    if not numeric or (first := next(begins, None)) is None:
        raise ValueError(
            'no rows of numbers: write a CSV with one row of names, and a number in each cell'
        )
    start = filled[first]
    above = [line for line in lines[:start] if not _NO_NAMES.fullmatch(line)]
    row, *_ = samples = [rows[place] for place in filled[first:]]
    # A line that is not divided, such as a title, has no names.
    if any(len(_cells_above(line, separator, len(row))) >= min(2, len(row)) for line in above):
        begin = [cells[0].strip('"') for cells in samples[:_BEGIN]]
        found = _names(above, separator, max(map(len, samples)), 1 + max(numeric), begin)
        if not found[0][0]:  # the index of pandas
            found[0][0] = 'time' if MOMENT.fullmatch(row[0]) else '1'
        elif weight(found[0][0], '.') and not any(weight(name, '.') for name in found[0][1:]):
            found[0][0] = 'time of the line'  # rather than which, others are used
        beside = zip(found[0], found[0][1:], row[1:], strict=False)
        found[1].update({k: one for k, of, one in beside if re.fullmatch('(?i)units?', of)})
    else:
        found = _joint_state(row) or ([str(k + 1) for k in range(len(row))], {}, {})
    for name, unit in zip(found[0], map(unit_of, row), strict=False):
        if unit:
            said = found[1].get(name) or meaning(name).unit
            if said and usual_unit(said) != usual_unit(unit):
                raise ValueError(f'{name} is in {said} by its name, and in {unit} by its cells')
            found[1][name] = unit
    titles = (line for line in above if len(cells_of(line.lstrip('#%/ '), separator)) < len(row))
    interval = 0.0 if row[0] else interval_of([cells_of(line, separator) for line in above])
    if interval:
        found[1][found[0][0]] = 's'
    return _Layout(separator, point, start, row, *found, ' '.join(titles), interval)


def _score(cells: Iterable[str], point: str) -> float:
    """Count the numbers in cells, less the other cells and what is in them."""
    return sum(weight(k, point) or -1 - k.count(';') - k.count('\t') for k in cells)


def _names(
    above: Sequence[str], separator: str, width: int, numbers: int, begin: Sequence[str]
) -> tuple[list[str], dict[str, str], dict[str, str]]:
    """Find names of columns, their units and clocks in the lines above rows of a width.

    `numbers` is how many cells with numbers a row has at least; the first rows `begin` with these.

    Raises:
        ValueError: if the names do not fit the numbers of a row.
    """
    rows = [_cells_above(line, separator, width) for line in above]
    rows = [row for row in rows if not all(map(_TYPES.fullmatch, filter(None, row)))]
    labelled = (row[1:] for row in rows[:-1] if re.search('(?i)unit|einheit', ''.join(row[:1])))
    labels = [known_units(row, FOREIGN) for row in labelled]  # Tektronix has one of each axis
    label = max(labels, key=lambda label: len([*filter(None, label)]), default=[])
    if found := with_times([row[:width] for row in rows if len(row) >= numbers], label, begin[0]):
        return found
    several = [len([*filter(None, row)]) >= min(width, 2) for row in rows]  # no rate, of catman
    long = [k for k, row in enumerate(rows) if len(row) >= numbers and several[k]]
    fitting = [k for k in long if not known_units(rows[k])]
    last = max(fitting, default=len(rows) - 1)
    # Descriptions may be below the names, which have most of the words that say quantities.
    whole = [k for k in fitting if len({*filter(None, rows[k])}) == width]
    says = [sum(bool(m.role) and not m.unsure for m in map(meaning, row)) for row in rows]
    at = max([*whole, last], key=lambda k: (says[k], k))
    names, groups = rows[at], rows[at - 1] if at else []
    own = meaning(rows[-1][0])
    if own.words and own.role == 'time' != meaning(names[0]).role:
        names = [rows[-1][0], *names[1:]]  # TIME below Labels, of Tektronix
    if label:  # such as Y_Unit_Label of LabVIEW
        units = ['', *label][len(label) >= len(names) :]
    else:
        below = (known_units(row, fewest=1) for row in rows[at + 1 : at + 2])
        units = next(filter(None, (*below, known_units(groups[1:] and groups))), [])
    filled = [*filter(None, names)]
    if len({*filled}) < len(filled) and len(groups) == len(names):  # such as Motor,,Load,
        for k in range(1, len(groups)):
            groups[k] = groups[k] or groups[k - 1]
        times = [name for name in names if meaning(name).role == 'time']
        for k, name in enumerate(names):
            if times != [name]:
                names[k] = f'{groups[k]} {name}'.strip()
    for k in range(len(names) - 1, 0, -1):  # a comma, of the same kind, before a unit
        if len(names) > width and known_units([names[k]]):
            names[k - 1 : k + 1] = [f'{names[k - 1]} [{names[k]}]']
    if len(names) == numbers - 1 and [*begin] == [*'123']:  # the row names of R
        names = ['', *names]
    if len(names) < numbers or (separator == ' ' and len(names) > width):
        cause = f'rows of {width} cells are below {len(names)} names: {", ".join(names)}'
        raise ValueError(f'{cause}: write a name for each cell, and decimal points')
    names = [*names[:width], *[''] * (width - len(names))]
    return names, named(names, units), {}


def _cells_above(line: str, separator: str, width: int) -> list[str]:
    """Divide a line above the numbers; names in a comment may be separated otherwise."""
    cells = cells_of(line.lstrip('#%/ '), separator)
    if len(cells) == width or (len(cells) > width and separator != ' '):
        return cells
    others = [cells_of(line.lstrip('#%/ '), one) for one in _SEPARATORS]
    others.append(re.split(r'\s{2,}', line.strip('#%/ \n')))
    return next((other for other in others if len(other) == width), cells)


def _joint_state(row: Sequence[str]) -> tuple[list[str], dict[str, str], dict[str, str]] | None:
    """Name the columns of `ros2 topic echo --csv`, if they are of that kind."""
    joints = [*takewhile(lambda cell: cell and not weight(cell, '.'), row[3:])]
    fields = (len(row) - 3) / max(len(joints), 1) - 1.0
    if not joints or fields not in {1.0, 2.0, 3.0} or not all(map(str.isdecimal, row[:2])):
        return None
    names = ['stamp_s', 'stamp_ns', 'frame', *len(joints) * [''], *joints]
    kinds = {2.0: ('{} velocity or effort',), 3.0: ('{} velocity', '{} effort')}.get(fields, ())
    names += [kind.format(joint) for kind in kinds for joint in joints]
    return names, dict.fromkeys(joints, 'rad'), {}
