"""What an external torque does to two braced branches."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.kinematics.preload import Preload
from gear_kinematics.plotting.figures import FAINT, INK, SERIES, render
from gear_kinematics.shape.angles import arc_seconds


def torque_split(preload: Preload, names: tuple[str, str], max_load: float, path: Path) -> bytes:
    """Plot how two branches share an external torque, and how far the output gives way.

    Args:
        preload: of the branches.
        names: of branches A and B.
        max_load: N·m; the plot reaches as far either way.
        path: of the file that is to be.
    """
    return render(path, (7.5, 6.0), partial(_draw, preload, names, max_load))


def _draw(preload: Preload, names: tuple[str, str], max_load: float, figure: Any) -> None:
    a, b = names
    thresholds = ((a, preload.threshold_a), (b, preload.threshold_b))
    corners = {name: load for name, load in thresholds if preload.torque and abs(load) < max_load}
    load = np.sort([*np.linspace(-max_load, max_load, 1001), *corners.values()])
    split = preload.split(load)
    torques, turns = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    leaving = [f'branch {name} leaves mesh at {load:+.4g} N·m' for name, load in corners.items()]
    torques.set_title('; '.join([f'preload {preload.torque:.4g} N·m', *leaving]), fontsize=10)
    torques.plot(load, split.branch_a, color=SERIES[0], label=f'branch {a}')
    torques.plot(load, split.branch_b, color=SERIES[1], label=f'branch {b}')
    torques.set_ylabel('torque, N·m')
    torques.legend(loc='upper center')
    turns.plot(load, arc_seconds(split.output_turn), color=INK)
    turns.set_ylabel('turn of the output, ″')
    turns.set_xlabel(f'load at the output, N·m, positive as ring gear {a} is turned')
    for axes in (torques, turns):
        axes.grid(visible=True, color=FAINT, linewidth=0.3)
        for corner in corners.values():
            axes.axvline(corner, color=FAINT, linestyle='--', linewidth=1.0)
