# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Changes of figures between groups of recordings, or over time, with their significance.

Figures are positive and scatter in proportion to their values, so that logarithms are compared:
log(value) = group + position + scatter, by least squares, with one scatter for all groups.
"""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import stdtr
from scipy.stats import theilslopes

from gear_kinematics.correction.uncertainty import COVERAGE, Component, Estimate, combined
from gear_kinematics.measurement.compare.quantities import Quantity
from gear_kinematics.measurement.loops import Array
from gear_kinematics.measurement.measured import HYSTERESIS
from gear_kinematics.measurement.names import Group

SIGNIFICANCE = 1.0 - COVERAGE
"""Probability of a false alarm in each of the two families of `judged`."""
FEWEST = 5
"""Recordings of a trend: of four, a steady rise or fall comes up by chance in 2 of 24 orders."""
_DRAWS = 4000
"""Random orders: they give a probability of 5 % within 0.7 % (95 %)."""
_SEED = 0x6EA2


@dataclass(frozen=True, slots=True)
class Change:
    """How a figure of one group, or recording, differs from that of another."""

    quantity: Quantity
    first: str
    second: str
    before: float
    """Geometric mean, SI."""
    after: float
    """The same at the positions of the first group."""
    interval: tuple[float, ...]
    """Limits of after / before, with a probability of `COVERAGE`; none if they are unknown."""
    probability: float | None
    """Of as much by chance; None if unknown."""
    repeated: bool
    """Whether these are by the scatter between recordings, else by that within them."""
    significant: bool = False
    """Among all changes of its family."""

    @property
    def judgement(self) -> str:
        """What is said of it."""
        if self.significant:
            return 'significant'
        return 'not judged' if self.probability is None else 'not significant'


def changes_of(
    quantity: Quantity, groups: Sequence[Group], positions: Sequence[str] | None = None
) -> list[Change]:
    """Compare a figure of groups with that of the first, not yet judging changes together.

    Args:
        quantity: of all recordings.
        groups: of the recordings.
        positions: of the output, one per recording; None: they are not paired.
    """
    known = [
        (k, positions[member] if positions else '', value)
        for k, group in enumerate(groups)
        for member in group.members
        if (value := quantity.values[member]) and value.value > 0.0
    ]
    if not any(k == 0 for k, *_ in known):
        return []
    effects = [*range(len(groups)), *sorted({place for _, place, _ in known})]
    rows = [[effect in {k, place} for effect in effects] for k, place, _ in known]
    design = np.array(rows, dtype=np.float64)
    logs = np.log([value.value for *_, value in known])
    solution = np.linalg.pinv(design)
    free = len(known) - int(np.linalg.matrix_rank(design))
    variance = float(np.sum((logs - design @ solution @ logs) ** 2)) / max(free, 1)

    def estimate(contrast: Array) -> Estimate | None:
        weights = np.round(contrast @ solution, 9)  # exactly 0 for what does not count
        if not np.allclose(weights @ design, contrast):
            return None  # no position is common to these groups
        value = float(weights @ logs)
        if free:
            return Estimate(value, math.sqrt(variance * float(weights @ weights)), free, 1 + free)
        parts = [
            Component(abs(weight) * v.standard / v.value, v.degrees_of_freedom)
            for weight, (*_, v) in zip(weights, known, strict=True)
            if v.standard is not None and weight
        ]
        if len(parts) < np.count_nonzero(weights):
            return Estimate(value, None, 0.0, 1)
        return Estimate(value, *combined(parts), 1)

    before = math.exp(np.mean([log for log, (k, *_) in zip(logs, known, strict=True) if k == 0]))
    first, *others = np.eye(len(groups), len(effects))
    changes = []
    for group, other in zip(groups[1:], others, strict=True):
        if log := estimate(other - first):
            names, values = (groups[0].name, group.name), (before, before * math.exp(log.value))
            half, chance = log.uncertainty, _chance(log)
            ends = () if half is None else (log.value - half, log.value + half)
            interval = tuple(map(math.exp, ends))
            changes.append(Change(quantity, *names, *values, interval, chance, free > 0))
    return changes


def _chance(estimate: Estimate) -> float | None:
    """Probability of a value as far from zero if the quantity is zero; None if unknown."""
    if estimate.standard is None:
        return None
    if not estimate.standard:
        return float(estimate.value == 0.0)
    degrees = np.floor(estimate.degrees_of_freedom + 1e-6)
    return float(2.0 * stdtr(degrees, -abs(estimate.value / estimate.standard)))


def judged(changes: Sequence[Change]) -> list[Change]:
    """Judge changes together, by Bonferroni: those of the hysteresis, and apart all others."""

    def family(change: Change) -> bool:
        return change.quantity.name == HYSTERESIS

    count = Counter(family(change) for change in changes if change.probability is not None)
    return [
        replace(change, significant=chance * count[family(change)] <= SIGNIFICANCE)
        for change in changes
        for chance in [math.inf if change.probability is None else change.probability]
    ]


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
