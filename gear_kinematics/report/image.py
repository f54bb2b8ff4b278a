# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Writes figures as image files, with matplotlib."""

import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import chdir, contextmanager
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

from gear_kinematics.report.document import Figure, Panel, Pen, number
from gear_kinematics.report.mark import MARK
from gear_kinematics.report.page import resource

COLOURS = dict(re.findall(r'--(\w+): light-dark\((#\w+)', resource('page.css')))
"""Colours of the light style of pages, by their names."""
INK, FAINT, RULE = COLOURS['text'], COLOURS['faint'], COLOURS['rule']
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
"""Metadata with our mark, by which files are recognised, for each format."""
_FOLDER = '/'
"""Working directory in which matplotlib is imported.

It obeys a matplotlibrc in the current folder, which may come with a recording. This directory has
neither such a file nor modules that could be imported in place of others."""
_PANEL = (6.0, 5.2)  # inches, side by side
_STACKED = (7.5, 3.0)  # inches
_FONT_SIZE = 9.0  # points
_DPI = 150
_TICK_DIGITS = 8


def check_image(path: Path, formats: Collection[str] = _METADATA.keys()) -> None:
    """Check before any work that the suffix is a format, and that there is matplotlib.

    Raises ValueError or ModuleNotFoundError if that is not so.
    """
    if _format(path) not in formats:
        raise ValueError(
            f'{path}: the suffix must be {" or ".join(f".{each}" for each in formats)}'
        )
    with chdir(_FOLDER):
        import_module('matplotlib')


def to_image(figure: Figure, path: Path) -> bytes:
    """Draw a figure to an image file that was checked before."""
    rows, columns = figure.shape
    if figure.stacked:
        size = _STACKED[0], rows * _STACKED[1]
    else:
        size = columns * _PANEL[0], rows * _PANEL[1]
    with canvas(size) as drawn:
        _draw_panels(figure, drawn)
        return encode(drawn, path)


def encode(figure: Any, path: Path) -> bytes:
    """Return the bytes of the image file of matplotlib's figure, with our mark."""
    buffer, suffix = BytesIO(), _format(path)
    figure.savefig(buffer, format=suffix, dpi=_DPI, metadata=_METADATA[suffix])
    return buffer.getvalue()


def _format(path: Path) -> str:
    return path.suffix[1:].lower()


@contextmanager
def canvas(size: tuple[float, float]) -> Iterator[Any]:
    """Open a figure of matplotlib in our style, of a size in inches, to encode in the block."""
    with chdir(_FOLDER):
        from matplotlib import rc_context  # noqa: PLC0415, an extra
        from matplotlib.figure import Figure  # noqa: PLC0415, an extra
    with rc_context({**_STYLE, 'font.size': _FONT_SIZE}):
        yield Figure(figsize=size, layout='constrained')


def add_legend(figure: Any, handles: Sequence[Any], names: Sequence[str]) -> None:
    """Add a legend above all plots, in as many columns as fit, so that it hides no lines."""
    for count in range(len(names), 0, -1):
        legend = figure.legend(handles, names, loc='outside upper center', ncols=count)
        if count == 1 or legend.get_window_extent().width <= figure.bbox.width:
            break
        legend.remove()


def _draw_panels(figure: Figure, canvas: Any) -> None:
    places = canvas.subplots(*figure.shape, sharex=figure.stacked, squeeze=False).ravel()
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
    axes.set_yscale(panel.scale)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(lambda value, _: number(value, _TICK_DIGITS).replace('-', '−'))
    if panel.equal:
        axes.set_aspect('equal')
    for line in panel.lines:
        axes.plot(
            line.x,
            line.y,
            linestyle='none' if line.points else '--' if line.pen == Pen.MODEL else '-',
            marker='.' if line.points else 'none',
            markersize=3.0,
            linewidth=1.0,
            color=COLOURS[line.pen],
            label=line.name,
        )
    label = {'textcoords': 'offset points', 'va': 'top', 'fontsize': 'small'}
    for place, text in panel.marks:
        axes.axvline(place, color=FAINT, linestyle='--', linewidth=0.8)
        at = {'xycoords': ('data', 'axes fraction'), 'xytext': (-2, 0), 'color': FAINT}
        axes.annotate(text, (place, 0.99), rotation=90, ha='right', **at, **label)
    for level, text in panel.levels:
        colour = COLOURS['fail']
        axes.axhline(level, color=colour, linestyle='--', linewidth=0.8)
        at = {'xycoords': ('axes fraction', 'data'), 'xytext': (0, -2), 'color': colour}
        axes.annotate(text, (0.01, level), **at, **label)
