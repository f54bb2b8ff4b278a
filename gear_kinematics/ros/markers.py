# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The mechanism as a visualization_msgs/MarkerArray, for RViz and Foxglove.

The outlines of the teeth have thousands of points, which would have to be sent again to move them.
Instead, each marker is locked to the frame of its link: the shapes are sent once, and /tf from
robot_state_publisher moves them. All are in one message, because after a jump in a recording
Foxglove shows only the last message of a topic.
"""

import math
from collections.abc import Iterator
from functools import cached_property

import numpy as np
from geometry_msgs.msg import Point, Pose, Vector3
from rclpy.serialization import serialize_message
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from gear_kinematics.kinematics import Mechanism, solve
from gear_kinematics.shape import teeth
from gear_kinematics.shape.outlines import Array, turned
from gear_kinematics.shape.solids import FACE_WIDTH
from gear_kinematics.shape.visuals import COLOURS

_REPEAT_BANDWIDTH = 5e3  # bytes/s on average
_OUTLINE_WIDTH = 0.2  # modules


class Markers:
    """Shows the mechanism; the message is created on first use."""

    def __init__(self, mechanism: Mechanism, *, module: float, frame_prefix: str) -> None:
        """Set the mechanism to show, and the module of its teeth, m."""
        self._mechanism = mechanism
        self._module = module
        self._frame_prefix = frame_prefix
        self._due_at = -math.inf

    def due(self, now: float) -> bytes | None:
        """Return the message if it is due at a time of a monotonic clock, s.

        It is repeated periodically, because RViz drops its markers when it is reset, when its
        fixed frame changes and when time jumps back.
        """
        if now < self._due_at:
            return None
        self._due_at = now + len(self._message) / _REPEAT_BANDWIDTH
        return self._message

    def repeat(self) -> None:
        """Make the message due now, for a new viewer."""
        self._due_at = -math.inf

    @cached_property
    def _message(self) -> bytes:
        markers = list(self._shapes())
        for number, marker in enumerate(markers):
            marker.id = number
            marker.header.frame_id = self._frame_prefix + marker.header.frame_id
        return bytes(serialize_message(MarkerArray(markers=markers)))

    def _shapes(self) -> Iterator[Marker]:
        """Yield each shape in the frame of its link, without prefix.

        Along the axis, the coupling is next to the satellite, and then the arm.
        """
        mechanism, face = self._mechanism, FACE_WIDTH
        ring, satellite = teeth.outlines(mechanism, self._module)
        line = _OUTLINE_WIDTH * self._module
        radius = float(np.hypot(*satellite.T).min())
        bar = 0.1 * radius
        axial = [branch.axial_position for branch in mechanism.branches]
        middle, length = 0.5 * (min(axial) + max(axial)), max(axial) - min(axial) + face
        yield _cylinder('rotor', 'rotor', 'rotor', 0.4 * radius, length, middle)
        yield _cylinder('output', 'output', 'output_shaft', 0.2 * radius, length + face, middle)
        # With the rotor at 0, the frames of rotor and stator coincide.
        cams = solve(mechanism, 0.0).satellite_centre.tolist()
        for branch, (x, y) in zip(mechanism.branches, cams, strict=True):
            z, on_satellite = branch.axial_position, f'satellite_{branch.name}'
            turned_ring = turned(ring, teeth.ring_phase(mechanism, branch))
            yield _line('ring', 'stator', 'stator', _closed(turned_ring), line, z + 0.5 * face)
            cam = _cylinder('cam', 'rotor', 'rotor', radius, 1.1 * face, z)
            cam.pose.position.x, cam.pose.position.y = x, y
            yield cam
            yield _cylinder('satellite', 'satellite', on_satellite, 2.0 * radius, face, 0.0)
            outline = _closed(satellite)
            yield _line('satellite', 'satellite', on_satellite, outline, line, 0.5 * face)
            slot, arm = (1.8 * radius, bar, 0.1 * face), (bar, 1.8 * radius, 0.2 * face)
            yield _marker(Marker.CUBE, 'slot', 'stator', on_satellite, slot, 0.55 * face)
            on_oldham = f'oldham_{branch.name}'
            yield _cylinder('oldham', 'oldham', on_oldham, 0.7 * radius, 0.2 * face, 0.7 * face)
            yield _marker(Marker.CUBE, 'arm', 'output', 'output_shaft', arm, z + 0.9 * face)


def _closed(outline: Array) -> Array:
    return np.concatenate([outline, outline[:1]])


def _line(kind: str, colour: str, link: str, points: Array, width: float, z: float) -> Marker:
    marker = _marker(Marker.LINE_STRIP, kind, colour, link, (width, 0.0, 0.0), z)
    marker.points = [Point(x=x, y=y) for x, y in points.tolist()]
    return marker


def _cylinder(
    kind: str, colour: str, link: str, diameter: float, height: float, z: float
) -> Marker:
    return _marker(Marker.CYLINDER, kind, colour, link, (diameter, diameter, height), z)


def _marker(
    shape: int, kind: str, colour: str, link: str, scale: tuple[float, float, float], z: float
) -> Marker:
    """Create a marker on the z axis of a link, locked to it, in the namespace `kind`."""
    red, green, blue, _ = map(float, COLOURS[colour].split())
    return Marker(
        header=Header(frame_id=link),
        ns=kind,
        type=shape,
        pose=Pose(position=Point(z=z)),
        scale=Vector3(**dict(zip('xyz', scale, strict=True))),
        color=ColorRGBA(r=red, g=green, b=blue, a=1.0),
        frame_locked=True,
    )
