"""The 4×4 transforms: rotations form a group, and the frames of the mechanism."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from properties import SHAPES, assert_close, samples

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.kinematics.transforms import (
    cam_translation,
    rotation_z,
    translation,
)

EPS = float(np.finfo(np.float64).eps)


def test_hand_computed_rotation_and_translation():
    quarter = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert_close(rotation_z(math.pi / 2.0), quarter, EPS)
    shift = [[1, 0, 0, 3], [0, 1, 0, 4], [0, 0, 1, 5], [0, 0, 0, 1]]
    np.testing.assert_array_equal(translation(3.0, 4.0, 5.0), shift)
    moved = translation(3.0, 4.0, 5.0) @ rotation_z(math.pi / 2.0) @ [1.0, 2.0, 3.0, 1.0]
    assert_close(moved, [1.0, 5.0, 8.0, 1.0], 4.0 * EPS)


@given(samples(100.0), st.floats(-100.0, 100.0))
def test_rotations_form_a_group(angles, other):
    rotation = rotation_z(angles)
    rounding = 4.0 * np.spacing(200.0)
    assert_close(rotation @ rotation_z(other), rotation_z(angles + other), rounding)
    unit = np.broadcast_to(np.eye(4), rotation.shape)
    assert_close(rotation @ np.swapaxes(rotation, -1, -2), unit, 4.0 * EPS)
    if angles.size:
        assert_close(np.linalg.det(rotation), np.ones(angles.shape), 4.0 * EPS)


def test_cams_are_where_their_phases_point():
    """Phase 0 points along the rotor's y axis, and π/2 therefore against its x axis."""
    branches = (Branch('a', 0.0, 0.5), Branch('b', math.pi / 2.0), Branch('c', math.pi, -0.5))
    offsets = cam_translation(Mechanism(80, 76, 2.0, branches))[:, :3, 3]
    assert_close(offsets, [[0.0, 2.0, 0.5], [-2.0, 0.0, 0.0], [0.0, -2.0, -0.5]], 4.0 * EPS)


@pytest.mark.parametrize('shape', SHAPES, ids=str)
def test_transforms_take_any_shape(shape):
    values = np.linspace(0.1, 1.0, math.prod(shape)).reshape(shape)
    rotation, shift = rotation_z(values), translation(values, 2.0 * values, 3.0)
    assert rotation.shape == shift.shape == (*shape, 4, 4)
    for index in np.ndindex(shape):
        np.testing.assert_array_equal(rotation[index], rotation_z(values[index]))
        x = values[index]
        np.testing.assert_array_equal(shift[index], translation(x, 2.0 * x, 3.0))
