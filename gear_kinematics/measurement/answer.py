# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Facts about a recording: the answer, the judgement by limits, and remarks."""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.figures import LOST_MOTION_SHARE, GearFigures
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import LOST_MOTION, Measured, cell_of
from gear_kinematics.measurement.ramp_gate import usual
from gear_kinematics.measurement.sentences import Cause, Observation, Observed
from gear_kinematics.measurement.transmission import TransmissionFigures

_SMALLER = 0.7  # share of the amplitude below which smaller ramps are worth recording
_MOST_UNCERTAIN = 0.25  # share of the whole twist; beyond it, a ± leaves nothing to say
_MOST_SCATTER = 0.6
"""Share of the transmission error that single readings have. It is at most 0.46 in three real
recordings, and at least 0.7 in 53 of 58 of a bench that reads up to 9 ms apart."""
_COARSE = 3.0  # times the step between readings, which alone makes them scatter by less
_UNEQUAL = 0.18  # share of the sum of both peaks; they differ by less in 37 real recordings


def answer(report: LostMotion) -> Observed:
    """Choose the observation that the reader needs first."""
    if first := report.wrong_ratio or report.recording.computed:
        return first
    if report.figures:
        return _of_ramps(report.figures)
    found, encoders = report.transmission, report.recording.encoders
    if found is None or encoders is None or not (error := found.forward or found.backward):
        return Observation.HARDLY_MOVES()
    if _scatters(found, encoders.error_step(report.gear_ratio).size):
        return Observation.SCATTERS(error=error)
    if found.lost_motion:
        return Observation.LOSES(error=error, lost=found.lost_motion)
    if found.reversals:
        return Observation.LAGS(error=error, lost=found.reversals)
    both = found.forward and found.backward
    return (Observation.LOSS_NOT_TOLD if both else Observation.DEVIATES)(error=error)


def _scatters(found: TransmissionFigures, step: float) -> bool:
    """Return whether most of the error is between neighbouring readings, unlike that of a gear.

    The step is that between readings of the error, rad.
    """
    error = found.error[found.direction != 0]
    least = max(_MOST_SCATTER * float(np.ptp(error)), _COARSE * step)
    return float(np.ptp(error - usual(error))) > least


def _of_ramps(figures: GearFigures) -> Observed:
    width = figures.hysteresis
    if width.value < 0.0 and (width.uncertainty is None or width.clear):
        return Observation.NEGATIVE_HYSTERESIS(hysteresis=width)
    most = max(abs(width.value), _MOST_UNCERTAIN * float(np.ptp(figures.middle_line.angle)))
    if math.inf > width.expanded > most:
        return Observation.LOOPS_DIFFER(hysteresis=width)
    backlash, cause = figures.backlash, figures.backlash.cause
    rests = {'hysteresis': width, 'end': figures.ramps[0].amplitude}
    if backlash.high is None:
        return Observation.PLAY_UNKNOWN(**rests, cause=cause)
    if value := backlash.value:
        return Observation.PLAY(**rests, play=value)
    known = rests | {'low': backlash.low, 'high': backlash.high}
    enough = 2.0 * figures.friction.value if figures.friction else math.inf
    if cause in {Cause.BENT, Cause.SOFT} and 0.0 < enough < _SMALLER * figures.ramps[0].amplitude:
        return Observation.PLAY_BY_SLOW_RAMPS(**known, torque=enough)
    if cause is Cause.NONE:
        return Observation.PLAY_WITHIN(**known)
    return Observation.PLAY_NOT_SEPARATED(**known, cause=cause)


# Limits


class LimitCheck(NamedTuple):
    """Whether a recording is shown to keep to a limit."""

    limit: str  #: name of the limit
    holds: bool
    why: Observed


@dataclass(frozen=True, slots=True)
class Limits:
    """Acceptance limits: greatest angles, rad, and least stiffness; None means no limit."""

    hysteresis: float | None = None
    lost_motion: float | None = None  #: at ±3 % of the rated torque, or on reversals without ramps
    backlash: float | None = None
    stiffness: float | None = None  #: N·m/rad, in the highest range of torque

    def judge(self, report: LostMotion) -> Iterator[LimitCheck]:
        """Judge a recording by each limit, at the less favourable end of the interval."""
        limits = {name.replace('_', ' '): limit for name, limit in asdict(self).items()}
        figures, computed = report.figures, report.recording.computed
        hidden = figures is not None and figures.below_friction
        for figure in report.main_figures:
            if (limit := limits.get(figure.name)) is None:
                continue
            if computed:
                yield LimitCheck(figure.name, holds=False, why=computed)
            elif hidden and figure.name == LOST_MOTION:
                why = Observation.NOT_JUDGED(figure=figure.name)
                yield LimitCheck(figure.name, holds=False, why=why)
            else:
                yield _judged(figure, limit)


def _judged(figure: Measured, limit: float) -> LimitCheck:
    if not figure.ends or max(figure.ends) < 0.0:  # of no gear
        unknown = Observation.NOT_KNOWN(figure=figure.name)
        return LimitCheck(figure.name, holds=False, why=unknown)
    sign = -1.0 if figure.name == 'stiffness' else 1.0  # its limit is a lower one
    low, high = sorted(sign * end for end in figure.ends)
    holds = high <= sign * limit
    what = Observation.WITHIN_LIMIT if holds else Observation.PERHAPS_BEYOND
    if math.inf in figure.ends:
        what = Observation.MEASURED_ONCE
    elif low > sign * limit:
        what = Observation.BEYOND_LIMIT
    value, most = figure.cell.with_unit(), cell_of(figure.unit, limit).with_unit()
    return LimitCheck(figure.name, holds, what(figure=figure.name, value=value, limit=most))


def remarks(report: LostMotion) -> Iterator[Observed]:
    """Yield what the figures are based on, and what limits their use."""
    if found := report.figures:
        yield (Observation.MEASURED_AT_OUTPUT if report.measured else Observation.INFERRED)()
        if found.below_friction and found.lost_motion and found.friction:
            torque, friction = LOST_MOTION_SHARE * found.rated_torque, found.friction.value
            yield Observation.READ_BELOW_FRICTION(torque=torque, friction=friction)
        # If the peaks differ, the zero of the torque is in doubt.
        high = float(np.mean([loop.fall.start for loop in found.ramps[-1].loops]))
        low = float(np.mean([loop.rise.start for loop in found.ramps[-1].loops]))
        if abs(high + low) > _UNEQUAL * (high - low):
            yield Observation.UNEQUAL_PEAKS(low=low, high=high)
        if len(found.ramps) == 1:
            yield Observation.ONE_AMPLITUDE()
    if motion := report.transmission:
        if motion.delay and motion.delay.clear:
            yield Observation.DELAY_TAKEN_OUT()
        elif motion.reversals and not motion.delay:
            yield Observation.DELAY_NOT_TOLD()
    if both := report.recording.encoders:
        for cause, count in both.unmatched.items():
            yield Observation.NOT_COMPARED(count=count, cause=cause)
    yield Observation.PLUS_MINUS()
