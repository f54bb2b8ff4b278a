# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Draw what `gearkin` does not: messages, bodies as viewers show them, and a simulated gear."""

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
import pinocchio
from links import pinocchio_configuration
from matplotlib.figure import Figure
from PIL import Image
from real_twins import PRINTED, READ_PRINTED, loops, real_gear

from gear_kinematics.kinematics import Branch, Mechanism, solve
from gear_kinematics.shape.urdf import urdf

BRANCHES = Branch('a', 0.0, 0.04), Branch('b', math.pi, -0.04)
ACTUATOR = Mechanism(80, 76, 0.0011, BRANCHES)
MESHES = Path(__file__).resolve().parents[1] / 'meshes' / '80_76_0_0011_0_0005'
SHARED = Path(__file__).resolve().parents[2] / 'shared' / 'data'
NAMES = {'output_joint': 'output_shaft', 'frame_prefix': ''}
MODULE = 0.0005  # m
ROTOR_ANGLE = 0.6  # rad
STL = np.dtype([('normal', '<3f4'), ('corners', '<(3,3)f4'), ('attribute', '<u2')])
STL_HEADER = 84  # bytes
SIZE = (1000, 1700)  # pixels, halved in the end
SCALE = 14_500.0  # pixels/m
EDGE = 1e-3
"""How far a triangle reaches over its edges, so that no gaps are seen."""
YAW, PITCH = math.radians(50.0), math.radians(16.0)
VIEW = np.array(
    [
        [-math.cos(YAW), 0.0, math.sin(YAW)],
        [-math.sin(PITCH) * math.sin(YAW), math.cos(PITCH), -math.sin(PITCH) * math.cos(YAW)],
        [math.cos(PITCH) * math.sin(YAW), math.sin(PITCH), math.cos(PITCH) * math.cos(YAW)],
    ]
)
"""To the right, up, and towards the viewer, in the frame of the stator."""
LIGHT = np.array([-0.4, 0.6, 0.69])  # where it comes from, for the viewer
INK, BLUE, GREY = '#1f2933', '#dbeafe', '#f1f3f5'


class Flow(NamedTuple):
    """Boxes by their texts, with the places of their centres, and arrows between them."""

    boxes: dict[str, tuple[float, float]]
    arrows: tuple[tuple[str, str, str], ...]
    """From, to and topic."""


NODE = 'gear_state_publisher'
FLOWS = {
    'pictures/driver.svg': Flow(
        {
            'motor driver': (0, 1.5),
            'output encoder\n(optional)': (0, 0),
            NODE: (3, 1.5),
            'controllers': (6, 3),
            'robot_state_publisher:\nRViz, Foxglove': (6, 2),
            'rqt_robot_monitor': (6, 1),
            'the real output,\nwith a calibration': (6, 0),
        },
        (
            ('motor driver', NODE, 'rotor_state'),
            ('output encoder\n(optional)', NODE, 'output_encoder'),
            (NODE, 'controllers', 'output_state, body_poses'),
            (NODE, 'robot_state_publisher:\nRViz, Foxglove', 'mechanism_joint_states'),
            (NODE, 'rqt_robot_monitor', '/diagnostics'),
            (NODE, 'the real output,\nwith a calibration', 'corrected_state, corrected_interval'),
        ),
    ),
    'pictures/arm.svg': Flow(
        {
            'driver of\nseven motors': (0, 1),
            NODE: (3, 1),
            'robot_state_publisher,\nMoveIt': (6, 2),
            'a recorder': (6, 1),
            'rqt_robot_monitor': (6, 0),
        },
        (
            ('driver of\nseven motors', NODE, 'rotor_state'),
            (NODE, 'robot_state_publisher,\nMoveIt', 'output_state of seven joints'),
            (NODE, 'a recorder', 'corrected_state, ...'),
            (NODE, 'rqt_robot_monitor', '/diagnostics'),
        ),
    ),
    'pictures/ros2_control.svg': Flow(
        {
            'motor driver': (0, 1),
            NODE: (3.2, 1),
            'JointStateTopicSystem\n(hardware)': (7.0, 1),
            'your controllers': (11.4, 1.9),
            'joint_state_broadcaster': (11.4, 0.1),
        },
        (
            ('motor driver', NODE, 'rotor_state'),
            (NODE, 'JointStateTopicSystem\n(hardware)', 'output_state'),
            (
                'JointStateTopicSystem\n(hardware)',
                'your controllers',
                'position, velocity, effort',
            ),
            ('JointStateTopicSystem\n(hardware)', 'joint_state_broadcaster', ''),
        ),
    ),
}


def draw_flow(flow: Flow, target: Path) -> None:
    """Draw boxes and arrows."""
    x, y = np.transpose(list(flow.boxes.values()))
    figure = Figure(figsize=(10.0, 1.0 + 0.8 * np.ptp(y)))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(x.min() - 0.9, x.max() + 1.3), ylim=(y.min() - 0.6, y.max() + 0.6))
    axes.axis('off')
    patches = {}
    for text, place in flow.boxes.items():
        colour = BLUE if text == NODE else GREY
        box = {'boxstyle': 'round,pad=0.5', 'facecolor': colour, 'edgecolor': INK}
        shown = axes.text(*place, text, ha='center', va='center', color=INK, bbox=box, zorder=2)
        patches[text] = shown.get_bbox_patch()
    figure.draw_without_rendering()  # only then have the boxes their sizes
    to_data = axes.transData.inverted()
    for start, end, topic in flow.arrows:
        (x0, y0), (x1, y1) = flow.boxes[start], flow.boxes[end]
        ends = {'patchA': patches[start], 'patchB': patches[end], 'shrinkA': 2, 'shrinkB': 2}
        axes.annotate(
            '', (x1, y1), (x0, y0), arrowprops={'arrowstyle': '-|>', 'color': INK} | ends
        )
        label = {'boxstyle': 'round,pad=0.2', 'facecolor': 'white', 'edgecolor': 'none'}
        right = to_data.transform(patches[start].get_window_extent().max)[0]
        left = to_data.transform(patches[end].get_window_extent().min)[0]
        share = (0.5 * (right + left) - x0) / (x1 - x0)  # in the middle between the boxes
        place = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
        axes.text(*place, topic, ha='center', va='center', fontsize=8, color=INK, bbox=label)
    figure.savefig(target, metadata={'Date': None})


def draw_printed_gear(target: Path) -> None:
    """Draw the recorded loop of COMPAct's printed gear, its image, and that of its twin."""
    with TemporaryDirectory() as folder:
        report = Path(folder) / 'report.json'
        gear, [ramps] = real_gear(SHARED / PRINTED, report, **READ_PRINTED)
    found = loops(gear, ramps)
    figure = Figure(figsize=(8.0, 4.5), layout='constrained')
    axes = figure.add_subplot(xlabel='wind-up [mrad]', ylabel='torque [N·m]')
    for angle, style in (
        (found.image, {'label': 'its image', 'color': '#94a3b8', 'linewidth': 4.0}),
        (found.recorded[0], {'label': 'recorded', 'color': INK, 'linewidth': 1.8}),
        (found.simulated, {'label': 'twin', 'color': '#ea580c', 'linewidth': 1.2}),
    ):
        axes.plot(1e3 * angle, found.torque, **style)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    figure.savefig(target, metadata={'Date': None})


def draw_bodies(target: Path) -> None:
    """Draw the meshes of the default mechanism where its URDF puts them."""
    text = urdf(ACTUATOR, module=MODULE, meshes=MESHES.as_uri(), **NAMES)
    model = pinocchio.buildModelFromXML(text)
    state = solve(ACTUATOR, ROTOR_ANGLE)
    turn = float(state.output_angle)
    positions = {'rotor': ROTOR_ANGLE, 'output_shaft': turn}
    for branch, slide in zip(ACTUATOR.branches, state.satellite_slide.tolist(), strict=True):
        positions[f'satellite_{branch.name}'] = turn - ROTOR_ANGLE
        positions[f'oldham_{branch.name}'] = slide
    geometry = pinocchio.buildGeomFromUrdfString(model, text, pinocchio.GeometryType.VISUAL)
    placed = pinocchio.GeometryData(geometry)
    q = pinocchio_configuration(model, positions)
    pinocchio.updateGeometryPlacements(model, model.createData(), geometry, placed, q)

    picture = np.full((*SIZE, 3), 255, np.uint8)
    depth = np.full(SIZE, -np.inf)
    for shape, place in zip(geometry.geometryObjects, placed.oMg, strict=True):
        if not shape.meshPath.endswith('.stl'):
            continue  # a shaft
        data = np.frombuffer(Path(shape.meshPath).read_bytes()[STL_HEADER:], STL)
        normals = data['normal'] @ (VIEW @ place.rotation).T
        corners = (data['corners'] @ place.rotation.T + place.translation) @ VIEW.T
        shades = np.clip(0.6 + 0.4 * normals @ LIGHT, 0.0, 1.0)
        for triangle, normal, shade in zip(corners, normals, shades, strict=True):
            if normal[2] > 0.0:
                colour = 255 * shade * shape.meshColor[:3]
                _paint(picture, depth, triangle, colour)
    Image.fromarray(picture).reduce(2).quantize(64).save(target, optimize=True)


def _paint(
    picture: np.ndarray, depth: np.ndarray, triangle: np.ndarray, colour: np.ndarray
) -> None:
    """Paint a triangle where nothing is before it: x to the right, y up, z to the viewer, m."""
    rows = 0.5 * SIZE[0] - SCALE * triangle[:, 1]
    columns = 0.5 * SIZE[1] + SCALE * triangle[:, 0]
    (top, left), (bottom, right) = (
        (int(end(rows)), int(end(columns))) for end in (np.min, np.max)
    )
    row, column = np.mgrid[top : bottom + 2, left : right + 2]
    edges = np.array([columns[1:] - columns[0], rows[1:] - rows[0]])
    offset = np.stack([column - columns[0], row - rows[0]])
    weights = np.einsum('ij,jrc->irc', np.linalg.pinv(edges), offset)
    z = triangle[0, 2] + np.einsum('i,irc->rc', triangle[1:, 2] - triangle[0, 2], weights)
    part = np.s_[top : bottom + 2, left : right + 2]
    shown = (weights >= -EDGE).all(axis=0) & (weights.sum(axis=0) <= 1.0 + EDGE)
    shown &= z > depth[part]
    depth[part][shown] = z[shown]
    picture[part][shown] = colour
