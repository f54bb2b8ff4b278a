"""When a gear has changed: by the one step, or slope, of a figure over time that explains most."""

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
from scipy.stats import theilslopes

from gear_kinematics.correction.uncertainty import COVERAGE
from gear_kinematics.measurement.compare.changes import Change, changes_of
from gear_kinematics.measurement.compare.groups import Group
from gear_kinematics.measurement.compare.quantities import Quantity
from gear_kinematics.measurement.recording import Recording

FEWEST = 5
"""Recordings: of four, a steady rise or fall comes up by chance in 2 of 24 orders."""
_DRAWS = 4000
"""Random orders: they give a probability of 5 % within 0.7 % (95 %)."""
_SEED = 0x6EA2
_DATE = re.compile(
    r'(?<!\d)(?:(?P<year>\d{4})[-_.]?)?(?P<month>\d\d)[-_.]?(?P<day>\d\d)'
    r'[-_.T ]+(?P<hour>\d\d)[-_.:h]?(?P<minute>\d\d)(?:[-_.:]?(?P<second>\d\d))?(?!\d)'
)
"""Such as 2024-07-12__14-07-48, 20240712T140748 or 0712_1407."""
_NO_YEAR = 2000
"""Taken where a name has no year; a leap year."""


def trend(quantity: Quantity, times: Sequence[float], names: Sequence[str]) -> Change | None:
    """Find the best step or slope over ascending times; None with too few recordings.

    The change is that between the two recordings beside a step; along a slope, between the first
    and the last of all recordings. Its probability is the share of random orders in which a step
    or a slope explains as much.
    """
    pairs = [(k, v.value) for k, v in enumerate(quantity.values) if v and v.value > 0.0]
    if len(pairs) < FEWEST:
        return None
    known, values = zip(*pairs, strict=True)
    logs = np.log(values)
    span = times[-1] - times[0] or 1.0
    time = np.array([(times[k] - times[0]) / span for k in known])
    candidates = np.column_stack([np.tri(len(known), len(known) - 1, -1), time])
    candidates -= candidates.mean(axis=0)
    candidates /= np.maximum(np.linalg.norm(candidates, axis=0), np.finfo(np.float64).tiny)
    # By how much each reduces the sum of squares; rounded, as equal ones must be.
    gains = np.round(((logs - logs.mean()) @ candidates) ** 2, 12)
    orders = np.random.default_rng(_SEED).permuted(np.tile(logs, (_DRAWS, 1)), axis=1)
    others = np.round(((orders - logs.mean()) @ candidates) ** 2, 12).max(axis=1)
    chance = float(1 + np.count_nonzero(others >= gains.max())) / (1 + _DRAWS)
    edge = int(np.argmax(gains)) + 1
    if edge < len(known):
        before, after = known[:edge], known[edge:]
        parts = Group(names[before[-1]], before), Group(names[after[0]], after)
        (step,) = changes_of(quantity, parts)
        return replace(step, probability=chance)
    slope, start, *ends = theilslopes(logs, time, COVERAGE)
    first, last, *interval = map(float, np.exp([start, start + slope, *ends]))
    whole = names[0], names[-1], first, last
    return Change(quantity, *whole, tuple(interval), chance, repeated=True)


def common_times(recordings: Sequence[Recording]) -> tuple[list[float], str]:
    """Date recordings by the best source that dates all of them.

    Returns:
        Times in s, of which only differences count, and their source.
    """
    for found, source in (
        ([recording.start for recording in recordings], 'the times in the recordings'),
        ([named_time(one.path.name) for one in recordings], 'the times in their names'),
    ):
        times = [time for time in found if time is not None]
        if len(times) == len(recordings):
            return times, source
    files = 'the times of their files, which copying may have changed'
    return [recording.path.stat().st_mtime for recording in recordings], files


def named_time(name: str) -> float | None:
    """Return the time in a name, s since 1970; None if there is none."""
    for match in _DATE.finditer(name):
        parts = {unit: int(value) for unit, value in match.groupdict('0').items()}
        parts['year'] = parts['year'] or _NO_YEAR
        with suppress(ValueError):
            return datetime(**parts, tzinfo=UTC).timestamp()
    return None
