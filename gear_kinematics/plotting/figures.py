"""Figures, their colours, and the bytes of their files."""

from collections.abc import Callable, Iterable
from contextlib import chdir
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.shape.outlines import Array

INK, FAINT = '#24292f', '#8c959f'
SERIES = ('#0969da', '#bf8700', '#1a7f37', '#8250df')
"""Of what is plotted together; more take them in turn."""
_STYLE = {
    'font.size': 9.0,
    'axes.edgecolor': INK,
    'axes.linewidth': 0.6,
    'grid.color': FAINT,
    'grid.linewidth': 0.3,
    'legend.frameon': False,
    'lines.linewidth': 1.2,
    'svg.hashsalt': 'gear_kinematics',  # the same figure gives the same bytes
    'pdf.fonttype': 42,  # TrueType, which publishers ask for
}
_UNDATED = {'svg': {'Date': None}, 'pdf': {'CreationDate': None}}
_DPI = 150


def styled(size: tuple[float, float], use: Callable[[Any], bytes]) -> bytes:
    """Begin a figure of a size in inches, and give what is made of it in the style of the plots.

    Raises:
        ModuleNotFoundError: without matplotlib.
    """
    # matplotlib obeys a matplotlibrc in the current folder, which may come with a recording.
    with chdir(Path(__file__).parent):
        from matplotlib import rc_context  # noqa: PLC0415, an extra
        from matplotlib.figure import Figure  # noqa: PLC0415, an extra
    with rc_context(_STYLE):
        return use(Figure(figsize=size, layout='constrained'))


def render(path: Path, size: tuple[float, float], draw: Callable[[Any], None]) -> bytes:
    """Draw on a figure of a size in inches and give the bytes of its file.

    Raises:
        ValueError: if the suffix of the path is that of no format.
        ModuleNotFoundError: without matplotlib.
    """
    kind = path.suffix[1:].lower()

    def make(figure: Any) -> bytes:
        formats = figure.canvas.get_supported_filetypes()
        if kind not in formats:
            known = ', '.join(sorted(formats))
            raise ValueError(f'{path}: the suffix of a plot is one of {known}')
        draw(figure)
        buffer = BytesIO()
        figure.savefig(buffer, format=kind, dpi=_DPI, metadata=_UNDATED.get(kind))
        return buffer.getvalue()

    return styled(size, make)


def shape(outlines: Iterable[Array], **style: Any) -> Any:
    """A patch of closed polygons (n, 2)."""
    from matplotlib.patches import PathPatch  # noqa: PLC0415, an extra

    return PathPatch(closed(outlines), **style)


def closed(outlines: Iterable[Array]) -> Any:
    """One path of closed polygons (n, 2)."""
    from matplotlib.path import Path as Polygons  # noqa: PLC0415, an extra

    return Polygons.make_compound_path(
        *(Polygons(np.concatenate([points, points[:1]]), closed=True) for points in outlines)
    )
