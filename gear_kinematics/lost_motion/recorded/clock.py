"""Times of rows: their unit, and what a clock with coarse steps tells about the rows between."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_EARLIEST = 631_152_000.0
"""s, 1990: a smaller time does not count from 1970."""
_LATEST = 4_102_444_800.0
"""s, 2100."""


class ClockError(ValueError):
    """Times that cannot be used; the text is the cause."""


def unit_since_1970(time: float) -> float | None:
    """Return the unit of a time that counts from 1970: s, ms, µs or ns; in s.

    Returns:
        None if the time does not count from 1970.
    """
    units = (1.0, 1e-3, 1e-6, 1e-9)
    scaled = ((unit, time * unit) for unit in units)
    return next((u for u, t in scaled if math.isfinite(t) and _EARLIEST <= t < _LATEST), None)


def times_of_rows(time: Array) -> Array:
    """Return when each row was sampled, s since the first.

    Rows between two steps of a coarse clock have equal times; they are spread evenly until the
    next step.

    Args:
        time: (n,), s, as it was read.

    Returns:
        (n,), increasing.

    Raises:
        ClockError: if the times are not finite, go back or stand still.
    """
    if not np.isfinite(time).all():
        raise ClockError('they are not numbers')
    since = time - time[0]
    steps = np.diff(since)
    if np.any(steps < 0.0):
        raise ClockError('they go back')
    first = np.concatenate([[0], 1 + np.flatnonzero(steps)])  # rows of a new time
    if len(first) < 2:  # noqa: PLR2004, one interval
        raise ClockError('they stand still')
    # The last step has no next one: its rows are as far apart as the others on average.
    interval = since[-1] / first[-1]
    end = since[-1] + interval * (len(since) - first[-1])
    spread: Array = np.interp(
        np.arange(len(since)), [*first, len(since)], [*since[first].tolist(), end]
    )
    return spread
