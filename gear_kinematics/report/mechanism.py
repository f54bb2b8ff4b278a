# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Draws a moving mechanism for a page; page.css positions its bodies, motion.js moves it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Mechanism

Array = NDArray[np.float64]

_RADIUS = 500.0  # radius of the drawing, in units so small that no screen resolves a tenth of one
_VIEW = _RADIUS + 5.0
_CENTRE = 7.0  # radius of the dots that mark centres
_SPEEDS = (1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0)  # playing speeds relative to real time
_EASY_RATE = 360.0  # degrees of the rotor per second, which the eye can follow


@dataclass(frozen=True, eq=False, slots=True)
class MovingMechanism:
    """A mechanism that moves with the x axis of the figure."""

    mechanism: Mechanism
    module: float  # module of the teeth, m
    time: Array  # times of the samples, (n,), s
    rotor: Array  # angle of the rotor, (n,), degrees
    output: Array  # angle of the output shaft, (n,), degrees
    start: int = 0  # index of the sample that is shown first
    forces: Array | None = None  # F_t of each branch, (n, B), as arrows in radii of the drawing


class Drawings:
    """The mechanisms of a page, which share their common shapes."""

    def __init__(self) -> None:
        self._names: dict[str, str] = {}  # names of the shapes by their paths

    def moving(self, moving: MovingMechanism, figure: str) -> Iterator[str]:
        """Write a mechanism with the controls of its motion along the x axis of a figure."""
        yield f'<div class="motion" data-figure="{figure}">\n{_controls(moving)}'
        forces = moving.forces is not None
        yield from self.branches(moving.mechanism, moving.module, forces=forces)
        yield '</div>\n'

    def branches(
        self, mechanism: Mechanism, module: float, *, forces: bool = False
    ) -> Iterator[str]:
        """Write a mechanism branch by branch, for an element that has the angles.

        The module of the teeth is in m. With forces, each branch has those on the satellite: an
        arrow of `--force` radii at the pitch point along u'(θ), and one against it at the cam.
        """
        from gear_kinematics.shape import outlines  # noqa: PLC0415, of pages alone

        drawn = [outlines.bodies(mechanism, module, k) for k in range(len(mechanism.branches))]
        radius = float(np.max(np.abs(drawn[0]['stator'][0])))
        if forces:
            drawn = [each | {'force': outlines.arrows(mechanism, radius)} for each in drawn]
        scale = _RADIUS / radius
        yield f'<div class="branches" style="--e: {scale * mechanism.eccentricity:.3f}px">\n'
        for branch, shapes in zip(mechanism.branches, drawn, strict=True):
            yield (
                f'<figure style="--cam: {math.degrees(branch.cam_phase):.6g}deg">'
                f'<svg viewBox="{-_VIEW:g} {-_VIEW:g} {2 * _VIEW:g} {2 * _VIEW:g}" role="img" '
                f'aria-label="branch {branch.name}"><g class="upright">\n'
            )
            for body, outline in shapes.items():
                yield f'<use class="{body}" href="#{self._name(outline, scale)}"/>\n'
            for body in ('output_shaft', 'satellite', 'oldham'):
                yield f'<circle class="{body} centre" r="{_CENTRE:g}"/>\n'
            yield f'</g></svg><figcaption>branch {branch.name}</figcaption></figure>\n'
        legend = ''.join(f'<li class="{body}">{outlines.NAMES[body]}</li>' for body in drawn[0])
        yield f'</div>\n<ul class="legend">{legend}</ul>\n'

    def shapes(self) -> str:
        """Write the shapes of all drawn mechanisms, for any place in the page."""
        paths = ''.join(f'<path id="{name}" d="{path}"/>\n' for path, name in self._names.items())
        return f'<svg class="shapes" aria-hidden="true">\n{paths}</svg>\n' if paths else ''

    def _name(self, outlines: Sequence[Array], scale: float) -> str:
        path = ''.join(_closed(scale * outline) for outline in outlines)
        return self._names.setdefault(path, f'shape-{len(self._names)}')


def _closed(points: Array) -> str:
    return f'M{" ".join(f"{x:.1f},{y:.1f}" for x, y in points.tolist())}Z'


def _controls(moving: MovingMechanism) -> str:
    speed = _easy_speed(moving)
    speeds = ''.join(
        f'<option value="{value:g}"{" selected" * (value == speed)}>{value:g} × real time</option>'
        for value in _SPEEDS
    )
    return (
        '<div class="controls"><button type="button" disabled>Play</button>'
        f'<select aria-label="speed">{speeds}</select><output></output>'
        f'<input type="range" min="0" max="{len(moving.time) - 1}" step="1" '
        f'value="{moving.start}" disabled aria-label="time"></div>\n'
    )


def _easy_speed(moving: MovingMechanism) -> float:
    """Choose the greatest speed at which the eye follows the rotor."""
    elapsed, turned = np.diff(moving.time), np.abs(np.diff(moving.rotor))
    forward = elapsed > 0.0
    fastest = float(np.fmax.reduce(turned[forward] / elapsed[forward], initial=0.0))
    return max((speed for speed in _SPEEDS if speed * fastest <= _EASY_RATE), default=min(_SPEEDS))
