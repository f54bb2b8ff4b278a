# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Outlines of the teeth: they touch and never overlap, as shapely sees them.

Expected values come from shapely's areas and from the worked example of an internal gear pair in
SDP/SI, Elements of Metric Gear Technology, table 5-1.
"""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from properties import mechanisms
from shapely import affinity

from gear_kinematics.kinematics import Branch, Mechanism, MechanismError, solve
from gear_kinematics.shape.teeth import (
    InterferenceError,
    Outlines,
    ToothPair,
    outlines,
    ring_phase,
    tooth_pair,
)

MODULE = 0.0005
HALF_PLAY = 0.01 * MODULE
"""On either side of a tooth, along the flank's normal."""


def pair_of(ring_teeth: int, satellite_teeth: int, stretch: float) -> Mechanism:
    """Make a mechanism whose eccentricity is so many times that of gears without shift."""
    eccentricity = stretch * 0.5 * MODULE * (ring_teeth - satellite_teeth)
    branches = (Branch('a'), Branch('b', math.pi), Branch('c', -1.2))
    return Mechanism(ring_teeth, satellite_teeth, eccentricity, branches)


MESHING = [
    pair_of(80, 76, 1.1),  # the default actuator
    pair_of(80, 76, 1.05),
    pair_of(80, 76, 1.35),
    pair_of(80, 78, 1.2),
    pair_of(61, 58, 1.2),
    pair_of(100, 99, 1.8),
    pair_of(30, 20, 1.0),
    pair_of(12, 9, 1.2),
]


def name(mechanism: Mechanism) -> str:
    return f'{mechanism.ring_teeth}-{mechanism.satellite_teeth}-{mechanism.eccentricity:.6f}'


def mesh_cycle(mechanism: Mechanism) -> np.ndarray:
    """Rotor angles over a cycle of the mesh (one ring tooth), the first turns and later ones."""
    cycle = np.linspace(0.0, math.tau / mechanism.ring_teeth, 16, endpoint=False)
    return np.concatenate([cycle, 5.0 + cycle[::4], -777.0 + cycle[::4]])


def overlaps(
    mechanism: Mechanism, shapes: Outlines, branch: int, rotor_angles, turn: float = 0.0
) -> list[float]:
    """Compute the area in which ring gear and satellite overlap at some angles, in modules².

    `turn` turns the satellite about its own centre.
    """
    phase = ring_phase(mechanism, mechanism.branches[branch])
    space = affinity.rotate(shapely.Polygon(shapes.ring), phase, (0, 0), use_radians=True)
    satellite = shapely.Polygon(shapes.satellite)
    assert space.is_valid
    assert satellite.is_valid
    state = solve(mechanism, rotor_angles)
    places = zip(state.output_angle, state.satellite_centre[:, branch], strict=True)
    return [
        affinity.translate(
            affinity.rotate(satellite, angle + turn, (0, 0), use_radians=True), *centre
        )
        .difference(space)
        .area
        / MODULE**2
        for angle, centre in places
    ]


@pytest.mark.parametrize('mechanism', MESHING, ids=name)
def test_teeth_never_overlap(mechanism):
    shapes = outlines(mechanism, MODULE)
    for branch in range(3):
        areas = overlaps(mechanism, shapes, branch, mesh_cycle(mechanism))
        assert len(areas) == 24
        assert max(areas) <= 1e-9


@pytest.mark.parametrize('mechanism', MESHING, ids=name)
@pytest.mark.parametrize('sense', [1.0, -1.0])
def test_teeth_touch_on_both_sides_but_for_the_play(mechanism, sense):
    shapes, angles = outlines(mechanism, MODULE), mesh_cycle(mechanism)[::3]
    base_radius = 0.5 * MODULE * mechanism.satellite_teeth * math.cos(math.radians(20.0))
    turn = sense * HALF_PLAY / base_radius
    for branch in range(3):
        assert min(overlaps(mechanism, shapes, branch, angles, 1.5 * turn)) > 1e-6
        assert max(overlaps(mechanism, shapes, branch, angles, 0.5 * turn)) <= 1e-9


def test_teeth_that_would_interfere_are_shortened():
    """Teeth of full height overlap here, and a little more height than chosen does too."""
    mechanism = pair_of(80, 76, 1.05)
    pair = tooth_pair(mechanism, MODULE)
    assert pair.addendum < 0.9
    for addendum, least in ((1.0, 1e-3), (pair.addendum + 0.06, 1e-6)):
        higher = ToothPair(mechanism, MODULE, addendum)
        assert higher.tip_interference_margin < 0.0
        assert max(overlaps(mechanism, higher.outlines, 0, mesh_cycle(mechanism))) > least


def test_numbers_of_the_handbooks_example():
    mechanism = Mechanism(24, 16, 0.0131683, (Branch('a'),))
    pair = tooth_pair(mechanism, 0.003)
    assert math.degrees(pair.working_pressure_angle) == pytest.approx(31.0937, abs=1e-3)
    assert pair.ring_profile_shift == pytest.approx(0.5, abs=1e-4)
    assert 2.0 * pair.satellite.base_radius == pytest.approx(0.045105, abs=1e-6)
    assert 2.0 * pair.ring.base_radius == pytest.approx(0.067658, abs=1e-6)
    assert 2.0 * pair.satellite_tip_radius == pytest.approx(0.054)
    # Slightly larger than in the table, which would touch below the satellite's base circle.
    assert 0.069 < 2.0 * pair.ring_tip_radius < 0.06902
    assert pair.tip_interference_margin > 0.0
    # From its angles, as the sum for both gears: ISO 21771.
    satellite, ring = (
        math.tan(math.acos(base / tip)) for base, tip in ((45.105, 54.0), (67.658, 69.0))
    )
    working = math.tan(math.radians(31.0937))
    ratio = (16 * (satellite - working) - 24 * (ring - working)) / math.tau
    assert pair.contact_ratio == pytest.approx(ratio, abs=5e-3)


@pytest.mark.parametrize(
    ('mechanism', 'words'),
    [
        (Mechanism(80, 76, 0.0009, (Branch('a'),)), ['0.0009 m', 'greater than 0.000939693 m']),
        (pair_of(80, 76, 1.0), ['0.001 m', 'margin of -0.0105 rad', 'contact ratio of 0.994']),
        (pair_of(80, 76, 1.5), ['0.0015 m', 'contact ratio of 0.691']),
        (pair_of(80, 76, 5.0), ['0.005 m', 'contact ratio of -7.221']),
    ],
    ids=['base circles', 'tips', 'contact', 'far'],
)
def test_teeth_that_cannot_mesh_are_refused_with_the_numbers(mechanism, words):
    with pytest.raises(InterferenceError) as caught:
        tooth_pair(mechanism, MODULE)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize('module', [0.0, -1.0, math.nan, math.inf])
def test_module_must_be_a_length(module):
    with pytest.raises(MechanismError, match='module'):
        outlines(pair_of(80, 76, 1.1), module)


def test_too_many_teeth_are_drawn_as_circles():
    mechanism = pair_of(100_000, 99_998, 1.35)
    assert tooth_pair(mechanism, MODULE).contact_ratio > 1.0
    assert sum(map(len, outlines(mechanism, MODULE))) < 10_000


@settings(max_examples=50)
@given(mechanisms(max_branches=1), st.floats(-5.0, 0.0))
def test_every_mechanism_has_outlines(mechanism, exponent):
    for outline in outlines(mechanism, mechanism.eccentricity * 10.0**exponent):
        polygon = shapely.Polygon(outline)
        assert polygon.is_valid
        assert polygon.exterior.is_ccw
        assert polygon.contains(shapely.Point(0.0, 0.0))
