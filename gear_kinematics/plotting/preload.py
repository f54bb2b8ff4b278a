"""Plot of two preloaded branches under an external torque."""

import numpy as np

from gear_kinematics.kinematics.preload import Preload
from gear_kinematics.report.document import Figure, Line, Panel, Pen
from gear_kinematics.shape.angles import arc_seconds


def torque_split(preload: Preload, names: tuple[str, str], max_load: float) -> Figure:
    """Plot how two branches share an external torque, and the turn of the output.

    Args:
        preload: of the two branches.
        names: of branches A and B.
        max_load: N·m; the plot reaches as far either way.
    """
    a, b = names
    thresholds = ((a, preload.threshold_a), (b, preload.threshold_b))
    corners = {name: load for name, load in thresholds if preload.torque and abs(load) < max_load}
    load = np.sort([*np.linspace(-max_load, max_load, 1001), *corners.values()])
    split = preload.split(load)
    marks = tuple((corner, f'branch {name} leaves mesh') for name, corner in corners.items())
    unnamed = tuple((corner, '') for corner in corners.values())
    torques = (
        Line(f'branch {a}', Pen.FIRST, load, split.branch_a),
        Line(f'branch {b}', Pen.SECOND, load, split.branch_b),
    )
    turn = Line('output', Pen.FAINT, load, arc_seconds(split.output_turn))
    x_label = f'load at the output [N·m], positive as ring gear {a} is turned'
    title = f'preload {preload.torque:.4g} N·m'
    return Figure(
        (
            Panel(title, x_label, 'torque [N·m]', torques, marks),
            Panel('', x_label, 'turn of the output [″]', (turn,), unnamed),
        ),
        stacked=True,
    )
