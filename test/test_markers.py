"""Markers: bodies where the matrix method puts them, teeth that mesh, and no message too many."""

import math

import numpy as np
import pytest
import shapely
from live import START, live_node, rotor_state
from rclpy.qos import QoSProfile
from shapely import affinity
from shown_markers import MODULE, all_at, sample_at, shown
from visualization_msgs.msg import Marker, MarkerArray

from gear_kinematics.kinematics import Branch, Mechanism, matrix_method
from gear_kinematics.markers import Markers

ANGLES = [0.0, 0.3, -2.0, 59.0, -119.0, 1e5]


def of_kind(markers: list[Marker], kind: str, shape: int | None = None) -> list[Marker]:
    return [m for m in markers if m.ns == kind and shape in {None, m.type}]


def yaw(marker: Marker) -> float:
    orientation = marker.pose.orientation
    assert (orientation.x, orientation.y) == (0.0, 0.0)
    return 2.0 * math.atan2(orientation.z, orientation.w)


def assert_at(marker: Marker, centre, angle: float) -> None:
    position = marker.pose.position
    np.testing.assert_allclose([position.x, position.y], centre, rtol=0.0, atol=1e-12)
    assert math.remainder(yaw(marker) - angle, math.tau) == pytest.approx(0.0, abs=1e-9)


def polygon(marker: Marker, turn: float = 0.0) -> shapely.Polygon:
    """Give the outline of a marker where a viewer draws it, but for a turn about its centre."""
    points = [(point.x, point.y) for point in marker.points]
    assert points[0] == points[-1]
    turned = affinity.rotate(shapely.Polygon(points), yaw(marker) + turn, (0, 0), use_radians=True)
    return affinity.translate(turned, marker.pose.position.x, marker.pose.position.y)


@pytest.mark.parametrize('rotor_angle', ANGLES)
def test_bodies_are_where_the_matrix_method_puts_them(mechanism, rotor_angle):
    markers = all_at(mechanism, rotor_angle)
    state = matrix_method.solve(mechanism, rotor_angle)
    phi5 = float(state.output_angle)
    centres = {
        'cam': (state.satellite_centre, rotor_angle),
        'satellite': (state.satellite_centre, phi5),
        'slot': (state.satellite_centre, phi5),
        'oldham': (state.oldham_centre, phi5),
        'arm': (np.zeros_like(state.oldham_centre), phi5),
    }
    for kind, (places, angle) in centres.items():
        [*of_this_kind] = of_kind(markers, kind)
        per_branch = len(of_this_kind) // len(mechanism.branches)
        for k, branch in enumerate(mechanism.branches):
            for marker in of_this_kind[k * per_branch : (k + 1) * per_branch]:
                assert_at(marker, places[k], angle)
                assert abs(marker.pose.position.z - branch.axial_position) <= 0.01
    for kind, angle in (('rotor', rotor_angle), ('output', phi5)):
        [marker] = of_kind(markers, kind)
        assert_at(marker, (0.0, 0.0), angle)


@pytest.mark.parametrize('rotor_angle', ANGLES)
def test_teeth_mesh_as_drawn(actuator, rotor_angle):
    markers = all_at(actuator, rotor_angle)
    rings, satellites = (of_kind(markers, k, Marker.LINE_STRIP) for k in ('ring', 'satellite'))
    assert len(rings) == len(satellites) == 2
    for ring, satellite in zip(rings, satellites, strict=True):
        assert ring.pose.position.z == satellite.pose.position.z
        space = polygon(ring)
        assert polygon(satellite).difference(space).area <= 1e-9 * MODULE**2
        assert polygon(satellite, 1e-3).difference(space).area > 1e-3 * MODULE**2


@pytest.mark.parametrize('rotor_angle', ANGLES)
def test_couplings_are_on_their_roses(mechanism, rotor_angle):
    markers = all_at(mechanism, rotor_angle)
    for rose, oldham in zip(of_kind(markers, 'rose'), of_kind(markers, 'oldham'), strict=True):
        path = shapely.LineString([(point.x, point.y) for point in rose.points])
        centre = shapely.Point(oldham.pose.position.x, oldham.pose.position.y)
        assert path.distance(centre) < 0.02 * mechanism.eccentricity


def test_every_marker_is_one_of_its_own_in_the_stators_frame(mechanism):
    markers = all_at(mechanism, 1.0, 'left_')
    names = [(marker.ns, marker.id) for marker in markers]
    assert len(names) == len(set(names)) == 2 + 8 * len(mechanism.branches)
    assert {marker.header.frame_id for marker in markers} == {'left_stator'}
    assert all(marker.action == Marker.ADD and marker.color.a == 1.0 for marker in markers)
    for marker in markers:
        sizes = [marker.scale.x, marker.scale.y, marker.scale.z]
        assert min(sizes[:1] if marker.type == Marker.LINE_STRIP else sizes) > 0.0


def test_what_stays_is_sent_once_a_second_and_what_moves_when_it_moves(actuator):
    markers = Markers(actuator, module=MODULE, frame_prefix='')
    first, second = sample_at(0.1), sample_at(0.2)
    kinds = [
        {marker.ns for marker in shown(markers, sample, now)}
        for sample, now in (
            (None, 5.0), (None, 5.1), (first, 5.2), (first, 5.3), (second, 5.4), (second, 6.1),
        )
    ]  # fmt: skip
    fixed = {'ring', 'rose'}
    moving = {'rotor', 'output', 'cam', 'satellite', 'slot', 'oldham', 'arm'}
    assert kinds == [fixed, set(), moving, set(), moving, fixed | moving]


def test_markers_of_any_mechanism_fit_into_messages():
    many = Mechanism(100_000, 99_999, 0.0011, tuple(Branch(name) for name in 'abcd'))
    markers = Markers(many, module=MODULE, frame_prefix='')
    assert sum(map(len, markers.due(sample_at(1.0), 0.0))) < 2**20


@pytest.mark.parametrize('executor', ['events', 'single_threaded'])
def test_node_shows_the_mechanism_to_who_looks_now_or_later(executor, tmp_path, actuator):
    expected = {(marker.ns, marker.id): marker for marker in all_at(actuator, 0.7)}
    with live_node(tmp_path, '-p', f'executor:={executor}') as live:
        live.peer.connect()
        live.peer.send(rotor_state(START, ['rotor'], [0.7]))
        for viewer in ('first', 'second'):
            subscription = live.peer.listen(MarkerArray, viewer, QoSProfile(depth=10), 'markers')

            def seen(messages=live.peer.received[viewer]) -> dict[tuple[str, int], Marker]:
                return {(marker.ns, marker.id): marker for m in messages for marker in m.markers}

            live.peer.wait_until(lambda seen=seen: seen() == expected, f'what the {viewer} sees')
            live.peer.node.destroy_subscription(subscription)
