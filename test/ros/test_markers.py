# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Markers: bodies placed as by the matrix method, meshing teeth, and few messages."""

import math

import numpy as np
import pytest
import shapely
from geometry_msgs.msg import Point, Pose, Quaternion
from links import link_poses, read
from live import LATCHED, START, live_node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from shapely import affinity
from visualization_msgs.msg import Marker, MarkerArray
from wire import encoded

from gear_kinematics.kinematics import Branch, Mechanism, RotorSample, matrix_method, split_turns
from gear_kinematics.ros.markers import Markers
from gear_kinematics.shape.urdf import urdf
from gear_kinematics.state.state_messages import StateMessages
from gear_kinematics.wire.topics import JOINT_STATES

MODULE = 0.0005
VOLATILE = QoSProfile(depth=10)
ANGLES = [0.3, -119.0, 1e5]


def sent(mechanism: Mechanism, prefix: str = '') -> list[Marker]:
    """Return the markers as they are sent, in the frames of their links."""
    data = Markers(mechanism, module=MODULE, frame_prefix=prefix).due(0.0)
    return deserialize_message(data, MarkerArray).markers


def all_at(mechanism: Mechanism, rotor_angle: float) -> list[Marker]:
    """Return the markers where a viewer shows them, with poses in the stator's frame.

    The links are where URDF and mechanism_joint_states put them, as robot_state_publisher does.
    """
    names = {'output_joint': 'output_shaft', 'frame_prefix': ''}
    _, joints = read(urdf(mechanism, module=MODULE, **names))
    sample = RotorSample(START, split_turns(rotor_angle), None, None)
    [data] = encoded(StateMessages(mechanism, **names), sample, [JOINT_STATES]).values()
    states = deserialize_message(data, JointState)
    links = link_poses(joints, dict(zip(states.name, states.position, strict=True)))
    markers = sent(mechanism)
    for marker in markers:
        link, place = links[marker.header.frame_id], marker.pose.position
        assert marker.pose.orientation == Quaternion()
        x, y, z, _ = link @ [place.x, place.y, place.z, 1.0]
        half = 0.5 * math.atan2(link[1, 0], link[0, 0])
        turned = Quaternion(z=math.sin(half), w=math.cos(half))
        marker.pose = Pose(position=Point(x=x, y=y, z=z), orientation=turned)
    return markers


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
    """The outline of a marker as drawn by a viewer, except for a turn about its centre."""
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
        assert ring.pose.position.z == pytest.approx(satellite.pose.position.z, abs=1e-12)
        space = polygon(ring)
        assert polygon(satellite).difference(space).area <= 1e-9 * MODULE**2
        assert polygon(satellite, 1e-3).difference(space).area > 1e-3 * MODULE**2


def test_every_marker_is_unique_and_locked_to_a_link(mechanism):
    markers = sent(mechanism, 'left_')
    names = [(marker.ns, marker.id) for marker in markers]
    assert len(names) == len(set(names)) == 2 + 7 * len(mechanism.branches)
    links, _ = read(
        urdf(mechanism, module=MODULE, output_joint='output_shaft', frame_prefix='left_')
    )
    assert {marker.header.frame_id for marker in markers} == set(links)
    assert all(marker.frame_locked for marker in markers)
    assert all(marker.action == Marker.ADD and marker.color.a == 1.0 for marker in markers)
    for marker in markers:
        sizes = [marker.scale.x, marker.scale.y, marker.scale.z]
        assert min(sizes[:1] if marker.type == Marker.LINE_STRIP else sizes) > 0.0


def test_message_is_due_at_first_and_for_every_new_viewer(actuator):
    markers = Markers(actuator, module=MODULE, frame_prefix='')
    message = markers.due(5.0)
    assert message
    assert [markers.due(now) for now in (5.0, 5.1, 10.0)] == [None] * 3
    markers.repeat()
    assert markers.due(10.0) == message
    assert markers.due(10.1) is None


def test_viewers_are_sent_less_than_20_kilobytes_a_second(mechanism):
    markers = Markers(mechanism, module=MODULE, frame_prefix='')
    minutes, rate = 10, 30
    messages = [markers.due(tick / rate) for tick in range(minutes * 60 * rate)]
    sizes = [len(message) for message in messages if message]
    assert sum(sizes) < 20e3 * minutes * 60
    assert len(sizes) >= minutes, 'viewers that were reset have to wait for long'


def test_markers_of_any_mechanism_fit_into_messages():
    many = Mechanism(100_000, 99_999, 0.0011, tuple(Branch(name) for name in 'abcd'))
    assert len(Markers(many, module=MODULE, frame_prefix='').due(0.0)) < 2**20


@pytest.mark.live
def test_node_shows_the_mechanism_to_present_and_later_viewers(tmp_path, actuator):
    # With so many teeth, the repetition comes too late for a test.
    large = Mechanism(400, 396, actuator.eccentricity, actuator.branches)
    expected = MarkerArray(markers=sent(large))
    teeth = '-p', 'ring_teeth:=400', '-p', 'satellite_teeth:=396'
    with live_node(tmp_path, *teeth) as live:
        for viewer, qos in (('first', VOLATILE), ('later', VOLATILE), ('latched', LATCHED)):
            subscription = live.peer.listen(MarkerArray, viewer, qos, 'markers')
            received = live.peer.received[viewer]
            live.peer.wait_until(lambda messages=received: messages, f'what the {viewer} sees')
            assert received[0] == expected
            live.peer.node.destroy_subscription(subscription)
