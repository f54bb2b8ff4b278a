# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Outlines fit each other, and poses agree with the 50-digit motion."""

import numpy as np
import oracle
import pytest
import shapely
from properties import numbers_of
from shapely import affinity

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.shape.outlines import BODIES, bodies, poses

MODULE = 0.0005  # m
ANGLES = [0.0, 0.7, -2.5, 40.0, 1234.5]


@pytest.mark.parametrize('rotor_angle', ANGLES)
def test_bodies_are_where_the_motion_says(mechanism, rotor_angle):
    e = mechanism.eccentricity
    expected = oracle.expected_motion(numbers_of(mechanism), oracle.rotor_angle_of(rotor_angle))
    for k, motion in enumerate(expected.branches):
        placed = poses(mechanism, rotor_angle, k)
        assert tuple(placed) == (*BODIES, 'force')
        satellite, oldham = placed['satellite'], placed['oldham']
        assert oracle.point_error(satellite.centre, motion.satellite_centre, e) <= 1e-12
        assert oracle.point_error(oldham.centre, motion.oldham_centre, e) <= 1e-12
        for body in ('satellite', 'oldham', 'output_shaft'):
            angle = placed[body].angle
            assert oracle.turn_angle_error(angle, expected.output_angle) <= 1e-12
        assert oracle.turn_angle_error(placed['rotor'].angle, rotor_angle) <= 1e-12
        for body in ('stator', 'rotor', 'output_shaft'):
            assert placed[body].centre.tolist() == [0.0, 0.0]
        assert placed['stator'].angle == 0.0


def test_poses_take_arrays_and_whole_turns(actuator):
    angles = np.array([[0.1, 2.0, 3.0], [-3.0, 0.0, 1.0]])
    many = poses(actuator, angles, 1, rotor_turns=[5, -7, 10**9])
    outline = bodies(actuator, MODULE, 1)['satellite'][0]
    assert many['satellite'].place(outline).shape == (2, 3, len(outline), 2)
    for i, j in np.ndindex(2, 3):
        one = poses(actuator, angles[i, j], 1, rotor_turns=[5, -7, 10**9][j])
        for body in BODIES:
            assert many[body].angle[i, j] == one[body].angle
            assert many[body].centre[i, j].tolist() == one[body].centre.tolist()


def test_borders_are_counterclockwise_and_holes_in_them_are_not(mechanism):
    for k in range(len(mechanism.branches)):
        for border, *holes in bodies(mechanism, MODULE, k).values():
            assert shapely.LinearRing(border).is_ccw
            assert not any(shapely.LinearRing(hole).is_ccw for hole in holes)
            assert all(map(shapely.Polygon(border).contains, map(shapely.Polygon, holes)))


def test_coupling_and_arm_are_drawn_if_the_slides_leave_room(actuator):
    assert tuple(bodies(actuator, MODULE)) == BODIES
    few_teeth = Mechanism(12, 9, 0.001, (Branch('a'),))
    assert tuple(bodies(few_teeth, MODULE)) == ('stator', 'satellite', 'rotor')


@pytest.mark.parametrize('eccentricity', [1e-300, 1e300])
def test_sizes_whose_squares_underflow_or_overflow_are_drawn(eccentricity):
    shapes = bodies(Mechanism(80, 76, eccentricity, (Branch('a'),)), eccentricity)
    assert tuple(shapes) == BODIES
    assert all(np.isfinite(outline).all() for outlines in shapes.values() for outline in outlines)


@pytest.mark.parametrize('rotor_angle', ANGLES)
@pytest.mark.parametrize('k', [0, 1])
def test_parts_fit_each_other(actuator, rotor_angle, k):
    """Cam in the bore, keys of the coupling in the slots of satellite and arm, all in the gear."""
    shapes, placed = bodies(actuator, MODULE, k), poses(actuator, rotor_angle, k)
    parts = {
        body: [shapely.Polygon(placed[body].place(outline)) for outline in outlines]
        for body, outlines in shapes.items()
    }
    gear, bore, *slots, _ = parts['satellite']
    cam, shaft = parts['rotor']
    assert cam.symmetric_difference(bore).area < 1e-3 * bore.area  # but for the corners
    assert shapely.distance(shaft.centroid, shapely.Point(0.0, 0.0)) < 1e-12
    # Of the coupling, the keys on its x axis are in the slots: they fill their width.
    coupling = parts['oldham'][0]
    o4, angle = shapely.Point(placed['oldham'].centre), float(placed['oldham'].angle)
    level = affinity.rotate(coupling, -angle, o4, use_radians=True)
    for slot, sign in zip(slots, (1.0, -1.0), strict=True):
        open_ = affinity.rotate(slot, -angle, o4, use_radians=True)
        end = o4.x + sign * (level.bounds[2] - o4.x)
        tip = level.intersection(shapely.box(end - 1e-5, -1.0, end + 1e-5, 1.0))
        assert open_.buffer(1e-9).contains(tip)
        assert tip.bounds[1::2] == pytest.approx(open_.bounds[1::2], abs=1e-9)
    # The coupling has room in the arm, and the arm in the satellite, and that in the ring gear.
    rim, jaws = parts['output_shaft']
    assert jaws.buffer(1e-9).contains(coupling)
    reach = np.max(np.hypot(*np.array(rim.exterior.coords).T))
    assert reach < np.min(np.hypot(*np.array(gear.exterior.coords).T))
    ring = np.max(np.hypot(*np.array(parts['stator'][1].exterior.coords).T))
    assert np.max(np.hypot(*np.array(gear.exterior.coords).T)) <= ring * (1.0 + 1e-12)
