"""Limits that turn a measurement into a verdict, judged at the end that speaks against them."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.middle_line import Backlash
from gear_kinematics.measurement.wording import ARC_MINUTES, plus_minus
from gear_kinematics.report.document import number


class Judgement(NamedTuple):
    """What became of a limit."""

    limit: str
    """Its name."""
    holds: bool
    text: str


_Range = tuple[float, float, str]
"""Ends of a figure as it is judged, and a text without the unit."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Of a gear: the most of angles, rad, and the least stiffness; None where there is none."""

    hysteresis: float | None = None
    lost_motion: float | None = None
    """At ±3 % of the rated torque, or on reversals where there are no ramps."""
    backlash: float | None = None
    stiffness: float | None = None
    """N·m/rad, in the highest range of torque."""

    def judge(self, report: LostMotion) -> Iterator[Judgement]:
        """Judge a recording by each limit."""
        found, motion = report.figures, report.transmission
        width = found.smallest.hysteresis if found else None
        moved = motion.lost_motion if motion else None
        lost_motion = found.largest.lost_motion if found else moved
        ranges = found.largest.stiffness if found else ()
        yield from _judged('hysteresis', self.hysteresis, _range(width, ARC_MINUTES))
        yield from _judged('lost motion', self.lost_motion, _range(lost_motion, ARC_MINUTES))
        yield from _judged('backlash', self.backlash, _play(found.backlash) if found else None)
        stiffness = _range(ranges[-1].both if ranges else None)
        yield from _judged('stiffness', self.stiffness, stiffness, least=True)


def _range(value: Estimate | None, scale: float = 1.0) -> _Range | None:
    if value is None:
        return None
    spread = value.uncertainty or 0.0
    return value.value - spread, value.value + spread, plus_minus(value, scale)


def _play(backlash: Backlash) -> _Range | None:
    low, high, _ = backlash
    if high is None:
        return None
    return low, high, f'{number(low * ARC_MINUTES)} to {number(high * ARC_MINUTES)}'


def _judged(
    name: str, limit: float | None, value: _Range | None, *, least: bool = False
) -> Iterator[Judgement]:
    if limit is None:
        return
    if value is None:
        yield Judgement(name, holds=False, text=f'the {name} is not known')
        return
    low, high, text = value
    holds, fails = (low >= limit, high < limit) if least else (high <= limit, low > limit)
    unit, scale = (' N·m/rad', 1.0) if least else ('′', ARC_MINUTES)
    told = 'is within' if holds else 'is beyond' if fails else 'may be beyond'
    limited = f'{told} the limit of {number(limit * scale)}{unit}'
    yield Judgement(name, holds, f'the {name} of {text}{unit} {limited}')
