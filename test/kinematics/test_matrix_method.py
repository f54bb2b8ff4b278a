# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The matrix method: against the closed form, with which it shares no formula, and the oracle."""

import math

import numpy as np
from hypothesis import given, settings
from properties import LENGTHS, assert_close, field_names, mechanisms, motions, speed_up

from gear_kinematics.kinematics import matrix_method, motion
from gear_kinematics.kinematics.transforms import rotation_z, translation

EPS = float(np.finfo(np.float64).eps)


@settings(max_examples=80)
@given(mechanisms(), motions())
def test_closed_form_and_matrix_method_agree_in_every_field(mechanism, values):
    by_matrices = matrix_method.solve(mechanism, *values)
    closed = motion.solve(mechanism, *values)
    ratio = speed_up(mechanism)
    rate = np.max(np.abs(values[1]), initial=0.0)
    fastest = ratio * max(rate, np.sqrt(np.max(np.abs(values[2]), initial=0.0)))
    # The angles of up to 20 rad, times the ratio, enter the sines with rounding errors.
    rounding = 40.0 * EPS * ratio
    compared = {'output_turn_angle'}
    for order, names in enumerate(LENGTHS):
        for name in names:
            tolerance = 10.0 * rounding * mechanism.eccentricity * fastest**order
            assert_close(getattr(by_matrices, name), getattr(closed, name), tolerance)
            compared.add(name)
    for order, name in enumerate(('output_angle', 'output_velocity', 'output_acceleration')):
        expected = getattr(closed, name)
        tolerance = rounding if order == 0 else 4.0 * EPS * np.abs(expected)
        assert_close(getattr(by_matrices, name), expected, tolerance)
        compared.add(name)
    difference = by_matrices.output_turn_angle - closed.output_turn_angle
    # Half a turn may come out with either sign.
    assert_close(np.sin(difference / 2.0), np.zeros(difference.shape), rounding)
    assert compared == set(field_names(closed))


def test_hand_computed_rotation_and_translation():
    quarter = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert_close(rotation_z(math.pi / 2.0), quarter, EPS)
    moved = translation(3.0, 4.0, 5.0) @ rotation_z(math.pi / 2.0) @ [1.0, 2.0, 3.0, 1.0]
    assert_close(moved, [1.0, 5.0, 8.0, 1.0], 4.0 * EPS)
