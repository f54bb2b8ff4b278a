# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What property tests share: mechanisms and motions to draw, and comparisons that NaN fails."""

import math
from dataclasses import fields

import numpy as np
import oracle
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from gear_kinematics.kinematics import Branch, Mechanism

SHAPES = ((), (1,), (5,), (0,), (2, 3), (3, 0), (2, 1, 2))

# Lengths of a state by the order of their time derivative.
LENGTHS = (
    ('satellite_centre', 'oldham_centre', 'satellite_slide', 'arm_slide'),
    ('satellite_velocity', 'oldham_velocity', 'satellite_slide_velocity', 'arm_slide_velocity'),
    ('satellite_acceleration', 'oldham_acceleration'),
)


@st.composite
def mechanisms(draw, max_branches: int = 4) -> Mechanism:
    """Draw teeth up to 400, eccentricities over twelve decades, cams at any phase."""
    ring_teeth = draw(st.integers(2, 400))
    satellite_teeth = draw(
        st.integers(1, ring_teeth - 1) | st.integers(max(1, ring_teeth - 5), ring_teeth - 1)
    )
    eccentricity = draw(st.floats(1.0, 10.0)) * 10.0 ** draw(st.integers(-9, 2))
    branches = tuple(
        Branch(name, draw(st.floats(-100.0, 100.0)), draw(st.floats(-1.0, 1.0)))
        for name in 'abcd'[: draw(st.integers(1, max_branches))]
    )
    return Mechanism(ring_teeth, satellite_teeth, eccentricity, branches)


def samples(limit: float, shapes=SHAPES):
    """Draw an array of a drawn shape, with elements of either sign up to a limit."""
    return st.sampled_from(shapes).flatmap(
        lambda shape: hnp.arrays(np.float64, shape, elements=st.floats(-limit, limit))
    )


@st.composite
def motions(draw, angle: float = 20.0, velocity: float = 100.0, acceleration: float = 1e4):
    """Draw rotor angles, velocities and accelerations of one shape, up to these limits."""
    angles = draw(samples(angle))
    others = (
        hnp.arrays(np.float64, angles.shape, elements=st.floats(-limit, limit))
        for limit in (velocity, acceleration)
    )
    return angles, *(draw(other) for other in others)


def largest(errors) -> float:
    """Give the largest magnitude; 0 of nothing, and NaN if there is one."""
    return float(np.max(np.abs(errors), initial=0.0))


def assert_close(actual, expected, tolerance) -> None:
    """Compare arrays of the same shape within an absolute tolerance; what is NaN is not close.

    Numbers below 1e-300 are all the same here: products of such have lost their bits.
    """
    assert np.shape(actual) == np.shape(expected)
    error = np.abs(np.subtract(actual, expected))
    assert np.all(error <= np.maximum(tolerance, 1e-300)), (
        f'{largest(error)} is more than {np.max(tolerance)}'
    )


def assert_same(actual, expected) -> None:
    """Compare states bit by bit; NaN equals NaN."""
    for field in fields(actual):
        np.testing.assert_array_equal(
            getattr(actual, field.name), getattr(expected, field.name), field.name, strict=True
        )


def field_names(state) -> list[str]:
    return [field.name for field in fields(state)]


def speed_up(mechanism: Mechanism) -> float:
    """Give the fastest angular rate in the mechanism per rotor rate: of 2 φ5 - θ."""
    teeth = mechanism.ring_teeth - mechanism.satellite_teeth
    return 2.0 * teeth / mechanism.satellite_teeth + 1.0


def numbers_of(mechanism: Mechanism) -> oracle.Numbers:
    """Give the plain numbers that the oracle takes."""
    return oracle.Numbers(
        mechanism.ring_teeth,
        mechanism.satellite_teeth,
        mechanism.eccentricity,
        tuple((branch.cam_phase, branch.axial_position) for branch in mechanism.branches),
    )


def position_errors(state, mechanism: Mechanism, rotor_angles) -> dict[str, float]:
    """Compare a state with the oracle's at exact rotor angles, in order of the flat state.

    Returns:
        For each kind of position its largest error: lengths in units of the eccentricity; the
        angle of the shaft modulo whole turns, rad; and `output_angle` beyond 2 ulp, rad.
    """
    numbers, e, count = numbers_of(mechanism), mechanism.eccentricity, len(mechanism.branches)
    turn_angles, output_angles = state.output_turn_angle.ravel(), state.output_angle.ravel()
    points = {
        name: getattr(state, name).reshape(-1, count, 2)
        for name in ('satellite_centre', 'oldham_centre')
    }
    slides = {
        name: getattr(state, name).reshape(-1, count) for name in ('satellite_slide', 'arm_slide')
    }
    errors: dict[str, list[float]] = {
        name: [0.0] for name in ('turn', 'output_angle', *points, *slides)
    }
    for n, angle in enumerate(rotor_angles):
        expected = oracle.expected_motion(numbers, angle)
        errors['turn'].append(oracle.turn_angle_error(turn_angles[n], expected.output_angle))
        error = oracle.angle_error(output_angles[n], expected.output_angle)
        spacing = math.ulp(float(expected.output_angle))
        errors['output_angle'].append(
            math.nan if math.isnan(error) else max(error - 2.0 * spacing, 0.0)
        )
        for k, branch in enumerate(expected.branches):
            for name, values in points.items():
                error = oracle.point_error(values[n, k], getattr(branch, name), e)
                errors[name].append(error)
            for name, values in slides.items():
                error = oracle.length_error(values[n, k], getattr(branch, name), e)
                errors[name].append(error)
    return {name: largest(values) for name, values in errors.items()}


def assert_within(errors: dict[str, float], tolerance: float = 1e-12) -> None:
    """Hold errors by name against one tolerance; what is NaN is not within it."""
    assert all(error <= tolerance for error in errors.values()), errors
