# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables that are no text, through the libraries of their formats."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.measurement.dialects import Table, numbers


def _table(
    columns: Mapping[str, Any],
    units: Mapping[str, str] | None = None,
    clocks: Mapping[str, str] | None = None,
) -> Table:
    first = {name: str(values[0]) for name, values in columns.items() if len(values)}
    return Table(
        [*columns],
        units or {},
        clocks or {},
        first,
        lambda names: ({name: columns[name] for name in names}, 1),
    )


def _parquet(path: Path) -> Table:
    """Columns of numbers, and the elements of vectors, as LeRobot has them."""
    import pyarrow.parquet as pq  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}
    for name, column in pq.read_table(path).to_pandas().items():
        if column.dtype.kind == 'O' and len(column) and np.ndim(column.iloc[0]) == 1:
            vectors = np.stack([np.asarray(vector, float) for vector in column])
            columns |= {f'{name}[{k}]': vectors[:, k] for k in range(vectors.shape[1])}
        elif column.dtype.kind in 'iufbM':
            columns[str(name)] = numbers(column)
    return _table(columns)


def _mat(path: Path) -> Table:
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
    return _table(columns)


def _tdms(path: Path) -> Table:
    """Channels of LabVIEW, with their units and times."""
    from nptdms import TdmsFile  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}
    units, clocks = {}, {}
    for group in TdmsFile.read(path).groups():
        for channel in group.channels():
            columns[channel.name] = channel[:]
            units[channel.name] = str(channel.properties.get('unit_string', ''))
            if 'wf_increment' in channel.properties:
                clocks[channel.name] = clock = f'time of {channel.name} [s]'
                columns[clock] = channel.time_track()
    return _table(columns, units, clocks)


def _mf4(path: Path) -> Table:
    """Channels of ASAM MDF, with their units and times."""
    from asammdf import MDF  # noqa: PLC0415, of an extra

    columns: dict[str, Any] = {}
    units, clocks = {}, {}
    with MDF(path) as file:
        for signal in file.iter_channels(skip_master=True):
            if signal.samples.dtype.kind in 'iuf' and signal.samples.ndim == 1:
                clocks[signal.name] = clock = f'time of {signal.name} [s]'
                columns |= {signal.name: signal.samples, clock: signal.timestamps}
                units[signal.name] = signal.unit
    return _table(columns, units, clocks)


FORMATS: Mapping[str, Callable[[Path], Table]] = {
    '.parquet': _parquet,
    '.mat': _mat,
    '.tdms': _tdms,
    '.mf4': _mf4,
    '.mdf': _mf4,
}
"""What opens a table, by the end of its name."""
