"""The mechanism moving, as a GIF or an MP4."""

import subprocess
from collections.abc import Callable, Iterator
from functools import partial
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import RotorPosition
from gear_kinematics.plotting.figures import FAINT, styled
from gear_kinematics.plotting.mechanism import Bodies, Centres
from gear_kinematics.plotting.motion import rose
from gear_kinematics.trajectory import Trajectory

_DPI = 100
_HEIGHT = 2 / 3  # of the width: the mechanism, and at half its size beside it the centres
_COLOURS = 48  # in a GIF: enough for smooth edges


def animate(
    mechanism: Mechanism,
    module: float,
    path: Path,
    frames: Trajectory,
    rate: float,
    *,
    branch: int = 0,
    width: int = 480,
    progress: Callable[[int], None] = lambda _: None,
) -> bytes:
    """Draw a branch moving, and its centres magnified, with the rose of O4.

    Args:
        mechanism: the mechanism.
        module: of the teeth, m.
        path: of the file that is to be, .gif or .mp4.
        frames: the positions of the rotor to draw.
        rate: frames/s; a GIF counts in hundredths of a second.
        branch: index of the branch.
        width: px; the height is two thirds of it.
        progress: called with each frame's number.

    Raises:
        ValueError: if `path` has another suffix.
        RuntimeError: without matplotlib; for an MP4 without ffmpeg, or if it fails.
    """
    writers = {'.gif': _gif, '.mp4': _mp4}
    suffix = path.suffix.lower()
    if suffix not in writers:
        raise ValueError(f'{path}: the suffix of an animation is one of gif, mp4')
    write = writers[suffix]
    size = width / _DPI, round(_HEIGHT * width) / _DPI

    def draw(figure: Any) -> bytes:
        return write(figure, _moving(figure, mechanism, module, branch, frames, progress), rate)

    return styled(size, draw)


def _moving(
    figure: Any,
    mechanism: Mechanism,
    module: float,
    branch: int,
    frames: Trajectory,
    progress: Callable[[int], None],
) -> Iterator[None]:
    """Draw one frame after the other."""
    figure.set_layout_engine('none')
    left = figure.add_axes((0.0, 0.0, _HEIGHT, 1.0))
    right = figure.add_axes((_HEIGHT, 0.25, 1.0 - _HEIGHT, 0.5))
    right.plot(*(rose(mechanism)[:, branch] / mechanism.eccentricity).T, color=FAINT, linewidth=0.3)
    artists = Bodies(left, mechanism, module, branch), Centres(right, mechanism, branch)
    for number, (turns, angle) in enumerate(zip(frames.turns, frames.angle, strict=True), start=1):
        for artist in artists:
            artist.show(RotorPosition(int(turns), float(angle)))
        progress(number)
        yield


def _gif(figure: Any, frames: Iterator[None], rate: float) -> bytes:
    from PIL import Image  # noqa: PLC0415, comes with matplotlib

    def images() -> Iterator[Any]:
        # Colours of its own for each frame would flicker, and take three times the space.
        colours = None
        for _ in frames:
            buffer = BytesIO()
            figure.savefig(buffer, format='rgba', dpi=_DPI)
            size = figure.canvas.get_width_height()
            image = Image.frombytes('RGBA', size, buffer.getvalue()).convert('RGB')
            colours = colours or image.quantize(_COLOURS)
            yield image.quantize(palette=colours, dither=Image.Dither.NONE)

    first, *others = images()
    content = BytesIO()
    first.save(
        content,
        'GIF',
        save_all=True,
        append_images=others,
        duration=10 * max(2, round(100.0 / rate)),  # ms; players take less than 20 for none
        loop=0,
    )
    return content.getvalue()


def _mp4(figure: Any, frames: Iterator[None], rate: float) -> bytes:
    from matplotlib.animation import FFMpegWriter  # noqa: PLC0415, an extra

    if not FFMpegWriter.isAvailable():
        raise RuntimeError('an MP4 needs the program ffmpeg; a GIF does not')
    writer = FFMpegWriter(rate)
    with TemporaryDirectory() as folder:
        path = Path(folder, 'animation.mp4')
        try:
            with writer.saving(figure, path, _DPI):
                for _ in frames:
                    writer.grab_frame()
        except (subprocess.SubprocessError, OSError) as error:
            raise RuntimeError(f'ffmpeg failed: {error}') from error
        return path.read_bytes()
