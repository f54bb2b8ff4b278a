"""Writes figures as image files, with matplotlib."""

from collections.abc import Callable, Sequence
from contextlib import chdir
from dataclasses import dataclass, replace
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any

from gear_kinematics.report.document import Figure, Panel, Pen
from gear_kinematics.report.interactive import (
    BEHIND,
    FEW,
    SymmetricLog,
    is_named,
    lane_range,
    tick_angle,
    tick_range,
)
from gear_kinematics.report.mark import MARK

INK, FAINT = '#24292f', '#8c959f'
SERIES = ('#0969da', '#bf8700', '#1a7f37', '#8250df', '#cf222e', '#1b7c83')
"""Colours of lines in a plot, reused in turn for more lines."""
_COLOURED = (Pen.FIRST, Pen.SECOND, Pen.THIRD, Pen.FOURTH, Pen.FIFTH, Pen.SIXTH)
_PENS = {**dict(zip(_COLOURED, SERIES, strict=True)), Pen.MODEL: INK, Pen.FAINT: FAINT}
_STYLE = {
    'axes.edgecolor': INK,
    'axes.linewidth': 0.6,
    'grid.color': FAINT,
    'grid.linewidth': 0.3,
    'legend.frameon': False,
    'lines.linewidth': 1.2,
    'svg.hashsalt': 'gear_kinematics',  # for reproducible files
    'svg.fonttype': 'none',  # text that can be searched and edited
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
_PANEL = (6.0, 5.2)  # inches, side by side
_STACKED = (7.5, 3.0)  # inches
_TALLEST = 12.0  # inches, up to which stacked panels have this height
_LEAST_PANEL = (3.1, 1.5)  # inches, with text of the size in a paper
_TEXT_HEIGHT = 0.9
"""Inches of the height of a figure that titles, labels and legend take at any width."""
_COLUMN = 4.7
"""Inches; narrower figures are for a column of a paper, with smaller text."""
_FONT_SIZES = (9.0, 7.0)  # points, of figures for a page and for a column
_INCH = 25.4  # mm
_WIDTHS = (30.0, 1000.0)  # mm
_DOTS = (30, 2400)  # per inch
_MOST_PIXELS = 20_000
"""Width of an image."""


@dataclass(frozen=True, slots=True)
class Paper:
    """What a figure is for; text has the same size on every paper."""

    width_mm: float | None = None
    """mm; None: the width that suits the figure."""
    dpi: int = 150
    """Of image formats that consist of pixels."""

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises:
            ValueError: if one is out of bounds, or the image would be too large.
        """
        least, most = _WIDTHS
        if self.width_mm is not None and not least <= self.width_mm <= most:
            raise ValueError(f'--width-mm must be between {least:g} and {most:g}')
        if not _DOTS[0] <= self.dpi <= _DOTS[1]:
            raise ValueError(f'--dpi must be between {_DOTS[0]} and {_DOTS[1]}')
        if (self.width_mm or 0.0) / _INCH * self.dpi > _MOST_PIXELS:
            raise ValueError(f'an image is at most {_MOST_PIXELS} pixels wide: reduce --dpi')

    @property
    def width(self) -> float | None:
        """Inches, if it is given."""
        return None if self.width_mm is None else self.width_mm / _INCH


_PAPER = Paper()


def to_image(figure: Figure, path: Path, paper: Paper = _PAPER) -> bytes:
    """Draw a figure for a file, in the format of the suffix of its path.

    Raises:
        ValueError: if the suffix is unknown.
        ModuleNotFoundError: without matplotlib.
    """
    narrowest, least = _LEAST_PANEL
    if figure.stacked:
        share = sum(figure.heights)
        width, height = _STACKED[0], min(_STACKED[1], max(least, _TALLEST / share))
        if paper.width:
            height = max(least, height * paper.width / width)
        return render(
            path, (width, share * height), partial(_draw_panels, figure), paper, scaled=False
        )
    if paper.width:  # as many panels side by side as can be read
        most = max(1, int(paper.width / narrowest))
        figure = replace(figure, columns=min(most, figure.shape[1]))
    rows, columns = figure.shape
    size = columns * _PANEL[0], rows * _PANEL[1]
    return render(path, size, partial(_draw_panels, figure), paper)


def render(
    path: Path,
    size: tuple[float, float],
    draw: Callable[[Any], None],
    paper: Paper = _PAPER,
    *,
    scaled: bool = True,
) -> bytes:
    """Draw on a matplotlib figure, and return the bytes of its file.

    Args:
        path: its suffix is the format.
        size: in inches, unless the paper has a width.
        draw: draws on the figure.
        paper: what it is for.
        scaled: whether another width changes the height.

    Raises:
        ValueError: if the suffix is unknown.
        ModuleNotFoundError: without matplotlib.
    """
    kind = format_of(path)

    def make(figure: Any) -> bytes:
        draw(figure)
        buffer = BytesIO()
        figure.savefig(buffer, format=kind, dpi=paper.dpi, **_marked(kind))
        return buffer.getvalue()

    width, height = size
    if paper.width:
        ratio = paper.width / width if scaled else 1.0
        width, height = paper.width, _TEXT_HEIGHT + (height - _TEXT_HEIGHT) * ratio
    return styled((width, height), make, _FONT_SIZES[bool(paper.width) and width < _COLUMN])


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


def styled(
    size: tuple[float, float], use: Callable[[Any], bytes], font_size: float = _FONT_SIZES[0]
) -> bytes:
    """Return the result of `use` for a new figure in our style.

    Args:
        size: of the figure, inches.
        use: what is done with it.
        font_size: points.

    Raises:
        ModuleNotFoundError: without matplotlib.
    """
    with chdir(_FOLDER):
        from matplotlib import rc_context  # noqa: PLC0415, an extra
        from matplotlib.figure import Figure  # noqa: PLC0415, an extra
    with rc_context({**_STYLE, 'font.size': font_size}):
        return use(Figure(figsize=size, layout='constrained'))


def add_legend(
    figure: Any, handles: Sequence[Any], names: Sequence[str], columns: Sequence[int] = ()
) -> None:
    """Add a legend above all plots, so that it hides none of their lines.

    Args:
        figure: of matplotlib.
        handles: what it names.
        names: as many.
        columns: numbers of columns to choose from, of which the first that fits the width is
            taken; without them, as many as fit.
    """
    for count in (*(columns or range(len(names), 1, -1)), 1):
        legend = figure.legend(handles, names, loc='outside upper center', ncols=count)
        if count == 1 or legend.get_window_extent().width <= figure.bbox.width:
            break
        legend.remove()


def _draw_panels(figure: Figure, canvas: Any) -> None:
    ratios = {'height_ratios': figure.heights} if figure.stacked else {}
    places = canvas.subplots(*figure.shape, sharex=figure.stacked, squeeze=False, **ratios).ravel()
    count = len(figure.panels)
    for axes in places[count:]:
        axes.set_visible(False)
    for k, (axes, panel) in enumerate(zip(places, figure.panels, strict=False), 1):
        if k == count or not figure.stacked:
            axes.set_xlabel(panel.x_label)
        _draw(axes, panel)
    named = {
        name: handle
        for axes, panel in zip(places, figure.panels, strict=False)
        if is_named(panel)
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if named:
        add_legend(canvas, list(named.values()), list(named))


def _draw(axes: Any, panel: Panel) -> None:
    axes.set_title(panel.title, fontsize='medium', wrap=True)
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
    if panel.lanes:
        axes.set_yticks([])
        axes.set_ylim(lane_range(panel))
    named = set()
    for line in panel.lines:
        axes.plot(
            line.x,
            [scale(y) for y in line.y] if scale else line.y,
            linestyle='none' if line.points else '--' if line.pen == Pen.MODEL else '-',
            marker='.' if line.points or panel.lanes else 'none',
            markersize=2.0 if len(line.x) > FEW else 6.0,
            linewidth=3.0 if panel.lanes else 1.0,
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
        axes.tick_params('x', labelsize='small')
    for place, text in panel.marks:
        axes.axvline(place, color=FAINT, linestyle='--', linewidth=0.8)
        _annotate(axes, text, (place, 0.99), ('data', 'axes fraction'), rotation=90, ha='right')
    for level, text in panel.levels:
        place = scale(level) if scale else level
        axes.axhline(place, color=FAINT, linestyle='--', linewidth=0.8)
        _annotate(axes, text, (0.01, place), ('axes fraction', 'data'))


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
        fontsize='small',
        color=FAINT,
        **style,
    )
