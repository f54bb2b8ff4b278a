# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Sentences on a recording: the answer, the judgement by limits, and remarks."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.figures import LOST_MOTION_SHARE, GearFigures
from gear_kinematics.measurement.loops import Loop
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import LOST_MOTION, Measured, shown
from gear_kinematics.measurement.middle_line import Cause
from gear_kinematics.measurement.wording import ARC_MINUTES, PERCENT, arc_minutes
from gear_kinematics.report.document import number

_SMALLER = 0.7
"""Share of their amplitude to which smaller ramps are worth recording."""
_TOLD = 0.25
"""Share of the whole motion by which a ± leaves nothing to be told."""
_UNEQUAL = 0.18
"""Difference of the peaks of a torque, of their sum, that none of 37 real recordings has."""
_HELD = 'the lost motion cannot be judged: it is read at a torque below the friction'


def answer(report: LostMotion) -> str:
    """Say for a person who must decide what the recording shows."""
    if report.wrong_ratio:
        return report.wrong_ratio
    if computed := report.recording.computed:
        return f'{computed[0].upper()}{computed[1:]}.'
    if report.figures:
        return _of_ramps(report.figures)
    found = report.transmission
    if found is None or not (accuracy := found.forward or found.backward):
        return 'The output does not move far enough in one direction to tell its errors.'
    error = f'In one direction the output deviates by {arc_minutes(accuracy)}′ peak to peak'
    if found.lost_motion:
        return f'{error}; on reversals it loses {arc_minutes(found.lost_motion)}′.'
    if found.reversals:
        return (
            f'{error}; backward it lags by {arc_minutes(found.reversals)}′, by lost motion or by '
            'a delay between the encoders.'
        )
    both = (
        '; what it loses on reversals cannot be told' if found.forward and found.backward else ''
    )
    return f'{error}{both}.'


def _of_ramps(figures: GearFigures) -> str:
    width = figures.hysteresis
    if width.value < 0.0 and (width.uncertainty is None or width.clear):
        return (
            f'The hysteresis is negative, {arc_minutes(width)}′, which no gear has: '
            'the torque comes later than the angle, as behind a filter or from another clock.'
        )
    least = max(abs(width.value), _TOLD * float(np.ptp(figures.middle_line.angle)))
    if math.inf > width.expanded > least:
        return (
            f'How far the output rests from its middle cannot be told: {arc_minutes(width)}′. The '
            'loops differ by more than their width, as where the angle drifts or slips.'
        )
    rests = f'At zero torque the output rests anywhere within {arc_minutes(width)}′.'
    backlash, cause = figures.backlash, figures.backlash.cause
    if backlash.high is None:
        return f'{rests} How much of it is play is not known; {cause.value}.'
    if value := backlash.value:
        return f'{rests} Of it, {arc_minutes(value)}′ is play, the rest friction.'
    low, high = (number(end * ARC_MINUTES, 2) for end in (backlash.low, backlash.high))
    said = cause.value
    enough = 2.0 * figures.friction.value if figures.friction else math.inf
    if cause in {Cause.BENT, Cause.SOFT} and 0.0 < enough < _SMALLER * figures.ramps[0].amplitude:
        said = f'to separate them, repeat slow ramps to ±{number(enough, 2)} N·m'
    rest = f'the rest friction; {said}.' if said else 'the rest friction.'
    return f'{rests[:-1]}; backlash: {low} to {high}′, {rest}'


# Limits


class LimitCheck(NamedTuple):
    """Whether a recording is shown to keep to a limit."""

    limit: str
    """Name of the limit."""
    holds: bool
    text: str


@dataclass(frozen=True, slots=True)
class Limits:
    """Acceptance limits: greatest angles, rad, and least stiffness; None means no limit."""

    hysteresis: float | None = None
    lost_motion: float | None = None
    """At ±3 % of the rated torque, or on reversals where there are no ramps."""
    backlash: float | None = None
    stiffness: float | None = None
    """N·m/rad, in the highest range of torque."""

    def judge(self, report: LostMotion) -> list[LimitCheck]:
        """Judge a recording by each limit, at the end of the interval that speaks against it."""
        limits = {name.replace('_', ' '): limit for name, limit in asdict(self).items()}
        computed = report.recording.computed
        unfit = dict.fromkeys(limits, computed) if computed else {}
        if report.figures is not None and report.figures.held_by_friction:
            unfit.setdefault(LOST_MOTION, _HELD)
        return [
            LimitCheck(figure.name, holds=False, text=unfit[figure.name])
            if figure.name in unfit
            else _judged(figure, limit)
            for figure in report.main_figures
            if (limit := limits.get(figure.name)) is not None
        ]


def _judged(figure: Measured, limit: float) -> LimitCheck:
    name = figure.name
    if not figure.ends or max(figure.ends) < 0.0:  # which no gear has
        return LimitCheck(name, holds=False, text=f'the {name} is not known')
    sign = -1.0 if name == 'stiffness' else 1.0  # the least of it, not the most
    low, high = sorted(sign * end for end in figure.ends)
    holds, fails = high <= sign * limit, low > sign * limit
    place = 'is within' if holds else 'is beyond' if fails else 'may be beyond'
    value, most = figure.cell.with_unit(), shown(figure.unit, limit).with_unit()
    text = f'the {name} of {value} {place} the limit of {most}'
    if math.inf in figure.ends:
        text = (
            f'the {name} of {value} cannot be shown to hold the limit of {most}: it was measured '
            'once, so that its uncertainty is not known'
        )
    return LimitCheck(name, holds, text)


# Remarks


def remarks(report: LostMotion) -> Iterator[str]:
    """Describe the basis and the limits of the figures, in sentences."""
    yield from report.remarks
    if found := report.figures:
        yield (
            'Measured at the output: the wind-up is that of the gear, if the rotor was measured, '
            'too, or locked.'
            if report.measured
            else 'Inferred, not measured: the angle is that of the motor encoder, with the output '
            'taken to be locked. The figures include the compliance of motor, bench and clamping.'
        )
        if found.held_by_friction and found.lost_motion and found.friction:
            yield (
                f'Lost motion is read at ±{number(LOST_MOTION_SHARE * found.rated_torque)} N·m, '
                f'below the friction of {number(found.friction.value)} N·m: it does not contain '
                'the play, and no limit is judged by it.'
            )
        yield from _of_zero(found.ramps[-1].loops)
        if len(found.ramps) == 1:
            yield 'All ramps have about one amplitude: small ones would separate play better.'
    if motion := report.transmission:
        if motion.delay and motion.delay.clear:
            yield (
                'The stamps of the two encoders differ by a delay. It has been taken out of the '
                'transmission error.'
            )
        elif motion.reversals and not motion.delay:
            yield (
                'The speed varies too little to tell lost motion from a delay between the '
                'encoders: move at several speeds.'
            )
    if both := report.recording.encoders:
        for cause, count in both.unmatched.items():
            yield f'{count} output angles were not compared: {cause}.'
    yield (
        f'Each ± contains the value with a probability of {PERCENT}, given the scatter of repeats '
        'and the steps of the encoders where they are known. Errors of scale (1 % of the torque '
        'is 1 % of friction and stiffness) and other positions of the output are not in it.'
    )


def _of_zero(loops: Sequence[Loop]) -> Iterator[str]:
    """Question the zero of the torque where its peaks differ."""
    high = float(np.mean([loop.fall.start for loop in loops]))
    low = float(np.mean([loop.rise.start for loop in loops]))
    if abs(high + low) > _UNEQUAL * (high - low):
        yield (
            f'The torque goes from {number(low)} to {number(high)} N·m: check that its sensor '
            'reads 0 without a load, as hysteresis and backlash are read at zero torque.'
        )
