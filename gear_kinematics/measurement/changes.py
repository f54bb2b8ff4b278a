# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Changes of a gear between recordings at a common torque, and their significance.

Figures are positive and scatter in proportion to their values. So their logarithms are compared,
by Student's t-test with a pooled variance of all groups.
"""

import fnmatch
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from os.path import commonprefix
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.figures import gear_figures
from gear_kinematics.measurement.loops import ALIKE
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import HYSTERESIS
from gear_kinematics.statistics.uncertainty import COVERAGE, Component, Estimate, combined

_OF_SMALL_RAMPS = (HYSTERESIS, 'friction')
SIGNIFICANCE = 1.0 - COVERAGE  # probability of a false alarm in either family of `judged`


class Group(NamedTuple):
    """Recordings of one state of the gear."""

    name: str
    members: tuple[int, ...]  # indices of the recordings


def single(names: Sequence[str]) -> list[Group]:
    """Return a group for each recording, named without the ending that all names share."""
    end = commonprefix([name[::-1] for name in names])[::-1]  # noqa: RUF071, of characters
    return [Group(name.removesuffix(end) or name, (k,)) for k, name in enumerate(names)]


def grouped(names: Sequence[str], patterns: Sequence[str]) -> list[Group]:
    """Group recordings by globs, in their order; each name belongs to the first that matches.

    Raises:
        ValueError: if there are fewer than two groups.
    """
    firsts = [next((p for p in patterns if fnmatch.fnmatchcase(n, p)), None) for n in names]
    groups = [
        Group(pattern, tuple(k for k, first in enumerate(firsts) if first == pattern))
        for pattern in dict.fromkeys(patterns)
        if pattern in firsts
    ]
    if len(groups) < 2:  # noqa: PLR2004, nothing to compare
        only = f'only the group {groups[0].name}' if groups else 'no recording that matches'
        raise ValueError(f'group {", ".join(patterns)}: there is {only}')
    return groups


# Figures


class Quantity(NamedTuple):
    """One figure of several recordings."""

    name: str
    unit: str  # SI
    values: tuple[Estimate | None, ...]  # one per recording


def at_common_torque(reports: Sequence[LostMotion]) -> list[LostMotion]:
    """Compute the figures anew at the least of all rated torques and amplitudes."""
    known = [own for report in reports if (own := report.figures)]
    if len(known) < 2:  # noqa: PLR2004, nothing to compare
        return [*reports]
    torque = min(min(own.rated_torque, own.ramps[-1].amplitude) for own in known)
    return [
        replace(report, figures=gear_figures(own.ramps, torque))
        if (own := report.figures)
        else report
        for report in reports
    ]


def quantities(reports: Sequence[LostMotion]) -> tuple[list[Quantity], list[str]]:
    """Choose the figures to compare from recordings that `at_common_torque` returns.

    Returns:
        The figures that at least two recordings have; and the names of recordings whose hysteresis
        and friction are left out, as their smallest ramps are smaller than those of the others.
    """
    smallest = {own.name: own.figures.ramps[0].amplitude for own in reports if own.figures}
    unlike = [name for name, own in smallest.items() if own < max(smallest.values()) / ALIKE]
    table: dict[tuple[str, str], list[Estimate | None]] = {}
    for k, report in enumerate(reports):
        for name, unit, value, at in report.main_figures:
            values = table.setdefault((f'{name}{at}', unit), [None] * len(reports))
            left_out = name in _OF_SMALL_RAMPS and report.name in unlike
            values[k] = value if isinstance(value, Estimate) and not left_out else None
    found = (Quantity(*names, tuple(values)) for names, values in table.items())
    return [own for own in found if len([*filter(None, own.values)]) > 1], unlike


# Changes


@dataclass(frozen=True, slots=True)
class Change:
    """How a figure of one group differs from that of the first."""

    quantity: Quantity
    first: str
    second: str
    before: float  # geometric mean, SI
    after: float
    interval: tuple[float, ...]  # `COVERAGE` interval of after / before; empty if unknown
    probability: float | None  # probability of at least this change by chance; None if unknown
    repeated: bool  # whether these are by the scatter between recordings, not within them
    significant: bool = False  # among all changes of its family

    @property
    def judgement(self) -> str:
        """The judgement in words."""
        if self.significant:
            return 'significant'
        return 'not judged' if self.probability is None else 'not significant'


def changes_of(quantity: Quantity, groups: Sequence[Group]) -> list[Change]:
    """Compare a figure of each group with that of the first, without judging the changes."""
    known = [
        [v for k in group.members if (v := quantity.values[k]) and v.value > 0.0]
        for group in groups
    ]
    logs = [np.log([own.value for own in values]) for values in known]
    degrees = sum(len(values) - 1 for values in known if values)
    squares = sum(float(np.sum((own - own.mean()) ** 2)) for own in logs if len(own))

    def scatter(values: Sequence[Estimate]) -> Component | None:
        """Return the uncertainty of the mean of a group's logarithms; None if it is unknown."""
        if degrees:
            return Component(math.sqrt(squares / degrees / len(values)), degrees)
        (value,) = values
        if value.standard is None:
            return None
        return Component(value.standard / value.value, value.degrees_of_freedom)

    changes = []
    for group, values, own in zip(groups[1:], known[1:], logs[1:], strict=True):
        if not (known[0] and values):
            continue
        parts = [part for part in (scatter(known[0]), scatter(values)) if part]
        ratio = float(own.mean() - logs[0].mean())
        change = Estimate(ratio, None, 0.0, 1)
        if len(parts) == 2:  # noqa: PLR2004, of both
            standard, free = combined(parts)
            change = Estimate(ratio, standard, degrees or free, 1 + degrees)
        before, half = math.exp(logs[0].mean()), change.uncertainty
        ends = () if half is None else (math.exp(ratio - half), math.exp(ratio + half))
        names, chance = (groups[0].name, group.name), _chance(change)
        after = before * math.exp(ratio)
        changes.append(Change(quantity, *names, before, after, ends, chance, degrees > 0))
    return changes


def _chance(estimate: Estimate) -> float | None:
    """Probability of a value at least as far from zero if the quantity is 0; None if unknown."""
    if estimate.standard is None:
        return None
    if not estimate.standard:
        return float(estimate.value == 0.0)
    from scipy.special import stdtr  # noqa: PLC0415, its import takes half of the start

    degrees = np.floor(estimate.degrees_of_freedom + 1e-6)
    return float(2.0 * stdtr(degrees, -abs(estimate.value / estimate.standard)))


def judged(changes: Sequence[Change]) -> list[Change]:
    """Judge changes by Bonferroni's method: those of the hysteresis, and apart, the rest."""
    tested = [change for change in changes if change.probability is not None]
    count = Counter(change.quantity.name == HYSTERESIS for change in tested)

    def significant(change: Change) -> bool:
        family = count[change.quantity.name == HYSTERESIS]
        return change.probability is not None and change.probability <= SIGNIFICANCE / family

    return [replace(change, significant=significant(change)) for change in changes]
