"""A sliding window of samples, for statistics now and then."""

from array import array
from typing import Any

import numpy as np
from numpy.typing import NDArray

_MOST = 2**20
"""Samples that are kept at most: 60 s, the longest window, at 17 kHz."""


class SlidingWindow:
    """Samples of the last seconds, as columns; a clock that is set back begins anew."""

    def __init__(self, columns: int) -> None:
        """Begin without samples of so many columns."""
        self._stamps = array('q')
        self._columns = tuple(array('d') for _ in range(columns))

    def add(self, stamp: int, *values: float) -> None:
        """Add a sample at a stamp, ns."""
        if self._stamps and stamp < self._stamps[-1]:
            self._drop(len(self._stamps))
        elif len(self._stamps) == _MOST:
            self._drop(_MOST // 2)
        self._stamps.append(stamp)
        for column, value in zip(self._columns, values, strict=True):
            column.append(value)

    def columns(self, length: int) -> NDArray[Any]:
        """Forget what is older than the last sample by more than `length`, ns.

        Returns:
            (columns, n), in the order of the stamps.
        """
        if self._stamps:
            self._drop(int(np.searchsorted(np.array(self._stamps), self._stamps[-1] - length)))
        return np.array(self._columns)

    def _drop(self, count: int) -> None:
        del self._stamps[:count]
        for column in self._columns:
            del column[:count]
