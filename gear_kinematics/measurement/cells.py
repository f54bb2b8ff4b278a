# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The cells of tables as text: numbers, times, and arrays of them."""

import csv
import re
import warnings
from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from gear_kinematics.measurement.names import known_units, meaning, usual_unit

MOMENT = re.compile(
    r'(\d+ days? |([a-z]{3} ){2} ?\d\d? |\d{1,4}[-./ ](\d\d?|[a-z]{3})[-./ ]\d{2,4}[T _-] ?)?'
    r'\d?\d:\d\d(:\d\d((::|[.,:;])\d+)?|[.,]\d+)\s?'
    r'(Z|UTC|[AP]M|[+-]\d\d:?\d\d|\d{4})?',
    re.ASCII | re.IGNORECASE,
)
_WITH_UNIT = re.compile(
    r"[-+\u2212]?[\d.,' \u00a0\u202f\u2019]*\d[.,]?(?:[eE][-+]?\d+)? ?([^\s\d][^\d]*)"
)
_TUPLE = re.compile(r'\(.*,( .*)?\)')  # as Python writes them
_NEGATIVE = re.compile(r'^\((\d[\d.,]*)\)$')
"""Negative numbers in brackets, as in accounts, which Excel writes."""
_RARE = (
    (r'\(', _NEGATIVE, r'-\1'),
    ('[dD]', r'(?<=[\d.])[dD](?=[-+]\d)', 'e'),  # as in Fortran
    ("[ '\u2019\u00a0\u202f]", r"(?<=\d)[ '\u2019\u00a0\u202f](?=\d{3}\b)", ''),
)
"""What few columns contain, and how numbers are written without it."""
_MARKED = r'[^\w\s]{0,3} ?[.,]?\d[\d.,]*([eE][-+]?\d+)? ?[^\w\s]{0,3}|[-+.,\d]*\d'
"""Numbers with more marks, such as 12.5- or < 0.1, or two without a space, such as 0.5-12.5."""
_FEW_MARKED = 0.01  # share of the rows that can have them
_IDS = re.compile(r'((joint|motor|actuator|servo|axis|node|can|id|name|index) ?)+')
"""Names of the column of a table with a row for each joint."""
_TOPICS = (
    'topic|message path|series|signal|channel|label|field|name|key|entry|variable|tag|tagname'
)
"""Names, the likeliest first, of the column of a table with a row for each value."""
_NAMES = 100  # words in a column that are compared with names
_OFTEN = 0.9  # share of the rows that are of another joint than the one before
_KEPT = 10_000  # cells, of which each is judged for several separators, and then again
MISSING = {'', 'nan', '-nan', 'inf', '-inf', 'null', 'none', '<na>', 'n/a', 'na', '-', '[]'}


def cells_of(line: str, separator: str) -> list[str]:
    """Divide a line into cells; a space as separator stands for any number of them."""
    if separator == ' ':
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]


def unit_of(cell: str) -> str:
    """Return the unit behind the number in a cell, as written; empty if there is none."""
    found = _WITH_UNIT.fullmatch(cell)
    return found[1] if found and known_units([found[1]], fewest=1) else ''


def numbers(column: Any, point: str = '.') -> Any:
    """Convert a column of pandas to numbers or datetime64[ns]; NaN or NaT where it has none."""
    import pandas as pd  # noqa: PLC0415, of an extra

    if column.dtype.kind == 'm':  # times since the start
        column = pd.Timestamp(0) + column
    if column.dtype.kind == 'M':
        return column.to_numpy('datetime64[ns]')
    if column.dtype.kind in 'iufb':
        return column.to_numpy()
    text = column.astype(str).str.strip().str.replace('\u2212', '-')
    filled = (cell for cell in text.dropna() if cell.lower() not in MISSING)
    unit = unit_of(next(filled, ''))
    if unit and all(unit_of(cell) == unit for cell in filled):
        text = text.str.removesuffix(unit).str.rstrip()
    for rare, pattern, plain in _RARE:
        if text.str.contains(rare).any():  # which takes a tenth of the time
            text = text.str.replace(pattern, plain, regex=True)
    if text.str.fullmatch('(0x)?[0-9a-fA-F]{1,15}').all() and (
        text.str.startswith('0x').all()
        or (
            text.str.len().eq(len(text.iloc[0])).all()
            and not text.str.fullmatch(r'\d+([eE]\d+)?').all()  # as numbers in arrays are
        )
    ):
        return text.map(lambda digits: int(digits, 16)).to_numpy()
    other = re.escape('.' if point == ',' else ',')
    marked = text[text.str.contains(other)]
    decimals = rf'({re.escape(point)}\d*)?'
    grouped = rf'[-+]?[1-9]\d{{0,2}}({other}\d{{3}})+{decimals}'
    thousands = len(marked) > 0 and marked.str.fullmatch(grouped).all()
    sure = marked.str.contains(re.escape(point)) | (marked.str.count(other) > 1)
    if thousands and not (sure.any() or text.str.fullmatch(rf'[-+]?\d{{1,3}}{decimals}').any()):
        raise ValueError(
            f'{column.name} has three digits behind each {"comma" if point == "." else "point"}, '
            'which may be decimals or thousands: write the numbers in another way'
        )
    plain = text.str.replace(other, '' if thousands else '.', regex=True)
    values = pd.to_numeric(plain.str.replace(',', '.'), errors='coerce').to_numpy(float)
    if known := np.count_nonzero(np.isfinite(values)):
        others = text[~np.isfinite(values) & ~text.str.lower().isin(MISSING)]
        marked = others[others.str.fullmatch(_MARKED)]
        if len(marked) > _FEW_MARKED * len(values):
            cause = f'{column.name} has cells such as {marked.iloc[0]}, which are no numbers'
            raise ValueError(f'{cause}: write them like -12.5')
        return values if known >= len(others) else np.full(len(values), np.nan)
    moments = _moments(text)
    return moments.to_numpy('datetime64[ns]') if moments.notna().any() else values


def checked(column: Any, name: str, names: Sequence[str], unit: str) -> Any:
    """Return a column by its name; ValueError if a further row says another name, or unit."""
    column = column.rename(name)
    if column.dtype.kind in 'iufbmM':
        return column
    text, (words, own, *_) = column.astype(str).str.strip(), meaning(name)
    units = {usual_unit(unit), own}
    cells = text[text.str.match(r'[^\W\d]{2}')].unique()[:_NAMES].tolist()
    footer = {'max', 'min'} <= {cell.lower() for cell in cells}  # which says no minutes
    for cell in cells:
        says = meaning(cell)
        if cell != name and (
            cell in names
            or (says.words == words and says.unit not in units)
            or not (footer or units.issuperset(known_units([cell])))
        ):
            raise ValueError(f'{name} goes on below as {cell}: divide the file there')
    return column


def _moments(text: Any) -> Any:
    """Convert dates and times of the day in any of the usual notations; NaT for other text."""
    import pandas as pd  # noqa: PLC0415, of an extra

    text = text.str.replace(r',(?! )', '.', regex=True)
    text = text.str.replace(r'(?<=:\d\d)(::|[:;])(?=\d{3,}\b)', '.', regex=True)  # 9:00:00:040
    text = text.str.replace(r'^(\d{4}-\d\d-\d\d)[-_](?=\d\d:)', r'\1T', regex=True)  # of TwinCAT
    moments = pd.to_datetime(text, format='ISO8601', utc=True, errors='coerce')
    if not moments.notna().any():
        half = text.str.lower().str.extract(r'(?:^| )(\d+):.*([ap])m$')  # 12:00 AM is midnight
        later = pd.to_timedelta(12.0 * (half[1] == 'p') - 12.0 * (half[0] == '12'), unit='h')
        text = text.str.replace('(?i)(?<=[0-9]) ?[ap]m$', '', regex=True)
        plain = text.str.replace(r'^\d+:\d+[.].*', r'0:\g<0>', regex=True)
        moments = pd.Timestamp(0) + pd.to_timedelta(plain, errors='coerce') + later
    if not moments.notna().any():  # other dates
        date = r'\d\d?[ ./-](\d\d?|[A-Za-z]{3})[ ./-](\d{4}|(?<=[./])\d\d) +\d\d?:\d\d'
        date = rf'\d{{4}}[./-]\d\d?[./-]\d\d?[ T]+\d\d?:\d\d|{date}'  # with AM or PM
        date = rf'[A-Z][a-z]{{2}} [A-Z][a-z]{{2}} +\d\d? \d\d:\d\d:\d\d|{date}'  # of asctime
        dates = text.where(text.str.match(date))
        dates = dates.str.replace(r'([./])(\d\d)(?= )', r'\g<1>20\2', regex=True)
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', UserWarning)  # about texts in no common format
            orders = [
                pd.to_datetime(dates, dayfirst=first, utc=True, errors='coerce')
                for first in (False, True)
            ]
        # Over midnight, the wrong order of day and month is a month longer, or no date.
        moments = min(orders, key=lambda one: (one.isna().sum(), one.max() - one.min())) + later
    return moments.dt.tz_localize(None)


def are_words_below(column: Any) -> Any:
    """Return which cells below a column of numbers are words, such as Min and Max in a footer."""
    if column.dtype.kind in 'iufb':
        return np.zeros(len(column), bool)
    filled = column.notna()
    words = column.astype(str).str.match(r'\s*[^\W\d]{2}') & filled
    last = np.flatnonzero(filled & ~words)
    below = np.arange(len(column)) > (last[-1] if len(last) > 0.5 * len(column) else len(column))
    return words & below


def may_be_divided(column: Any) -> bool:
    """Return whether numbers may be whole ones with a mark between thousands: 1.024 for 1024."""
    if column.dtype.kind != 'f':
        return False
    values = np.abs(column[np.isfinite(column)].to_numpy())
    small, rest = values[values > 0.0].min(initial=1.0) < 1.0, np.round(1000.0 * values, 6) % 1.0
    large = values.max(initial=0.0) >= 1000.0  # noqa: PLR2004, as said above
    return bool((values % 1.0).any() and not (small or large or rest.any()))


def are_divided(text: Any, point: str) -> bool:
    """Return whether only numbers from 1000 on have decimals, which are always three."""
    text, mark = text.dropna().str.strip(), re.escape(point)
    whole = text.str.fullmatch(rf'[-+]?([1-9]\d{{0,2}}({mark}\d{{3}})?|0)')
    return bool(whole.all() and not text.str.contains(mark).all())


@lru_cache(_KEPT)
def weight(cell: str, point: str) -> float:
    """Return how certainly a cell is a number or a time: 0 to 1."""
    if elements := _array(cell):
        return min(weight(one, '.') for one in elements)
    plain, grouped = _forms(point)
    cell = _NEGATIVE.sub(r'-\1', cell.removesuffix(unit_of(cell)).rstrip())
    if plain.fullmatch(cell):
        return 1.0 if ',' not in cell else 0.9
    return 0.5 if grouped.fullmatch(cell) or MOMENT.fullmatch(cell) else 0.0


@cache
def _forms(point: str) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Patterns of numbers with a decimal point, without and with marks between thousands."""
    mark, other = re.escape(point), re.escape('.' if point == ',' else ',')
    power = r'(([eE][-+]?|[dD][-+])\d+)?'
    plain = rf'[-+\u2212]?(\d+({mark}\d*)?|{mark}\d+){power}|0x[\da-fA-F]+'
    grouped = rf"[-+\u2212]?[1-9]\d{{0,2}}(([ '\u2019\u00a0\u202f]|{other})\d{{3}})+({mark}\d*)?"
    return re.compile(plain), re.compile(grouped)


def _array(cell: Any) -> list[str]:
    text = str(cell).strip()
    listed = text[:1] + text[-1:] == '[]' or (text[:1] == '(' and _TUPLE.fullmatch(text))
    inner = text[1:-1].strip(' ,') if listed else ''
    parts = inner.split(',' if re.search('[,"\']', inner) else None)
    return [one.strip(' "\'') for one in parts] if inner else []


def are_arrays(cells: Iterable[str]) -> bool:
    """Return whether the cells of a column are arrays of numbers, of which some can be empty."""
    arrays = [array for array in map(_array, cells) if array]
    return bool(arrays) and all(weight(one, '.') for array in arrays for one in array)


def elements_of(frame: Any, names: Sequence[str], places: Iterable[int]) -> dict[str, Any]:
    """Divide columns of arrays; elements of sensor_msgs/JointState bear the name of their joint.

    Args:
        frame: the columns of the table, by their places.
        names: names of all columns.
        places: those of the columns with arrays.
    """
    import pandas as pd  # noqa: PLC0415, of an extra

    found: dict[str, Any] = {}
    for place in places:
        name, arrays = names[place], [*map(_array, frame[place])]
        keys: Iterable[Iterable[Any]] = map(range, map(len, arrays))
        namer, form = name.rpartition('position')[0] + 'name', f'{name}[{{}}]'
        if name.endswith('position') and namer in names:
            keys, form = map(cache(_array), frame[names.index(namer)]), f'{{}} {name}'
        elif max(map(len, arrays)) == 1:
            form = name
        rows = (dict(zip(*pair, strict=False)) for pair in zip(keys, arrays, strict=True))
        columns = pd.DataFrame(rows, dtype=object).fillna('nan')
        found |= {form.format(key): column for key, column in columns.items()}
    return found


def key_of(names: Sequence[str], columns: Sequence[Sequence[str]]) -> tuple[str, str]:
    """Return the column that says which series or joint a row is of, and that of its value.

    The first is empty if a row has all series, the second if it has several values of a joint. The
    columns of the first rows have fewer cells where a row is short.
    """
    roles, lower = {meaning(name).role for name in names}, [n.lower().strip('_') for n in names]
    if 'value' in lower and not {'rotor', 'output'} <= roles:
        for place in (lower.index(name) for name in _TOPICS.split('|') if name in lower):
            cells = columns[place]
            if len({*cells}) < len(cells) or not all(map(str.isdecimal, cells)):  # no row number
                return names[place], names[lower.index('value')]
    found = []
    for name, cells in zip(names, columns, strict=True):
        changes = sum(one != other for one, other in pairwise(cells))
        several = 2 * len({*cells}) <= len(cells) and changes > _OFTEN * (len(cells) - 1)
        plain = all(cell[:1] not in '[(' for cell in cells)
        plain &= all(cell.isdecimal() or not weight(cell, '.') for cell in cells)
        if several and plain and _IDS.fullmatch(' '.join(meaning(name).words)):
            found.append(name)
    found.sort(key=lambda name: 'name' not in meaning(name).words)
    return (found[0] if found and 'angle' in roles else ''), ''
