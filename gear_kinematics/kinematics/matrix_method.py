# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The motion by the matrix method, eqs. (4), (7), (8), (11)-(18): 4×4 transforms alone.

The slides of the Oldham couplings come from solving the loop closure
T_21 T_3k,2 T_4k,3k O = T_51 T_4k,5 O as the linear system of eq. (17); velocities and
accelerations from differentiating the transforms and that system. No formula of the closed form
(`motion`) is used, so the two check each other.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.gear_ratio import whole_turns
from gear_kinematics.kinematics.mechanism import Mechanism
from gear_kinematics.kinematics.motion import MotionState
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.kinematics.transforms import (
    cam_translation,
    output_turn,
    rotation_z,
    satellite_turn,
)

Array = NDArray[np.float64]

_SPIN = np.zeros((4, 4))  # the generator of Rz: dRz/dq = _SPIN Rz
_SPIN[0, 1], _SPIN[1, 0] = -1.0, 1.0
_X, _Y, _ORIGIN = 0, 1, 3  # columns of a transform


class _Jet(NamedTuple):
    """Matrices (..., m, n) with their first and second time derivatives."""

    value: Array
    first: Array
    second: Array

    def __matmul__(self, right: '_Jet') -> '_Jet':
        """Multiply by the product rule."""
        return _Jet(
            self.value @ right.value,
            self.first @ right.value + self.value @ right.first,
            self.second @ right.value + 2.0 * self.first @ right.first + self.value @ right.second,
        )

    def column(self, index: int) -> '_Jet':
        """The x and y components of one column of the transforms, (..., 2, 1)."""
        return _Jet(*(matrix[..., :2, index, np.newaxis] for matrix in self))

    def row(self, index: int) -> '_Jet':
        """Row with an index, (..., 1, n)."""
        return _Jet(*(matrix[..., index, np.newaxis, :] for matrix in self))

    def vectors(self) -> Array:
        """The columns as one array (3, ..., 2): the value and its two derivatives."""
        return np.stack(self)[..., 0]


@np.errstate(invalid='ignore')  # values that are not finite give NaN
def solve(
    mechanism: Mechanism,
    rotor_angle: 'ArrayLike',
    rotor_velocity: 'ArrayLike' = 0.0,
    rotor_acceleration: 'ArrayLike' = 0.0,
    *,
    rotor_turns: 'ArrayLike' = 0,
) -> MotionState:
    """Solve the motion of all bodies; arguments and result are those of `motion.solve`.

    The turns are added to the angle in float64, so many turns cost precision.

    Raises:
        ValueError: if `rotor_turns` are not integers up to ±`MOST_TURNS`.
    """
    angle = np.asarray(rotor_angle, dtype=np.float64) + TURN * whole_turns(rotor_turns)
    inputs = (angle, rotor_velocity, rotor_acceleration)
    rotor = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) for value in inputs))
    output = [output_turn(mechanism, value) for value in rotor]
    on_cam = [satellite_turn(mechanism, value) for value in rotor]

    cam = cam_translation(mechanism)
    fixed_cam = _Jet(cam, np.zeros_like(cam), np.zeros_like(cam))
    output_to_stator = _rotation(*output)
    satellite_to_stator = _rotation(*rotor) @ fixed_cam @ _rotation(*on_cam)
    satellite = satellite_to_stator.column(_ORIGIN)  # eq. (7)
    # Loop closure, eqs. (11) = (14): O3 + x (T_31 ex) = y (T_51 ey), linear in the slides x, y.
    slides = _slides(satellite_to_stator.column(_X), output_to_stator.column(_Y), satellite)
    oldham = output_to_stator.column(_Y) @ slides.row(1)  # eq. (14)
    slide, arm_slide = np.moveaxis(slides.vectors()[:2], -1, 0)
    return MotionState.from_orders(
        output=np.stack(output),
        output_turn_angle=output[0] - TURN * np.rint(output[0] / TURN),
        satellite=satellite.vectors(),
        oldham=oldham.vectors(),
        satellite_slide=slide,
        arm_slide=arm_slide,
    )


def _rotation(angle: Array, rate: Array, acceleration: Array) -> _Jet:
    """Rz of an angle that changes with time, (..., 1, 4, 4), to broadcast over branches."""
    value = rotation_z(angle[..., np.newaxis])
    rate, acceleration = (v[..., np.newaxis, np.newaxis, np.newaxis] for v in (rate, acceleration))
    turned = _SPIN @ value
    return _Jet(value, rate * turned, rate**2 * (_SPIN @ turned) + acceleration * turned)


def _slides(satellite_x: _Jet, arm_y: _Jet, satellite: _Jet) -> _Jet:
    """Solve the linear system of eq. (17) and its derivatives for (x, y), (..., 2, 1).

    Its matrix is symmetric and orthogonal, hence its own inverse, eq. (18).
    """
    pairs = (np.broadcast_arrays(x, -y) for x, y in zip(satellite_x, arm_y, strict=True))
    matrix = _Jet(*(np.concatenate(pair, axis=-1) for pair in pairs))
    value = matrix.value @ -satellite.value
    first = matrix.value @ (-satellite.first - matrix.first @ value)
    second = matrix.value @ (
        -satellite.second - 2.0 * matrix.first @ first - matrix.second @ value
    )
    return _Jet(value, first, second)
