# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The expected motion at 50 digits, from 4×4 matrix products, independent of the code under test.

T_ab takes frame-a coordinates to frame b; frames: 1 stator, 2 rotor, 3 satellite, 4 Oldham
coupling, 5 output shaft. The slides solve the loop closure T_21 T_32 T_43 O = T_51 T_45 O.
Nothing of `gear_kinematics` is imported here, and nothing here is a closed form.
"""

import math
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import mpmath

mp = mpmath.mp.clone()  # a precision of its own
mp.dps = 50
Real = mpmath.mpf
Matrix = list[list[Real]]  # exact zeros and ones are the ints 0 and 1

CLOSED = mp.mpf('1e-44')  # what the loop may stay open by, in units of the eccentricity
TIME_STEP = mp.mpf('1e-12')  # s: far below any period, and squared far above 1e-50


class Numbers(NamedTuple):
    """A mechanism in plain numbers: those that the code under test is given, exactly."""

    ring_teeth: int
    satellite_teeth: int
    eccentricity: float
    branches: tuple[tuple[float, float], ...]
    """For each branch its cam phase (rad) and axial position (m)."""


class BranchMotion(NamedTuple):
    """Where the bodies of one branch are; points are (x, y, z) in the stator frame, m."""

    satellite_angle: Real
    """rad, in (-π, π]: the turn of the matrix T_31."""
    satellite_centre: tuple[Real, ...]
    oldham_centre: tuple[Real, ...]
    satellite_slide: Real
    arm_slide: Real


class Expected(NamedTuple):
    """The motion of all bodies."""

    output_angle: Real
    """rad; counts turns."""
    branches: tuple[BranchMotion, ...]

    @property
    def centres(self) -> list[tuple[Real, ...]]:
        """In the order of body_poses: of the satellites, then of the couplings."""
        satellites = [branch.satellite_centre for branch in self.branches]
        return satellites + [branch.oldham_centre for branch in self.branches]


class Derivatives(NamedTuple):
    """The motion with its first and second time derivatives."""

    value: Expected
    first: Expected
    second: Expected


def rotor_angle_of(position: float, zero: float = 0.0, direction: int = 1, turns: int = 0) -> Real:
    """Give the exact rotor angle of an encoder `position` beyond a count of whole turns."""
    return direction * (mp.mpf(position) + 2 * mp.pi * turns - mp.mpf(zero))


def rotation_z(angle: Real) -> Matrix:
    c, s = mp.cos_sin(angle)
    return [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def translation(x: Real, y: Real, z: Real) -> Matrix:
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


def product(left: Matrix, right: Matrix) -> Matrix:
    """Multiply 4×4 matrices; what is exactly zero is passed over, since most of it is."""
    result = []
    for row in left:
        line = [0, 0, 0, 0]
        for entry, other in zip(row, right, strict=True):
            if entry:
                for j in range(4):
                    if other[j]:
                        line[j] += entry * other[j]
        result.append(line)
    return result


def expected_motion(numbers: Numbers, rotor_angle: Real) -> Expected:
    """Find the motion of all bodies at an exact rotor angle, rad."""
    teeth = numbers.ring_teeth - numbers.satellite_teeth
    output_angle = -rotor_angle * teeth / numbers.satellite_teeth  # eqs. (3), (5)
    T_21 = rotation_z(rotor_angle)
    T_51 = rotation_z(output_angle)
    turn_on_cam = rotation_z(output_angle - rotor_angle)
    branches = []
    for to_cam, axial in _cams(numbers):
        T_32 = product(to_cam, turn_on_cam)
        T_31 = product(T_21, T_32)
        x, y = _slides(T_31, T_51)
        T_41 = product(T_31, translation(x, 0, 0))  # eq. (11)
        by_arm = product(T_51, translation(0, y, axial))  # eq. (14)
        gap = max(abs(T_41[row][3] - by_arm[row][3]) for row in range(3))
        if gap > CLOSED * numbers.eccentricity:
            raise ArithmeticError(f'the loop of {numbers} stays open by {gap} at {rotor_angle}')
        angle = mp.atan2(T_31[1][0], T_31[0][0])
        branches.append(BranchMotion(angle, _origin(T_31), _origin(T_41), x, y))
    return Expected(output_angle, tuple(branches))


def expected_derivatives(
    numbers: Numbers, rotor_angle: Real, velocity: float, acceleration: float
) -> Derivatives:
    """Differentiate the motion by time, numerically: TIME_STEP² beside 1 is what is left out."""
    h = TIME_STEP
    before, now, after = (
        expected_motion(numbers, rotor_angle + velocity * t + acceleration * t * t / 2)
        for t in (-h, mp.zero, h)
    )

    def first(low, middle, high):  # noqa: ARG001, of the same form as `second`
        return (high - low) / (2 * h)

    def second(low, middle, high):
        return (high - 2 * middle + low) / (h * h)

    return Derivatives(
        now, _combine(first, before, now, after), _combine(second, before, now, after)
    )


def angle_error(actual: float, expected: Real) -> float:
    """Give the difference of two angles, rad; NaN if `actual` is."""
    return abs(float(mp.mpf(float(actual)) - expected))


def turn_angle_error(actual: float, expected: Real) -> float:
    """Give the difference of two angles modulo whole turns, rad, in [0, π]; NaN if `actual` is."""
    difference = mp.mpf(float(actual)) - expected
    if not mp.isfinite(difference):
        return math.nan
    return abs(float(difference - 2 * mp.pi * mp.nint(difference / (2 * mp.pi))))


def length_error(actual: float, expected: Real, eccentricity: float) -> float:
    """Give the difference of two lengths in units of the eccentricity; NaN if `actual` is."""
    return abs(float((mp.mpf(float(actual)) - expected) / mp.mpf(eccentricity)))


def point_error(actual, expected: tuple[Real, ...], eccentricity: float) -> float:
    """Give the greatest difference of coordinates in units of the eccentricity.

    `actual` has two coordinates or three, so many are compared; NaN counts as the greatest.
    """
    errors = [
        length_error(a, b, eccentricity)
        for a, b in zip(actual, expected[: len(actual)], strict=True)
    ]
    return math.nan if any(map(math.isnan, errors)) else max(errors)


@lru_cache
def _cams(numbers: Numbers) -> list[tuple[Matrix, Real]]:
    """Trans(e u(α)), from the rotor's axis to the centre of a cam, and z, for every branch."""
    e = mp.mpf(numbers.eccentricity)
    cams = []
    for phase, axial in numbers.branches:
        c, s = mp.cos_sin(mp.mpf(phase))
        cams.append((translation(-e * s, e * c, mp.mpf(axial)), mp.mpf(axial)))
    return cams


def _slides(T_31: Matrix, T_51: Matrix) -> tuple[Real, Real]:
    """Solve O3 + x (x axis of frame 3) = y (y axis of frame 5) by Cramer's rule, eq. (17)."""
    a, b, p = T_31[0][0], -T_51[0][1], -T_31[0][3]
    c, d, q = T_31[1][0], -T_51[1][1], -T_31[1][3]
    determinant = a * d - b * c
    return (p * d - b * q) / determinant, (a * q - p * c) / determinant


def _origin(transform: Matrix) -> tuple[Real, ...]:
    return tuple(mp.mpf(row[3]) for row in transform[:3])


def _combine(rule, *motions):
    """Apply a rule number by number to motions of the same structure."""
    if not isinstance(motions[0], tuple):
        return rule(*motions)
    parts = [_combine(rule, *fields) for fields in zip(*motions, strict=True)]
    kind = type(motions[0])
    return kind(*parts) if hasattr(kind, '_fields') else tuple(parts)


def turn_of(ring_teeth: int, tooth: int, ring_hole: int, chassis_hole: int) -> Fraction:
    """Turn of the ring gear's profile by a setting, in whole turns, from first principles."""
    return (
        Fraction(tooth, ring_teeth)
        + Fraction(ring_hole, ring_teeth + 1)
        + Fraction(chassis_hole, ring_teeth + 2)
    ) % 1
