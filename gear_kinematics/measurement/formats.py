# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The formats of tables, and the libraries that read those that are not text.

A table becomes a recording in steps, each in a module of its own: `open_table` here chooses the
reader; `texts` decodes a text, in which `dialects` finds names, units and numbers, whose `cells`
are numbers, times or arrays; `channel_times` finds times that belong to some channels, and
`series` divides texts with a row for each value; `names` has the words and units in names, by
which `columns` chooses, or `advice` proposes columns; `clocks` gives the rows their times;
`assumed_units` doubts units that are not given; and `tables` decides which rows are used.
"""

import json
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.finding import (
    BAG_NAME,
    COMPRESSED,
    NO_CONTENT,
    POINTER,
    TABLES,
    table_format,
)
from gear_kinematics.measurement.cells import elements_of, key_of, numbers
from gear_kinematics.measurement.dialects import TableFile, loaded, open_text
from gear_kinematics.measurement.names import meaning
from gear_kinematics.measurement.series import series_of

_ROWS = 100  # that show whether a column says which series a row is of
_COVER = 50  # rows; a first sheet with fewer may describe those that follow
_ASAMMDF = re.compile(r'DG(M?)(\d+)_(.*)')
"""Names of channels of a group, and of its times (M), that asammdf exports."""
_OBJECT = 0xDD000000  # begins the reference to an object, such as a table, in a file of MATLAB


def _parquet(path: Path) -> TableFile:
    """Read columns of numbers, elements of vectors, as LeRobot writes them, fields, and series."""
    import pyarrow as pa  # noqa: PLC0415, of an extra
    import pyarrow.parquet as pq  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}
    units: dict[str, str] = {}
    names = pq.read_schema(path).names
    if repeated := [name for name in names if names.count(name) > 1]:
        raise ValueError(f'more than one column {repeated[0]!r}')
    table = pq.read_table(path)
    while any(map(pa.types.is_struct, table.schema.types)):
        table = table.flatten()
    images = pa.binary(), pa.large_binary()
    table = table.select([k for k, kind in enumerate(table.schema.types) if kind not in images])
    frame = table.to_pandas()
    if frame.index.dtype.kind in 'mMf':
        frame = frame.rename_axis(index=frame.index.name or 'time').reset_index()
    names = [*map(str, frame)]
    texts = [frame[name].head(_ROWS).dropna().astype(str).tolist() for name in frame]
    key, value = key_of(names, texts)
    if key:
        return loaded(*series_of(frame.set_axis(names, axis=1), '.', key, value, {}))
    for name, column in zip(names, map(frame.get, frame), strict=True):
        first = np.asarray(next(iter(column.dropna()), 0))
        namer = f'{name.rpartition("position")[0]}name'
        if first.ndim != 1:
            columns[name] = numbers(column)
        elif name.endswith('position') and namer in names:
            both = frame[[namer, name]].map(lambda each: str(np.asarray(each).tolist()))
            joints = elements_of(both.set_axis([0, 1], axis=1), [namer, name], [1])
            columns |= {joint: numbers(angles) for joint, angles in joints.items()}
            units |= dict.fromkeys(joints, 'rad')
        elif first.dtype.kind in 'iuf':
            vectors = (vector if np.ndim(vector) else () for vector in column)
            elements = enumerate(zip_longest(*vectors, fillvalue=np.nan))
            columns |= {f'{name}[{k}]': np.array(values, float) for k, values in elements}
    return loaded(columns, units)


def _mat(path: Path) -> TableFile:
    """Read vectors and the columns of matrices, also those in structures."""
    from scipy.io import loadmat  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}
    units: dict[str, str] = {}

    def add(name: str, value: Any) -> None:
        if isinstance(value, dict):
            if isinstance(unit := value.get('Unit'), str) and unit:  # of dSPACE
                units[f'{name}.Data'] = unit
            for key, inner in value.items():
                add(f'{name}.{key}' if name else key, inner)
        elif all(isinstance(each, dict) for each in np.atleast_1d(value)):  # of scopes of Simulink
            above, dot, own = name.rpartition('.')
            labels = [signal.get('label', signal.get('Name')) for signal in value]  # of dSPACE
            labels = [label if isinstance(label, str) else '' for label in labels]
            for k, (label, signal) in enumerate(zip(labels, value, strict=True)):
                known = label and labels.count(label) == 1
                add(f'{above}{dot}{label if known else f"{own}[{k}]"}', signal)
        elif np.ndim(value) in {1, 2} and np.asarray(value).dtype.kind in 'iuf':
            values = np.squeeze(value)
            if values.ndim == 1 and values.size > 1 and values[0] != _OBJECT:
                columns[name] = values
            elif values.ndim == 2:  # noqa: PLR2004, a matrix; Simulink has a row for each signal
                values = min(values, values.T, key=len)
                columns.update({f'{name}[{k}]': one for k, one in enumerate(values)})

    try:
        found = loadmat(path, simplify_cells=True)
    except NotImplementedError:  # version 7.3
        import h5py  # noqa: PLC0415, of an extra

        with h5py.File(path) as file:
            found = _of_hdf5(file)
    except ValueError:
        return open_text(path)  # as save -ascii writes it
    add('', {key: value for key, value in found.items() if key[:1] not in '_#'})
    if len({name.partition('.')[0] for name in columns}) == 1:  # all are in one structure
        columns, units = (
            {name.partition('.')[2] or name: one for name, one in each.items()}
            for each in (columns, units)
        )
    groups = [(*named.groups(), v) for k, v in columns.items() if (named := _ASAMMDF.match(k))]
    if times := {group: values for master, group, _, values in groups if master}:
        channels = [one for one in groups if not one[0]]
        return _of_channels((g, own, v, '', times.get(g)) for _, g, own, v in channels)
    if not columns:
        raise ValueError('no columns of numbers: save the vectors of a timetable or timeseries')
    return loaded(columns, units)


def _of_hdf5(group: Any) -> dict[str, Any]:
    """Read structures and matrices, without texts, as MATLAB 7.3 writes them, by columns."""
    return {
        key: _of_hdf5(one) if hasattr(one, 'keys') else one[()].T
        for key, one in group.items()
        if one.attrs.get('MATLAB_class') != b'char'
    }


def _of_channels(channels: Iterable[tuple[Any, str, Any, str, Any]]) -> TableFile:
    """Return a table of channels, named with their groups if they share a name.

    A channel is its group, name, values, unit, and times, s, or None.
    """
    columns: dict[str, Any] = {}
    units, clocks = dict[str, str](), dict[str, str]()
    found = [*channels]
    several = len({name for _, name, *_ in found}) < len(found)
    for group, own, values, unit, times in found:
        name = f'{group}/{own}' if several else own
        columns[name] = values
        if unit:
            units[name] = unit
        if times is not None:
            clocks[name] = clock = f'time of {name}'
            columns[clock], units[clock] = times, 's'
    return loaded(columns, units, clocks)


def _tdms(path: Path) -> TableFile:
    """Read the channels of LabVIEW, with their units and times."""
    from nptdms import TdmsFile  # noqa: PLC0415, of an extra

    found, begin = [], None
    for group in TdmsFile.read(path).groups():
        timed = any(meaning(channel.name).role == 'time' for channel in group.channels())
        for channel in group.channels():
            known, times = channel.properties, None
            if (step := known.get('wf_increment')) and not timed:
                times = known.get('wf_start_offset', 0.0) + step * np.arange(len(channel))
                if start := known.get('wf_start_time'):
                    begin = begin or start
                    times += (start - begin) / np.timedelta64(1, 's')
            unit = str(known.get('unit_string') or known.get('NI_UnitDescription', ''))
            found.append((group.name, channel.name, channel[:], unit, times))
    return _of_channels(found)


def _mf4(path: Path) -> TableFile:
    """Read the channels of ASAM MDF, with units and times, without samples marked as invalid."""
    from asammdf import MDF  # noqa: PLC0415, of an extra

    with MDF(path) as file:
        valid = (one.validate(copy=False) for one in file.iter_channels(skip_master=True))
        return _of_channels(
            (one.group_index, one.name, one.samples, one.unit, one.timestamps)
            for one in valid
            if one.samples.dtype.kind in 'iuf' and one.samples.ndim == 1
        )


def _workbook(path: Path) -> TableFile:
    """Read the first sheet that is no cover, in which names and units are found as in a text."""
    import pandas as pd  # noqa: PLC0415, of an extra

    with pd.ExcelFile(path, engine='openpyxl') as book:  # not that of an old .xls
        sheet, *_ = parsed = [book.parse(0, header=None)]
        if len(sheet) < _COVER:
            parsed += [book.parse(name, header=None) for name in book.sheet_names[1:]]
            sheet = next((one for one in parsed if len(one) >= _COVER), sheet)
    try:
        return open_text(path, sheet.to_csv(header=False, index=False).encode())
    except ValueError as error:
        sheets = pd.read_excel(path, sheet_name=None, header=None)
        known = {name: one.apply(pd.to_numeric, errors='coerce') for name, one in sheets.items()}
        found = ', '.join(str(name) for name in known if known[name].notna().any(axis=None))
        hint = f'; sheets with numbers: {found}: save one as CSV' * bool(found)
        raise ValueError(f'{error}{hint}') from error


def _json(path: Path) -> TableFile:
    """Read an object in each line, whose fields and arrays are columns."""
    import pandas as pd  # noqa: PLC0415, of an extra

    lines = path.read_text('utf-8-sig').splitlines()
    rows = pd.json_normalize([*map(json.loads, filter(None, lines))])
    return open_text(path, rows.to_csv(index=False).encode())


_READERS: Mapping[str, Callable[[Path], TableFile]] = {
    'text': open_text,
    'parquet': _parquet,
    'mat': _mat,
    'tdms': _tdms,
    'mf4': _mf4,
    'workbook': _workbook,
    'json': _json,
}
"""Readers, by the format that `TABLES` gives for a name."""


def is_table(path: Path) -> bool:
    """Return whether the name of a recording is that of a table; otherwise it is a bag."""
    return bool(table_format(path))


@contextmanager
def open_bag(path: Path) -> Iterator[Bag]:
    """Open a bag; a BagError lists what can be read, unless the name is that of a bag."""
    try:
        with Bag(path) as bag:
            yield bag
    except BagError as error:
        if path.is_file() and not BAG_NAME.search(path.name):
            kinds = (
                f'{error}; bags are .mcap, .db3, .bag and folders, tables {", ".join(TABLES)}, '
                f'texts also compressed, as {", ".join(f".csv{end}" for end in COMPRESSED)}'
            )
            raise BagError(kinds) from error
        raise


def open_table(path: Path) -> TableFile:
    """Open a table; OSError or ValueError if it cannot be read."""
    if path.exists() and not path.is_file():
        raise ValueError('not a regular file')
    with path.open('rb') as file:
        if file.read(len(POINTER)) == POINTER:
            raise ValueError(NO_CONTENT)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # of the libraries, about what is not read
            return _READERS[table_format(path)](path)
    except (ImportError, OSError, ValueError):
        raise
    except Exception as error:  # each library has its own
        raise ValueError(f'cannot be read as {path.suffix}: {error}') from error
