"""Plots of the motion: roses and slides of the couplings, and the output over time."""

from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.kinematics import Gear, GearRatio, Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.image import FAINT, SERIES, render
from gear_kinematics.shape import outlines
from gear_kinematics.shape.outlines import Array
from gear_kinematics.state.calibration_file import Calibration
from gear_kinematics.state.correction import Correction
from gear_kinematics.state.trajectory import Trajectory

MOST_PETALS = 1000
"""With more, a rose looks like a disc."""
_PETAL_POINTS = 48
_MM = 1e3  # in a metre
_MRAD = 1e3  # in a radian


def roses(mechanism: Mechanism, path: Path, trajectory: Trajectory | None = None) -> bytes:
    """Plot the paths of the centres of the Oldham couplings, branch by branch.

    The part that a trajectory of the rotor covers is highlighted.

    Raises:
        ValueError: if there are more than `MOST_PETALS`, or `path` has an unknown suffix.
    """
    width = 3.4 * len(mechanism.branches)
    whole = rose(mechanism)
    moved = None if trajectory is None else trajectory.state(mechanism).oldham_centre
    return render(path, (width, 3.8), partial(_draw_roses, mechanism, whole, moved))


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


def slides(mechanism: Mechanism, path: Path, trajectory: Trajectory, *, by_angle: bool) -> bytes:
    """Plot slides and sliding speeds of the couplings, over the rotor angle or over time."""
    draw = partial(_draw_slides, mechanism, trajectory, by_angle=by_angle)
    return render(path, (7.0, 5.0), draw)


def output(
    gear: Gear,
    path: Path,
    trajectory: Trajectory,
    calibration: Calibration | None = None,
) -> bytes:
    """Plot angle and rate of the output shaft over time.

    With a calibration, also the deviation of the real output angle with its 95 % interval.
    """
    correction = None if calibration is None else trajectory.correction(calibration)
    height = 4.5 if correction is None else 6.5
    draw = partial(_draw_output, gear.gear_ratio, trajectory, correction)
    return render(path, (7.0, height), draw)


def _draw_roses(mechanism: Mechanism, whole: Array, moved: Array | None, figure: Any) -> None:
    e = _MM * mechanism.eccentricity
    plots = figure.subplots(1, len(mechanism.branches), squeeze=False, sharey=True)[0]
    around = np.linspace(0.0, TURN, 361)
    for k, (axes, colour) in enumerate(zip(plots, cycle(SERIES))):
        axes.set_title(
            f'branch {mechanism.branches[k].name}: {mechanism.oldham_petals} petals', fontsize=9
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
    state = trajectory.state(mechanism)
    x = trajectory.time
    label = 'time, s'
    if by_angle:
        x = np.degrees(trajectory.turns * TURN + trajectory.angle)
        label = f'rotor angle, °, at {trajectory.velocity[0]:.4g} rad/s'
    positions, speeds = figure.subplots(2, 1, sharex=True)
    for k, colour in zip(range(len(mechanism.branches)), cycle(SERIES)):
        name = mechanism.branches[k].name
        for where, dashes, slide, speed in (
            ('on the satellite', '-', state.satellite_slide, state.satellite_slide_velocity),
            ('on the arm', '--', state.arm_slide, state.arm_slide_velocity),
        ):
            style = {'color': colour, 'linestyle': dashes, 'label': f'{name}, {where}'}
            positions.plot(x, _MM * slide[:, k], **style)
            speeds.plot(x, _MM * speed[:, k], **style)
    positions.set_ylabel('slide, mm')
    speeds.set_ylabel('sliding speed, mm/s')
    speeds.set_xlabel(label)
    for axes in (positions, speeds):
        axes.grid(visible=True)
        axes.margins(x=0.0)
    if by_angle:
        speeds.set_xticks(np.arange(x[0], x[-1] + 1.0, 45.0))
    # One row; else one column per branch; else as many columns as fit the width.
    handles, names = positions.get_legend_handles_labels()
    for columns in (len(names), *range(len(mechanism.branches), 0, -1)):
        legend = figure.legend(handles, names, loc='outside upper center', ncols=columns)
        if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
            break
        legend.remove()


def _draw_output(
    ratio: GearRatio, trajectory: Trajectory, correction: Correction | None, figure: Any
) -> None:
    turns, rest = ratio.output_angle(trajectory.turns, trajectory.angle, np)
    velocity = ratio.output_rate(trajectory.velocity)
    plots = figure.subplots(2 if correction is None else 3, 1, sharex=True)
    angle, rate = plots[:2]
    angle.plot(trajectory.time, np.degrees(TURN * turns + rest), color=SERIES[0])
    angle.set_ylabel('output angle, °')
    rate.plot(trajectory.time, np.degrees(velocity), color=SERIES[0])
    rate.set_ylabel('output rate, °/s')
    if correction is not None:
        deviation, half_width = _MRAD * correction.deviation, _MRAD * correction.half_width
        bounds = deviation - half_width, deviation + half_width
        plots[2].fill_between(trajectory.time, *bounds, color=FAINT, alpha=0.5, label='95 %')
        plots[2].plot(trajectory.time, deviation, color=SERIES[0])
        plots[2].set_ylabel('deviation, mrad')
        plots[2].legend(loc='upper right')
    plots[-1].set_xlabel('time, s')
    for axes in plots:
        axes.grid(visible=True)
        axes.margins(x=0.0)
