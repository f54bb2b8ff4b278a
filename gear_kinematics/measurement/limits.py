"""Limits that turn a measurement into a verdict, judged at the end that speaks against them."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.wording import ARC_MINUTES, plus_minus
from gear_kinematics.report.document import number
from gear_kinematics.state.uncertainty import Estimate


class Judgement(NamedTuple):
    """What became of a limit."""

    limit: str
    """Its name."""
    holds: bool
    text: str


class _Range(NamedTuple):
    """A figure as it is judged."""

    low: float
    high: float
    text: str


@dataclass(frozen=True, slots=True)
class Limits:
    """Of a gear; None where there is none."""

    hysteresis: float | None = None
    """rad, the most."""
    lost_motion: float | None = None
    """rad, the most; at ±3 % of the rated torque, or on reversals where there are no ramps."""
    backlash: float | None = None
    """rad, the most."""
    stiffness: float | None = None
    """N·m/rad, the least; in the highest range of torque."""

    def judge(self, report: LostMotion) -> Iterator[Judgement]:
        """Judge a recording by each limit."""
        found, motion = report.figures, report.transmission
        moved = motion.lost_motion if motion else None
        ranges = found.largest.stiffness if found else ()
        play = found.backlash if found else None
        known = {
            'hysteresis': _range(found.smallest.hysteresis if found else None, '′', ARC_MINUTES),
            'lost motion': _range(found.largest.lost_motion if found else moved, '′', ARC_MINUTES),
            'backlash': play
            and play.high is not None
            and _Range(
                play.low,
                play.high,
                f'{number(play.low * ARC_MINUTES)} to {number(play.high * ARC_MINUTES)}′',
            ),
            'stiffness': _range(ranges[-1].both if ranges else None, ' N·m/rad'),
        }
        limits = (self.hysteresis, self.lost_motion, self.backlash, self.stiffness)
        for (name, value), limit in zip(known.items(), limits, strict=True):
            if limit is not None:
                yield _judged(name, value or None, limit, least=name == 'stiffness')


def _range(value: Estimate | None, unit: str, scale: float = 1.0) -> _Range | None:
    if value is None:
        return None
    spread = value.uncertainty or 0.0
    return _Range(value.value - spread, value.value + spread, plus_minus(value, scale) + unit)


def _judged(name: str, value: _Range | None, limit: float, *, least: bool) -> Judgement:
    if value is None:
        return Judgement(name, holds=False, text=f'the {name} is not known')
    shown = f'{number(limit)} N·m/rad' if least else f'{number(limit * ARC_MINUTES)}′'
    told = f'the {name} of {value.text}'
    if value.low >= limit if least else value.high <= limit:
        return Judgement(name, holds=True, text=f'{told} is within the limit of {shown}')
    if value.high < limit if least else value.low > limit:
        return Judgement(name, holds=False, text=f'{told} is beyond the limit of {shown}')
    return Judgement(name, holds=False, text=f'{told} may be beyond the limit of {shown}')
