# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Animations of the mechanism as GIF."""

import math
from collections.abc import Callable, Iterator
from io import BytesIO
from typing import Any

import numpy as np

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import RotorPosition
from gear_kinematics.plotting.mechanism import FACES, BodyDrawing, CentreDrawing
from gear_kinematics.plotting.motion import rose
from gear_kinematics.plotting.trajectory import Trajectory
from gear_kinematics.report.image import FAINT, INK, canvas
from gear_kinematics.report.mark import MARK
from gear_kinematics.shape.outlines import NAMES

_WIDTH, _DPI = 4.0, 105  # inches: 420 pixels
_HEIGHT = 2 / 3  # of the width: the mechanism, and to its right the centres at half its size
_GROUND = '#ffffff'


def animate(
    mechanism: Mechanism,
    module: float,
    frames: Trajectory,
    *,
    fps: int,
    force: float = 0.0,
    progress: Callable[[int], None] = lambda _: None,
) -> bytes:
    """Animate the first branch, and its magnified centres with the rose of O4, as a GIF.

    The module of the teeth is in m. A tooth force F_t, N, adds the forces on the satellite. A GIF
    rounds the duration of a frame to hundredths of a second. `progress` is called with the number
    of each frame. Raises ModuleNotFoundError without matplotlib.
    """
    with canvas((_WIDTH, _HEIGHT * _WIDTH)) as figure:
        figure.set_dpi(_DPI)
        return _gif(figure, _moving(figure, mechanism, module, frames, force, progress), fps)


def _moving(
    figure: Any,
    mechanism: Mechanism,
    module: float,
    frames: Trajectory,
    force: float,
    progress: Callable[[int], None],
) -> Iterator[None]:
    """Draw the frames one by one."""
    figure.set_layout_engine('none')
    left = figure.add_axes((0.0, 0.0, _HEIGHT, 1.0))
    right = figure.add_axes((0.725, 0.385, 0.225, 0.225 / _HEIGHT))
    x, y = rose(mechanism)[:, 0].T / mechanism.eccentricity
    right.plot(x, y, color=FAINT, linewidth=0.3)
    middle = 0.5 * (1.0 + _HEIGHT)
    style = {'va': 'center', 'color': INK, 'fontsize': 7}
    ratio = str(mechanism.gear_ratio).replace('-', '−')
    teeth = f'{mechanism.ring_teeth}/{mechanism.satellite_teeth} teeth, $i$ = {ratio}'
    for height, text in (
        (0.95, teeth),
        (0.345, f'path of $O_4$: {mechanism.oldham_petals} petals'),
    ):
        figure.text(middle, height, text, ha='center', **style)
    moments = [figure.text(0.735, height, '', **style) for height in (0.88, 0.82, 0.76)]
    bodies = BodyDrawing(left, mechanism, module, 0, force)
    names = [NAMES[body] for body in bodies.patches]
    handles = list(bodies.patches.values())
    style = {'fontsize': 7, 'handlelength': 0.8, 'labelspacing': 0.3}
    figure.legend(handles, names, loc=(0.72, 0.02), **style)
    artists = bodies, CentreDrawing(right, mechanism, 0)
    output = frames.state(mechanism).output_angle
    for number, (time, turns, angle, turned) in enumerate(
        zip(frames.time, frames.turns, frames.angle, output, strict=True), start=1
    ):
        for artist in artists:
            artist.show(RotorPosition(int(turns), float(angle)))
        degrees = (360.0 * turns + math.degrees(angle), math.degrees(turned))
        texts = (f'$t$ = {time:.3f} s', *map(_angle, ('φ_2', 'φ_5'), degrees))
        for moment, text in zip(moments, texts, strict=True):
            moment.set_text(text)
        progress(number)
        yield


def _angle(symbol: str, degrees: float) -> str:
    return f'${symbol}$ = {round(degrees, 1) + 0.0:.1f}°'.replace('-', '−')


def _gif(figure: Any, frames: Iterator[None], fps: int) -> bytes:
    from PIL import Image  # noqa: PLC0415, comes with matplotlib

    palette = _palette()

    def images() -> Iterator[Any]:
        for _ in frames:
            buffer = BytesIO()
            figure.savefig(buffer, format='rgba', dpi=figure.dpi)
            size = figure.canvas.get_width_height()
            image = Image.frombytes('RGBA', size, buffer.getvalue()).convert('RGB')
            yield image.quantize(palette=palette, dither=Image.Dither.NONE)

    first, *others = images()
    content = BytesIO()
    first.save(
        content,
        'GIF',
        save_all=True,
        append_images=others,
        duration=10 * max(2, round(100.0 / fps)),  # ms; players ignore durations under 20
        loop=0,
        comment=MARK.encode(),
    )
    return content.getvalue()


def _palette() -> Any:
    """Make a palette of the colours of the drawing, and of their mixtures at smooth edges.

    Different palettes for the frames would flicker, and more colours would take more space.
    """
    from PIL import Image, ImageColor  # noqa: PLC0415, comes with matplotlib

    pairs = [*FACES.values(), *((_GROUND, edge) for _, edge in FACES.values())]
    pairs += [(_GROUND, INK), (_GROUND, FAINT)]
    rgb = [tuple(np.array(ImageColor.getrgb(colour)) for colour in pair) for pair in pairs]
    colours = np.unique([colour for a, b in rgb for colour in (a, b, (a + b) // 2)], axis=0)
    palette = Image.new('P', (1, 1))
    palette.putpalette(colours.astype(np.uint8).tobytes())
    return palette
