# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Mechanism and Branch: what is accepted, what is refused, and what follows from the teeth."""

import math
from dataclasses import FrozenInstanceError
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from properties import assert_close, mechanisms

from gear_kinematics.kinematics import Branch, Mechanism, MechanismError, solve

A = Branch('a')
NAMES = 'a branch name is a letter, then letters, digits or underscores, not '

GOOD = {'ring_teeth': 80, 'satellite_teeth': 76, 'eccentricity': 1e-3, 'branches': (A,)}


@pytest.mark.parametrize(
    ('wrong', 'faults'),
    [
        ({'ring_teeth': -80}, ['ring_teeth must be at least 1, not -80']),
        ({'ring_teeth': 80.0}, ['ring_teeth must be an integer, not 80.0']),
        ({'satellite_teeth': '76'}, ["satellite_teeth must be an integer, not '76'"]),
        ({'satellite_teeth': True}, ['satellite_teeth must be an integer, not True']),
        ({'satellite_teeth': 81}, ['satellite_teeth (81) must be less than ring_teeth (80)']),
        ({'eccentricity': 0.0}, ['eccentricity must be greater than 0, not 0.0']),
        ({'eccentricity': math.nan}, ['eccentricity must be finite, not nan']),
        ({'eccentricity': '1e-3'}, ["eccentricity must be a number, not '1e-3'"]),
        ({'eccentricity': True}, ['eccentricity must be a number, not True']),
        ({'branches': ()}, ['branches must name at least one branch']),
        ({'branches': ('a', A)}, ["branches must be of type Branch, not 'a'"]),
        (
            {'branches': (A, Branch('b'), Branch('a', 1.0))},
            ["branch name 'a' is used more than once"],
        ),
        ({'branches': (Branch('a', 'π'),)}, ["a.cam_phase must be a number, not 'π'"]),
        (
            {'satellite_teeth': 80, 'eccentricity': -1.0},
            [
                'satellite_teeth (80) must be less than ring_teeth (80)',
                'eccentricity must be greater than 0, not -1.0',
            ],
        ),
        (
            {
                'ring_teeth': 0,
                'satellite_teeth': 7.5,
                'branches': (Branch('1'), Branch('a', math.nan, -math.inf), Branch('a'), 3),
            },
            [
                'ring_teeth must be at least 1, not 0',
                'satellite_teeth must be an integer, not 7.5',
                NAMES + "'1'",
                'a.cam_phase must be finite, not nan',
                'a.axial_position must be finite, not -inf',
                "branch name 'a' is used more than once",
                'branches must be of type Branch, not 3',
            ],
        ),
    ],
    ids=str,
)
def test_every_fault_is_listed_at_once(wrong, faults):
    with pytest.raises(MechanismError) as caught:
        Mechanism(**GOOD | wrong)
    assert list(caught.value.faults) == faults
    assert str(caught.value) == '; '.join(faults)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize('name', ['', '_a', '1', 'a b', 'a-b', 'a.b', 'ä', 'a/b', 'a\n', 3, None])
def test_names_unfit_for_frames_are_refused(name):
    with pytest.raises(MechanismError) as caught:
        Mechanism(80, 76, 1e-3, (Branch(name),))
    assert list(caught.value.faults) == [NAMES + repr(name)]


def test_numpy_numbers_and_lists_become_plain_types():
    plain = Mechanism(80, 76, 0.5, (Branch('a', 1.0, 2.0),))
    mechanism = Mechanism(
        np.int64(80), np.uint8(76), np.float32(0.5), [Branch('a', np.float64(1.0), 2)]
    )
    assert mechanism == plain
    assert hash(mechanism) == hash(plain)
    with pytest.raises(FrozenInstanceError):
        mechanism.ring_teeth = 81
    branch = mechanism.branches[0]
    kinds = [type(mechanism.ring_teeth), type(mechanism.satellite_teeth)]
    assert kinds == [int, int]
    values = (mechanism.eccentricity, branch.cam_phase, branch.axial_position)
    assert [type(value) for value in values] == [float, float, float]
    assert isinstance(mechanism.branches, tuple)


@pytest.mark.parametrize(('ring_teeth', 'satellite_teeth', 'ratio', 'petals'), [
    (80, 76, Fraction(-19), 40), (80, 78, Fraction(-39), 80), (61, 58, Fraction(-58, 3), 61),
    (80, 79, Fraction(-79), 160), (2, 1, Fraction(-1), 4),
])  # fmt: skip
def test_numbers_of_the_specification(ring_teeth, satellite_teeth, ratio, petals):
    mechanism = Mechanism(ring_teeth, satellite_teeth, 1e-3, (A,))
    assert mechanism.gear_ratio == ratio
    assert mechanism.oldham_petals == petals


def test_petals_are_the_tips_of_the_path_of_the_coupling():
    """Count the places at distance e on the whole path, for every pair of small tooth numbers."""
    for ring_teeth in range(2, 19):
        for satellite_teeth in range(1, ring_teeth):
            mechanism = Mechanism(ring_teeth, satellite_teeth, 1.0, (A,))
            # The slide of the coupling on the arm is ±e when the rotor has turned by n π zs/zk
            # (the Oldham coupling turns zk/zs as fast against the cam).
            n = np.arange(4 * ring_teeth * satellite_teeth)
            tips = solve(mechanism, n * math.pi * satellite_teeth / ring_teeth).oldham_centre
            assert_close(np.hypot(*tips[:, 0].T), np.ones(n.size), 1e-9)
            places = {tuple(place) for place in np.rint(tips[:, 0] * 1e6).astype(int)}
            assert mechanism.oldham_petals == len(places)


def test_a_cycle_is_the_fewest_turns_after_which_positions_repeat():
    """Counted in rotor turns, for every pair of small tooth numbers."""
    for ring_teeth in range(2, 30):
        for satellite_teeth in range(1, ring_teeth):
            teeth = ring_teeth - satellite_teeth
            turns = next(n for n in range(1, 31) if n * teeth % satellite_teeth == 0)
            assert Mechanism(ring_teeth, satellite_teeth, 1.0, (A,)).cycle_turns == turns


@settings(max_examples=60)
@given(mechanisms(max_branches=1), st.floats(-10.0, 10.0), st.floats(-100.0, 100.0))
def test_satellite_rolls_on_the_ring_gear_without_slip(mechanism, angle, velocity):
    """Where the rolling circles touch, the satellite has no velocity."""
    state = solve(mechanism, angle, velocity)
    e = mechanism.eccentricity
    centre = state.satellite_centre[0]
    contact = centre / e * mechanism.ring_rolling_radius
    arm = contact - centre
    radius = mechanism.satellite_rolling_radius
    assert_close(np.hypot(*arm), radius, 1e-12 * mechanism.ring_rolling_radius)
    turning = state.output_velocity * np.array([-arm[1], arm[0]])
    assert_close(state.satellite_velocity[0] + turning, np.zeros(2), 1e-12 * e * abs(velocity))
