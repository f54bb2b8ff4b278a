"""Hysteresis, transmission error and its spectrum."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from gear_kinematics.lost_motion.curves import Panel
from gear_kinematics.plotting.figures import FAINT, INK, SERIES, render

_LINES = {'forward': SERIES[0], 'backward': SERIES[1], 'model': INK, 'unknown': FAINT}
"""Colours of the lines of a panel."""


def lost_motion(panels: Sequence[Panel], path: Path) -> bytes:
    """Plot what `curves.panels` gives, side by side.

    Args:
        panels: at least one.
        path: of the file that is to be.
    """
    return render(path, (6.0 * len(panels), 5.2), partial(_draw_all, panels))


def _draw_all(panels: Sequence[Panel], figure: Any) -> None:
    for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True):
        _draw(axes, panel)


def _draw(axes: Any, panel: Panel) -> None:
    axes.set_title(panel.title, fontsize=10)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    axes.grid(visible=True, color=FAINT, linewidth=0.3)
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
        axes.axvline(place, color=FAINT, linestyle='--', linewidth=0.8)
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
            color=FAINT,
        )
    if named:
        axes.legend(loc='best', fontsize=9)
