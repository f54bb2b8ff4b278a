# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Plot of two preloaded branches under an external torque."""

import math

import numpy as np

from gear_kinematics.kinematics.preload import Preload
from gear_kinematics.report.document import Figure, Line, Panel, Pen
from gear_kinematics.shape.angles import arc_seconds

_MARGIN = 1.2  # greatest load of the plot over that at which a branch leaves mesh


def torque_split(preload: Preload, names: tuple[str, str]) -> Figure:
    """Plot how branches A and B share an external torque, and the turn of the output."""
    a, b = names
    marks = [
        (load, f'branch {name} leaves mesh')
        for name, load in ((a, preload.threshold_a), (b, preload.threshold_b))
        if preload.torque and math.isfinite(load)
    ]
    leaving = [load for load, _ in marks]
    most = _MARGIN * max(map(abs, leaving), default=1.0)  # N·m
    load = np.sort([*np.linspace(-most, most, 1001), *leaving])
    split = preload.split(load)
    torques = (
        Line(f'branch {a}', Pen.FIRST, load, split.branch_a),
        Line(f'branch {b}', Pen.SECOND, load, split.branch_b),
    )
    turn = Line('output', Pen.THIRD, load, arc_seconds(split.output_turn))
    x_label = f'load at the output [N·m], positive as ring gear {a} is turned'
    title = f'preload {preload.torque:.4g} N·m'
    unnamed = tuple((load, '') for load in leaving)
    return Figure(
        (
            Panel(title, x_label, 'torque [N·m]', torques, tuple(marks)),
            Panel('', x_label, 'turn of the output [″]', (turn,), unnamed),
        ),
        stacked=True,
    )
