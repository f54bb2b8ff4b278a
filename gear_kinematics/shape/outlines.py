# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Polygons of the bodies of a branch, and their poses at a rotor angle, for drawings and pages.

The gears are to scale; cam, coupling and arm are sized so that they fit inside the satellite and
their slides can be seen. Where the slides are too long for that, with very few teeth, coupling
and arm are left out.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics import Mechanism, solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.shape import teeth
from gear_kinematics.shape.teeth import circle

Array = NDArray[np.float64]
Polygons = tuple[Array, ...]
"""Closed polygons (n, 2), m, in the frame of their body: a counterclockwise border, then clockwise
holes, so that the nonzero and the even-odd fill rule agree."""

NAMES = {
    'stator': 'ring gear',
    'satellite': 'satellite',
    'rotor': "rotor's cam",
    'oldham': 'Oldham coupling',
    'output_shaft': 'arm',
    'force': 'force on satellite',
}
"""Names of the bodies and arrows in drawings."""
BODIES = tuple(NAMES)[:-1]
"""The bodies of a branch from back to front, named as the links of the URDF."""

_ARC = math.radians(3.0)  # approximate distance of points on a circle
_RING_BORDER = 1.07  # outer radius of the ring gear, in root radii
_LEAST_ROOM = 0.3
"""Share of the satellite's root radius that coupling and arm need in addition to their slides."""


class Pose(NamedTuple):
    """Pose of a body in the frame of the stator; `...` is the shape of the rotor angles."""

    centre: Array  #: position of the body's origin, (..., 2), m
    angle: Array  #: orientation of the body within a turn, (...), rad

    def place(self, outline: Array) -> Array:
        """Transform points (n, 2) of the body to the frame of the stator, (..., n, 2)."""
        cosine, sine = np.cos(self.angle), np.sin(self.angle)
        to_stator = np.stack([np.stack([cosine, sine], -1), np.stack([-sine, cosine], -1)], -2)
        turned: Array = outline @ to_stator
        return turned + self.centre[..., np.newaxis, :]


def bodies(mechanism: Mechanism, module: float, branch: int = 0) -> dict[str, Polygons]:
    """Compute the outlines of the branch with an index, in the order of `BODIES`.

    The module of the teeth is in m.
    """
    of_branch = mechanism.branches[branch]
    ring, satellite = teeth.outlines(mechanism, module)
    ring = turned(ring, teeth.ring_phase(mechanism, of_branch))
    root = float(np.min(np.hypot(*satellite.T)))
    e = mechanism.eccentricity
    x, y = of_branch.cam_direction
    cam_centre = e * x, e * y
    shapes = {'stator': _pierced(circle(_RING_BORDER * float(np.max(np.hypot(*ring.T)))), ring)}
    room = root - 3.0 * e  # the slides take three eccentricities
    if room < _LEAST_ROOM * root:
        shapes['satellite'] = _pierced(satellite, circle(0.5 * root))
        shapes['rotor'] = _pierced(circle(0.5 * root, *cam_centre))
        return shapes
    # Radii from the inside to the outside, and half the width of the keys.
    shaft, cam, key = 0.18 * room, 0.29 * room, 0.07 * room
    coupling_bore = cam + e + 0.03 * room
    coupling = coupling_bore + 0.17 * room
    jaw = coupling + e + 0.02 * room
    tongue = coupling + e + 0.12 * room  # of the coupling
    slot = tongue + e + 0.02 * room  # of the satellite and the arm
    rim_bore, rim = slot + 0.03 * room, slot + 0.11 * room  # of the arm
    inner = 0.5 * (coupling_bore + coupling)
    slots = np.array([(inner, -key), (slot, -key), (slot, key), (inner, key)])
    mark = circle(0.2 * (root - rim), 0.5 * (rim + root))
    # A block inside the rim of the arm, with a slot for a key of the coupling.
    side = [(jaw, 2.4 * key), (jaw, key), (slot, key)]
    block = [*((x, -y) for x, y in side), *reversed(side)]
    keys = _tabbed_circle(coupling, [(tongue, -key), (tongue, key)], 4)
    jaws = turned(_tabbed_circle(rim_bore, block, 2), 0.5 * math.pi)
    return shapes | {
        'satellite': _pierced(satellite, circle(cam), slots, turned(slots, math.pi), mark),
        'rotor': _pierced(circle(cam, *cam_centre), circle(shaft)),
        'oldham': _pierced(keys, circle(coupling_bore)),
        'output_shaft': _pierced(circle(rim), jaws),
    }


def arrows(mechanism: Mechanism, length: float) -> Polygons:
    """Outline the forces on a satellite, in a frame whose y axis is u(θ).

    One arrow of the given length, m, points along u'(θ) at the pitch point, and the opposite one
    acts at O3. A negative length reverses both.
    """
    e, half = mechanism.eccentricity, 0.03 * length
    ends = (-length, mechanism.ring_rolling_radius, -half), (length, e, half)
    return tuple(
        np.array([(0.0, y - width), (tip, y), (0.0, y + width)]) for tip, y, width in ends
    )


def poses(
    mechanism: Mechanism,
    rotor_angle: 'ArrayLike',
    branch: int = 0,
    *,
    rotor_turns: 'ArrayLike' = 0,
) -> dict[str, Pose]:
    """Compute the poses of the `BODIES` of the branch with an index, then that of `arrows`.

    The rotor angle φ2, rad, has any shape `(...)`; whole turns are added to it as in `solve`.
    """
    state = solve(mechanism, rotor_angle, rotor_turns=rotor_turns)
    shape = state.output_angle.shape
    _, within_turn = split_turns(np.broadcast_to(np.asarray(rotor_angle, np.float64), shape))
    axis, still = np.zeros((*shape, 2)), np.zeros(shape)
    return {
        'stator': Pose(axis, still),
        'satellite': Pose(state.satellite_centre[..., branch, :], state.output_turn_angle),
        'rotor': Pose(axis, within_turn),
        'oldham': Pose(state.oldham_centre[..., branch, :], state.output_turn_angle),
        'output_shaft': Pose(axis, state.output_turn_angle),
        'force': Pose(axis, within_turn + mechanism.branches[branch].cam_phase),
    }


def turned(outline: Array, angle: float) -> Array:
    """Turn points (n, 2) about the origin by an angle, rad."""
    return Pose(np.zeros(2), np.asarray(angle)).place(outline)


def _tabbed_circle(radius: float, tab: Sequence[tuple[float, float]], count: int) -> Array:
    """Make a circle with equal, evenly spaced tabs, of which `tab` is on the x axis."""
    half_width = abs(tab[0][1])
    start = math.asin(half_width / radius)
    foot = radius * math.cos(start)
    end = TURN / count - start
    angles = np.linspace(start, end, math.ceil((end - start) / _ARC))
    arc = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    part = np.concatenate([[(foot, -half_width), *tab], arc[:-1]])
    return np.concatenate([turned(part, TURN * k / count) for k in range(count)])


def _pierced(border: Array, *holes: Array) -> Polygons:
    return border, *(hole[::-1] for hole in holes)
