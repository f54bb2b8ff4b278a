"""Which recordings belong together, by their names."""

import fnmatch
from collections.abc import Sequence
from os.path import commonprefix
from typing import NamedTuple

from gear_kinematics.measurement.comparison import expression

DEFAULT_PATTERN = r'pos(?:ition)?[_ -]?(\d+)'
"""The position in a name, such as position_1 or pos2."""


class Group(NamedTuple):
    """Recordings of one state of the gear."""

    name: str
    members: tuple[int, ...]
    """Numbers of the recordings."""


def single(names: Sequence[str]) -> list[Group]:
    """Return a group for each recording, named without the ending that all names share."""
    end = commonprefix([name[::-1] for name in names])[::-1]  # noqa: RUF071, of characters
    return [Group(name.removesuffix(end) or name, (k,)) for k, name in enumerate(names)]


def by_label(labels: Sequence[str]) -> list[Group]:
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
    groups = by_label([label for label in labels if label])
    if len(groups) < 2:  # noqa: PLR2004, nothing to compare
        only = f'only the group {groups[0].name}' if groups else 'no recording that matches'
        raise ValueError(f'--group {", ".join(patterns)}: there is {only}')
    return groups, [number for number, label in enumerate(labels) if not label]


def positions_of(names: Sequence[str], pattern: str) -> tuple[list[Group], list[str]]:
    """Read the positions of the output, which a group in parentheses contains, in names.

    Returns:
        The gears, whose recordings differ in the position alone; and the position of each
        recording.

    Raises:
        ValueError: if the pattern is wrong, or if a name contains no position.
    """
    position = expression('--positions', pattern)
    gears, positions = [], []
    for name in names:
        if not (match := position.search(name)):
            raise ValueError(f'--positions {pattern}: there is no position in the name {name}')
        positions.append(match[1])
        gears.append(name[: match.start()].rstrip('_- ') + name[match.end() :])
    return by_label(gears), positions


def _label(name: str, pattern: str) -> str | None:
    if '(' not in pattern:
        return pattern if fnmatch.fnmatchcase(name, pattern) else None
    return match[1] if (match := expression('--group', pattern).search(name)) else None
