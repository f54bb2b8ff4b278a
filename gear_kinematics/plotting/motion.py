"""Plots of the motion: roses and slides of the couplings, and the output over time."""

from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.bag.trajectory import Trajectory
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.corrector import Correction
from gear_kinematics.correction.uncertainty import COVERAGE
from gear_kinematics.kinematics import Gear, GearRatio, Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.image import FAINT, INK, SERIES, Paper, add_legend, render
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
_PAPER = Paper()


def roses(
    mechanism: Mechanism,
    path: Path,
    trajectory: Trajectory | None = None,
    paper: Paper = _PAPER,
) -> bytes:
    """Plot the paths of the centres of the Oldham couplings, branch by branch.

    The part that a trajectory of the rotor covers is highlighted.

    Raises:
        ValueError: if there are more than `MOST_PETALS`, or `path` has an unknown suffix.
    """
    width = 3.4 * len(mechanism.branches)
    whole = rose(mechanism)
    moved = None if trajectory is None else trajectory.state(mechanism).oldham_centre
    return render(path, (width, 3.8), partial(_draw_roses, mechanism, whole, moved), paper)


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
    mechanism: Mechanism,
    path: Path,
    trajectory: Trajectory,
    paper: Paper = _PAPER,
    *,
    by_angle: bool,
) -> bytes:
    """Plot slides and sliding speeds of the couplings, over the rotor angle or over time.

    Of many turns, there are the least and greatest values, and a few turns in detail.
    """
    draw = partial(_draw_slides, mechanism, trajectory, by_angle=by_angle)
    return render(path, (7.0, 5.0), draw, paper)


def output(
    gear: Gear,
    path: Path,
    trajectory: Trajectory,
    calibration: Calibration | None = None,
    paper: Paper = _PAPER,
) -> bytes:
    """Plot angle and rate of the output shaft over time.

    Of many turns, there are the least and greatest values, and one turn in detail. With a
    calibration, there is also the deviation of the real output angle with its interval.
    """
    correction = None if calibration is None else trajectory.correction(calibration)
    height = 4.5 if correction is None else 6.5
    draw = partial(_draw_output, gear.gear_ratio, trajectory, correction)
    return render(path, (7.0, height), draw, paper)


def _draw_roses(mechanism: Mechanism, whole: Array, moved: Array | None, figure: Any) -> None:
    e = _MM * mechanism.eccentricity
    plots = figure.subplots(1, len(mechanism.branches), squeeze=False, sharey=True)[0]
    around = np.linspace(0.0, TURN, 361)
    for k, (axes, colour) in enumerate(zip(plots, cycle(SERIES))):
        axes.set_title(
            f'branch {mechanism.branches[k].name}: {mechanism.oldham_petals} petals',
            fontsize='medium',
        )
        axes.plot(e * np.cos(around), e * np.sin(around), '--', color=FAINT, linewidth=0.6)
        x, y = _MM * whole[:, k].T
        axes.plot(x, y, color=colour if moved is None else FAINT, linewidth=0.6)
        if moved is not None:
            x, y = _MM * moved[:, k].T
            axes.plot(x, y, color=colour, linewidth=1.0)
        axes.set_aspect('equal')
        axes.set_xlabel('x, mm')
    plots[0].set_ylabel('y, mm')


def _draw_slides(
    mechanism: Mechanism, trajectory: Trajectory, figure: Any, *, by_angle: bool
) -> None:
    long = not by_angle and trajectory.travel[-1] > _MANY_TURNS
    plots = figure.subplots(2, 1 + long, sharex='col', sharey='row', squeeze=False)
    parts = [trajectory]
    if long:
        start, end = trajectory.fastest(_SLIDE_TURNS)
        parts.append(trajectory.part(start, end, _PART))
        _title(plots[0], start, end, f'{_SLIDE_TURNS} turns of the rotor')
    for column, (moved, (positions, speeds)) in enumerate(zip(parts, plots.T, strict=True)):
        state = moved.state(mechanism)
        x = np.degrees(moved.turns * TURN + moved.angle) if by_angle else moved.time
        for k, colour in zip(range(len(mechanism.branches)), cycle(SERIES)):
            name = mechanism.branches[k].name
            for where, dashes, slide, speed in (
                ('on the satellite', '-', state.satellite_slide, state.satellite_slide_velocity),
                ('on the arm', '--', state.arm_slide, state.arm_slide_velocity),
            ):
                for axes, values in ((positions, slide[:, k]), (speeds, speed[:, k])):
                    if long and column == 0:
                        _fill(axes, x, _MM * values, FAINT)
                    else:
                        label = f'{name}, {where}'
                        axes.plot(x, _MM * values, color=colour, linestyle=dashes, label=label)
        for axes in (positions, speeds):
            axes.grid(visible=True)
            axes.margins(x=0.0)
        label = f'rotor angle, °, at {trajectory.velocity[0]:.4g} rad/s' if by_angle else 'time, s'
        speeds.set_xlabel(label)
        if by_angle:
            speeds.set_xticks(np.arange(x[0], x[-1] + 1.0, 45.0))
    plots[0, 0].set_ylabel('slide, mm')
    plots[1, 0].set_ylabel('sliding speed, mm/s')
    # One row; else one column per branch; else as many columns as fit the width.
    handles, names = plots[0, -1].get_legend_handles_labels()
    add_legend(figure, handles, names, (len(names), *range(len(mechanism.branches), 0, -1)))


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


def _draw_output(
    ratio: GearRatio, trajectory: Trajectory, correction: Correction | None, figure: Any
) -> None:
    turns, rest = ratio.output_angle(trajectory.turns, trajectory.angle, np)
    values = [
        ('output angle, °', np.degrees(TURN * turns + rest)),
        ('output rate, °/s', np.degrees(ratio.output_rate(trajectory.velocity))),
    ]
    if correction is not None:
        values.append(('deviation, mrad', _MRAD * correction.deviation))
    window = abs(float(ratio)) * _OUTPUT_TURNS
    long = trajectory.travel[-1] > _MANY_WINDOWS * window
    plots = figure.subplots(len(values), 1 + long, sharex='col', squeeze=False)
    everything = np.ones(len(trajectory.time), bool)
    shown = [everything]
    if long:
        start, end = trajectory.fastest(window)
        _title(plots[0], start, end, 'a turn of the output')
        shown.append((trajectory.time >= start) & (trajectory.time <= end))
    for column, rows in enumerate(shown):
        time = trajectory.time[rows]
        for axes, (label, all_values) in zip(plots[:, column], values, strict=True):
            if long and column == 0:
                _fill(axes, time, all_values, SERIES[0])
            else:
                axes.plot(time, all_values[rows], color=SERIES[0])
            if column == 0:
                axes.set_ylabel(label)
            axes.grid(visible=True)
            axes.margins(x=0.0)
        if correction is not None:
            half_width = _MRAD * correction.half_width[rows]
            bounds = values[-1][1][rows] - half_width, values[-1][1][rows] + half_width
            band = plots[-1, column].fill_between(time, *bounds, color=FAINT, alpha=0.5, zorder=1)
            if column == 0:
                add_legend(figure, [band], [f'{100.0 * COVERAGE:g} % interval of the deviation'])
        plots[-1, column].set_xlabel('time, s')
