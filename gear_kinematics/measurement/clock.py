"""Stamps of recordings: their unit, their order, and when a recording was made."""

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[Any]

_EARLIEST = 631_152_000.0
"""s, 1990: a smaller time does not count from 1970."""
_LATEST = 4_102_444_800.0
"""s, 2100."""
_NAMED = re.compile(
    r'(?<!\d)(?:(?P<year>\d{4})[-_.]?)?(?P<month>\d\d)[-_.]?(?P<day>\d\d)'
    r'[-_.T ]+(?P<hour>\d\d)[-_.:h]?(?P<minute>\d\d)(?:[-_.:]?(?P<second>\d\d))?(?!\d)'
)
"""Such as 2024-07-12__14-07-48, 20240712T140748 or 0712_1407."""
_NO_YEAR = 2000
"""Taken where a name has no year; a leap year."""


class ClockError(ValueError):
    """Times that cannot be used; the text is the cause."""


def unit_since_1970(time: float) -> float | None:
    """The unit, s, of a time that counts from 1970 in s, ms, µs or ns; None if it does not."""
    units = (1.0, 1e-3, 1e-6, 1e-9)
    return next((unit for unit in units if _EARLIEST <= time * unit < _LATEST), None)


def times_of_rows(time: Array) -> Array:
    """Return when each row was sampled, s since the first.

    Rows between two steps of a coarse clock have equal times; they are spread evenly until the
    next step.

    Args:
        time: (n,), s, as it was read.

    Returns:
        (k,), increasing, of the rows before the clock was set back.

    Raises:
        ClockError: if most are later than that, or the others are not finite, or stand still.
    """
    kept = before_set_back(time)
    if 2 * kept < len(time):
        raise ClockError('they go back')
    time = time[:kept]
    if not np.isfinite(time).all():
        raise ClockError('they are not numbers')
    since = time - time[0]
    first = np.concatenate([[0], 1 + np.flatnonzero(np.diff(since))])  # rows of a new time
    if len(first) < 2:  # noqa: PLR2004, one interval
        raise ClockError('they stand still')
    # The last step has no next one: its rows are as far apart as the others on average.
    interval = since[-1] / first[-1]
    end = since[-1] + interval * (len(since) - first[-1])
    steps, times = np.append(first, len(since)), np.append(since[first], end)
    spread: Array = np.interp(np.arange(len(since)), steps, times)
    return spread


def before_set_back(stamps: Array) -> int:
    """Number of stamps before the first that is older than the one before it."""
    back = np.flatnonzero(np.diff(stamps) < 0)
    return int(back[0]) + 1 if len(back) else len(stamps)


def in_order(stamps: Array) -> tuple[Array, int]:
    """Choose stamps, ns, as the node does: those in disorder by up to a second are left out.

    Returns:
        The indices that are kept, and how many are left out in disorder. A clock that was set back
        further ends them.
    """
    late = np.maximum.accumulate(stamps) - stamps
    late = late[~np.logical_or.accumulate(late > CLOCK_RESET)]
    kept = np.flatnonzero(late == 0)
    return kept, len(late) - len(kept)


@dataclass(frozen=True, slots=True)
class Dates:
    """Times at which a recording may have been made, s since 1970."""

    recorded: float | None
    """By the recording: the start of a bag, or the first time of a CSV."""
    named: float | None
    """In the name; without a year it is in `_NO_YEAR`."""
    modified: float
    """Of the file."""


def common_times(dates: Sequence[Dates]) -> tuple[list[float], str]:
    """Choose the best source that dates all recordings.

    Returns:
        Times in s, of which only differences count, and their source.
    """
    for attribute, source in (
        ('recorded', 'the times in the recordings'),
        ('named', 'the times in their names'),
    ):
        times = [getattr(date, attribute) for date in dates]
        if None not in times:
            return times, source
    files = 'the times of their files, which copying may have changed'
    return [date.modified for date in dates], files


def dates_of(path: Path, recorded: float | None) -> Dates:
    """Find the dates of a recording, which starts at a time by its contents, if they say so.

    Raises:
        OSError: if there is none.
    """
    return Dates(recorded, named_time(path.name), path.stat().st_mtime)


def named_time(name: str) -> float | None:
    """Return the time in a name, s since 1970; None if there is none."""
    for match in _NAMED.finditer(name):
        parts = {unit: int(value) for unit, value in match.groupdict('0').items()}
        parts['year'] = parts['year'] or _NO_YEAR
        with suppress(ValueError):
            return datetime(**parts, tzinfo=UTC).timestamp()
    return None
