"""The panels that show several recordings together."""

from collections.abc import Iterator, Sequence

import numpy as np

from gear_kinematics.measurement.compare.groups import Group
from gear_kinematics.measurement.compare.quantities import Chosen, Common
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report.document import Figure, Line, Panel, Pen, printable

_PENS = (Pen.FIRST, Pen.SECOND, Pen.THIRD, Pen.FOURTH, Pen.FIFTH, Pen.SIXTH)
_TORQUES = 300
"""Of half a loop."""


def figure(common: Common, groups: Sequence[Group]) -> Figure:
    """Draw the loops of recordings over one another, and their main figures over the groups."""
    ticks = tuple((float(k), printable(group.name)) for k, group in enumerate(groups))
    lines = tuple(sorted(_loops(groups, common.loops), key=lambda line: not line.behind))
    torque, angle = 'torque at the output [N·m]', 'wind-up at the output [arcmin]'
    panels = [Panel('mean loops', torque, angle, lines)] if lines else []
    places = [  # those of a group side by side
        (k + 0.5 * place / len(group.members), member)
        for k, group in enumerate(groups)
        for place, member in enumerate(group.members)
    ]
    for quantity in filter(lambda quantity: quantity.main, common.quantities):
        known = [(x, v.value, v.uncertainty) for x, m in places if (v := quantity.values[m])]
        x, y, error = np.array(known, dtype=np.float64).T
        scale, label = quantity.scale, f'{quantity.name} [{quantity.cell(0.0).unit}]'
        line = Line('recordings', Pen.FIRST, x, scale * y, points=True, error=scale * error)
        panels.append(Panel(quantity.name, '', label, (line,), ticks=ticks))
    return Figure(tuple(panels))


def _loops(groups: Sequence[Group], chosen: Sequence[Chosen]) -> Iterator[Line]:
    """Draw mean loops; of many groups, only the first and the last are told apart."""
    few = len(groups) <= len(_PENS)
    pens = dict(enumerate(_PENS)) if few else {0: Pen.FIRST, len(groups) - 1: Pen.SECOND}
    for k, group in enumerate(groups):
        for ramps, _ in filter(None, (chosen[member] for member in group.members)):
            torque = ramps.amplitude * np.linspace(1.0, -1.0, _TORQUES)
            fall = np.mean([loop.fall.angle_at(torque) for loop in ramps.loops], axis=0)
            rise = np.mean([loop.rise.angle_at(torque[::-1]) for loop in ramps.loops], axis=0)
            angle = np.concatenate([fall, rise]) - np.mean([fall, rise])
            around = np.concatenate([torque, torque[::-1]])
            legend = printable(group.name) if k in pens else 'between them'
            yield Line(legend, pens.get(k, Pen.FAINT), around, angle * ARC_MINUTES)
