"""The figures of several recordings at one torque, so that they can be compared."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.comparison import HYSTERESIS
from gear_kinematics.measurement.figures import Figures, settings_for
from gear_kinematics.measurement.loops import ALIKE, Ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.wording import ARC_MINUTES, plus_minus
from gear_kinematics.report.document import Cell, number

_RATES = 1.25
"""Ratio of rates that is named: by creep of 10 % in a decade of time, the most of the simulated
gears, angles then differ by 1 %."""
_REACHED = 0.98
"""Share of a torque that counts as reached: controlled peaks repeat within 1 %."""

Chosen = tuple[Ramps, Figures] | None
"""Ramps of a recording with their figures, if it has such."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """One figure of several recordings."""

    name: str
    unit: str
    """SI."""
    values: tuple[Estimate | None, ...]
    """One per recording."""
    main: bool
    """Whether summaries and panels show it."""

    @property
    def scale(self) -> float:
        """The factor with which values are shown."""
        return ARC_MINUTES if self.unit == 'rad' else 1.0

    def cell(self, *values: float | Estimate, between: str = ' to ') -> Cell:
        """Show values in the unit of reports."""
        texts = (
            plus_minus(v, self.scale) if isinstance(v, Estimate) else number(self.scale * v)
            for v in values
        )
        return Cell(between.join(texts), unit='′' if self.unit == 'rad' else self.unit)


class Common(NamedTuple):
    """What recordings have in common."""

    loops: tuple[Chosen, ...]
    """One per recording: the smallest ramps that reach a common torque."""
    quantities: list[Quantity]
    """Figures of at least two recordings."""
    remarks: list[str]
    """On recordings that can be compared in part only."""


def at_common_torque(
    reports: Sequence[LostMotion],
    rated_torque: float | None = None,
    corners: Sequence[float] | None = None,
) -> list[LostMotion]:
    """Compute the figures of recordings with ramps for the same torques, N·m.

    The rated torque is the least of theirs unless given; the corners between ranges of stiffness
    are shares of it.
    """
    known = [own for report in reports if (own := report.figures)]
    if len(known) < 2:  # noqa: PLR2004, nothing to compare
        return list(reports)
    rated = rated_torque or min(own.settings.rated_torque for own in known)
    reach = min(rated, *(own.largest.amplitude for own in known))
    smallest = min((r.ramps for r in reports if r.figures), key=lambda ramps: ramps[0].amplitude)
    usual = settings_for(smallest, 0.0, rated, corners)
    limits = (*(limit for limit in usual.corners if limit < reach), reach)
    return [report.at(rated, limits, usual.small_load) for report in reports]


def in_common(reports: Sequence[LostMotion]) -> Common:
    """Choose the ramps and the figures of recordings, as `at_common_torque` returns them."""
    known = [report.figures for report in reports if report.figures]
    least = max((own.smallest.amplitude for own in known), default=0.0)
    tops = (min(own.settings.rated_torque, own.largest.amplitude) for own in known)
    reach = min(tops, default=0.0)
    # For hysteresis and friction: of about one amplitude. For lost motion and stiffness: loaded.
    small = tuple(_first(report, least / ALIKE, least * ALIKE) for report in reports)
    loaded = tuple(_first(report, _REACHED * reach, math.inf) for report in reports)
    remarks = []
    if lacking := [r.name for r, c in zip(reports, small, strict=True) if r.figures and not c]:
        remarks.append(
            f'Hysteresis and friction are compared on ramps to about {number(least)} N·m, which '
            f'{", ".join(lacking)} lack'
        )
    for chosen in (small, loaded):
        rates = [c[1].rate for c in chosen if c and c[1].rate]
        if rates and max(rates) > _RATES * min(rates):
            ends = f'{number(min(rates), 2)} to {number(max(rates), 2)} N·m/s'
            remarks.append(f'The torque changed at {ends}: figures may differ by that alone')
            break
    return Common(loaded, _quantities(reports, small, loaded, reach), remarks)


def _first(report: LostMotion, low: float, high: float) -> Chosen:
    own = zip(report.ramps, report.figures.by_amplitude if report.figures else (), strict=True)
    return next((both for both in own if low <= both[0].amplitude <= high), None)


def _quantities(
    reports: Sequence[LostMotion], small: Sequence[Chosen], loaded: Sequence[Chosen], reach: float
) -> list[Quantity]:
    little, large = ([chosen and chosen[1] for chosen in own] for own in (small, loaded))
    moved = [report.transmission for report in reports]
    overall = [f.overall if f else None for f in large]
    ranges = [
        {(s.low, s.high): s.both for s in found if 0.0 < s.low < s.high <= reach}
        for found in (f.stiffness if f else () for f in large)
    ]
    stiffness = {
        f'stiffness {number(low)} to {number(high)} N·m': [own.get((low, high)) for own in ranges]
        for low, high in sorted({limits for own in ranges for limits in own})
    }
    listed: list[tuple[str, str, Iterable[Estimate | None]]] = [
        (HYSTERESIS, 'rad', (f.hysteresis if f else None for f in little)),
        ('lost motion without friction', 'rad', (f.frictionless if f else None for f in little)),
        ('friction', 'N·m', (f.friction if f else None for f in little)),
        ('lost motion', 'rad', (f.lost_motion if f else None for f in large)),
        *((name, 'N·m/rad', values) for name, values in stiffness.items()),
        ('overall stiffness', 'N·m/rad', (s.both if s else None for s in overall)),
        ('lost motion on reversals', 'rad', (f.lost_motion if f else None for f in moved)),
        ('transmission accuracy', 'rad', (f.forward if f else None for f in moved)),
    ]
    main = {HYSTERESIS, *[*stiffness][-1:]} if any(small) else {name for name, *_ in listed}
    found = [Quantity(name, unit, tuple(v), name in main) for name, unit, v in listed]
    return [quantity for quantity in found if sum(map(bool, quantity.values)) > 1]
