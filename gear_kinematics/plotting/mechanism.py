# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The kinematic scheme: the bodies of a branch, and their centres magnified."""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import RotorPosition
from gear_kinematics.report.document import Figure, Line, Panel, Pen
from gear_kinematics.report.image import COLOURS, FAINT, INK, add_legend, canvas, encode
from gear_kinematics.shape.outlines import NAMES, Array, Pose, arrows, bodies, poses


def _face(edge: str) -> str:
    """Mix the colour of an outline with white, as in page.css."""
    parts = (int(edge[k : k + 2], 16) for k in (1, 3, 5))
    return '#' + ''.join(f'{round(255 - 0.45 * (255 - part)):02x}' for part in parts)


_EDGES = {
    'stator': FAINT,
    'satellite': COLOURS['first'],
    'rotor': COLOURS['fail'],
    'oldham': COLOURS['notable'],
    'output_shaft': COLOURS['pass'],
}
FACES = {body: (_face(edge), edge) for body, edge in _EDGES.items()} | {'force': (INK, INK)}
"""Colours of the face of each body and of its outline."""
_MARGIN = 1.02
_OUTLINE = 0.45  # points
_ARROW = 0.5  # length, in radii of the stator
_DETAIL = 1.35  # eccentricities from the axis to the edge of the detail
_LABEL = 15.0  # distance of a label from its point, points
_MM = 1e3  # in a metre
_CIRCLE = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 121))


class BodyDrawing:
    """Drawing of the bodies of a branch to scale; `show` moves them."""

    def __init__(
        self, axes: Any, mechanism: Mechanism, module: float, branch: int, force: float = 0.0
    ) -> None:
        """Draw the bodies at φ2 = 0; a force F_t, N, adds those of ring gear and cam."""
        from matplotlib.patches import PathPatch  # noqa: PLC0415, an extra

        self._mechanism, self._branch = mechanism, branch
        self._outlines = bodies(mechanism, module, branch)
        radius = float(np.max(self._outlines['stator'][0]))
        if force:
            length = math.copysign(_ARROW * radius, force)
            self._outlines['force'] = arrows(mechanism, length)
        self.patches = {}
        for body, outlines in self._outlines.items():
            face, edge = FACES[body]
            style = {'facecolor': face, 'edgecolor': edge, 'linewidth': _OUTLINE}
            self.patches[body] = axes.add_patch(PathPatch(_path(outlines), **style))
        _square(axes, _MARGIN * radius)
        self.show(RotorPosition(0, 0.0))

    def show(self, rotor: RotorPosition) -> None:
        """Move the bodies to their poses at a rotor position."""
        placed = poses(self._mechanism, rotor.angle, self._branch, rotor_turns=rotor.turns)
        for body, patch in self.patches.items():
            patch.set_path(_path(placed[body].place(part) for part in self._outlines[body]))


class CentreDrawing:
    """Drawing of the centres of a branch's bodies, in units of e; `show` moves them.

    O4 is where the slot of the satellite (the x axis of its frame) intersects that of the arm (the
    y axis of the output shaft's frame).
    """

    def __init__(self, axes: Any, mechanism: Mechanism, branch: int) -> None:
        """Draw the centres at φ2 = 0."""
        self._mechanism, self._branch = mechanism, branch
        axes.plot(_CIRCLE.real, _CIRCLE.imag, color=FAINT, linewidth=0.8)
        styles = {
            'satellite slot': ('satellite', 0.8),
            'arm slot': ('output_shaft', 0.8),
            'e': ('rotor', 2.4),
            'x': ('satellite', 2.4),
            'y': ('output_shaft', 2.4),
        }
        self.lines = {
            name: axes.plot([], [], color=_EDGES[body], linewidth=width)[0]
            for name, (body, width) in styles.items()
        }
        axes.plot(0.0, 0.0, 'o', color=INK, markersize=5.0)
        self.points = {
            body: axes.plot([], [], 'o', color=_EDGES[body], markersize=5.0, zorder=3)[0]
            for body in ('satellite', 'oldham')
        }
        _square(axes, _DETAIL)
        self.show(RotorPosition(0, 0.0))

    def show(self, rotor: RotorPosition) -> None:
        """Move the centres to their places at a rotor position."""
        placed = poses(self._mechanism, rotor.angle, self._branch, rotor_turns=rotor.turns)
        e = self._mechanism.eccentricity
        o1 = np.zeros(2)
        o3, o4 = (placed[body].centre / e for body in ('satellite', 'oldham'))
        along = e * np.array([[_DETAIL, 0.0], [-_DETAIL, 0.0]])
        ends = {
            'satellite slot': placed['satellite'].place(along) / e,
            'arm slot': placed['output_shaft'].place(along[:, ::-1]) / e,
            'e': (o1, o3),
            'x': (o3, o4),
            'y': (o1, o4),
        }
        for name, points in ends.items():
            self.lines[name].set_data(*np.transpose(np.asarray(points)))
        for body, point in (('satellite', o3), ('oldham', o4)):
            self.points[body].set_data(*point[:, np.newaxis])


def outlines(mechanism: Mechanism, module: float) -> Figure:
    """Return the outlines of the first branch at φ2 = 0, in mm, for a module of the teeth in m."""
    placed = poses(mechanism, 0.0)
    pens = {'stator': Pen.SECOND, 'satellite': Pen.FIRST, 'rotor': Pen.FIFTH}
    lines = []
    for body, parts in bodies(mechanism, module).items():
        if body in pens:
            for part in parts:
                x, y = _MM * placed[body].place(np.vstack([part, part[:1]])).T
                lines.append(Line(NAMES[body], pens[body], x, y))
    return Figure((Panel('', 'x [mm]', 'y [mm]', tuple(lines), equal=True),))


def scheme(
    mechanism: Mechanism, module: float, path: Path, rotor: RotorPosition, force: float = 0.0
) -> bytes:
    """Draw the kinematic scheme: the bodies of a branch to scale, and their centres magnified.

    The branch is the first one, at the rotor angle φ2, rad, with teeth of a module, m. The suffix
    of the path is the format of the image. A force F_t, N, adds the forces on the satellite.
    """
    with canvas((7.4, 4.7)) as figure:
        left, right = figure.subplots(1, 2)
        drawn = BodyDrawing(left, mechanism, module, 0, force)
        drawn.show(rotor)
        CentreDrawing(right, mechanism, 0).show(rotor)
        placed = poses(mechanism, rotor.angle, rotor_turns=rotor.turns)
        _label_centres(right, mechanism, placed)
        add_legend(figure, list(drawn.patches.values()), [NAMES[body] for body in drawn.patches])
        rotor_angle, output_angle = (
            f'{math.degrees(placed[body].angle) + 0.0:.4g}°'.replace('-', '−')
            for body in ('rotor', 'output_shaft')
        )
        left.set_title(
            f'branch {mechanism.branches[0].name}, '
            f'$z_k$ = {mechanism.ring_teeth}, $z_s$ = {mechanism.satellite_teeth}\n'
            f'$φ_2$ = {rotor_angle}, $φ_5$ = {output_angle}'
            + f', $F_t$ = {force:.4g} N'.replace('-', '−')
            * bool(force),
            fontsize='medium',
        )
        eccentricity = f'the centres, $e$ = {_MM * mechanism.eccentricity:.4g} mm'
        right.set_title(eccentricity, fontsize='medium')
        return encode(figure, path)


def _label_centres(axes: Any, mechanism: Mechanism, placed: dict[str, Pose]) -> None:
    """Name the centres and the sides of their triangle, away from its middle."""
    e = mechanism.eccentricity
    o1 = np.zeros(2)
    o3, o4 = (placed[body].centre / e for body in ('satellite', 'oldham'))
    middle = (o1 + o3 + o4) / 3.0
    for text, colour, at in (
        ('$O_1$', INK, o1),
        ('$O_3$', _EDGES['satellite'], o3),
        ('$O_4$', _EDGES['oldham'], o4),
        ('$e$', _EDGES['rotor'], 0.5 * o3),
        ('$x$', _EDGES['satellite'], 0.5 * (o3 + o4)),
        ('$y$', _EDGES['output_shaft'], 0.5 * o4),
    ):
        outwards = at - middle
        axes.annotate(
            text,
            at,
            xytext=_LABEL * outwards / np.hypot(*outwards),
            textcoords='offset points',
            ha='center',
            va='center',
            color=colour,
            fontsize='large',
        )


def _square(axes: Any, half: float) -> None:
    axes.set_aspect('equal')
    axes.set_axis_off()
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)


def _path(outlines: Iterable[Array]) -> Any:
    """Make one path of closed polygons (n, 2)."""
    from matplotlib.path import Path as Polygons  # noqa: PLC0415, an extra

    return Polygons.make_compound_path(
        *(Polygons(np.concatenate([points, points[:1]]), closed=True) for points in outlines)
    )
