# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The figures of several recordings at one torque, so that they can be compared."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.figures import Figures, settings_for
from gear_kinematics.measurement.loops import ALIKE
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import HYSTERESIS, Measured
from gear_kinematics.report.document import number

_REACHED = 0.98
"""Share of a torque that counts as reached: controlled peaks repeat within 1 %."""
_UNLOADED = (HYSTERESIS, 'lost motion without friction', 'friction')
"""Figures of small ramps, which have to be of about one amplitude; the others need the load."""


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


class Common(NamedTuple):
    """What recordings have in common."""

    loaded: list[Figures | None]
    """One per recording: of the smallest ramps that reach a common torque."""
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
    reach = min(rated, *(own.ramps.amplitude for own in known))
    smallest = min((own.by_amplitude[0].ramps for own in known), key=lambda own: own.amplitude)
    usual = settings_for([smallest], 0.0, rated, corners)
    limits = (*(limit for limit in usual.corners if limit < reach), reach)
    return [report.at(replace(usual, corners=limits)) for report in reports]


def in_common(reports: Sequence[LostMotion]) -> Common:
    """Choose the ramps and the figures of recordings, as `at_common_torque` returns them."""
    known = [own for report in reports if (own := report.figures)]
    least = max((own.by_amplitude[0].ramps.amplitude for own in known), default=0.0)
    tops = (min(own.settings.rated_torque, own.ramps.amplitude) for own in known)
    reach = min(tops, default=0.0)
    small = [_first(report, least / ALIKE, least * ALIKE) for report in reports]
    loaded = [_first(report, _REACHED * reach, math.inf) for report in reports]
    remarks = []
    if lacking := [r.name for r, c in zip(reports, small, strict=True) if r.figures and not c]:
        remarks.append(
            f'Hysteresis and friction are compared on ramps to about {number(least)} N·m, which '
            f'{", ".join(lacking)} lack'
        )
    units: dict[str, str] = {}
    found: list[dict[str, Estimate]] = []
    for report, little, large in zip(reports, small, loaded, strict=True):
        figures = list(_figures(report, little, large, reach))
        units |= {figure.name: figure.unit for figure in figures}
        values = {figure.name: figure.value for figure in figures}
        found.append({name: v for name, v in values.items() if isinstance(v, Estimate)})
    top = [name for name in units if name.startswith('stiffness')][-1:]
    main = {HYSTERESIS, *top} if any(small) else set(units)
    quantities = [
        Quantity(name, unit, tuple(own.get(name) for own in found), name in main)
        for name, unit in units.items()
        if sum(name in own for own in found) > 1
    ]
    return Common(loaded, quantities, remarks)


def _first(report: LostMotion, low: float, high: float) -> Figures | None:
    known = report.figures.by_amplitude if report.figures else ()
    return next((own for own in known if low <= own.ramps.amplitude <= high), None)


def _figures(
    report: LostMotion, small: Figures | None, loaded: Figures | None, reach: float
) -> Iterator[Measured]:
    if small:
        yield from (figure for figure in small.listed() if figure.name in _UNLOADED)
    if loaded:
        ranges = tuple(s for s in loaded.stiffness if 0.0 < s.low < s.high <= reach)
        others = replace(loaded, stiffness=ranges).listed()
        yield from (figure for figure in others if figure.name not in _UNLOADED)
    if moved := report.transmission:
        yield Measured('lost motion on reversals', 'rad', moved.lost_motion)
        yield Measured('transmission accuracy', 'rad', moved.forward)
