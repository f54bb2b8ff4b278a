# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Involute teeth of ring gear and satellite that mesh at the eccentricity.

The teeth are those of the basic rack of ISO 53: pressure angle α = 20°, addendum m, clearance
c = 0.25 m. Base circles and thickness follow from module m, tooth numbers and profile shifts, as
in ISO 21771 (which has DIN 3960's equations). The satellite has no profile shift; that
of the ring gear gives zero backlash at the centre distance e:

    cos αw = m (zk - zs) cos α/(2 e)        xk - xs = (zk - zs)(inv αw - inv α)/(2 tan α)

The profile shift of the ring gear is positive outwards, so its spaces are the teeth of an external
gear with zk teeth and shift xk. If the tooth numbers differ by little, the tips collide outside
the contact (trochoid interference), unless

    [Θs + inv αs - inv αw] zs/zk + inv αw - inv αk ≥ Θk
    cos Θs = (rk² - rs² - e²)/(2 e rs)      cos Θk = (rk² - rs² + e²)/(2 e rk)

with rs, rk the tip radii and αs, αk the involute's pressure angles there; and a ring tip stays
clear of the satellite's base circle (involute interference) if tan αk ≥ (1 - zs/zk) tan αw. Both
are in SDP/SI, Elements of Metric Gear Technology, section 5, and derived in Colbourne, The
Geometry of Involute Gears. The usual remedy is shorter teeth: here they are as high as
interference permits. Trimming interference does not matter, since the satellite is assembled
axially, not radially.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Branch, Mechanism, MechanismError
from gear_kinematics.kinematics.preload import ring_turn_between
from gear_kinematics.kinematics.rotor_turns import TURN

Array = NDArray[np.float64]

PRESSURE_ANGLE = math.radians(20.0)  #: α of the basic rack, rad (ISO 53)
_CLEARANCE = 0.25  # between tip and root, modules (ISO 53, type A)
_BACKLASH = 0.02  # between the flanks, along their normal, modules; taken from the satellite
_LEAST_TIP = 0.2  # thickness, modules, below which a tip counts as pointed
_FLANK_POINTS = 8  # with fewer, the chords of gears with few teeth come too close
_CIRCLE_POINTS = 120
_MOST_TEETH = 1000  # more are too fine for any picture


class InterferenceError(ValueError):
    """Involute teeth cannot mesh at an eccentricity; the text gives the numbers."""


class Outlines(NamedTuple):
    """Closed counterclockwise polygons, m, without repeating the first point."""

    ring: Array
    """Outline of the ring gear in the stator's frame, (n, 2); the material is outside.

    It still has to be turned by `ring_phase`.
    """
    satellite: Array
    """Outline of the satellite in frame 3, (m, 2): about its centre, at the angle φ5."""


def outlines(mechanism: Mechanism, module: float) -> Outlines:
    """Compute the outlines of ring gear and satellite, which mesh at every rotor angle.

    Draw the satellite at `satellite_centre`, turned by `output_angle`, and the ring gear of a
    branch turned by its `ring_phase`. If the teeth cannot mesh (see `tooth_pair`), or are too many
    to be seen, the outlines are the rolling circles. The module is in metres; MechanismError if it
    is not finite and greater than 0.
    """
    try:
        pair = tooth_pair(mechanism, module)
    except InterferenceError:
        pair = None
    if pair is None or mechanism.ring_teeth > _MOST_TEETH:
        return Outlines(
            circle(mechanism.ring_rolling_radius), circle(mechanism.satellite_rolling_radius)
        )
    return pair.outlines


def ring_phase(mechanism: Mechanism, branch: Branch) -> float:
    """Turn ψ_k of a branch's ring gear for its cam phase, rad, within half a tooth pitch."""
    return ring_turn_between(mechanism, 0.0, branch.cam_phase)


def tooth_pair(mechanism: Mechanism, module: float) -> 'ToothPair':
    """Find the highest teeth, up to those of the basic rack, that mesh without interference.

    The module is in metres; MechanismError if it is not finite and greater than 0. Raises
    InterferenceError if there are no such teeth; the text gives the numbers.
    """
    if not 0.0 < module < math.inf:
        raise MechanismError([f'module must be finite and greater than 0, not {module!r}'])
    e, teeth = mechanism.eccentricity, mechanism.ring_teeth - mechanism.satellite_teeth
    problem = f'involute teeth of module {module:g} m do not mesh at an eccentricity of {e:g} m'
    least = 0.5 * module * teeth * math.cos(PRESSURE_ANGLE)
    if e <= least:
        raise InterferenceError(f'{problem}, which must be greater than {least:.6g} m')
    pairs = [ToothPair(mechanism, module, percent / 100.0) for percent in range(100, 0, -1)]
    pair = next((pair for pair in pairs if pair.clear), pairs[-1])
    if not (pair.clear and pair.contact_ratio >= 1.0):
        tried = ', '.join(str(pair) for pair in dict.fromkeys([pairs[0], pair]))
        raise InterferenceError(f'{problem}: {tried}')
    return pair


@dataclass(frozen=True)
class ToothPair:
    """The teeth of ring gear and satellite; lengths in m, angles in rad."""

    mechanism: Mechanism
    module: float  #: module of the teeth, m
    addendum: float
    """Height of the teeth above their reference circle, modules: 1, or less if shortened."""

    def __str__(self) -> str:
        return (
            f'an addendum of {self.addendum:g} modules gives a tip interference margin of '
            f'{self.tip_interference_margin:.3g} rad and a contact ratio of '
            f'{self.contact_ratio:.3f}'
        )

    @property
    def working_pressure_angle(self) -> float:
        """Angle αw between the line of action and the common tangent of the rolling circles."""
        teeth = self.mechanism.ring_teeth - self.mechanism.satellite_teeth
        reference = 0.5 * self.module * teeth
        return math.acos(reference * math.cos(PRESSURE_ANGLE) / self.mechanism.eccentricity)

    @property
    def ring_profile_shift(self) -> float:
        """Profile shift xk of the ring gear, modules; that of the satellite is 0."""
        teeth = self.mechanism.ring_teeth - self.mechanism.satellite_teeth
        involute = _inv(self.working_pressure_angle) - _inv(PRESSURE_ANGLE)
        return 0.5 * teeth * involute / math.tan(PRESSURE_ANGLE)

    @cached_property
    def satellite(self) -> 'Involute':
        """The satellite's teeth."""
        return Involute.of(self.mechanism.satellite_teeth, self.module, 0.0, _BACKLASH)

    @cached_property
    def ring(self) -> 'Involute':
        """The ring gear's spaces."""
        return Involute.of(self.mechanism.ring_teeth, self.module, self.ring_profile_shift, 0.0)

    @property
    def satellite_tip_radius(self) -> float:
        """Tip radius rs of the satellite, m."""
        return self.module * (0.5 * self.mechanism.satellite_teeth + self.addendum)

    @cached_property
    def ring_tip_radius(self) -> float:
        """Tip radius rk of the ring gear, m; greater if involute interference requires it."""
        teeth = 0.5 * self.mechanism.ring_teeth
        ratio = self.mechanism.satellite_teeth / self.mechanism.ring_teeth
        flank = (1.0 - ratio) * math.tan(self.working_pressure_angle)
        return max(
            self.module * (teeth + self.ring_profile_shift - self.addendum),
            self.ring.base_radius * math.hypot(1.0, flank),
        )

    @property
    def satellite_root_radius(self) -> float:
        """Root radius, m, with clearance to the tips of the ring gear."""
        return self.ring_tip_radius - self.mechanism.eccentricity - _CLEARANCE * self.module

    @property
    def ring_root_radius(self) -> float:
        """Root radius, m, with clearance to the tips of the satellite."""
        return self.satellite_tip_radius + self.mechanism.eccentricity + _CLEARANCE * self.module

    @cached_property
    def tip_interference_margin(self) -> float:
        """Margin to trochoid interference, as a turn of the ring gear, rad; 0 is contact."""
        e, rs, rk = self.mechanism.eccentricity, self.satellite_tip_radius, self.ring_tip_radius
        difference = rk * rk - rs * rs
        # Tip circles that do not cross have the angle 0 or π.
        satellite, ring = (
            math.acos(max(-1.0, min(cosine, 1.0)))
            for cosine in (
                (difference - e * e) / (2.0 * e * rs),
                (difference + e * e) / (2.0 * e * rk),
            )
        )
        working = _inv(self.working_pressure_angle)
        satellite += _inv(self.satellite.pressure_angle(rs)) - working
        ring += _inv(self.ring.pressure_angle(rk)) - working
        return satellite * self.mechanism.satellite_teeth / self.mechanism.ring_teeth - ring

    @property
    def contact_ratio(self) -> float:
        """Length of the path of contact in base pitches: the mean number of pairs in contact."""
        length = (
            self.satellite.roll(self.satellite_tip_radius)
            - self.ring.roll(self.ring_tip_radius)
            + self.mechanism.eccentricity * math.sin(self.working_pressure_angle)
        )
        return length / (math.pi * self.module * math.cos(PRESSURE_ANGLE))

    @property
    def outlines(self) -> Outlines:
        """Compute the outlines of both gears, whether they mesh or not."""
        return Outlines(
            self.ring.outline(self.ring_tip_radius, self.ring_root_radius),
            self.satellite.outline(self.satellite_root_radius, self.satellite_tip_radius),
        )

    @property
    def clear(self) -> bool:
        """Whether the tips do not interfere, and no tooth or space is too thin."""
        return (
            self.tip_interference_margin >= 0.0
            and self.satellite_root_radius > 0.0
            and self.satellite.tooth(self.satellite_tip_radius) >= _LEAST_TIP * self.module
            and self.ring.space(self.ring_tip_radius) >= _LEAST_TIP * self.module
            and self.satellite.space(self.satellite_root_radius) > 0.0
            and self.ring.tooth(self.ring_root_radius) > 0.0
        )


class Involute(NamedTuple):
    """External involute teeth; also the spaces of the ring gear, taken as teeth."""

    teeth: int
    base_radius: float  #: radius of the base circle, m
    base_half_angle: float  #: half the angular thickness of a tooth on the base circle, rad

    @classmethod
    def of(cls, teeth: int, module: float, profile_shift: float, backlash: float) -> Self:
        """Make teeth of the basic rack, thinned by the backlash; shift and backlash in modules."""
        base_radius = 0.5 * module * teeth * math.cos(PRESSURE_ANGLE)
        half_angle = (0.5 * math.pi + 2.0 * profile_shift * math.tan(PRESSURE_ANGLE)) / teeth
        # Turning an involute by an angle moves it by base radius × angle along its normal.
        return cls(
            teeth,
            base_radius,
            half_angle + _inv(PRESSURE_ANGLE) - 0.5 * backlash * module / base_radius,
        )

    def pressure_angle(self, radius: float) -> float:
        """Pressure angle of the involute at a radius, rad; 0 below the base circle."""
        return math.acos(min(1.0, self.base_radius / radius))

    def roll(self, radius: float) -> float:
        """Radius of curvature of the involute at a radius, m."""
        return self.base_radius * math.tan(self.pressure_angle(radius))

    def half_angle(self, radius: float) -> float:
        """Half the angular thickness at a radius, rad; flanks are radial below the base circle."""
        return self.base_half_angle - _inv(self.pressure_angle(radius))

    def tooth(self, radius: float) -> float:
        """Thickness of a tooth along a circle, m."""
        return 2.0 * radius * self.half_angle(radius)

    def space(self, radius: float) -> float:
        """Width of a space along a circle, m."""
        return 2.0 * radius * (math.pi / self.teeth - self.half_angle(radius))

    def outline(self, root_radius: float, tip_radius: float) -> Array:
        """Compute the closed outline with the middle of a tooth on the y axis, (n, 2), m."""
        start = max(root_radius, self.base_radius)
        rolls = np.linspace(self.roll(start), self.roll(tip_radius), _FLANK_POINTS)
        radii = np.hypot(self.base_radius, rolls)
        if root_radius < start:
            radii = np.append(root_radius, radii)
        half_angles = np.array([self.half_angle(radius) for radius in radii])
        # A tooth, counterclockwise: up one flank, down the other.
        radius = np.concatenate([radii, radii[::-1]])
        angle = 0.5 * math.pi + np.concatenate([-half_angles, half_angles[::-1]])
        pitches = 2.0 * math.pi / self.teeth * np.arange(self.teeth)[:, np.newaxis]
        turned = pitches + angle
        outline = np.stack([radius * np.cos(turned), radius * np.sin(turned)], axis=-1)
        return outline.reshape(-1, 2)


def _inv(angle: float) -> float:
    """Compute the involute function, tan α - α."""
    return math.tan(angle) - angle


def circle(radius: float, x: float = 0.0, y: float = 0.0) -> Array:
    """Make a circle about a point, counterclockwise, (n, 2)."""
    angle = np.linspace(0.0, TURN, _CIRCLE_POINTS, endpoint=False)
    return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])
