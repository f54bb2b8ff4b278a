# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Meshes as Assimp reads them (RViz's and MoveIt's library), and where Pinocchio puts them."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
import shapely
from links import pinocchio_configuration
from live import START
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from shapely import affinity
from wire import encoded

from gear_kinematics.kinematics import Branch, Mechanism, RotorSample, split_turns
from gear_kinematics.parameters.meshes import folder_uri
from gear_kinematics.shape import teeth
from gear_kinematics.shape.outlines import bodies
from gear_kinematics.shape.solids import solids, to_stl
from gear_kinematics.shape.urdf import urdf
from gear_kinematics.state.state_messages import StateMessages
from gear_kinematics.wire.topics import JOINT_STATES

ROOT = Path(__file__).resolve().parents[2]
MODULE = 0.0005
NAMES = {'output_joint': 'output_shaft', 'frame_prefix': ''}
BODIES = {
    'ring_gear': 'stator',
    'satellite': 'satellite',
    'cam': 'rotor',
    'coupling': 'oldham',
    'arm': 'output_shaft',
}
ACTUATOR = Mechanism(
    80, 76, 0.0011, (Branch('a', 0.0, 0.04), Branch('b', math.pi, -0.04))
)  # the default one
SPREAD = Mechanism(
    61, 58, 0.001, (Branch('a', 0.7, 0.03), Branch('b', -1.9, 0.0), Branch('c', 2.5, -0.02))
)
FEW_TEETH = Mechanism(12, 9, 0.001, (Branch('a'),))  # no room for coupling and arm
CIRCLES = Mechanism(80, 79, 0.0011, (Branch('a'),))  # its teeth cannot mesh


def imported(path: Path) -> np.ndarray:
    """Read the triangles of a mesh with Assimp, (n, 3, 3)."""
    coal = pytest.importorskip('coal', reason='coal is not installed')
    mesh = coal.MeshLoader().load(str(path), np.ones(3))
    corners = [[mesh.tri_indices(n)[k] for k in range(3)] for n in range(mesh.num_tris)]
    return mesh.vertices()[np.array(corners)]


def face(triangles: np.ndarray, side: float = 1.0) -> shapely.Polygon:
    """Put together the flat face at the upper end, or at the lower end with side -1."""
    height = side * triangles[..., 2]
    at_end = np.all(height == height.max(), axis=1)
    return shapely.union_all([shapely.Polygon(corners) for corners in triangles[at_end, :, :2]])


def polygon(outlines) -> shapely.Polygon:
    border, *holes = outlines
    return shapely.Polygon(border, holes)


def deviation(one: shapely.Geometry, other: shapely.Geometry) -> float:
    """The greatest distance between two borders, m."""
    return shapely.hausdorff_distance(one.boundary, other.boundary)


@pytest.fixture(scope='module')
def written(tmp_path_factory):
    """Write the meshes of a mechanism to files, once."""
    pytest.importorskip('mapbox_earcut', reason='mapbox_earcut is not installed')
    folders: dict[Mechanism, Path] = {}

    def write(mechanism: Mechanism) -> Path:
        if mechanism not in folders:
            folder = folders[mechanism] = tmp_path_factory.mktemp('meshes')
            for name, solid in solids(mechanism, MODULE).items():
                (folder / f'{name}.stl').write_bytes(to_stl(solid))
        return folders[mechanism]

    return write


def assert_outlines_come_back(folder: Path, mechanism: Mechanism) -> set[str]:
    """Compare both faces of every mesh with the outlines of the bodies; returns the names."""
    neutral = Mechanism(
        mechanism.ring_teeth, mechanism.satellite_teeth, mechanism.eccentricity, (Branch('a'),)
    )
    shapes = bodies(neutral, MODULE)
    for name, body in BODIES.items():
        if body not in shapes:
            continue
        triangles, expected = imported(folder / f'{name}.stl'), polygon(shapes[body])
        for side in (-1.0, 1.0):
            found = face(triangles, side)
            assert deviation(found, expected) < 1e-8
            assert found.symmetric_difference(expected).area < 1e-8 * expected.length
    return {path.stem for path in folder.iterdir()}


@pytest.mark.parametrize(
    'mechanism',
    [ACTUATOR, SPREAD, FEW_TEETH, CIRCLES],
    ids=lambda m: f'{m.ring_teeth}-{m.satellite_teeth}',
)
def test_meshes_are_closed_and_their_outlines_are_within_ten_nanometres(written, mechanism):
    folder = written(mechanism)
    names = set(BODIES) - ({'coupling', 'arm'} if mechanism is FEW_TEETH else set())
    assert assert_outlines_come_back(folder, mechanism) == names
    for name, solid in solids(mechanism, MODULE).items():
        assert_closed_and_outwards(folder / f'{name}.stl', solid)
    # The outlines are those of the teeth.
    ring, satellite = teeth.outlines(mechanism, MODULE)
    [space] = face(imported(folder / 'ring_gear.stl')).interiors
    gear = face(imported(folder / 'satellite.stl')).exterior
    assert deviation(shapely.Polygon(space), shapely.Polygon(ring)) < 1e-8
    assert deviation(shapely.Polygon(gear), shapely.Polygon(satellite)) < 1e-8


def assert_closed_and_outwards(path: Path, solid) -> None:
    """Every edge has two sides in opposite directions, and the volume is that of the prism."""
    triangles = imported(path)
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 6)
    sides = {tuple(edge) for edge in edges.tolist()}
    assert len(sides) == len(edges)
    assert sides == {edge[3:] + edge[:3] for edge in sides}
    first, second, third = triangles.swapaxes(0, 1)
    volume = np.sum(first * np.cross(second, third)) / 6.0  # negative if inside out
    assert volume == pytest.approx(polygon(solid.outlines).area * solid.height, rel=1e-5)
    assert np.ptp(triangles[..., 2]) == pytest.approx(solid.height, rel=1e-6)


def test_installed_meshes_are_those_of_the_default_actuator(actuator):
    """If not: gearkin urdf --meshes meshes/80_76_0_0011_0_0005."""
    uri = folder_uri('auto', actuator, MODULE)
    assert uri.startswith('package://gear_kinematics/')
    folder = ROOT / uri.removeprefix('package://gear_kinematics/')
    assert assert_outlines_come_back(folder, actuator) == set(BODIES)
    for name, solid in solids(actuator, MODULE).items():
        assert_closed_and_outwards(folder / f'{name}.stl', solid)


class Shown:
    """A mechanism as Pinocchio shows its URDF at a rotor angle."""

    def __init__(self, mechanism: Mechanism, uri: str, rotor_angle: float, packages=()) -> None:
        pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
        text = urdf(mechanism, module=MODULE, meshes=uri, **NAMES)
        model = pin.buildModelFromXML(text)
        self.geometry = pin.buildGeomFromUrdfString(
            model, text, pin.GeometryType.VISUAL, package_dirs=[str(path) for path in packages]
        )
        self.data = pin.GeometryData(self.geometry)
        sample = RotorSample(START, split_turns(rotor_angle), None, None)
        [message] = encoded(StateMessages(mechanism, **NAMES), sample, [JOINT_STATES]).values()
        states = deserialize_message(message, JointState)
        positions = dict(zip(states.name, states.position, strict=True))
        q = pinocchio_configuration(model, positions)
        pin.updateGeometryPlacements(model, model.createData(), self.geometry, self.data, q)

    def meshes(self, name: str) -> list[tuple[shapely.Polygon, float, float]]:
        """Give for each branch the face of a mesh in the frame of the stator, and its ends, m."""
        found = []
        for shape, place in zip(self.geometry.geometryObjects, self.data.oMg, strict=True):
            if Path(shape.meshPath).stem != name:
                continue
            triangles = imported(Path(shape.meshPath)) @ place.rotation.T + place.translation
            z = triangles[..., 2]
            triangles[..., 2] = np.round(z, 9)
            found.append((face(triangles), float(z.min()), float(z.max())))
        return found


@pytest.mark.parametrize('rotor_angle', [0.0, 0.3, -119.0])
def test_meshes_mesh(written, actuator, rotor_angle):
    """Placed by their URDF, the gears touch nearly, and neither they nor the others overlap."""
    shown = Shown(actuator, written(actuator).as_uri(), rotor_angle)
    parts = [shown.meshes(name) for name in BODIES]
    assert [len(part) for part in parts] == [2] * 5
    for ring, satellite, cam, coupling, arm in zip(*parts, strict=True):
        (gear, *below_and_above), (space, *_) = satellite, ring
        assert below_and_above == pytest.approx(ring[1:], abs=1e-9)
        assert gear.intersection(space).area < 1e-9 * MODULE**2
        centre = shapely.Polygon(gear.exterior).centroid
        turned = affinity.rotate(gear, 1e-3, centre, use_radians=True)
        assert turned.intersection(space).area > 1e-3 * MODULE**2
        # The cam fills the bore, but for the corners of both circles.
        bore = shapely.Polygon(max(gear.interiors, key=lambda hole: hole.length))
        assert deviation(shapely.Polygon(cam[0].exterior), bore) < 2e-6
        # The keys of the coupling slide in the jaws of the arm.
        assert coupling[1:] == pytest.approx(arm[1:], abs=1e-9)
        assert coupling[0].intersection(arm[0]).area < 1e-3 * MODULE**2
        assert affinity.rotate(coupling[0], 1.0).intersection(arm[0]).area > MODULE**2
        # They are beside the satellite, on the side away from the other branch.
        inner, outer = sorted(coupling[1:], key=abs)
        assert abs(inner) == pytest.approx(max(map(abs, satellite[1:])), abs=1e-9)
        assert abs(outer) > abs(inner)


def test_ring_gears_are_turned_for_their_branches(written):
    shown = Shown(SPREAD, written(SPREAD).as_uri(), 1.7)
    rings, satellites = shown.meshes('ring_gear'), shown.meshes('satellite')
    assert len(rings) == len(satellites) == 3
    for (space, *_), (gear, *_) in zip(rings, satellites, strict=True):
        assert gear.intersection(space).area < 1e-9 * MODULE**2


def test_meshes_are_found_by_the_name_of_the_package(actuator, tmp_path):
    (tmp_path / 'gear_kinematics').symlink_to(ROOT)
    shown = Shown(actuator, folder_uri('auto', actuator, MODULE), 0.0, [tmp_path])
    assert len(shown.meshes('satellite')) == 2


def test_foxglove_bridge_may_serve_the_installed_meshes_which_are_opaque(actuator):
    text = urdf(actuator, module=MODULE, meshes=folder_uri('auto', actuator, MODULE), **NAMES)
    names = re.findall('filename="(.*)"', text)
    # The default of its asset_uri_allowlist, in its oldest form.
    allowed = re.compile(r'package://(?:[-\w%]+/)*[-\w%]+\.(?:dae|obj|stl)')
    assert len(names) == 10
    assert all(allowed.fullmatch(name) for name in names)
    # A ring gear hides nothing, and needs not be transparent as the housing of simple shapes.
    assert set(re.findall(r'rgba="\S+ \S+ \S+ (\S+)"', text)) == {'1.0'}
    simple = urdf(actuator, module=MODULE, **NAMES)
    assert 'mesh' not in simple
    assert '0.35"' in simple
