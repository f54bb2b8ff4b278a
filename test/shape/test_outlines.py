"""Outlines fit each other, and poses agree with the 50-digit motion."""

import math

import numpy as np
import oracle
import pytest
from properties import numbers_of

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.shape.outlines import BODIES, bodies, poses

MODULE = 0.0005  # m
ANGLES = [0.0, 0.7, -2.5, 40.0, 1234.5]


def area(outline) -> float:
    """Area by the shoelace formula; negative if clockwise."""
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def centroid(outline) -> np.ndarray:
    """Centroid of the area."""
    (x, y), (next_x, next_y) = outline.T, np.roll(outline, -1, axis=0).T
    parts = x * next_y - y * next_x
    return np.array([np.sum((x + next_x) * parts), np.sum((y + next_y) * parts)]) / (
        6.0 * area(outline)
    )


@pytest.mark.parametrize('rotor_angle', ANGLES)
def test_bodies_are_where_the_motion_says(mechanism, rotor_angle):
    e = mechanism.eccentricity
    expected = oracle.expected_motion(numbers_of(mechanism), oracle.rotor_angle_of(rotor_angle))
    for k, motion in enumerate(expected.branches):
        placed = poses(mechanism, rotor_angle, k)
        assert tuple(placed) == BODIES
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


def test_place_turns_counterclockwise_and_then_moves(actuator):
    quarter = poses(actuator, -19.0 * math.pi / 2)['satellite']  # the output turns by π/2
    [placed] = quarter.place(np.array([[2.0, 1.0]]))
    # The rotor has turned 4 3/4 times clockwise: the cam points from +y to 90° counterclockwise.
    assert placed == pytest.approx([-1.0 - 0.0011, 2.0], abs=1e-12)


def test_borders_are_counterclockwise_and_holes_in_them_are_not(mechanism):
    for k in range(len(mechanism.branches)):
        for border, *holes in bodies(mechanism, MODULE, k).values():
            assert area(border) > 0.0
            assert all(-area(border) < area(hole) < 0.0 for hole in holes)


def test_coupling_and_arm_are_drawn_if_the_slides_leave_room(actuator):
    assert tuple(bodies(actuator, MODULE)) == BODIES
    few_teeth = Mechanism(12, 9, 0.001, (Branch('a'),))
    assert tuple(bodies(few_teeth, MODULE)) == ('stator', 'satellite', 'rotor')
    for border, *holes in bodies(few_teeth, MODULE).values():
        assert all(-area(border) < area(hole) < 0.0 for hole in holes)


@pytest.mark.parametrize('eccentricity', [1e-300, 1e300])
def test_sizes_whose_squares_underflow_or_overflow_are_drawn(eccentricity):
    shapes = bodies(Mechanism(80, 76, eccentricity, (Branch('a'),)), eccentricity)
    assert tuple(shapes) == BODIES
    assert all(np.isfinite(outline).all() for outlines in shapes.values() for outline in outlines)


@pytest.mark.parametrize('rotor_angle', ANGLES)
def test_parts_fit_each_other(actuator, rotor_angle):
    """Cam in the bore, keys of the coupling in the slots of satellite and arm, all in the gear."""
    e = actuator.eccentricity
    for k in range(2):
        shapes, placed = bodies(actuator, MODULE, k), poses(actuator, rotor_angle, k)

        def at(body, hole=0, shapes=shapes, placed=placed):
            return placed[body].place(shapes[body][hole])

        o3, o4 = placed['satellite'].centre, placed['oldham'].centre
        assert centroid(at('rotor')) == pytest.approx(o3, abs=1e-12)
        assert centroid(at('satellite', 1)) == pytest.approx(o3, abs=1e-12)
        assert abs(area(at('rotor'))) == pytest.approx(abs(area(at('satellite', 1))), rel=1e-12)
        assert centroid(at('rotor', 1)) == pytest.approx([0.0, 0.0], abs=1e-12)
        assert centroid(at('oldham')) == pytest.approx(o4, abs=1e-12)
        # In the frame of the output the keys are along x and y, as the slots are.
        angle = float(placed['output_shaft'].angle)
        to_output = np.array(
            [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
        )
        coupling = (at('oldham') - o4) @ to_output
        reach = np.max(coupling[:, 0])
        key = np.max(coupling[coupling[:, 0] > reach - 1e-9, 1])
        keys = (at('oldham') - o3) @ to_output
        for hole, sign in ((2, 1.0), (3, -1.0)):
            slot = (at('satellite', hole) - o3) @ to_output
            assert np.ptp(slot[:, 1]) == pytest.approx(2.0 * key, rel=1e-9)
            assert np.mean(slot[:, 1]) == pytest.approx(0.0, abs=1e-12)
            assert np.max(sign * slot[:, 0]) > np.max(sign * keys[:, 0])
        # The arm's inner border leaves the coupling room: beyond its keys, and beside it.
        arm = at('output_shaft', 1) @ to_output
        assert np.max(arm[np.abs(arm[:, 0]) <= 1.01 * key, 1]) > reach + e
        satellite, stator = at('satellite'), at('stator', 1)
        assert np.max(np.hypot(*at('output_shaft').T)) < np.min(np.hypot(*(satellite).T))
        assert np.max(np.hypot(*satellite.T)) <= np.max(np.hypot(*stator.T)) * (1.0 + 1e-12)
