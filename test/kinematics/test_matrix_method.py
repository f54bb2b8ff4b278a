"""The matrix method: against the closed form, with which it shares no formula, and the oracle."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from properties import (
    LENGTHS,
    assert_close,
    field_names,
    mechanisms,
    motions,
    speed_up,
)

from gear_kinematics.kinematics import MotionState, matrix_method, motion

EPS = float(np.finfo(np.float64).eps)


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


def test_inputs_broadcast_and_results_are_read_only(mechanism):
    state = matrix_method.solve(mechanism, np.zeros((3, 1)), np.ones(2))
    whole = matrix_method.solve(mechanism, np.zeros((3, 2)), np.ones((3, 2)))
    count = len(mechanism.branches)
    assert isinstance(state, MotionState)
    assert state.oldham_acceleration.shape == (3, 2, count, 2)
    for field in fields(state):
        np.testing.assert_array_equal(getattr(state, field.name), getattr(whole, field.name))
        with pytest.raises(ValueError, match='read-only'):
            getattr(state, field.name)[...] = 1.0


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_angles_that_are_not_finite_give_nan(actuator, bad):
    state = matrix_method.solve(actuator, [0.5, bad], 1.0, 1.0)
    good = matrix_method.solve(actuator, [0.5], 1.0, 1.0)
    for names in LENGTHS:
        for name in names:
            array = getattr(state, name)
            np.testing.assert_array_equal(array[:1], getattr(good, name))
            assert np.all(np.isnan(array[1])), name
