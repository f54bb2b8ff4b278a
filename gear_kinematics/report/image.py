# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Writes figures as image files, with matplotlib."""

import re
from collections.abc import Iterator, Sequence
from contextlib import chdir, contextmanager
from dataclasses import dataclass, replace
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

from gear_kinematics.report.document import MAX_LARGE_DOTS, Figure, Panel, Pen
from gear_kinematics.report.mark import MARK
from gear_kinematics.report.page import resource
from gear_kinematics.report.symmetric_log import SymmetricLog, tick_text

COLOURS = dict(re.findall(r'--(\w+): light-dark\((#\w+)', resource('page.css')))
"""Of pages in the light, by their names."""
INK, FAINT, RULE = COLOURS['text'], COLOURS['faint'], COLOURS['rule']
SERIES = tuple(COLOURS[pen] for pen in Pen if pen not in {Pen.MODEL, Pen.FAINT})
"""Colours of lines in a plot, reused in turn for more lines."""
_STYLE = {
    'axes.edgecolor': INK,
    'axes.linewidth': 0.6,
    'axes.axisbelow': True,
    'grid.color': RULE,
    'grid.linewidth': 0.5,
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
}
"""By the format: our mark, by which files are recognised."""
_FOLDER = '/'
"""To import matplotlib in: it obeys a matplotlibrc in the current folder, which may come with a
recording. There are no modules either that could be imported in place of others."""
_PANEL = (6.0, 5.2)  # inches, side by side
_STACKED = (7.5, 3.0)  # inches
_TALLEST = 12.0  # inches, up to which stacked panels have this height
_LEAST_PANEL = (3.1, 1.5)  # inches, with text of the size in a paper
_TEXT_HEIGHT = 0.9
"""Inches of the height of a figure that titles, labels and legend take at any width."""
_COLUMN = 4.7
"""Inches; narrower figures are for a column of a paper, with smaller text."""
_FONT_SIZES = (9.0, 7.0)  # points, of figures for a page and for a column
INCH = 25.4  # mm


@dataclass(frozen=True, slots=True)
class ImageFile:
    """What a figure is drawn for; text has the same size at every width."""

    path: Path
    """Its suffix is the format."""
    width_mm: float | None = None
    """None: the width that suits the figure."""
    dpi: int = 150
    """Of formats that consist of pixels."""

    @property
    def width(self) -> float | None:
        """Inches, if it is given."""
        return None if self.width_mm is None else self.width_mm / INCH

    @property
    def format(self) -> str:
        """The format."""
        return self.path.suffix[1:].lower()

    def check(self) -> None:
        """Check that it can be written, before any work.

        Raises:
            ValueError: if the suffix is unknown.
            ModuleNotFoundError: without matplotlib.
        """
        if self.format not in _METADATA:
            known = ', '.join(_METADATA)
            raise ValueError(f'{self.path}: the suffix of a plot must be one of {known}')
        with chdir(_FOLDER):
            import_module('matplotlib')

    @contextmanager
    def canvas(self, width: float, height: float, *, scaled: bool = True) -> Iterator[Any]:
        """Open a figure of matplotlib; the file has to be encoded before it is closed.

        Args:
            width: inches, unless the file has a width.
            height: inches.
            scaled: whether another width changes the height.
        """
        if self.width:
            ratio = self.width / width if scaled else 1.0
            width, height = self.width, _TEXT_HEIGHT + (height - _TEXT_HEIGHT) * ratio
        small = bool(self.width) and width < _COLUMN
        with canvas((width, height), _FONT_SIZES[small]) as opened:
            yield opened

    def encode(self, figure: Any) -> bytes:
        """Return the bytes of the file, with our mark."""
        buffer, metadata = BytesIO(), _METADATA[self.format]
        figure.savefig(buffer, format=self.format, dpi=self.dpi, metadata=metadata)
        return buffer.getvalue()


def to_image(figure: Figure, file: ImageFile) -> bytes:
    """Draw a figure for a file that was checked."""
    least_width, least_height = _LEAST_PANEL
    if figure.stacked:
        share = sum(panel.height for panel in figure.panels)
        width, height = _STACKED[0], min(_STACKED[1], max(least_height, _TALLEST / share))
        if file.width:
            height = max(least_height, height * file.width / width)
        size = width, share * height
    else:
        if file.width:  # as many panels side by side as can be read
            most = max(1, int(file.width / least_width))
            figure = replace(figure, columns=min(most, figure.shape[1]))
        rows, columns = figure.shape
        size = columns * _PANEL[0], rows * _PANEL[1]
    with file.canvas(*size, scaled=not figure.stacked) as drawn:
        _draw_panels(figure, drawn)
        return file.encode(drawn)


@contextmanager
def canvas(size: tuple[float, float], font_size: float = _FONT_SIZES[0]) -> Iterator[Any]:
    """Open a figure of matplotlib in our style, of a size in inches.

    Raises:
        ModuleNotFoundError: without matplotlib.
    """
    with chdir(_FOLDER):
        from matplotlib import rc_context  # noqa: PLC0415, an extra
        from matplotlib.figure import Figure  # noqa: PLC0415, an extra
    with rc_context({**_STYLE, 'font.size': font_size}):
        yield Figure(figsize=size, layout='constrained')


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
    heights = [panel.height for panel in figure.panels]
    ratios = {'height_ratios': heights} if figure.stacked else {}
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
        if panel.has_legend
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if named:
        add_legend(canvas, list(named.values()), list(named))


def _draw(axes: Any, panel: Panel) -> None:
    axes.set_title(panel.title, fontsize='medium', wrap=True)
    axes.set_ylabel(panel.y_label)
    axes.grid(visible=True)
    if panel.scale == 'log':
        axes.set_xscale('log')
        axes.set_yscale('log')
        axes.set_ylim(bottom=panel.low)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(lambda value, _: tick_text(value))
    scale = SymmetricLog(panel) if panel.scale == 'symlog' else None
    if scale:
        axes.set_yticks(scale.axis['tickvals'], scale.axis['ticktext'])
        axes.set_ylim(scale.axis['range'])
    if panel.equal:
        axes.set_aspect('equal')
    if panel.lanes:
        axes.set_yticks([])
        axes.set_ylim(panel.lane_range)
    for line in panel.lines:
        axes.plot(
            line.x,
            scale.height(line.y) if scale else line.y,
            linestyle='none' if line.points else '--' if line.pen == Pen.MODEL else '-',
            marker='.' if line.points or panel.lanes else 'none',
            markersize=2.0 if len(line.x) > MAX_LARGE_DOTS else 6.0,
            linewidth=3.0 if panel.lanes else 1.0,
            alpha=line.opacity,
            color=COLOURS[line.pen],
            label=line.name,
        )
        if line.error is not None:
            style = {'linestyle': 'none', 'linewidth': 1.0, 'capsize': 3.0}
            axes.errorbar(line.x, line.y, line.error, color=COLOURS[line.pen], **style)
    if panel.ticks:
        axes.set_xticks(*zip(*panel.ticks, strict=True), rotation=panel.tick_angle)
        axes.set_xlim(panel.tick_range)
        axes.tick_params('x', labelsize='small')
    label = {'textcoords': 'offset points', 'va': 'top', 'fontsize': 'small'}
    for place, text in panel.marks:
        axes.axvline(place, color=FAINT, linestyle='--', linewidth=0.8)
        at = {'xycoords': ('data', 'axes fraction'), 'xytext': (-2, 0), 'color': FAINT}
        axes.annotate(text, (place, 0.99), rotation=90, ha='right', **at, **label)
    for level, text in panel.levels:
        place = float(scale.height(level)) if scale else level
        colour = FAINT if panel.lanes else COLOURS['fail']
        axes.axhline(place, color=colour, linestyle='--', linewidth=0.8)
        at = {'xycoords': ('axes fraction', 'data'), 'xytext': (0, -2), 'color': colour}
        axes.annotate(text, (0.01, place), **at, **label)
