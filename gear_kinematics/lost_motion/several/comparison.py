"""Differences between recordings, or groups of them, with their significance."""

import fnmatch
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.lost_motion.several.common import Quantity
from gear_kinematics.state.uncertainty import COVERAGE, Estimate

SIGNIFICANCE = 1.0 - COVERAGE
"""Probability of at least one false alarm among all changes of a report."""


@dataclass(frozen=True, slots=True)
class Group:
    """Recordings of one state of the gear."""

    name: str
    members: tuple[int, ...]
    """Numbers of the recordings."""


@dataclass(frozen=True, slots=True)
class Change:
    """How a figure of one group differs from that of another."""

    quantity: Quantity
    first: Group
    second: Group
    before: Estimate
    after: Estimate
    difference: Estimate
    """In the unit of the figure."""
    relative: Estimate | None
    """Difference / value before; None if that is hardly known."""
    probability: float | None
    """Of a difference as large if nothing has changed; None if unknown."""
    significant: bool = False

    @property
    def clear(self) -> bool:
        """Whether a change of the figure by its whole value would show."""
        return (self.difference.uncertainty or 0.0) < abs(self.before.value)


def single(names: Sequence[str]) -> list[Group]:
    """Return a group for each recording."""
    return [Group(name, (number,)) for number, name in enumerate(names)]


def grouped(names: Sequence[str], patterns: Sequence[str]) -> tuple[list[Group], list[int]]:
    """Sort recordings into groups, in the order in which these occur.

    Args:
        names: of the recordings.
        patterns: globs, each of which makes a group of the recordings it matches; or a regular
            expression with one group in parentheses, whose text names the group. The first that
            matches counts.

    Returns:
        Groups, whose members are numbered without the others; and the numbers of the others.

    Raises:
        ValueError: if a pattern is no regular expression with one group, or if there are not at
            least two groups.
    """
    compiled = [_Pattern(pattern) for pattern in patterns]
    members: dict[str, list[int]] = {}
    others: list[int] = []
    for number, name in enumerate(names):
        found = next(filter(None, (pattern.group_of(name) for pattern in compiled)), None)
        if found:
            members.setdefault(found, []).append(number - len(others))
        else:
            others.append(number)
    if len(members) < 2:  # noqa: PLR2004, nothing to compare
        found = f'only the group {next(iter(members))}' if members else 'no recording that matches'
        raise ValueError(f'--group {", ".join(patterns)}: there is {found}')
    return [Group(name, tuple(numbers)) for name, numbers in members.items()], others


def at_positions(names: Sequence[str], pattern: str) -> tuple[list[Group], list[str]]:
    """Group recordings whose names differ only in the position of the output.

    Args:
        names: of the recordings.
        pattern: a regular expression with one group in parentheses, the position.

    Returns:
        Groups, and the position of each recording.

    Raises:
        ValueError: if a name contains no position, or if no group has two positions.
    """
    expression = with_one_group('--positions', pattern)
    members: dict[str, list[int]] = {}
    positions = []
    for number, name in enumerate(names):
        match = expression.search(name)
        if not match:
            raise ValueError(f'--positions {pattern}: there is no position in the name {name}')
        positions.append(match[1])
        rest = name[: match.start()].rstrip('_- ') + name[match.end() :]
        members.setdefault(rest, []).append(number)
    groups = [Group(name, tuple(numbers)) for name, numbers in members.items()]
    if not any(len({positions[member] for member in group.members}) > 1 for group in groups):
        raise ValueError('--positions: no two recordings differ in the position alone')
    return groups, positions


def with_one_group(option: str, text: str) -> re.Pattern[str]:
    """Compile a regular expression with one group in parentheses.

    Raises:
        ValueError: if it is none; the text names the option.
    """
    try:
        expression = re.compile(text)
    except re.error as error:
        raise ValueError(f'{option} {text}: {error}') from error
    if expression.groups != 1:
        raise ValueError(
            f'{option} {text}: a regular expression needs one group in parentheses, not '
            f'{expression.groups}'
        )
    return expression


class _Pattern:
    """One pattern of `grouped`."""

    def __init__(self, text: str) -> None:
        self._glob = '(' not in text
        self._text = text
        self._expression = (
            re.compile(fnmatch.translate(text)) if self._glob else with_one_group('--group', text)
        )

    def group_of(self, name: str) -> str | None:
        """Return the group of a recording, if the pattern matches its name."""
        if self._glob:
            return self._text if self._expression.match(name) else None
        match = self._expression.search(name)
        return match[1] if match else None


def estimate(quantity: Quantity, group: Group) -> Estimate | None:
    """Estimate a figure of a group: its mean, by the spread between its recordings.

    That of a single recording is its own, by the scatter within it.
    """
    found = [value for number in group.members if (value := quantity.values[number])]
    if len(found) < 2:  # noqa: PLR2004, no spread between
        return next(iter(found), None)
    return Estimate.of_mean([value.value for value in found])


def spread(quantity: Quantity, group: Group) -> float | None:
    """Standard deviation of a figure between the recordings of a group; None for one."""
    found = [value.value for number in group.members if (value := quantity.values[number])]
    return float(np.std(found, ddof=1)) if len(found) > 1 else None


def changes(quantities: Sequence[Quantity], groups: Sequence[Group]) -> list[Change]:
    """Compare every group with the first one; significance is that of all changes together."""
    first, *others = groups
    found = [
        _change(quantity, first, other, before, after)
        for other in others
        for quantity in quantities
        if (before := estimate(quantity, first)) and (after := estimate(quantity, other))
    ]
    return _judged(found)


def _change(
    quantity: Quantity, first: Group, second: Group, before: Estimate, after: Estimate
) -> Change:
    difference = after.minus(before)
    relative = None
    uncertainty = before.uncertainty or 0.0
    if quantity.relative and abs(before.value) > 2.0 * uncertainty:
        # The sensitivities of after / before (GUM 5.1.3).
        ratio = after.value / before.value
        scatter = after.times(1.0 / before.value).minus(before.times(ratio / before.value))
        relative = replace(scatter, value=ratio - 1.0)
    probability = difference.probability_of_zero()
    return Change(quantity, first, second, before, after, difference, relative, probability)


def _judged(changes: Sequence[Change]) -> list[Change]:
    """Judge changes together, by Holm's method: S. Holm, Scand. J. Statistics 6 (1979) 65."""
    adjusted = holm([math.nan if c.probability is None else c.probability for c in changes])
    return [
        replace(change, significant=together < SIGNIFICANCE)
        for change, together in zip(changes, adjusted, strict=True)
    ]


def holm(probabilities: Sequence[float]) -> list[float]:
    """Adjust probabilities of false alarms so that they hold for all together, by Holm's method.

    Args:
        probabilities: NaN: not tested.
    """
    tested = sorted((p, k) for k, p in enumerate(probabilities) if not math.isnan(p))
    adjusted = [math.nan] * len(probabilities)
    greatest = 0.0
    for rank, (probability, number) in enumerate(tested):
        greatest = max(greatest, min(1.0, (len(tested) - rank) * probability))
        adjusted[number] = greatest
    return adjusted
