# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Animations of the mechanism as GIF or MP4."""

import math
import shutil
import subprocess
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from gear_kinematics.bag.trajectory import Trajectory
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import RotorPosition
from gear_kinematics.plotting.mechanism import FACES, Bodies, Centres
from gear_kinematics.plotting.motion import rose
from gear_kinematics.report.image import FAINT, INK, canvas
from gear_kinematics.report.mark import MARK
from gear_kinematics.shape.outlines import NAMES

_WIDTH = 4.0  # inches for any number of pixels, so that lines and text scale with them
_HEIGHT = 2 / 3  # of the width: the mechanism, and beside it the centres at half its size
_GROUND = '#ffffff'
_MOST_PIXELS = 1_000_000_000
"""Pixels of all frames of a GIF, which are in memory until the last one is drawn."""


def check_animation(path: Path) -> None:
    """Check that an animation can be written, before any work.

    Args:
        path: of the image file, .gif or .mp4.

    Raises:
        ValueError: if `path` has another suffix.
        ModuleNotFoundError: without matplotlib or, for an MP4, ffmpeg.
    """
    suffix = path.suffix.lower()
    if suffix not in _WRITERS:
        known = ', '.join(sorted(known[1:] for known in _WRITERS))
        raise ValueError(f'{path}: the suffix of an animation is one of {known}')
    with canvas((1.0, 1.0)):
        pass
    if suffix == '.mp4':
        _ffmpeg()


def animate(
    mechanism: Mechanism,
    module: float,
    path: Path,
    frames: Trajectory,
    *,
    fps: int,
    width: int,
    progress: Callable[[int], None] = lambda _: None,
) -> bytes:
    """Animate the first branch, and its magnified centres with the rose of O4.

    Args:
        mechanism: the mechanism.
        module: of the teeth, m.
        path: of the image file, .gif or .mp4.
        frames: rotor positions to draw.
        fps: frames per second; a GIF rounds their duration to hundredths of a second.
        width: px; the height is two thirds of it.
        progress: called with the number of each frame.

    Raises:
        ValueError: if `path` has another suffix, or a GIF would need too much memory.
        ModuleNotFoundError: without matplotlib or, for an MP4, ffmpeg.
        RuntimeError: for an MP4, if ffmpeg fails.
    """
    check_animation(path)
    write = _WRITERS[path.suffix.lower()]
    if write is _gif and len(frames.time) * _HEIGHT * width**2 > _MOST_PIXELS:
        raise ValueError(
            f'{path}: too large for a GIF: {len(frames.time)} frames, {width} px wide'
        )

    with canvas((_WIDTH, _HEIGHT * _WIDTH)) as figure:
        figure.set_dpi(width / _WIDTH)
        return write(figure, _moving(figure, mechanism, module, frames, progress), fps)


def _moving(
    figure: Any,
    mechanism: Mechanism,
    module: float,
    frames: Trajectory,
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
    bodies = Bodies(left, mechanism, module, 0)
    names = [NAMES[body] for body in bodies.patches]
    handles = list(bodies.patches.values())
    figure.legend(handles, names, loc=(0.72, 0.02), fontsize=7, handlelength=0.8)
    artists = bodies, Centres(right, mechanism, 0)
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
    """The colours of the drawing, and the means of adjacent ones, for smooth edges.

    A palette for each frame would flicker; more colours would take more space.
    """
    from PIL import Image, ImageColor  # noqa: PLC0415, comes with matplotlib

    pairs = [*FACES.values(), *((_GROUND, edge) for _, edge in FACES.values())]
    pairs += [(_GROUND, INK), (_GROUND, FAINT)]
    rgb = [tuple(np.array(ImageColor.getrgb(colour)) for colour in pair) for pair in pairs]
    colours = np.unique([colour for a, b in rgb for colour in (a, b, (a + b) // 2)], axis=0)
    palette = Image.new('P', (1, 1))
    palette.putpalette(colours.astype(np.uint8).tobytes())
    return palette


def _mp4(figure: Any, frames: Iterator[None], fps: int) -> bytes:
    from matplotlib import rcParams  # noqa: PLC0415, an extra
    from matplotlib.animation import FFMpegWriter  # noqa: PLC0415, an extra

    rcParams['animation.ffmpeg_path'] = _ffmpeg()  # `canvas` restores it
    writer = FFMpegWriter(fps, metadata={'comment': MARK})
    with TemporaryDirectory() as folder:
        path = Path(folder, 'animation.mp4')
        try:
            with writer.saving(figure, path, figure.dpi):
                for _ in frames:
                    writer.grab_frame()
        except (subprocess.SubprocessError, OSError) as error:
            raise RuntimeError(f'ffmpeg failed: {error}') from error
        return path.read_bytes()


def _ffmpeg() -> str:
    """Return the path of the program: the system's, or that of the package imageio-ffmpeg."""
    if found := shutil.which('ffmpeg'):
        return found
    from imageio_ffmpeg import get_ffmpeg_exe  # noqa: PLC0415, an extra

    return str(get_ffmpeg_exe())


_WRITERS = {'.gif': _gif, '.mp4': _mp4}
"""By the suffix of the file."""
