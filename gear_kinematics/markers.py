"""The mechanism as a visualization_msgs/MarkerArray, for RViz and Foxglove.

Every pose is in the frame `stator`. Markers locked to the frames of the links would have to be
sent only once, but could not be seen without robot_state_publisher. What moves is serialised once
instead, outlines of teeth having thousands of points, and from then on only poses are written
into the bytes. What stays is sent once a second, for those who come later. Stamps are zero, which
viewers take for now.
"""

import math
import struct
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from numpy.typing import NDArray
from rclpy.serialization import serialize_message
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from gear_kinematics import teeth
from gear_kinematics.description import COLOURS, FACE_WIDTH
from gear_kinematics.drawing import roses, turned
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.rotor_input import RotorSample

Array = NDArray[np.float64]

_REPEAT = 1.0  # s, after which everything is sent again
_OUTLINE_WIDTH = 0.2  # modules
_ROSE_WIDTH = 0.03  # eccentricities
_PETAL_POINTS = 24
_MOST_PETALS = 100  # of a rose; more could not be told apart
_POSE = struct.Struct('=7d')


class Markers:
    """Shows the mechanism; nothing is laid out before somebody looks."""

    def __init__(self, mechanism: Mechanism, *, module: float, frame_prefix: str) -> None:
        """Take what is to be shown; the module is that of the teeth, m."""
        self._mechanism = mechanism
        self._module = module
        self._frame_id = frame_prefix + 'stator'
        self._shown: RotorSample | None = None
        self._repeat_at = -math.inf

    def due(self, sample: RotorSample | None, now: float) -> Iterator[bytes]:
        """Yield the messages that bring every viewer up to date.

        Args:
            sample: the last one, if there was any.
            now: the time on any clock that does not jump, s.
        """
        repeat = now >= self._repeat_at
        if repeat:
            self._repeat_at = now + _REPEAT
            yield self._fixed
        if sample is not None and (repeat or sample is not self._shown):
            self._shown = sample
            yield self._moving.encode(_places(self._mechanism, sample))

    @cached_property
    def _outlines(self) -> teeth.Outlines:
        return teeth.outlines(self._mechanism, self._module)

    @cached_property
    def _fixed(self) -> bytes:
        """The ring gears, and the roses on which the centres of the Oldham couplings move."""
        line, thin = _OUTLINE_WIDTH * self._module, _ROSE_WIDTH * self._mechanism.eccentricity
        petals = min(self._mechanism.oldham_petals, _MOST_PETALS)
        paths = roses(self._mechanism, petals, _PETAL_POINTS).swapaxes(0, 1)
        markers = []
        for branch, rose in zip(self._mechanism.branches, paths, strict=True):
            outline = turned(self._outlines.ring, teeth.ring_phase(self._mechanism, branch))
            z = branch.axial_position
            markers += [
                _line('ring', 'stator', _closed(outline), line, z + 0.5 * FACE_WIDTH),
                _line('rose', 'oldham', rose, thin, z + 1.2 * FACE_WIDTH),
            ]
        return self._serialised(markers)

    @cached_property
    def _moving(self) -> '_Template':
        """Rotor and cams, satellites, Oldham couplings, output shaft and arms.

        Along the axis, each satellite carries its coupling, and that the arm.
        """
        outline = _closed(self._outlines.satellite)
        line, radius = _OUTLINE_WIDTH * self._module, float(np.hypot(*outline.T).min())
        axial = [branch.axial_position for branch in self._mechanism.branches]
        middle, length = 0.5 * (min(axial) + max(axial)), max(axial) - min(axial) + FACE_WIDTH
        parts = [
            ('rotor', _cylinder('rotor', 'rotor', 0.4 * radius, length, middle)),
            ('output', _cylinder('output', 'output', 0.2 * radius, length + FACE_WIDTH, middle)),
        ]
        for branch in self._mechanism.branches:
            z, face, bar = branch.axial_position, FACE_WIDTH, 0.1 * radius
            cam, satellite, oldham = (
                f'{kind}_{branch.name}' for kind in ('cam', 'satellite', 'oldham')
            )
            parts += [
                (cam, _cylinder('cam', 'rotor', radius, 1.1 * face, z)),
                (satellite, _cylinder('satellite', 'satellite', 2.0 * radius, face, z)),
                (satellite, _line('satellite', 'satellite', outline, line, z + 0.5 * face)),
                (
                    satellite,
                    _box('slot', 'stator', (1.8 * radius, bar, 0.1 * face), z + 0.55 * face),
                ),
                (oldham, _cylinder('oldham', 'oldham', 0.7 * radius, 0.2 * face, z + 0.7 * face)),
                ('output', _box('arm', 'output', (bar, 1.8 * radius, 0.2 * face), z + 0.9 * face)),
            ]
        # Orientations that no other bytes are like show where the poses are.
        for number, (_, marker) in enumerate(parts):
            marker.pose.orientation = Quaternion(x=1e300, y=1e300, z=1e300, w=float(number))
        data = self._serialised([marker for _, marker in parts])
        slots = []
        for place, marker in parts:
            pose = _POSE.pack(
                0.0, 0.0, z := marker.pose.position.z, 1e300, 1e300, 1e300, marker.id
            )
            slots.append(_Slot(place, z, data.index(pose)))
        return _Template(bytearray(data), slots)

    def _serialised(self, markers: Sequence[Marker]) -> bytes:
        for number, marker in enumerate(markers):
            marker.header.frame_id, marker.id = self._frame_id, number
        return bytes(serialize_message(MarkerArray(markers=markers)))


class _Slot(NamedTuple):
    """A pose in the bytes of a template."""

    place: str
    z: float
    offset: int


class _Template(NamedTuple):
    """A serialised MarkerArray, into which poses are written."""

    buffer: bytearray
    slots: list[_Slot]

    def encode(self, places: Mapping[str, '_Place']) -> bytes:
        """The message with every marker at its place."""
        for name, z, offset in self.slots:
            (x, y), angle = places[name]
            half = 0.5 * angle
            pose = (x, y, z, 0.0, 0.0, math.sin(half), math.cos(half))
            _POSE.pack_into(self.buffer, offset, *pose)
        return bytes(self.buffer)


class _Place(NamedTuple):
    """Where a body is in the plane."""

    centre: tuple[float, float]
    """m."""
    angle: float
    """rad, within the turn."""


def _places(mechanism: Mechanism, sample: RotorSample) -> dict[str, _Place]:
    """The place of every body by its name."""
    form, (turns, angle) = closed_form(mechanism), sample.position
    _, output_angle = form.output_angle(turns, angle, math)
    places = {'rotor': _Place((0.0, 0.0), angle), 'output': _Place((0.0, 0.0), output_angle)}
    positions = form.branches(angle, output_angle, math)
    for branch, position in zip(mechanism.branches, positions, strict=True):
        on_cam = position.satellite.real, position.satellite.imag
        places[f'cam_{branch.name}'] = _Place(on_cam, angle)
        places[f'satellite_{branch.name}'] = _Place(on_cam, output_angle)
        on_slots = position.oldham.real, position.oldham.imag
        places[f'oldham_{branch.name}'] = _Place(on_slots, output_angle)
    return places


def _closed(outline: Array) -> Array:
    return np.concatenate([outline, outline[:1]])


def _line(kind: str, colour: str, points: Array, width: float, z: float) -> Marker:
    marker = _marker(Marker.LINE_STRIP, kind, colour, (width, 0.0, 0.0), z)
    marker.points = [Point(x=x, y=y) for x, y in points.tolist()]
    return marker


def _cylinder(kind: str, colour: str, diameter: float, height: float, z: float) -> Marker:
    return _marker(Marker.CYLINDER, kind, colour, (diameter, diameter, height), z)


def _box(kind: str, colour: str, size: tuple[float, float, float], z: float) -> Marker:
    return _marker(Marker.CUBE, kind, colour, size, z)


def _marker(
    shape: int, kind: str, colour: str, scale: tuple[float, float, float], z: float
) -> Marker:
    """A marker about the axis; viewers list it under its kind."""
    red, green, blue, _ = map(float, COLOURS[colour].split())
    x_scale, y_scale, z_scale = scale
    return Marker(
        ns=kind,
        type=shape,
        pose=Pose(position=Point(z=z)),
        scale=Vector3(x=x_scale, y=y_scale, z=z_scale),
        color=ColorRGBA(r=red, g=green, b=blue, a=1.0),
    )
