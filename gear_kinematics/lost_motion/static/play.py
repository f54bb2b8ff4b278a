"""Play and friction of hysteresis loops, by the members of a family of models that predict best.

A model is judged by how well the other loops predict each loop. All models that do so about as
well as the best one (within one standard error) count: play has a value only if all of them have
it.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Self

import numpy as np

from gear_kinematics.lost_motion.static.creep import transmitted
from gear_kinematics.lost_motion.static.fitted_model import FittedModel
from gear_kinematics.lost_motion.static.friction import friction_of, without_build_up
from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.ramps import Array, Loop
from gear_kinematics.lost_motion.static.residuals import ResidualTest, residual_tests
from gear_kinematics.lost_motion.static.soft_middle import SOFTEST, soft_middle
from gear_kinematics.lost_motion.static.springs import SHAPES, Fit, Fitting, Gap, Model, Springs
from gear_kinematics.state.uncertainty import Component, Estimate, common_part

_HARDLY_SOFT = 0.5
"""A middle that is stiffer than this share of the stiffness beyond is no gap."""
_FLANKS = 0.95
"""Share of the angle of a loop from which on a gap leaves too little of the spring beyond it."""
_MOST_FRICTION = 0.8
"""Share of the torque from which on friction leaves too little of it for the spring."""
_CLEAR_OF_BLUR = 4.0
"""In a soft middle, the load rises by more than this many times the blur of corners."""
_CLEAR_OF_LOAD = 0.02
"""And by more than this share of the greatest load."""
_UNLIKE = 0.1
"""A model whose hysteresis differs by this share from the one measured is not that of the gear."""
_ROUNDING = 1e-3
"""Share of the greatest load by which predictions may differ and still be as good."""
_LEVELS = 200
"""Torques of the loop of a model."""
_FAMILY = [Model(shape, gap) for shape in SHAPES for gap in Gap]
_FAMILY_OF_ONE = [Model(SHAPES[0], Gap.PLAY)]
"""For a loop that no other predicts."""


class Cause(StrEnum):
    """Why a play has no value."""

    NONE = ''
    ZERO = 'zero is within reach'
    SOFT = 'soft middle'
    """Play or a soft spring: a limit."""
    MODELS = 'models differ'
    """Neither value nor limit, as is the following."""
    FLANKS = 'ramps too small'
    WITHIN = 'ramps within the play'
    SINGLE = 'not repeated'


@dataclass(frozen=True, slots=True)
class Candidate:
    """A model that was tried."""

    name: str
    error: float
    """N·m, root mean square of the load of each loop, as predicted by the others."""
    plausible: bool
    """Whether it predicts about as well as the best model."""
    gap: Estimate | None
    """rad, if it is plausible and has one clear of zero."""


@dataclass(frozen=True, slots=True)
class PlayModel:
    """The simplest plausible model, and what all plausible ones tell of the play."""

    name: str
    stiffness: float
    """N·m/rad, of the spring beyond the play, up to the peak."""
    play: Estimate | None
    """rad, the backlash; None if zero is within reach or if it cannot be told from the spring."""
    limit: float | None
    """rad, below which the play is with 95 %, if it has no value."""
    cause: Cause
    """Why there is no value, or neither value nor limit."""
    friction: Estimate
    """N·m, at the output, without load."""
    growth: Estimate | None
    """Share of the load that adds to the friction; None if not significant."""
    missing: Estimate | None
    """N·m, of the friction near the peaks, as it builds up slowly; None if not significant."""
    more: Estimate | None
    """N·m, by which the friction within the play exceeds that beyond; None if not significant."""
    residual: float
    """N·m, root mean square of the load on the middle lines minus the model's."""
    softness: float | None
    """Stiffness over the play as a share of that beyond it; None without a rest of stiffness."""
    tests: tuple[ResidualTest, ...]
    """Of what the model leaves of the middle lines."""
    candidates: tuple[Candidate, ...]
    """All models tried, the best first; empty without repeats."""
    angles: Array
    """(n,), rad, ascending: the curve of the model."""
    loads: Array
    """(n,), N·m, ascending, at these angles."""

    def under(self, stiffness: float) -> Self:
        """Return what the model tells of the play if more load finds this stiffness, N·m/rad.

        Ramps that yield at less than a fifth of it everywhere stay within the play.
        """
        if self.stiffness >= SOFTEST * stiffness:
            return self
        return replace(self, play=None, limit=None, cause=Cause.WITHIN)

    def loop(self, amplitude: float) -> tuple[Array, Array]:
        """Torques and angles of the model's hysteresis loop, from one peak back to it."""
        torque = amplitude * np.linspace(1.0, -1.0, _LEVELS)
        growth = self.growth.value if self.growth else 0.0
        peak = max(0.0, amplitude - self.friction.value) / (1.0 + growth)
        load = transmitted(torque, peak, self.friction.value, growth)
        there = np.concatenate([load, -load])
        tie = np.linspace(0.0, 1e-9, len(self.loads))
        angle = np.interp(there, self.loads + tie * amplitude, self.angles)
        return np.concatenate([torque, -torque]), angle


def play_model(
    loops: Sequence[Loop], angle_step: float, hysteresis: float, by_time: float = 0.0
) -> PlayModel | None:
    """Choose a model for loops of one amplitude; None if their middle line is no spring's.

    Args:
        loops: at least one.
        angle_step: rad, between readings of the encoder; 0 if unknown.
        hysteresis: rad, the width of the loops at zero torque, which no free play exceeds.
        by_time: N·m, standard uncertainty of the friction by a lag of the encoder and by creep.
    """
    lines = Midlines.of(loops)
    if not (np.ptp(lines.angle, axis=1).all() and np.ptp(lines.load, axis=1).all()):
        return None
    friction, growth = friction_of(lines, angle_step)
    lines, missing = without_build_up(lines)
    if missing:
        half = 0.5 * missing.rest
        friction = replace(friction, value=friction.value + half).joined(Component(half))
    fitting = Fitting(lines)
    repeated = len(loops) > 1
    tried = _tried(fitting, lines, _FAMILY if repeated else _FAMILY_OF_ONE)
    if not tried:
        return None
    plausible = _plausible(tried, lines) if repeated else []
    chosen = min(
        plausible or tried, key=lambda model: (model.size, float(np.mean(tried[model].errors)))
    )
    best = FittedModel.of(chosen, fitting, tried[chosen], lines)
    if not best:
        return None
    more = best.more_friction
    excess = more.value if more else 0.0
    middles = {model: _Middle.of(model, fitting, tried, lines) for model in plausible}
    if friction.value > _MOST_FRICTION * loops[0].amplitude:
        play, limit, cause = None, None, Cause.FLANKS
    elif middles:
        hidden = best.hidden(excess, angle_step)
        play, limit, cause = _verdict(chosen, middles, hidden, angle_step, hysteresis)
    else:
        play, limit, cause = _single(2.0 * best.half)
    off = abs(best.width(friction.value) - hysteresis)
    # Only a soft middle, in which friction holds the gear, is wider than the loops.
    if play and play.value > hysteresis and off > _UNLIKE * hysteresis:
        play, cause = None, Cause.MODELS
    return PlayModel(
        chosen.name,
        best.stiffness,
        play,
        limit,
        cause,
        friction.joined(Component(by_time), Component(excess / math.sqrt(3.0))),
        growth,
        missing.near if missing else None,
        more,
        float(np.sqrt(np.mean(best.rest**2))),
        max((middle.ratio for middle in middles.values()), default=0.0) or None,
        residual_tests(best.rest, lines.load, lines.pace),
        _candidates(tried, middles) if middles else (),
        best.angles + float(np.mean(lines.centre)),
        best.loads,
    )


def _single(gap: float) -> tuple[Estimate | None, None, Cause]:
    """Return the play of a single loop."""
    if gap:
        return Estimate.of_mean([gap]), None, Cause.NONE
    return None, None, Cause.SINGLE


def _tried(fitting: Fitting, lines: Midlines, family: Sequence[Model]) -> dict[Model, Fit]:
    """Fit a family, without soft middles that noise can make by rounding the corners."""
    tried = {}
    for model in family:
        found = fitting.fit(model)
        if found and not (model.gap == Gap.SOFT and _rounded(fitting, model, found, lines)):
            tried[model] = found
    return tried


def _rounded(fitting: Fitting, model: Model, found: Fit, lines: Midlines) -> bool:
    least = max(_CLEAR_OF_BLUR * lines.blur, _CLEAR_OF_LOAD * float(np.max(np.abs(lines.load))))
    return _rise(model, fitting.each(model, found), lines) <= least


def _plausible(tried: Mapping[Model, Fit], lines: Midlines) -> list[Model]:
    """Return the models that predict as well as the best one, within one standard error."""
    rounding = (_ROUNDING * float(np.max(np.abs(lines.load)))) ** 2
    best = min(tried.values(), key=lambda fit: float(np.mean(fit.errors))).errors
    found = []
    for model, fit in tried.items():
        worse = fit.errors - best
        error = float(np.std(worse, ddof=1)) / math.sqrt(len(worse))
        if float(np.mean(worse)) <= error + rounding:
            found.append(model)
    return found


@dataclass(frozen=True, slots=True)
class _Middle:
    """What a plausible model tells of the play, rad."""

    gaps: Array
    """(loops,)."""
    least: float
    most: float
    ratio: float = 0.0
    """Stiffness within it over that beyond."""

    @classmethod
    def of(
        cls, model: Model, fitting: Fitting, tried: Mapping[Model, Fit], lines: Midlines
    ) -> '_Middle':
        """Take the soft middle of a model, or the gap that a model without one could have."""
        springs = fitting.each(model, tried[model])
        soft = soft_middle(model, springs, fitting, lines)
        if soft.width.value and (model.gap == Gap.PLAY or soft.least > 0.0):
            most = soft.most if soft.most < _FLANKS * 2.0 * lines.reach else math.inf
            return cls(soft.widths, soft.least if math.isfinite(most) else 0.0, most, soft.ratio)
        vague = soft_middle(model, springs, fitting, lines, _HARDLY_SOFT)
        wider = Model(model.shape, Gap.PLAY)
        gaps = fitting.each(wider, tried[wider]).gap if wider in tried else soft.widths
        gap = Estimate.of_mean(gaps.tolist())
        most = max(gap.value + (gap.uncertainty or 0.0), vague.most)
        return cls(gaps, 0.0, most, vague.ratio)

    @property
    def gap(self) -> Estimate:
        """The mean of the gaps."""
        return Estimate.of_mean(self.gaps.tolist())


def _rise(model: Model, springs: Springs, lines: Midlines) -> float:
    """Mean rise of the load within the gap, N·m."""
    if model.gap != Gap.SOFT:
        return 0.0
    return float(np.mean(springs.factors[:, -1] * springs.gap)) / lines.reach


def _verdict(
    chosen: Model,
    middles: Mapping[Model, _Middle],
    hidden: float,
    angle_step: float,
    hysteresis: float,
) -> tuple[Estimate | None, float | None, Cause]:
    """Return value, limit and cause.

    Args:
        chosen: the simplest plausible model.
        middles: of all plausible models.
        hidden: rad, standard uncertainty of the gap that the repeats do not show.
        angle_step: rad, between readings of the encoder.
        hysteresis: rad.
    """
    gaps = np.mean([m.gaps for model, m in middles.items() if model.size == chosen.size], axis=0)
    own = Estimate.of_mean(gaps.tolist())
    others = np.stack([middle.gaps - gaps for middle in middles.values()], -1)
    # How far the models are apart is known by as many repeats.
    choice = Component(common_part(others), own.repeats - 1)
    wider = own.joined(choice, Component(hidden))
    if all(middle.least > 0.0 for middle in middles.values()) and (
        wider.value > (wider.uncertainty or 0.0)
    ):
        return wider, None, Cause.NONE
    limit = max(middle.most for middle in middles.values()) + 2.0 * hidden
    limit = max(limit, _ROUNDING * hysteresis)
    if math.isinf(limit):
        return None, None, Cause.FLANKS
    if limit >= hysteresis:
        return None, None, Cause.MODELS
    soft = any(middle.ratio and middle.most for middle in middles.values())
    return None, max(limit, angle_step), Cause.SOFT if soft else Cause.ZERO


def _candidates(
    tried: Mapping[Model, Fit], middles: Mapping[Model, _Middle]
) -> tuple[Candidate, ...]:
    found = [
        Candidate(
            model.name,
            math.sqrt(max(0.0, float(np.mean(fit.errors)))),  # it may be rounded below zero
            model in middles,
            middles[model].gap if model in middles and middles[model].least > 0.0 else None,
        )
        for model, fit in tried.items()
    ]
    return tuple(sorted(found, key=lambda candidate: candidate.error))
