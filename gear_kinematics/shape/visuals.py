# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Appearance of the links of the URDF: cylinders and boxes, or meshes with teeth."""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple, Self

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.shape.solids import FACE_WIDTH, PLATE, solids
from gear_kinematics.shape.teeth import ring_phase

COLOURS = {
    'stator': '0.55 0.57 0.60 0.35',
    'rotor': '0.72 0.45 0.20 1.0',
    'satellite': '0.20 0.45 0.70 1.0',
    'oldham': '0.85 0.65 0.13 1.0',
    'output': '0.35 0.37 0.40 1.0',
}
"""Red, green, blue and opacity of the bodies, in the format of URDF."""

_BAR = 0.1  # width of the bars of the arms, in radii of the satellite
_LEAST_BORE = 0.25  # radius of a rotor whose cams have no bore, in radii of the cam


Point = tuple[float, float, float]


class Cylinder(NamedTuple):
    """A cylinder about the z axis, m."""

    radius: float
    length: float


class Visual(NamedTuple):
    """A shape on a link."""

    link: str  #: name of the link, without the prefix
    shape: str  #: name of the geometry element in the URDF
    size: Mapping[str, str]  #: attributes of the geometry element
    xyz: Point = (0.0, 0.0, 0.0)  #: position of the shape's centre, m
    yaw: float = 0.0  #: turn of the shape about the z axis, rad
    opaque: bool = False  #: whether the colour is opaque, whatever `COLOURS` says

    @classmethod
    def cylinder(cls, link: str, cylinder: Cylinder, xyz: Point = (0.0, 0.0, 0.0)) -> Self:
        """Make a cylinder with its centre at a point."""
        radius, length = map(repr, cylinder)
        return cls(link, 'cylinder', {'radius': radius, 'length': length}, xyz)

    @property
    def colour(self) -> str:
        """Red, green, blue and opacity."""
        colour = COLOURS[self.link.partition('_')[0]]
        return f'{colour.rpartition(" ")[0]} 1.0' if self.opaque else colour


def cylinders(mechanism: Mechanism, module: float) -> dict[str, Cylinder]:
    """Make the cylinder that represents each link, by the link's name without the prefix.

    The module is in m; together with the tooth numbers, it determines the sizes.
    """
    ring = 0.5 * module * mechanism.ring_teeth
    satellite = 0.5 * module * mechanism.satellite_teeth
    half_length = max(abs(b.axial_position) for b in mechanism.branches) + FACE_WIDTH
    links = {
        'stator': Cylinder(1.15 * ring, 2.0 * half_length),
        'rotor': Cylinder(0.5 * ring, 1.6 * half_length),
        'output_shaft': Cylinder(0.2 * ring, 2.4 * half_length),
    }
    for branch in mechanism.branches:
        links[f'satellite_{branch.name}'] = Cylinder(satellite, FACE_WIDTH)
        links[f'oldham_{branch.name}'] = Cylinder(0.7 * satellite, 1.2 * FACE_WIDTH)
    return links


def simple(mechanism: Mechanism, module: float) -> Iterator[Visual]:
    """Yield the cylinder of every link, the cams and the arms; the module is in m."""
    links = cylinders(mechanism, module)
    for link, cylinder in links.items():
        yield Visual.cylinder(link, cylinder)
    # Cams and arms protrude beyond the faces of satellites and couplings, so that they are seen.
    cam = Cylinder(1.2 * links['rotor'].radius, 1.3 * FACE_WIDTH)
    radius = 0.5 * module * mechanism.satellite_teeth
    for branch in mechanism.branches:
        yield Visual.cylinder('rotor', cam, xyz=cam_centre(branch, mechanism.eccentricity))
        size = _BAR * radius, 1.8 * radius, 1.4 * FACE_WIDTH
        yield _box('output_shaft', size, branch.axial_position)


def meshed(mechanism: Mechanism, module: float, folder: str) -> Iterator[Visual]:
    """Yield the solids, as meshes below a URI, and the shafts and bars that join them.

    Along the axis, the coupling is next to the satellite, on the face that points away from the
    middle of the mechanism, and the bar of the arm is next to the coupling. The module is in m.
    """
    shapes = solids(mechanism, module)
    axial = [branch.axial_position for branch in mechanism.branches]
    middle = 0.5 * (min(axial) + max(axial))
    cam, satellite, arm = shapes['cam'], shapes['satellite'], shapes.get('arm')
    bore = cam.bore or _LEAST_BORE * cam.reach
    reach = (arm or satellite).reach

    def mesh(link: str, name: str, z: float, yaw: float = 0.0) -> Visual:
        uri = {'filename': f'{folder}/{name}.stl'}
        return Visual(link, 'mesh', uri, (0.0, 0.0, z), yaw, opaque=True)

    def shaft(link: str, radius: float, beyond: float) -> Visual:
        length = max(axial) - min(axial) + 2.0 * beyond
        return Visual.cylinder(link, Cylinder(radius, length), xyz=(0.0, 0.0, middle))

    yield shaft('rotor', bore, 0.5 * FACE_WIDTH)
    yield shaft('output_shaft', 0.5 * bore, 1.5 * FACE_WIDTH)
    for branch in mechanism.branches:
        z = branch.axial_position
        outwards = math.copysign(1.0, z - middle)
        offset = outwards * 0.5 * (FACE_WIDTH + PLATE)
        yield mesh('stator', 'ring_gear', z, ring_phase(mechanism, branch))
        yield mesh('rotor', 'cam', z, branch.cam_phase)
        yield mesh(f'satellite_{branch.name}', 'satellite', 0.0)
        oldham = f'oldham_{branch.name}'
        if arm:
            yield mesh(oldham, 'coupling', offset)
            yield mesh('output_shaft', 'arm', z + offset)
        else:  # the slides are too long for coupling and arm to be drawn
            disc = Cylinder(0.35 * satellite.reach, PLATE)
            yield Visual.cylinder(oldham, disc, xyz=(0.0, 0.0, offset))
        # Across the keys of the coupling, so that they are seen.
        size = _BAR * satellite.reach, 2.0 * reach, PLATE
        yield _box('output_shaft', size, z + offset + outwards * PLATE, 0.25 * math.pi)


def cam_centre(branch: Branch, eccentricity: float) -> Point:
    """Compute the centre of the cam of a branch in the frame of the rotor, m."""
    x, y = branch.cam_direction
    return eccentricity * x, eccentricity * y, branch.axial_position


def _box(link: str, size: Point, z: float, yaw: float = 0.0) -> Visual:
    return Visual(link, 'box', {'size': ' '.join(map(repr, size))}, (0.0, 0.0, z), yaw)
