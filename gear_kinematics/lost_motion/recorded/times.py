"""When recordings were made: by their contents, their names, or the times of their files."""

import csv
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.lost_motion.recorded.clock import unit_since_1970
from gear_kinematics.lost_motion.recorded.csv_files import is_csv

_TIME_COLUMNS = {'time', 'stamp', 'timestamp', 't'}
_UNIT = re.compile(r'[\s_]*[\[(]?(n|u|µ|m)?s[\])]?$')
_NAMED = re.compile(
    r'(?<!\d)(?:(?P<year>\d{4})[-_.]?)?(?P<month>\d\d)[-_.]?(?P<day>\d\d)'
    r'[-_.T ]+(?P<hour>\d\d)[-_.:h]?(?P<minute>\d\d)(?:[-_.:]?(?P<second>\d\d))?(?!\d)'
)
"""Such as 2024-07-12__14-07-48, 20240712T140748 or 0712_1407."""
_NO_YEAR = 2000
"""Taken where a name has no year; a leap year."""


@dataclass(frozen=True, slots=True)
class Times:
    """Times at which a recording may have been made, s since 1970."""

    recorded: float | None
    """By the recording: the start of a bag, or the first time of a CSV."""
    named: float | None
    """In the name; without a year it is in `_NO_YEAR`."""
    modified: float
    """Of the file."""


def times_of(path: Path) -> Times:
    """Find the times of a recording.

    Raises:
        OSError: if there is none.
    """
    return Times(_recorded(path), named_time(path.name), path.stat().st_mtime)


def common_times(times: Sequence[Times]) -> tuple[list[float], str]:
    """Choose the best source that dates all recordings.

    Returns:
        Times in s, of which only differences count, and their source.
    """
    for attribute, source in (
        ('recorded', 'the times in the recordings'),
        ('named', 'the times in their names'),
    ):
        found = [getattr(time, attribute) for time in times]
        if None not in found:
            return found, source
    return [time.modified for time in times], (
        'the times of their files, which copying may have changed'
    )


def named_time(name: str) -> float | None:
    """Return the time in a name, s since 1970; None if there is none."""
    for match in _NAMED.finditer(name):
        parts = {unit: int(value) for unit, value in match.groupdict('0').items()}
        with suppress(ValueError):
            time = datetime(
                parts['year'] or _NO_YEAR,
                parts['month'],
                parts['day'],
                parts['hour'],
                parts['minute'],
                parts['second'],
                tzinfo=UTC,
            )
            return time.timestamp()
    return None


def _recorded(path: Path) -> float | None:
    with suppress(BagError, OSError, ValueError, csv.Error):
        # What cannot be read here is reported where it is measured.
        return _first_time(path) if is_csv(path) else _first_stamp(path)
    return None


def _first_stamp(path: Path) -> float | None:
    with Bag(path) as bag:
        first = next(bag.messages(bag.topics), None)
    return None if first is None else 1e-9 * first[1]


def _first_time(path: Path) -> float | None:
    """Read the first time of a CSV, if it counts from 1970."""
    with path.open(encoding='utf-8-sig', newline='') as file:
        head = list(islice(file, 2))
    if len(head) < 2:  # noqa: PLR2004, names and a row
        return None
    delimiter = max(',;\t', key=head[0].count)
    names, values = csv.reader(head, delimiter=delimiter)
    for name, value in zip(names, values, strict=False):
        if _UNIT.sub('', name.strip().lower()) in _TIME_COLUMNS:
            unit = unit_since_1970(time := float(value))
            return None if unit is None else unit * time
    return None
