"""When a gear has changed: by the one step, or slope, of a figure over time that explains most."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.stats import theilslopes

from gear_kinematics.correction.uncertainty import COVERAGE
from gear_kinematics.measurement.compare.changes import Change, changes_of
from gear_kinematics.measurement.compare.groups import Group
from gear_kinematics.measurement.compare.quantities import Quantity

FEWEST = 5
"""Recordings: of four, a steady rise or fall comes up by chance in 2 of 24 orders."""
_DRAWS = 4000
"""Random orders: they give a probability of 5 % within 0.7 % (95 %)."""
_SEED = 0x6EA2


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
