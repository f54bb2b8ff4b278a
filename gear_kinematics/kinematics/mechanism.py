# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The mechanism: tooth numbers, eccentricity, branches, and quantities derived from them."""

import math
import operator
import re
from dataclasses import dataclass
from fractions import Fraction
from numbers import Real

from gear_kinematics.kinematics.errors import MechanismError
from gear_kinematics.kinematics.gear_ratio import GearRatio

_BRANCH_NAME = re.compile('[A-Za-z][A-Za-z0-9_]*')


@dataclass(frozen=True, slots=True)
class Branch:
    """A branch of the transmission: a satellite on its cam, and its Oldham coupling."""

    name: str
    """A letter, then letters, digits or underscores, as it becomes part of frame names."""
    cam_phase: float = 0.0
    """Angle α_k of the eccentric cam on the rotor, rad; 0 points along the rotor's y axis."""
    axial_position: float = 0.0
    """Position along the motor axis, m; the planar motion leaves it unchanged."""

    @property
    def cam_direction(self) -> tuple[float, float]:
        """Unit vector u(α_k) in the frame of the rotor, from its axis to the centre of the cam."""
        return -math.sin(self.cam_phase), math.cos(self.cam_phase)


@dataclass(frozen=True)
class Mechanism:
    """An anti-backlash planetary gear with any number of branches, validated on construction.

    Raises:
        MechanismError: listing every fault at once.
    """

    ring_teeth: int
    """Number of teeth zk of the ring gears on the stator."""
    satellite_teeth: int
    """Number of teeth zs of the satellites; less than `ring_teeth`."""
    eccentricity: float
    """Eccentricity e, m: the radius of the circle on which the satellites' centres move."""
    branches: tuple[Branch, ...]

    def __post_init__(self) -> None:
        """Convert the fields to plain Python types, or list their faults."""
        faults: list[str] = []
        ring = _teeth('ring_teeth', self.ring_teeth, faults)
        satellite = _teeth('satellite_teeth', self.satellite_teeth, faults)
        if ring is not None and satellite is not None and satellite >= ring:
            faults.append(f'satellite_teeth ({satellite}) must be less than ring_teeth ({ring})')
        eccentricity = _finite('eccentricity', self.eccentricity, faults)
        if eccentricity is not None and eccentricity <= 0.0:
            faults.append(f'eccentricity must be greater than 0, not {eccentricity!r}')
        branches = _branches(self.branches, faults)
        if faults:
            raise MechanismError(faults)
        for name, value in (
            ('ring_teeth', ring),
            ('satellite_teeth', satellite),
            ('eccentricity', eccentricity),
            ('branches', branches),
        ):
            object.__setattr__(self, name, value)

    @property
    def gear_ratio(self) -> GearRatio:
        """Signed, exact ratio i = ω2/ω5 = -zs/(zk - zs) (eq. 3): the output turns backwards."""
        return GearRatio(-self.satellite_teeth, self.ring_teeth - self.satellite_teeth)

    @property
    def cycle_turns(self) -> int:
        """Rotor turns after which every position repeats: the numerator of the ratio."""
        return abs(self.gear_ratio.numerator)

    @property
    def ring_rolling_radius(self) -> float:
        """Radius of the ring gear's rolling circle, m."""
        return self.eccentricity * self.ring_teeth / (self.ring_teeth - self.satellite_teeth)

    @property
    def satellite_rolling_radius(self) -> float:
        """Radius of the satellite's rolling circle, m."""
        return self.eccentricity * self.satellite_teeth / (self.ring_teeth - self.satellite_teeth)

    @property
    def oldham_petals(self) -> int:
        """Petals of the rose r = e cos(zk ψ/(zk - zs)) on which an Oldham coupling's centre moves.

        With zk/(zk - zs) = p/q in lowest terms: p if p and q are both odd, else 2 p.
        """
        order = Fraction(self.ring_teeth, self.ring_teeth - self.satellite_teeth)
        both_odd = order.numerator % 2 == 1 and order.denominator % 2 == 1
        return order.numerator if both_odd else 2 * order.numerator


Gear = Mechanism | GearRatio
"""A gear: a full mechanism or only its ratio; both have a `gear_ratio`."""


def _teeth(name: str, value: object, faults: list[str]) -> int | None:
    try:
        if isinstance(value, bool):
            raise TypeError
        teeth = operator.index(value)  # type: ignore[arg-type]  # raises TypeError
    except TypeError:
        faults.append(f'{name} must be an integer, not {value!r}')
        return None
    if teeth < 1:
        faults.append(f'{name} must be at least 1, not {teeth}')
        return None
    return teeth


def _finite(name: str, value: object, faults: list[str]) -> float | None:
    try:
        if not isinstance(value, Real) or isinstance(value, bool):
            raise TypeError
        number = float(value)
    except (TypeError, OverflowError):
        faults.append(f'{name} must be a number, not {value!r}')
        return None
    if not math.isfinite(number):
        faults.append(f'{name} must be finite, not {number!r}')
        return None
    return number


def _branches(branches: object, faults: list[str]) -> tuple[Branch, ...]:
    if not isinstance(branches, (tuple, list)) or not branches:
        faults.append('branches must name at least one branch')
        return ()
    checked: list[Branch] = []
    for branch in branches:
        if not isinstance(branch, Branch):
            faults.append(f'branches must be of type Branch, not {branch!r}')
            continue
        name: object = branch.name
        if not (isinstance(name, str) and _BRANCH_NAME.fullmatch(name)):
            faults.append(
                f'a branch name is a letter, then letters, digits or underscores, not {name!r}'
            )
            continue
        phase = _finite(f'{name}.cam_phase', branch.cam_phase, faults)
        position = _finite(f'{name}.axial_position', branch.axial_position, faults)
        if any(name == other.name for other in checked):
            faults.append(f'branch name {name!r} is used more than once')
        checked.append(Branch(name, phase or 0.0, position or 0.0))
    return tuple(checked)
