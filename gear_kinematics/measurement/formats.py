# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The formats of tables, and the libraries that read those that are no text."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.finding import BAG_NAME
from gear_kinematics.measurement.cells import numbers
from gear_kinematics.measurement.dialects import TableFile, loaded, open_text


def _parquet(path: Path) -> TableFile:
    """Columns of numbers, and the elements of vectors, as LeRobot has them."""
    import pyarrow.parquet as pq  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}
    for name, column in pq.read_table(path).to_pandas().items():
        filled = column.dropna()
        if column.dtype.kind == 'O' and len(filled) and np.ndim(filled.iloc[0]) == 1:
            vectors = np.full((len(column), filled.map(len).max()), np.nan)
            for row, vector in zip(vectors, column, strict=True):
                if np.ndim(vector):
                    row[: len(vector)] = vector
            columns |= {f'{name}[{k}]': vectors[:, k] for k in range(vectors.shape[1])}
        else:
            columns[str(name)] = numbers(column)
    return loaded(columns)


def _mat(path: Path) -> TableFile:
    """Vectors, columns of matrices, and those in structures."""
    from scipy.io import loadmat  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}

    def add(name: str, value: Any) -> None:
        if isinstance(value, dict):
            for key, inner in value.items():
                add(f'{name}.{key}' if name else key, inner)
        elif np.ndim(value) in {1, 2} and np.asarray(value).dtype.kind in 'iuf':
            values = np.squeeze(value)
            if values.ndim == 1 and values.size > 1:
                columns[name] = values
            elif values.ndim == 2:  # noqa: PLR2004, a matrix
                columns.update({f'{name}[{k}]': one for k, one in enumerate(values.T)})

    try:
        found = loadmat(path, simplify_cells=True)
    except NotImplementedError as error:
        raise ValueError('MATLAB 7.3 is not read: save it with -v7') from error
    add('', {key: value for key, value in found.items() if not key.startswith('__')})
    if len({name.partition('.')[0] for name in columns}) == 1:  # all are in one structure
        columns = {name.partition('.')[2] or name: values for name, values in columns.items()}
    return loaded(columns)


class _Channel(NamedTuple):
    """A channel of a measuring system."""

    group: Any
    """Its name or its number."""
    name: str
    values: Any
    unit: str
    times: Any = None
    """s, if it has its own."""


def _of_channels(channels: Sequence[_Channel]) -> TableFile:
    """Return a table of channels, with their groups if they share a name."""
    columns: dict[str, Any] = {}
    units, clocks = {}, {}
    several = len({one.name for one in channels}) < len(channels)
    for group, own, values, unit, times in channels:
        name = f'{group}/{own}' if several else own
        columns[name], units[name] = values, unit
        if times is not None:
            clocks[name] = clock = f'time of {name}'
            columns[clock], units[clock] = times, '=s'
    return loaded(columns, units, clocks)


def _tdms(path: Path) -> TableFile:
    """Channels of LabVIEW, with their units and times."""
    from nptdms import TdmsFile  # noqa: PLC0415, of an extra

    found, begin = [], None
    for group in TdmsFile.read(path).groups():
        for channel in group.channels():
            known, times = channel.properties, None
            if step := known.get('wf_increment'):
                times = known.get('wf_start_offset', 0.0) + step * np.arange(len(channel))
                if start := known.get('wf_start_time'):
                    begin = begin or start
                    times += (start - begin) / np.timedelta64(1, 's')
            unit = str(known.get('unit_string', ''))
            found.append(_Channel(group.name, channel.name, channel[:], unit, times))
    return _of_channels(found)


def _mf4(path: Path) -> TableFile:
    """Channels of ASAM MDF, with their units and times."""
    from asammdf import MDF  # noqa: PLC0415, of an extra

    with MDF(path) as file:
        signals = file.iter_channels(skip_master=True)
        return _of_channels([
            _Channel(one.group_index, one.name, one.samples, one.unit, one.timestamps)
            for one in signals
            if one.samples.dtype.kind in 'iuf' and one.samples.ndim == 1
        ])  # fmt: skip


READERS: Mapping[str, Callable[[Path], TableFile]] = {
    **dict.fromkeys(('.csv', '.tsv', '.txt', '.dat', '.asc', '.lvm'), open_text),
    '.parquet': _parquet,
    '.mat': _mat,
    '.tdms': _tdms,
    **dict.fromkeys(('.mf4', '.mdf'), _mf4),
}
"""What opens a table, by the end of its name."""


def is_table(path: Path) -> bool:
    """Return whether a recording is a table, by its name; otherwise it is a bag."""
    return path.suffix.lower() in READERS


@contextmanager
def open_bag(path: Path) -> Iterator[Bag]:
    """Open what is no table; a BagError names what can be read, unless the name is a bag's."""
    try:
        with Bag(path) as bag:
            yield bag
    except BagError as error:
        if path.is_file() and not BAG_NAME.search(path.name):
            kinds = f'{error}; bags are .mcap, .db3, .bag and folders, tables {", ".join(READERS)}'
            raise BagError(kinds) from error
        raise


def open_table(path: Path) -> TableFile:
    """Open a table; OSError or ValueError if it cannot be read."""
    if path.exists() and not path.is_file():
        raise ValueError('not a regular file')
    suffix = path.suffix.lower()
    try:
        return READERS[suffix](path)
    except (ImportError, OSError, ValueError):
        raise
    except Exception as error:  # of the libraries, each of which has its own
        raise ValueError(f'cannot be read as {suffix}: {error}') from error
