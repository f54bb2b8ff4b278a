"""Writes figures as image files, with matplotlib."""

from collections.abc import Callable
from contextlib import chdir
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any

from gear_kinematics.report.document import Figure, Panel, Pen
from gear_kinematics.report.interactive import BEHIND, FEW, SymmetricLog, tick_angle, tick_range
from gear_kinematics.report.mark import MARK

INK, FAINT = '#24292f', '#8c959f'
SERIES = ('#0969da', '#bf8700', '#1a7f37', '#8250df', '#cf222e', '#1b7c83')
"""Colours of lines in a plot, reused in turn for more lines."""
_COLOURED = (Pen.FIRST, Pen.SECOND, Pen.THIRD, Pen.FOURTH, Pen.FIFTH, Pen.SIXTH)
_PENS = {**dict(zip(_COLOURED, SERIES, strict=True)), Pen.MODEL: INK, Pen.FAINT: FAINT}
_STYLE = {
    'font.size': 9.0,
    'axes.edgecolor': INK,
    'axes.linewidth': 0.6,
    'grid.color': FAINT,
    'grid.linewidth': 0.3,
    'legend.frameon': False,
    'lines.linewidth': 1.2,
    'svg.hashsalt': 'gear_kinematics',  # for reproducible files
    'pdf.fonttype': 42,  # TrueType, which publishers require
}
_METADATA = {
    'png': {'Comment': MARK},
    'svg': {'Description': MARK, 'Date': None},  # undated, for reproducible files
    'pdf': {'Creator': MARK, 'CreationDate': None},
    'ps': {'Creator': MARK},
    'eps': {'Creator': MARK},
}
_WITH_EXIF = 'jpg', 'jpeg', 'tif', 'tiff', 'webp'
_SOFTWARE = 0x0131
"""The tag in Exif."""
_FOLDER = Path(__file__).parent
"""To import matplotlib in: it obeys a matplotlibrc in the current folder, which may come with a
recording."""
_DPI = 150
_PANEL = (6.0, 5.2)  # inches, side by side
_STACKED = (7.5, 3.0)  # inches


def to_image(figure: Figure, path: Path) -> bytes:
    """Draw a figure for a file, in the format of the suffix of its path.

    Raises:
        ValueError: if the suffix is unknown.
        ModuleNotFoundError: without matplotlib.
    """
    width, height = _STACKED if figure.stacked else _PANEL
    rows, columns = figure.shape
    return render(path, (columns * width, rows * height), partial(_draw_panels, figure))


def render(path: Path, size: tuple[float, float], draw: Callable[[Any], None]) -> bytes:
    """Draw on a matplotlib figure, with its size in inches, and return the bytes of its file.

    Raises:
        ValueError: if the suffix is unknown.
        ModuleNotFoundError: without matplotlib.
    """
    kind = format_of(path)

    def make(figure: Any) -> bytes:
        draw(figure)
        buffer = BytesIO()
        figure.savefig(buffer, format=kind, dpi=_DPI, **_marked(kind))
        return buffer.getvalue()

    return styled(size, make)


def _marked(kind: str) -> dict[str, Any]:
    """Options of savefig for our mark, in the formats that have a place for it."""
    if kind not in _WITH_EXIF:
        return {'metadata': _METADATA.get(kind)}
    from PIL import Image  # noqa: PLC0415, comes with matplotlib

    exif = Image.Exif()
    exif[_SOFTWARE] = MARK
    return {'pil_kwargs': {'exif': exif}}


def format_of(path: Path) -> str:
    """Return the format of an image file, which is the suffix of its path.

    Raises:
        ValueError: if the suffix is unknown.
        ModuleNotFoundError: without matplotlib.
    """
    with chdir(_FOLDER):
        from matplotlib.backend_bases import FigureCanvasBase  # noqa: PLC0415, an extra
    formats = FigureCanvasBase.get_supported_filetypes()
    if (kind := path.suffix[1:].lower()) not in formats:
        known = ', '.join(sorted(formats))
        raise ValueError(f'{path}: the suffix of a plot must be one of {known}')
    return kind


def styled(size: tuple[float, float], use: Callable[[Any], bytes]) -> bytes:
    """Return the result of `use` for a new figure in our style, with its size in inches.

    Raises:
        ModuleNotFoundError: without matplotlib.
    """
    with chdir(_FOLDER):
        from matplotlib import rc_context  # noqa: PLC0415, an extra
        from matplotlib.figure import Figure  # noqa: PLC0415, an extra
    with rc_context(_STYLE):
        return use(Figure(figsize=size, layout='constrained'))


def _draw_panels(figure: Figure, canvas: Any) -> None:
    places = canvas.subplots(*figure.shape, sharex=figure.stacked, squeeze=False).ravel()
    count = len(figure.panels)
    for axes in places[count:]:
        axes.set_visible(False)
    for k, (axes, panel) in enumerate(zip(places, figure.panels, strict=False), 1):
        if k == count or not figure.stacked:
            axes.set_xlabel(panel.x_label)
        _draw(axes, panel)


def _draw(axes: Any, panel: Panel) -> None:
    axes.set_title(panel.title, fontsize=10)
    axes.set_ylabel(panel.y_label)
    axes.grid(visible=True, color=FAINT, linewidth=0.3)
    if panel.scale == 'log':
        axes.set_xscale('log')
        axes.set_yscale('log')
        axes.set_ylim(bottom=panel.low)
    scale = SymmetricLog.of(panel) if panel.scale == 'symlog' else None
    if scale:
        axis = scale.axis(panel)
        axes.set_yticks(axis['tickvals'], axis['ticktext'])
        axes.set_ylim(axis['range'])
    if panel.equal:
        axes.set_aspect('equal')
    named = set()
    for line in panel.lines:
        axes.plot(
            line.x,
            [scale(y) for y in line.y] if scale else line.y,
            linestyle='none' if line.points else '--' if line.pen == Pen.MODEL else '-',
            marker='.' if line.points else 'none',
            markersize=2.0 if len(line.x) > FEW else 6.0,
            linewidth=1.0,
            alpha=BEHIND if line.behind else 1.0,
            color=_PENS[line.pen],
            label='' if line.name in named else line.name,
        )
        if line.error is not None:
            axes.errorbar(
                line.x,
                line.y,
                line.error,
                linestyle='none',
                linewidth=1.0,
                capsize=3.0,
                color=_PENS[line.pen],
            )
        named.add(line.name)
    if panel.ticks:
        axes.set_xticks(*zip(*panel.ticks, strict=True), rotation=tick_angle(panel))
        axes.set_xlim(tick_range(panel))
        axes.tick_params('x', labelsize=8)
    for place, text in panel.marks:
        axes.axvline(place, color=FAINT, linestyle='--', linewidth=0.8)
        _annotate(axes, text, (place, 0.99), ('data', 'axes fraction'), rotation=90, ha='right')
    for level, text in panel.levels:
        place = scale(level) if scale else level
        axes.axhline(place, color=FAINT, linestyle='--', linewidth=0.8)
        _annotate(axes, text, (0.01, place), ('axes fraction', 'data'))
    if len(named) > 1:
        axes.legend(loc='best', fontsize=9)


def _annotate(
    axes: Any, text: str, place: tuple[float, float], coordinates: tuple[str, str], **style: Any
) -> None:
    axes.annotate(
        text,
        place,
        xycoords=coordinates,
        xytext=(-2, 0) if style else (0, -2),
        textcoords='offset points',
        va='top',
        fontsize=8,
        color=FAINT,
        **style,
    )
