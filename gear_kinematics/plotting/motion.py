# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Figures of the motion: roses and slides of the couplings, and the output over time."""

from itertools import chain, cycle

import numpy as np

from gear_kinematics.kinematics import Gear, Mechanism, solve
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.plotting.trajectory import Trajectory
from gear_kinematics.report.document import PENS, Array, Figure, Line, Panel, Pen

MOST_PETALS = 1000  # greatest number of petals; with more, a rose looks like a disc
_PETAL_POINTS = 48
_MM = 1e3  # in a metre
_SAMPLES = 361  # per turn


def roses(mechanism: Mechanism) -> Figure:
    """Plot the paths of the centres of the Oldham couplings, branch by branch.

    Raises ValueError if there are more petals than `MOST_PETALS`.
    """
    panels = []
    paths = np.moveaxis(_MM * rose(mechanism), 1, 0)
    for branch, path, pen in zip(mechanism.branches, paths, cycle(PENS)):
        line = Line(branch.name, pen, *path.T)
        title = f'branch {branch.name}: {mechanism.oldham_petals} petals'
        panels.append(Panel(title, 'x [mm]', 'y [mm]', (line,), equal=True))
    return Figure(tuple(panels))


def rose(mechanism: Mechanism) -> Array:
    """Compute the complete paths of the couplings' centres O4, (n, B, 2), m (eqs. 21, 22).

    Raises ValueError if there are more petals than `MOST_PETALS`.
    """
    if mechanism.oldham_petals > MOST_PETALS:
        raise ValueError(
            f'a picture has room for {MOST_PETALS} petals, not for {mechanism.oldham_petals}'
        )
    count = mechanism.oldham_petals * _PETAL_POINTS + 1
    angle = np.linspace(0.0, TURN * mechanism.cycle_turns, count)
    return np.asarray(solve(mechanism, angle).oldham_centre)


def slides(mechanism: Mechanism, speed: float) -> Figure:
    """Plot the couplings' slides and sliding speeds over a rotor turn at a speed, rad/s."""
    angle = np.linspace(0.0, TURN, _SAMPLES)
    state = solve(mechanism, angle, speed)
    names = [
        f'{branch.name}, on the {part}'
        for part in ('satellite', 'arm')
        for branch in mechanism.branches
    ]

    def panel(label: str, on_satellite: Array, on_arm: Array) -> Panel:
        values = chain(on_satellite.T, on_arm.T)
        lines = (
            Line(name, pen, np.degrees(angle), _MM * value)
            for name, pen, value in zip(names, cycle(PENS), values)
        )
        return Panel('', f'rotor angle [°] at {speed:.4g} rad/s', label, tuple(lines))

    return Figure(
        (
            panel('slide [mm]', state.satellite_slide, state.arm_slide),
            panel(
                'sliding speed [mm/s]', state.satellite_slide_velocity, state.arm_slide_velocity
            ),
        ),
        stacked=True,
    )


def output(gear: Gear, trajectory: Trajectory) -> Figure:
    """Plot angle and rate of the output shaft over time."""
    turns, rest = gear.gear_ratio.output_angle(trajectory.turns, trajectory.angle, np)
    rate = gear.gear_ratio.output_rate(trajectory.velocity)
    panels = (
        Panel('', 'time [s]', label, (Line('output', Pen.FIRST, trajectory.time, values),))
        for label, values in (
            ('output angle [°]', np.degrees(TURN * turns + rest)),
            ('output rate [°/s]', np.degrees(rate)),
        )
    )
    return Figure(tuple(panels), stacked=True)
