# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What names of recordings say: groups, positions, settings of the preload, and times."""

import fnmatch
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from os.path import commonprefix
from typing import NamedTuple

from gear_kinematics.kinematics import Gear, Mechanism, vernier
from gear_kinematics.measurement.encoder_step import UNITS
from gear_kinematics.measurement.recording import Recording

POSITION = r'pos(?:ition)?[_ -]?(\d+)'
"""The position in a name, such as position_1 or pos2."""
_DATE = re.compile(
    r'(?<!\d)(?:(?P<year>\d{4})[-_.]?)?(?P<month>\d\d)[-_.]?(?P<day>\d\d)'
    r'[-_.T ]+(?P<hour>\d\d)[-_.:h]?(?P<minute>\d\d)(?:[-_.:]?(?P<second>\d\d))?(?!\d)'
)
"""Such as 2024-07-12__14-07-48, 20240712T140748 or 0712_1407."""
_NO_YEAR = 2000
"""Taken where a name has no year; a leap year."""
_SETTINGS = (
    r'pins?[_ -](\d+)[_ -](\d+)[_ -](\d+)',
    r'(?:preload|setting|turn|pre)[_ -]?(\d+(?:\.\d+)?)',
)
"""Such as pins_0_78_1 (tooth, ring hole, chassis hole), preload_2 or turn_0.15."""
_PINS = 3
_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d{1,2})?', re.IGNORECASE)


class Group(NamedTuple):
    """Recordings of one state of the gear."""

    name: str
    members: tuple[int, ...]
    """Numbers of the recordings."""


def single(names: Sequence[str]) -> list[Group]:
    """Return a group for each recording, named without the ending that all names share."""
    end = commonprefix([name[::-1] for name in names])[::-1]  # noqa: RUF071, of characters
    return [Group(name.removesuffix(end) or name, (k,)) for k, name in enumerate(names)]


def _by_label(labels: Sequence[str]) -> list[Group]:
    """Group recordings of the same label, in the order in which labels first occur."""
    return [
        Group(label, tuple(k for k, own in enumerate(labels) if own == label))
        for label in dict.fromkeys(labels)
    ]


def grouped(names: Sequence[str], patterns: Sequence[str]) -> tuple[list[Group], list[int]]:
    """Group recordings by patterns, of which the first that matches counts.

    Each is a glob, which makes one group, or a regular expression with one group in parentheses,
    whose text names the group.

    Returns:
        Groups, whose members are numbered without the others; and the numbers of the others.

    Raises:
        ValueError: if a pattern is wrong, or if there are not at least two groups.
    """
    labels = [next(filter(None, (_label(name, p) for p in patterns)), None) for name in names]
    groups = _by_label([label for label in labels if label])
    if len(groups) < 2:  # noqa: PLR2004, nothing to compare
        only = f'only the group {groups[0].name}' if groups else 'no recording that matches'
        raise ValueError(f'group {", ".join(patterns)}: there is {only}')
    return groups, [number for number, label in enumerate(labels) if not label]


def positions_of(names: Sequence[str], pattern: str) -> tuple[list[Group], list[str]]:
    """Read the positions of the output, which a group in parentheses contains, in names.

    Returns:
        The gears, whose recordings differ in the position alone; and the position of each
        recording.

    Raises:
        ValueError: if the pattern is wrong, or if a name contains no position.
    """
    position = _expression('positions', pattern)
    gears, positions = [], []
    for name in names:
        if not (match := position.search(name)):
            raise ValueError(f'positions {pattern}: there is no position in the name {name}')
        positions.append(match[1])
        gears.append(name[: match.start()].rstrip('_- ') + name[match.end() :])
    return _by_label(gears), positions


def _label(name: str, pattern: str) -> str | None:
    if '(' not in pattern:
        return pattern if fnmatch.fnmatchcase(name, pattern) else None
    return match[1] if (match := _expression('group', pattern).search(name)) else None


@dataclass(frozen=True, slots=True)
class Scale:
    """What a setting is."""

    unit: str
    """In which settings are shown; empty for plain numbers."""
    size: float
    """rad; 1 for plain numbers."""
    play: float | None
    """rad of play that a turn of the ring gear by 1 rad closes; None for plain numbers."""


def settings_of(
    names: Sequence[str], pattern: str, unit: str | None, gear: Gear
) -> tuple[list[float], Scale]:
    """Read the settings in names.

    Args:
        names: of the recordings.
        pattern: a regular expression with one group in parentheses, the setting, or three: tooth,
            ring hole and chassis hole. Empty: the first default pattern that all names match.
        unit: of a turn of the ring gear, a key of `UNITS`; None for plain numbers and pins.
        gear: turns of the ring gear need its teeth.

    Returns:
        Settings, plain numbers or turns of the ring gear in rad.

    Raises:
        ValueError: if names contain no settings, or if the teeth are not known.
    """
    needed = 'one group in parentheses, or three for pins'
    patterns = [re.compile(own) for own in _SETTINGS]
    if pattern:
        patterns = [_expression('preloads', pattern, needed, (1, _PINS))]
    matches = [[own.search(name) for name in names] for own in patterns]
    complete = next((found for found in matches if all(found)), None)
    if complete is None:
        without = next(n for n in names if not any(e.search(n) for e in patterns))
        raise ValueError(f'preloads: there is no setting in the name {without}')
    found = [match.groups('') for match in complete if match]
    if bad := next((t for groups in found for t in groups if not _NUMBER.fullmatch(t)), None):
        raise ValueError(f'preloads {pattern}: {bad!r} is no setting')
    pinned = len(found[0]) == _PINS
    if not pinned and unit is None:
        return [float(text) for (text,) in found], Scale('', 1.0, None)
    if not isinstance(gear, Mechanism):
        raise ValueError('preloads: turns of a ring gear need its teeth')  # noqa: TRY004
    scale = Scale(unit or 'deg', UNITS[unit or 'deg'], gear.ring_teeth / gear.satellite_teeth)
    if not pinned:
        return [float(text) * scale.size for (text,) in found], scale
    start = vernier.pin_setting(gear.ring_teeth, 0, 0, 0)
    pins = [vernier.pin_setting(gear.ring_teeth, *map(int, holes)) for holes in found]
    return [abs(vernier.angle_between(start.turn, pin.turn)) for pin in pins], scale


def _expression(
    name: str, text: str, needed: str = 'one group in parentheses', counts: Sequence[int] = (1,)
) -> re.Pattern[str]:
    """Compile a regular expression, which an error names.

    Raises:
        ValueError: if it is none, or if the count of its groups is not among `counts`.
    """
    try:
        found = re.compile(text)
    except re.error as error:
        raise ValueError(f'{name} {text}: {error}') from error
    if found.groups not in counts:
        raise ValueError(f'{name} {text}: a regular expression needs {needed}, not {found.groups}')
    return found


# Times


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
