# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Loop closure: the residual detects faults, the Jacobian is right, the mobility is one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from properties import assert_close, largest, mechanisms, motions, speed_up

from gear_kinematics.kinematics import Branch, Mechanism, matrix_method, motion
from gear_kinematics.kinematics.loop_closure import (
    constraint_jacobian,
    mobility_by_counting,
    mobility_by_rank,
    residual,
)

EPS = float(np.finfo(np.float64).eps)
ANGLES = np.linspace(-7.0, 7.0, 141)


def with_branches(count: int) -> Mechanism:
    branches = tuple(Branch('abcd'[k], 2.0 * math.pi * k / count) for k in range(count))
    return Mechanism(80, 76, 0.0011, branches)


def coordinates(mechanism, angle) -> np.ndarray:
    """Place the bodies, (x, y, angle) each in the order of the columns, lengths in units of e."""
    ratio = -(mechanism.ring_teeth - mechanism.satellite_teeth) / mechanism.satellite_teeth
    output = ratio * angle
    bodies = [0.0, 0.0, angle]
    for branch in mechanism.branches:
        theta = angle + branch.cam_phase
        arm = np.cos(theta - output)
        bodies += [-np.sin(theta), np.cos(theta), output]
        bodies += [-arm * np.sin(output), arm * np.cos(output), output]
    return np.array([*bodies, 0.0, 0.0, output])


def constraints(mechanism, bodies, start) -> np.ndarray:
    """Residuals of the joints for bodies at arbitrary places, in the order of the rows.

    Written from what the joints demand, without derivatives. The satellites roll from `start`.
    """
    rotor, shaft = bodies[:3], bodies[-3:]
    teeth = mechanism.ring_teeth - mechanism.satellite_teeth
    values = [*rotor[:2], *shaft[:2]]
    for k, branch in enumerate(mechanism.branches):
        satellite, coupling = bodies[3 + 6 * k : 6 + 6 * k], bodies[6 + 6 * k : 9 + 6 * k]
        theta = rotor[2] + branch.cam_phase
        values += [satellite[0] - rotor[0] + np.sin(theta)]
        values += [satellite[1] - rotor[1] - np.cos(theta)]
        apart, q = coupling[:2] - satellite[:2], satellite[2]
        values += [coupling[2] - q, np.cos(q) * apart[1] - np.sin(q) * apart[0]]
        apart, q = coupling[:2] - shaft[:2], shaft[2]
        values += [coupling[2] - q, np.cos(q) * apart[0] + np.sin(q) * apart[1]]
        # As the centre goes around the ring, the satellite turns back by (zk - zs)/zs of that.
        x, y, turned = start[3 + 6 * k : 6 + 6 * k]
        around = np.arctan2(
            x * satellite[1] - y * satellite[0], x * satellite[0] + y * satellite[1]
        )
        values += [around + (satellite[2] - turned) * mechanism.satellite_teeth / teeth]
    return np.array(values)


@pytest.mark.slow
@given(mechanisms(), motions())
def test_loops_of_both_methods_close(mechanism, values):
    tolerance = 200.0 * EPS * speed_up(mechanism) * mechanism.eccentricity
    for method in (motion, matrix_method):
        gaps = residual(mechanism, values[0], method.solve(mechanism, *values))
        assert_close(gaps, np.zeros((*values[0].shape, len(mechanism.branches))), tolerance)


@pytest.mark.parametrize(
    ('field', 'shape'),
    [
        ('satellite_slide', ()),
        ('arm_slide', ()),
        ('oldham_centre', (2,)),
        ('satellite_centre', (2,)),
    ],
)
@pytest.mark.parametrize('branch', [0, 1])
def test_residual_is_the_size_of_the_fault(actuator, field, shape, branch):
    """A fault of 1 µm in any position of one branch shows in that branch alone."""
    state = motion.solve(actuator, ANGLES)
    fault = np.zeros((ANGLES.size, 2, *shape))
    fault[:, branch] = 1e-6 / math.sqrt(math.prod(shape) * len(shape) or 1)
    gaps = residual(actuator, ANGLES, replace(state, **{field: getattr(state, field) + fault}))
    assert_close(gaps[:, branch], np.full(ANGLES.size, 1e-6), 1e-15)
    assert largest(gaps[:, 1 - branch]) < 1e-17


def test_residual_detects_a_wrong_rotor_angle(actuator):
    """The satellite's centre is off by e times the angle, to first order."""
    gaps = residual(actuator, ANGLES + 1e-6, motion.solve(actuator, ANGLES))
    assert np.all(gaps >= 0.999e-6 * actuator.eccentricity)


def test_residual_of_a_state_that_is_not_finite_is_not_small(actuator):
    assert np.all(np.isnan(residual(actuator, 0.5, motion.solve(actuator, math.nan))))


@pytest.mark.parametrize(
    ('count', 'counted', 'rows', 'columns', 'rank'),
    [(1, 1, 11, 12, 11), (2, 0, 18, 18, 17), (3, -1, 25, 24, 23)],
)
def test_mobility_is_one_at_every_rotor_angle(count, counted, rows, columns, rank):
    mechanism = with_branches(count)
    assert mobility_by_counting(mechanism) == counted
    jacobian = constraint_jacobian(mechanism, ANGLES)
    assert jacobian.shape == (ANGLES.size, rows, columns)
    # Rank by the gap in the singular values, not by the tolerance of a library.
    values = np.linalg.svd(jacobian, compute_uv=False)
    assert np.min(values[:, rank - 1]) > 1e-3
    assert np.max(values[:, rank:], initial=0.0) < 1e-13
    for angle in ANGLES[::20]:
        assert mobility_by_rank(mechanism, angle) == columns - rank == 1


def test_jacobian_is_the_derivative_of_the_constraints(mechanism):
    """Column by column, by central differences; rows up to their scale and sign."""
    step = 1e-5
    for angle in (0.0, 0.4, -2.9):
        start = coordinates(mechanism, angle)
        on_the_way = constraints(mechanism, coordinates(mechanism, angle + 0.3), start)
        assert_close(on_the_way, np.zeros(on_the_way.shape), 1e-13)
        expected = np.transpose(
            [
                constraints(mechanism, start + shift, start)
                - constraints(mechanism, start - shift, start)
                for shift in step * np.eye(start.size)
            ]
        ) / (2.0 * step)
        actual = constraint_jacobian(mechanism, angle)
        factors = np.sum(actual * expected, axis=1) / np.sum(expected**2, axis=1)
        assert np.all(np.abs(factors) > 1e-6)
        assert_close(actual, factors[:, np.newaxis] * expected, 1e-8 * largest(actual))
