# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Plot of two preloaded branches under an external torque."""

import math

import numpy as np

from gear_kinematics.kinematics.preload import Preload
from gear_kinematics.report.document import Figure, Line, Panel, Pen
from gear_kinematics.shape.angles import arc_seconds

_STEPS = 4
"""Rows of a table on either side of zero load, whose spacing is a round number."""
_ROUND = (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10)
"""Spacings of the rows, times a power of ten."""
_MARGIN = 1.2
"""Least range of load / greatest load at which a branch leaves mesh."""


def load_range(preload: Preload) -> float:
    """The load up to which a table and a plot show all that happens, N·m."""
    loads = (load for load in leaving_mesh(preload) if abs(load) < math.inf)
    spacing = _MARGIN * (max(map(abs, loads), default=0.0) or 1.0) / _STEPS
    decade = 10.0 ** math.floor(math.log10(spacing))
    return _STEPS * next(n * decade for n in _ROUND if n * decade >= spacing)


def loads_to_list(preload: Preload, max_load: float) -> list[float]:
    """Loads for a table, N·m: evenly spaced, with those at which a branch leaves mesh between."""
    even = np.linspace(-max_load, max_load, 2 * _STEPS + 1).tolist()
    return sorted({*even, *(load for load in leaving_mesh(preload) if abs(load) < max_load)})


def leaving_mesh(preload: Preload, names: tuple[str, str] = ('A', 'B')) -> dict[float, str]:
    """The loads at which branches leave mesh, N·m, in words; none without a preload."""
    if not preload.torque:
        return {}
    loads = (preload.threshold_a, preload.threshold_b)
    return {load: f'branch {name} leaves mesh' for load, name in zip(loads, names, strict=True)}


def torque_split(preload: Preload, names: tuple[str, str], max_load: float) -> Figure:
    """Plot how two branches share an external torque, and the turn of the output.

    Args:
        preload: of the two branches.
        names: of branches A and B.
        max_load: N·m; the plot reaches as far either way.
    """
    a, b = names
    corners = leaving_mesh(preload, names).items()
    marks = tuple((load, text) for load, text in corners if abs(load) < max_load)
    unnamed = tuple((load, '') for load, _ in marks)
    load = np.sort([*np.linspace(-max_load, max_load, 1001), *(load for load, _ in marks)])
    split = preload.split(load)
    torques = (
        Line(f'branch {a}', Pen.FIRST, load, split.branch_a),
        Line(f'branch {b}', Pen.SECOND, load, split.branch_b),
    )
    turn = Line('output', Pen.THIRD, load, arc_seconds(split.output_turn))
    x_label = f'load at the output [N·m], positive as ring gear {a} is turned'
    title = f'preload {preload.torque:.4g} N·m'
    return Figure(
        (
            Panel(title, x_label, 'torque [N·m]', torques, marks),
            Panel('', x_label, 'turn of the output [″]', (turn,), unnamed),
        ),
        stacked=True,
    )
