# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Plots of the motion: roses and slides of the couplings, and the output over time."""

from itertools import cycle
from typing import Any

import numpy as np

from gear_kinematics.bag.trajectory import Trajectory
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.uncertainty import COVERAGE
from gear_kinematics.kinematics import Gear, Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.image import FAINT, INK, SERIES, ImageFile, add_legend
from gear_kinematics.shape import outlines
from gear_kinematics.shape.outlines import Array

MOST_PETALS = 1000
"""With more, a rose looks like a disc."""
_PETAL_POINTS = 48
_MM = 1e3  # in a metre
_MRAD = 1e3  # in a radian
_MANY_TURNS = 12
"""Turns of the rotor from which on slides are a solid block."""
_SLIDE_TURNS = 3
"""Turns of the rotor that show slides in detail."""
_OUTPUT_TURNS = 1
"""Turns of the output that show it in detail."""
_MANY_WINDOWS = 5
"""Lengths of the detail from which on the whole of an output shows little."""
_PART = 721  # samples
_INTERVALS = 400


def roses(mechanism: Mechanism, file: ImageFile, trajectory: Trajectory | None = None) -> bytes:
    """Plot the paths of the centres of the Oldham couplings, branch by branch.

    The part that a trajectory of the rotor covers is highlighted.

    Raises:
        ValueError: if there are more than `MOST_PETALS`, or the file has an unknown suffix.
    """
    e = _MM * mechanism.eccentricity
    whole = _MM * rose(mechanism)
    moved = None if trajectory is None else _MM * trajectory.state(mechanism).oldham_centre
    around = np.linspace(0.0, TURN, 361)
    with file.canvas(3.4 * len(mechanism.branches), 3.8) as figure:
        plots = figure.subplots(1, len(mechanism.branches), squeeze=False, sharey=True)[0]
        for k, (axes, colour) in enumerate(zip(plots, cycle(SERIES))):
            name = mechanism.branches[k].name
            axes.set_title(f'branch {name}: {mechanism.oldham_petals} petals', fontsize='medium')
            axes.plot(e * np.cos(around), e * np.sin(around), '--', color=FAINT, linewidth=0.6)
            axes.plot(*whole[:, k].T, color=colour if moved is None else FAINT, linewidth=0.6)
            if moved is not None:
                axes.plot(*moved[:, k].T, color=colour, linewidth=1.0)
            axes.set_aspect('equal')
            axes.set_xlabel('x [mm]')
        plots[0].set_ylabel('y [mm]')
        return file.encode(figure)


def rose(mechanism: Mechanism) -> Array:
    """The complete paths of the centres of the couplings, O4, (n, B, 2), m (eqs. 21, 22).

    Raises:
        ValueError: if there are more petals than `MOST_PETALS`.
    """
    if mechanism.oldham_petals > MOST_PETALS:
        raise ValueError(
            f'a picture has room for {MOST_PETALS} petals, not for {mechanism.oldham_petals}'
        )
    return outlines.roses(mechanism, mechanism.oldham_petals, _PETAL_POINTS)


def slides(
    mechanism: Mechanism, file: ImageFile, trajectory: Trajectory, *, by_angle: bool
) -> bytes:
    """Plot slides and sliding speeds of the couplings, over the rotor angle or over time.

    Of many turns, there are the least and greatest values, and a few turns in detail.
    """
    long = not by_angle and trajectory.travel[-1] > _MANY_TURNS
    with file.canvas(7.0, 5.0) as figure:
        plots = figure.subplots(2, 1 + long, sharex='col', sharey='row', squeeze=False)
        parts = [trajectory]
        if long:
            start, end = trajectory.fastest(_SLIDE_TURNS)
            parts.append(trajectory.part(start, end, _PART))
            _title(plots[0], start, end, f'{_SLIDE_TURNS} turns of the rotor')
        for column, moved in enumerate(parts):
            x = np.degrees(moved.turns * TURN + moved.angle) if by_angle else moved.time
            _draw_slides(plots[:, column], mechanism, moved, x, band=long and column == 0)
        label = (
            f'rotor angle [°] at {trajectory.velocity[0]:.4g} rad/s' if by_angle else 'time [s]'
        )
        for speeds in plots[1]:
            speeds.set_xlabel(label)
            if by_angle:
                speeds.set_xticks(np.arange(x[0], x[-1] + 1.0, 45.0))
        plots[0, 0].set_ylabel('slide [mm]')
        plots[1, 0].set_ylabel('sliding speed [mm/s]')
        # One row; else one column per branch; else as many columns as fit the width.
        handles, names = plots[0, -1].get_legend_handles_labels()
        add_legend(figure, handles, names, (len(names), *range(len(mechanism.branches), 0, -1)))
        return file.encode(figure)


def _draw_slides(
    plots: Array, mechanism: Mechanism, moved: Trajectory, x: Array, *, band: bool
) -> None:
    """Draw slides and sliding speeds, as bands between the least and greatest values or lines."""
    state = moved.state(mechanism)
    for k, (branch, colour) in enumerate(zip(mechanism.branches, cycle(SERIES))):
        for where, dashes, slide, speed in (
            ('on the satellite', '-', state.satellite_slide, state.satellite_slide_velocity),
            ('on the arm', '--', state.arm_slide, state.arm_slide_velocity),
        ):
            for axes, values in zip(plots, (_MM * slide[:, k], _MM * speed[:, k]), strict=True):
                if band:
                    _fill(axes, x, values, colour)
                else:
                    label = f'{branch.name}, {where}'
                    axes.plot(x, values, color=colour, linestyle=dashes, label=label)
    for axes in plots:
        _frame(axes)


def output(
    gear: Gear, file: ImageFile, trajectory: Trajectory, calibration: Calibration | None = None
) -> bytes:
    """Plot angle and rate of the output shaft over time.

    Of many turns, there are the least and greatest values, and one turn in detail. With a
    calibration, there is also the deviation of the real output angle with its interval.
    """
    turns, rest = gear.gear_ratio.output_angle(trajectory.turns, trajectory.angle, np)
    values = {
        'output angle [°]': np.degrees(TURN * turns + rest),
        'output rate [°/s]': np.degrees(gear.gear_ratio.output_rate(trajectory.velocity)),
    }
    half_width = None
    if calibration:
        correction = trajectory.correction(calibration)
        deviation = values['deviation [mrad]'] = _MRAD * correction.deviation
        half_width = _MRAD * correction.half_width
    window = abs(float(gear.gear_ratio)) * _OUTPUT_TURNS
    long = trajectory.travel[-1] > _MANY_WINDOWS * window
    with file.canvas(7.0, 4.5 if half_width is None else 6.5) as figure:
        plots = figure.subplots(len(values), 1 + long, sharex='col', squeeze=False)
        shown = [np.ones(len(trajectory.time), bool)]
        if long:
            start, end = trajectory.fastest(window)
            _title(plots[0], start, end, 'a turn of the output')
            shown.append((trajectory.time >= start) & (trajectory.time <= end))
        for column, rows in enumerate(shown):
            time = trajectory.time[rows]
            for axes, (label, all_values) in zip(plots[:, column], values.items(), strict=True):
                if long and column == 0:
                    _fill(axes, time, all_values, SERIES[0])
                else:
                    axes.plot(time, all_values[rows], color=SERIES[0])
                if column == 0:
                    axes.set_ylabel(label)
                _frame(axes)
            if half_width is not None:
                ends = (deviation - half_width)[rows], (deviation + half_width)[rows]
                band = plots[-1, column].fill_between(
                    time, *ends, color=FAINT, alpha=0.5, zorder=1
                )
                if column == 0:
                    text = f'{100.0 * COVERAGE:g} % interval of the deviation'
                    add_legend(figure, [band], [text])
            plots[-1, column].set_xlabel('time [s]')
        return file.encode(figure)


def _title(plots: Array, start: float, end: float, part: str) -> None:
    """Name the whole of a long recording and a part of it, and mark the part in the whole."""
    whole, detail = plots
    whole.set_title('the whole:\nleast and greatest values', fontsize='medium')
    detail.set_title(f'{part},\nwhere it is fastest', fontsize='medium')
    whole.axvspan(start, end, color=INK, alpha=0.25)


def _fill(axes: Any, x: Array, y: Array, colour: str) -> None:
    """Fill between the least and the greatest values of intervals."""
    starts = np.unique(np.linspace(0, len(x), _INTERVALS, endpoint=False, dtype=np.intp))
    least, greatest = np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)
    axes.fill_between(x[starts], least, greatest, color=colour, alpha=0.5, linewidth=1.0)


def _frame(axes: Any) -> None:
    axes.grid(visible=True)
    axes.margins(x=0.0)
