"""The figures of several recordings at one torque, so that they can be compared."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple

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
    ranges = sorted(
        {(s.low, s.high) for f in large if f for s in f.stiffness if 0.0 < s.low < s.high <= reach}
    )
    stiffness = {
        f'stiffness {number(own[0])} to {number(own[1])} N·m': partial(_stiffness, own)
        for own in ranges
    }
    listed: list[tuple[str, str, Sequence[Any], Callable[[Any], Estimate | None]]] = [
        (HYSTERESIS, 'rad', little, attrgetter('hysteresis')),
        ('lost motion without friction', 'rad', little, attrgetter('frictionless')),
        ('friction', 'N·m', little, attrgetter('friction')),
        ('lost motion', 'rad', large, attrgetter('lost_motion')),
        *((name, 'N·m/rad', large, of) for name, of in stiffness.items()),
        ('overall stiffness', 'N·m/rad', large, lambda f: f.overall and f.overall.both),
        ('lost motion on reversals', 'rad', moved, attrgetter('lost_motion')),
        ('transmission accuracy', 'rad', moved, attrgetter('forward')),
    ]
    main = {HYSTERESIS, *[*stiffness][-1:]}
    found = (
        Quantity(name, unit, tuple(own and of(own) for own in owners), name in main)
        for name, unit, owners, of in listed
    )
    known = [quantity for quantity in found if sum(map(bool, quantity.values)) > 1]
    return known if any(small) else [replace(quantity, main=True) for quantity in known]


def _stiffness(limits: tuple[float, float], figures: Figures) -> Estimate | None:
    return next((s.both for s in figures.stiffness if (s.low, s.high) == limits), None)
