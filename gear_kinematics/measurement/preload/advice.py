# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Up to which setting of the preload the hysteresis falls, and which setting a load needs.

Hysteresis is the angle between loads ±M0 on the gear, M0 being the friction. It falls while the
preload closes the play, and rests once both branches stay in mesh under ±M0:

    hysteresis = rest + slope max(x0 - x, 0)
    least setting under a load M = x0 + (M - M0) c/b

c is the compliance of the softer branch alone, b the play that a unit of the setting closes: zk/zs
of a turn of the ring gear, else the slope. Lost motion without friction, between ± its load, does
as well.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from gear_kinematics.correction.uncertainty import COVERAGE, Estimate, student_t
from gear_kinematics.measurement.preload.file import Span

FEWEST = 3
"""Settings that are needed."""
_PARAMETERS = 3
"""Rest, slope and x0."""
_MAX_CHANCE = 0.1
"""Probability by the F test below which a fall is clear."""
_ENDS = 301
"""Settings at which x0 is tried, so that its interval is read to 0.3 % of their range."""
_RATIOS = np.concatenate([[0.0], np.geomspace(0.02, 500.0, 300)])
"""Of the slope, per range of the settings, to the rest, in steps of 3.4 %."""
_ROUNDING = 1e-6
"""Least relative scatter, as equal figures are not exact."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What a recording tells about the preload."""

    setting: float
    angle: float
    """rad, the hysteresis, or another angle that the play widens."""
    load: float
    """N·m, between ± which the angle lies."""
    friction: float
    """N·m."""
    compliances: tuple[float, float] | None = None
    """rad/(N·m), under high positive and negative torque."""


@dataclass(frozen=True)
class Advice:
    """What recordings at several settings tell about the preload."""

    levels: tuple[float, ...]
    """The settings, ascending."""
    falling: bool
    """Whether the angle falls, by the F test."""
    end: Span
    """x0; of equally good fits the greatest."""
    rest: float
    """rad, from x0 on."""
    slope: float
    """rad per unit of the setting, before."""
    scatter: float
    """Relative standard deviation of a recording about the fit."""
    least: Span | None = None
    """At which both branches stay in mesh under the load; without a load, x0. None if not known,
    as all that follows."""
    added_friction: Estimate | None = None
    """N·m of friction at that setting, above that without preload."""
    closed: float | None = None
    """The setting from which on there is no play without load."""
    compliances: tuple[float, float] | None = None
    """rad/(N·m), of the branches that carry positive and negative torque."""


def advise(readings: Sequence[Reading], closing: float | None, load: float | None) -> Advice:
    """Fit the model to recordings.

    Args:
        readings: at three settings or more.
        closing: b, rad per unit of the setting; None: by the slope.
        load: M, N·m; None: none in particular.
    """
    settings = np.array([reading.setting for reading in readings])
    levels = np.unique(settings)
    ends = np.linspace(levels[0], levels[-1], _ENDS)
    # In logarithms, as recordings scatter in proportion to the value: (ratios, ends, readings).
    ratios = _RATIOS[:, np.newaxis] / np.ptp(levels)
    reach = np.maximum(ends[:, np.newaxis] - settings, 0.0)
    rests = np.log([r.angle for r in readings]) - np.log1p(ratios[..., np.newaxis] * reach)
    variance = np.var(rests, axis=-1) + _ROUNDING**2
    # Up to the second setting, all ends fit alike, with different slopes.
    column = int(np.searchsorted(ends, levels[1], 'right')) - 1
    column = max(column, int(np.argmin(np.min(variance, axis=0))))
    best = int(np.argmin(variance[:, column])), column
    freedom = len(readings) - _PARAMETERS
    worse = variance / variance[best] - 1.0
    left, falling = np.full(worse.shape, fill_value=True), False
    if freedom > 0:
        left = worse <= stats.f.ppf(COVERAGE, 1, freedom) / freedom
        # The first ratio is no slope at all.
        chance = stats.f.sf(worse[0, 0] * 0.5 * freedom, 2, freedom)
        falling = bool(chance <= _MAX_CHANCE)
    all_ends, all_slopes = np.broadcast_arrays(ends, ratios * np.exp(np.mean(rests, axis=-1)))
    x0, slope = float(ends[column]), float(all_slopes[best])
    scatter = math.sqrt(len(readings) * variance[best] / max(freedom, 1))
    rest = float(np.exp(np.mean(rests[best])))
    possible = all_ends[left]
    end = Span(x0, float(np.min(possible)), float(np.max(possible)))
    known = tuple(levels.tolist()), falling, end, rest, slope, scatter
    alone = [r for r in readings if r.compliances and r.setting < x0]
    rests_seen, slope_known = end.high < levels[-1], closing or end.low > levels[1]
    if not (falling and rests_seen and slope_known and alone):
        return Advice(*known)
    sides = np.mean([r.compliances for r in alone if r.compliances], axis=0)
    b, softer, at = closing or slope, np.max(sides), np.mean([reading.load for reading in alone])
    beyond = ((load or at) - at) * softer
    leasts = possible + beyond / (closing or all_slopes[left])
    value = x0 + beyond / b
    # The compliance is as uncertain as the angles, since few do not tell their own scatter.
    spread = beyond / b * student_t(freedom) * scatter / math.sqrt(len(alone))
    low = value - math.hypot(value - np.min(leasts), spread)
    high = value + math.hypot(np.max(leasts) - value, spread)
    closed = float(x0 - at * softer / b)
    # Friction grows with the preload, from the setting on at which the play is closed.
    line = stats.linregress(np.maximum(settings - closed, 0.0), [r.friction for r in readings])
    growth = Estimate(line.slope, line.stderr, len(readings) - 2, len(readings))
    added = growth.times(float(load * softer / b)) if load else None
    return Advice(*known, Span(float(value), low, high), added, closed, tuple(sides.tolist()))
