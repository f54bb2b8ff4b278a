"""The 4×4 transforms: rotations form a group, and the frames of the mechanism."""

import math

import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from properties import SHAPES, assert_close, mechanisms, numbers_of, samples, speed_up

from gear_kinematics.kinematics import Branch, Mechanism, solve
from gear_kinematics.kinematics.transforms import (
    apply,
    cam_translation,
    frames,
    output_turn,
    rotation_z,
    satellite_turn,
    translation,
)

EPS = float(np.finfo(np.float64).eps)


def floats_of(matrix) -> np.ndarray:
    return np.array([[float(entry) for entry in row] for row in matrix])


def test_hand_computed_rotation_and_translation():
    quarter = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert_close(rotation_z(math.pi / 2.0), quarter, EPS)
    shift = [[1, 0, 0, 3], [0, 1, 0, 4], [0, 0, 1, 5], [0, 0, 0, 1]]
    np.testing.assert_array_equal(translation(3.0, 4.0, 5.0), shift)
    moved = apply(translation(3.0, 4.0, 5.0) @ rotation_z(math.pi / 2.0), [1.0, 2.0, 3.0])
    assert_close(moved, [1.0, 5.0, 8.0], 4.0 * EPS)


@given(samples(100.0), st.floats(-100.0, 100.0))
def test_rotations_form_a_group(angles, other):
    rotation = rotation_z(angles)
    rounding = 4.0 * np.spacing(200.0)
    assert_close(rotation @ rotation_z(other), rotation_z(angles + other), rounding)
    unit = np.broadcast_to(np.eye(4), rotation.shape)
    assert_close(rotation @ np.swapaxes(rotation, -1, -2), unit, 4.0 * EPS)
    if angles.size:
        assert_close(np.linalg.det(rotation), np.ones(angles.shape), 4.0 * EPS)


@pytest.mark.parametrize('shape', SHAPES, ids=str)
def test_transforms_take_any_shape(shape):
    values = np.linspace(0.1, 1.0, math.prod(shape)).reshape(shape)
    rotation, shift = rotation_z(values), translation(values, 2.0 * values)
    moved = apply(shift @ rotation, [1.0, 0.0, 7.0])
    assert rotation.shape == shift.shape == (*shape, 4, 4)
    assert moved.shape == (*shape, 3)
    for index in np.ndindex(shape):
        np.testing.assert_array_equal(rotation[index], rotation_z(values[index]))
        x, y = math.cos(values[index]) + values[index], math.sin(values[index]) + 2 * values[index]
        assert_close(moved[index], [x, y, 7.0], 4.0 * EPS)


def test_translations_broadcast():
    shift = translation([1.0, 2.0], 0.0, [[3.0], [4.0], [5.0]])
    assert shift.shape == (3, 2, 4, 4)
    np.testing.assert_array_equal(shift[2, 1, :, 3], [2.0, 0.0, 5.0, 1.0])


def test_points_broadcast_against_transforms():
    moved = apply(translation([1.0, 2.0], 0.0)[:, np.newaxis], np.zeros((3, 3)))
    assert moved.shape == (2, 3, 3)
    np.testing.assert_array_equal(moved[..., 0], [[1.0] * 3, [2.0] * 3])


def test_cams_are_where_their_phases_point():
    """Phase 0 points along the rotor's y axis, and π/2 therefore against its x axis."""
    branches = (Branch('a', 0.0, 0.5), Branch('b', math.pi / 2.0), Branch('c', math.pi, -0.5))
    offsets = cam_translation(Mechanism(80, 76, 2.0, branches))[:, :3, 3]
    assert_close(offsets, [[0.0, 2.0, 0.5], [-2.0, 0.0, 0.0], [0.0, -2.0, -0.5]], 4.0 * EPS)


@pytest.mark.slow
@given(mechanisms(), samples(100.0))
def test_turns_of_shaft_and_satellite(mechanism, angles):
    """The satellite turns by φ5 - φ2 = -φ2 zk/zs on its cam."""
    zk, zs = mechanism.ring_teeth, mechanism.satellite_teeth
    tolerance = 8.0 * EPS * np.abs(angles) * (speed_up(mechanism) + 1.0)
    assert_close(output_turn(mechanism, angles), -angles * (zk - zs) / zs, tolerance)
    assert_close(satellite_turn(mechanism, angles), -angles * zk / zs, tolerance)


@pytest.mark.slow
@given(mechanisms(max_branches=2), samples(5.0, shapes=((), (3,), (2, 1))))
def test_frames_agree_with_the_oracle(mechanism, angles):
    """Every transform against 50-digit products with exact slides, at any axial position."""
    state = solve(mechanism, angles)
    chain = frames(mechanism, angles, state.satellite_slide, state.arm_slide)
    numbers, e = numbers_of(mechanism), mechanism.eccentricity
    rounding = 40.0 * EPS * (1.0 + speed_up(mechanism))
    # The axial position is much greater than the other lengths and must not hide their errors.
    scale = np.ones((4, 4)) * rounding
    scale[:2, 3] *= e
    for index in np.ndindex(angles.shape):
        angle = oracle.rotor_angle_of(angles[index])
        expected = oracle.expected_motion(numbers, angle)
        T_21, T_51 = oracle.rotation_z(angle), oracle.rotation_z(expected.output_angle)
        assert_close(chain.rotor_to_stator[index], floats_of(T_21), scale)
        assert_close(chain.output_to_stator[index], floats_of(T_51), scale)
        for k, branch in enumerate(expected.branches):
            phase, axial = numbers.branches[k]
            up, aside = oracle.mp.cos(phase) * e, -oracle.mp.sin(phase) * e
            T_32 = oracle.product(
                oracle.translation(aside, up, axial),
                oracle.rotation_z(expected.output_angle - angle),
            )
            T_43 = oracle.translation(branch.satellite_slide, 0, 0)
            T_45 = oracle.translation(0, branch.arm_slide, axial)
            T_31 = oracle.product(T_21, T_32)
            for actual, exact in (
                (chain.satellite_to_rotor, T_32),
                (chain.satellite_to_stator, T_31),
                (chain.oldham_to_satellite, T_43),
                (chain.oldham_to_output, T_45),
                (chain.oldham_to_stator, oracle.product(T_31, T_43)),
            ):
                assert_close(actual[(*index, k)], floats_of(exact), scale)
