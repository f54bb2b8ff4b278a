# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Errors of the recorded poses and joints of the bodies, by the matrix method."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Mechanism, matrix_method
from gear_kinematics.parameters import NodeParameters

Array = NDArray[np.float64]


def errors_of_poses(
    gear: Mechanism, motions: Array, recorded: Sequence[Sequence[float]]
) -> dict[str, Array]:
    """Return errors by name, (n,), of n messages with 7 numbers for each body.

    The motions are angles and velocities of the rotor, (2, n).
    """
    state = matrix_method.solve(gear, *motions)
    centres = np.concatenate([state.satellite_centre, state.oldham_centre], axis=1)
    bodies, axial = centres.shape[1], [each.axial_position for each in gear.branches] * 2
    fit = [row if len(row) == 7 * bodies else (math.nan,) * 7 * bodies for row in recorded]
    poses = np.reshape(fit, (-1, bodies, 7))
    apart = np.hypot(*np.moveaxis(poses[..., :2] - centres, -1, 0))
    apart = np.hypot(apart, poses[..., 2] - axial)
    x, y, z, w = np.moveaxis(poses[..., 3:], -1, 0)
    turned = 2.0 * np.arctan2(z, w) - state.output_angle[:, np.newaxis]
    turned -= math.tau * np.round(turned / math.tau)
    turned = np.hypot(turned, 2.0 * np.hypot(x, y)) + np.abs(np.hypot(z, w) - 1.0)
    return {'position of bodies': apart.max(axis=1), 'orientation of bodies': turned.max(axis=1)}


def own_joints(
    parameters: NodeParameters, names: Sequence[str], arrays: Sequence[Sequence[float]]
) -> list[list[float]]:
    """Return positions and velocities of the own joints in a message, NaN where there are none.

    Joints of a single gear may have another prefix.

    Raises:
        ValueError: if all joints belong to other actuators.
    """
    own = parameters.joint_names
    if not {*own} & {*names}:
        if parameters.actuator:
            raise ValueError
        names = own
    known: list[dict[str, float]] = [dict(zip(names, each, strict=False)) for each in arrays[:2]]
    return [[values.get(name, math.nan) for name in own] for values in known]


def errors_of_joints(gear: Mechanism, motions: Array, recorded: Sequence[Any]) -> dict[str, Array]:
    """Return errors by name, (n,), of n pairs of `own_joints`, whose velocities may be withheld.

    The motions are angles and velocities of the rotor, (2, n).
    """
    state, count = matrix_method.solve(gear, *motions), len(gear.branches)
    slides = np.repeat([False, True, False], [1 + count, count, 1])
    errors: dict[str, Array] = {}
    for names, given, output, slide, values in zip(
        (('position', 'slide'), ('velocity', 'slide velocity')),
        motions,
        (state.output_angle, state.output_velocity),
        (state.satellite_slide, state.satellite_slide_velocity),
        np.moveaxis(np.array(recorded), 1, 0),
        strict=True,
    ):
        expected = np.transpose([given, *[output - given] * count, *slide.T, output])
        withheld = np.isnan(values).all(axis=1, keepdims=True) & (names[0] == 'velocity')
        error = np.where(withheld, 0.0, np.abs(values - expected))
        for name, part in zip(names, (~slides, slides), strict=True):
            errors[f'{name} of joints'] = error[:, part].max(axis=1)
    return errors
