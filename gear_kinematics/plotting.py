"""Plots for people, as the bytes of image files; matplotlib is imported here only."""

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.angles import arc_seconds
from gear_kinematics.kinematics.preload import Preload
from gear_kinematics.lost_motion.curves import Panel

_INK, _FAINT, _FIRST, _SECOND = '#24292f', '#8c959f', '#0969da', '#bf8700'
_LINES = {'forward': _FIRST, 'backward': _SECOND, 'model': _INK, 'unknown': _FAINT}
"""Colours of the lines of a panel."""


def torque_split(preload: Preload, names: tuple[str, str], max_load: float, path: Path) -> bytes:
    """Plot what an external torque does to two braced branches, and how far the output gives way.

    Args:
        preload: of the branches.
        names: of branches A and B.
        max_load: N·m; the plot reaches as far either way.
        path: of the file that is to be; its suffix says which format.

    Raises:
        ValueError: if there is no such format.
        RuntimeError: without matplotlib.
    """
    a, b = names
    thresholds = ((a, preload.threshold_a), (b, preload.threshold_b))
    corners = {name: load for name, load in thresholds if preload.torque and abs(load) < max_load}
    load = np.sort([*np.linspace(-max_load, max_load, 1001), *corners.values()])
    split = preload.split(load)
    figure = _figure(path)
    torques, turns = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    leaving = [f'branch {name} leaves mesh at {load:+.4g} N·m' for name, load in corners.items()]
    torques.set_title('; '.join([f'preload {preload.torque:.4g} N·m', *leaving]), fontsize=10)
    torques.plot(load, split.branch_a, color=_FIRST, label=f'branch {a}')
    torques.plot(load, split.branch_b, color=_SECOND, label=f'branch {b}')
    torques.set_ylabel('torque, N·m')
    torques.legend(loc='upper center')
    turns.plot(load, arc_seconds(split.output_turn), color=_INK)
    turns.set_ylabel('turn of the output, ″')
    turns.set_xlabel(f'load at the output, N·m, positive as ring gear {a} is turned')
    for axes in (torques, turns):
        axes.grid(visible=True, color=_FAINT, linewidth=0.3)
        for corner in corners.values():
            axes.axvline(corner, color=_FAINT, linestyle='--', linewidth=1.0)
    return _image(figure, path)


def lost_motion(panels: Sequence[Panel], path: Path) -> bytes:
    """Plot what `curves.panels` gives, side by side.

    Args:
        panels: at least one.
        path: of the file that is to be; its suffix says which format.

    Raises:
        ValueError: if there is no such format.
        RuntimeError: without matplotlib.
    """
    figure = _figure(path, (6.0 * len(panels), 5.2))
    for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True):
        _draw(axes, panel)
    return _image(figure, path)


def _draw(axes: Any, panel: Panel) -> None:
    axes.set_title(panel.title, fontsize=10)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    axes.grid(visible=True, color=_FAINT, linewidth=0.3)
    if panel.low is not None:
        axes.set_xscale('log')
        axes.set_yscale('log')
        axes.set_ylim(bottom=panel.low)
    named = set()
    for line in panel.lines:
        dashes = '--' if line.kind == 'model' else '-'
        axes.plot(
            line.x,
            line.y,
            linestyle='none' if line.points else dashes,
            marker='.' if line.points else 'none',
            markersize=2.0,
            linewidth=1.0,
            color=_LINES[line.kind],
            label='' if line.name in named else line.name,
        )
        named.add(line.name)
    for place, text in panel.marks:
        axes.axvline(place, color=_FAINT, linestyle='--', linewidth=0.8)
        axes.annotate(
            text,
            (place, 0.99),
            xycoords=('data', 'axes fraction'),
            xytext=(-2, 0),
            textcoords='offset points',
            rotation=90,
            ha='right',
            va='top',
            fontsize=8,
            color=_FAINT,
        )
    if named:
        axes.legend(loc='best', fontsize=9)


def _figure(path: Path, size: tuple[float, float] = (7.5, 6.0)) -> Any:
    try:
        from matplotlib.figure import Figure  # noqa: PLC0415, an extra
    except ImportError as error:
        raise RuntimeError('a plot needs the Python package matplotlib') from error
    figure = Figure(figsize=size, layout='constrained')
    formats = figure.canvas.get_supported_filetypes()
    if path.suffix[1:].lower() not in formats:
        raise ValueError(f'{path}: the suffix of a plot is one of {", ".join(sorted(formats))}')
    return figure


def _image(figure: Any, path: Path) -> bytes:
    buffer = BytesIO()
    figure.savefig(buffer, format=path.suffix[1:].lower(), dpi=150)
    return buffer.getvalue()
