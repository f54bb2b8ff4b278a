# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The bodies as solids: their outlines, extruded along the axis, as binary STL.

Each body of a branch is one closed solid in its own frame, and the same for every branch: the URDF
places them. STL has no unit; the coordinates are in m, as URDF readers take them. They are of
single precision, which is 2 nm for a radius of 20 mm.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.shape.outlines import Polygons, bodies

FACE_WIDTH = 0.01  #: face width of the gears, m
PLATE = 0.2 * FACE_WIDTH  #: thickness of coupling and arm, m
STL_HEADER = b'gear_kinematics, m'
"""Header of the files. Readers take a file that begins with "solid" for text."""

_SOLIDS = {
    'ring_gear': ('stator', FACE_WIDTH),
    'satellite': ('satellite', FACE_WIDTH),
    'cam': ('rotor', FACE_WIDTH),
    'coupling': ('oldham', PLATE),
    'arm': ('output_shaft', PLATE),
}
"""Body whose outline each solid has, and the height of the solid, m."""
_STL = np.dtype([('normal', '<f4', 3), ('corners', '<f4', (3, 3)), ('attribute', '<u2')])

Triangles = NDArray[np.float32]
"""Triangles (n, 3, 3) by corner and coordinate, m; counterclockwise as seen from outside."""


class Solid(NamedTuple):
    """A prism about z = 0."""

    outlines: Polygons
    height: float  #: height along the axis, m

    @property
    def reach(self) -> float:
        """The greatest distance from the axis, m."""
        return float(np.max(np.hypot(*self.outlines[0].T)))

    @property
    def bore(self) -> float | None:
        """Radius of the first hole, whose centre is on the axis, m; None without holes."""
        return float(np.hypot(*self.outlines[1][0])) if self.outlines[1:] else None


def solids(mechanism: Mechanism, module: float) -> dict[str, Solid]:
    """Make the solids by the names of their files, without coupling and arm if they do not fit.

    Ring gear and cam are those of a branch with a cam phase of 0. For other branches, turn the
    ring gear by its `ring_phase`, and the cam by its cam phase. The module is in m.
    """
    shapes = bodies(replace(mechanism, branches=(Branch('neutral'),)), module)
    return {
        name: Solid(shapes[body], height)
        for name, (body, height) in _SOLIDS.items()
        if body in shapes
    }


def to_stl(solid: Solid) -> bytes:
    """Write a solid as binary STL; ModuleNotFoundError if the extra `mesh` is not installed."""
    corners = triangles(solid)
    first, second, third = corners.astype(np.float64).swapaxes(0, 1)
    normals = np.cross(second - first, third - first)
    lengths = np.linalg.norm(normals, axis=-1, keepdims=True)
    records = np.zeros(len(corners), _STL)
    records['corners'] = corners
    np.divide(normals, lengths, out=normals, where=lengths > 0.0)
    records['normal'] = normals
    return STL_HEADER.ljust(80) + np.uint32(len(corners)).tobytes() + records.tobytes()


def triangles(solid: Solid) -> Triangles:
    """Triangulate the surface: a face at either end, and walls on edges that a face has once.

    The surface is therefore closed, however the faces were divided.
    """
    # Divide the points as they are written: rounding them later could turn a triangle over.
    points = np.concatenate(solid.outlines).astype(np.float32)
    face = _divided(points, solid.outlines)
    edges = np.concatenate([face[:, [0, 1]], face[:, [1, 2]], face[:, [2, 0]]])
    forwards, backwards = (pair @ [len(points), 1] for pair in (edges, edges[:, ::-1]))
    start, end = edges[~np.isin(forwards, backwards)].T
    low, high = (
        np.column_stack([points, np.full(len(points), z, np.float32)])
        for z in (-0.5 * solid.height, 0.5 * solid.height)
    )
    walls = [[low[start], low[end], high[end]], [low[start], high[end], high[start]]]
    return np.concatenate(
        [high[face], low[face[:, ::-1]], *(np.stack(wall, axis=1) for wall in walls)]
    )


def _divided(points: Triangles, outlines: Polygons) -> NDArray[np.int64]:
    """Divide a polygon with holes into triangles, (n, 3): indices, counterclockwise."""
    # An extra: only those who write meshes need it.
    from mapbox_earcut import triangulate_float64  # noqa: PLC0415

    ends = np.cumsum([len(outline) for outline in outlines], dtype=np.uint32)
    face = triangulate_float64(points.astype(np.float64), ends).astype(np.int64).reshape(-1, 3)
    (x, y), (next_x, next_y), (last_x, last_y) = points[face].astype(np.float64).transpose(1, 2, 0)
    clockwise = (next_x - x) * (last_y - y) < (next_y - y) * (last_x - x)
    face[clockwise] = face[clockwise, ::-1]
    return face
