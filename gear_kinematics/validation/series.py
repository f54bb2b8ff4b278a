"""A record over time that is thinned out as it grows, for plots."""

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.report import Series

Array = NDArray[np.float64]

_MOST = 4000  # points; half as many are kept when there are more
_SECOND = 1e9  # ns


class SeriesRecorder:
    """Keeps, of each interval of samples, the one with the worst error."""

    def __init__(self) -> None:
        """Start empty."""
        self._columns = np.zeros((5, 0))
        self._interval = 1
        self._rest = np.zeros((5, 0))
        self._first: int | None = None

    def update(self, output: dict[str, Array], poses: dict[str, Array]) -> None:
        """Take what was compared of output_state, and of body_poses at the same stamps."""
        if not output or not len(output['stamp']):
            return
        if self._first is None:
            self._first = int(output['stamp'][0])
        position_error = np.zeros(len(output['stamp']))
        if poses and len(poses['stamp']):
            order = np.argsort(poses['stamp'], kind='stable')
            at = np.searchsorted(poses['stamp'], output['stamp'], sorter=order)
            at = order[np.minimum(at, len(order) - 1)]
            same = poses['stamp'][at] == output['stamp']
            position_error[same] = poses['error'][at[same]]
        fresh = np.array(
            [
                (output['stamp'] - self._first) / _SECOND,
                output['rotor_angle'],
                output['output_angle'],
                output['error'],
                position_error,
            ]
        )
        self._rest = np.concatenate([self._rest, fresh], axis=1)
        whole = self._rest.shape[1] // self._interval * self._interval
        self._columns = np.concatenate(
            [self._columns, _worst(self._rest[:, :whole], self._interval)], axis=1
        )
        self._rest = self._rest[:, whole:]
        while self._columns.shape[1] > _MOST:
            even = self._columns.shape[1] // 2 * 2
            left = self._columns[:, even:]
            self._columns = np.concatenate([_worst(self._columns[:, :even], 2), left], axis=1)
            self._interval *= 2

    def series(self) -> Series | None:
        """Give the record, or None where nothing was compared."""
        if self._first is None:
            return None
        rest = _worst(self._rest, max(self._rest.shape[1], 1))
        return Series(*np.concatenate([self._columns, rest], axis=1).tolist())


def _worst(columns: Array, interval: int) -> Array:
    """Of each interval the first three numbers of its middle, and the worst of each error."""
    table = columns.reshape(5, -1, interval)
    thinned = table[:, :, interval // 2].copy()
    for row in (3, 4):
        worst = np.argmax(np.abs(table[row]), axis=1) if table.size else []
        thinned[row] = table[row, np.arange(table.shape[1]), worst]
    return thinned
