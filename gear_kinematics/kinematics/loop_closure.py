# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Loop closure: the residual of the vector loops, the constraint Jacobian, and the mobility.

The planar multibody system behind the Jacobian: the stator is fixed; the moving bodies are the
rotor, for each branch its satellite and its Oldham coupling, and the output shaft, each with the
coordinates (x, y, angle). Constraints: two rotary joints on the stator (rotor, output shaft), and
for each branch a rotary joint (satellite on cam), two sliding joints (coupling in the satellite,
coupling in the arm) and the mesh of satellite and ring gear.
"""

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.kinematics.mechanism import Mechanism
from gear_kinematics.kinematics.motion import Array, MotionState, solve
from gear_kinematics.kinematics.transforms import (
    cam_translation,
    output_turn,
    rotation_z,
    satellite_turn,
    translation,
)


def residual(mechanism: Mechanism, rotor_angle: 'ArrayLike', state: MotionState) -> Array:
    """Compute the closure error of the vector loops of a state for each branch, (..., B), m.

    The greatest of three distances: between the centre of the Oldham coupling by eq. (11) and by
    eq. (14), at the slides of the state; between the former and `state.oldham_centre`; between
    the centre of the satellite and `state.satellite_centre`. It grows with the float64 spacing of
    `rotor_angle`, so pass an angle of few turns.
    """
    rotor, on_cam, shaft = (
        rotation_z(angle)[..., np.newaxis, :, :]
        for angle in (
            rotor_angle,
            satellite_turn(mechanism, rotor_angle),
            output_turn(mechanism, rotor_angle),
        )
    )
    satellite = rotor @ (cam_translation(mechanism) @ on_cam)
    by_satellite = (satellite @ translation(state.satellite_slide, 0.0))[..., :2, 3]  # eq. (11)
    by_arm = (shaft @ translation(0.0, state.arm_slide))[..., :2, 3]  # eq. (14)
    gaps = (
        by_satellite - by_arm,
        by_satellite - state.oldham_centre,
        satellite[..., :2, 3] - state.satellite_centre,
    )
    distances = [np.hypot(gap[..., 0], gap[..., 1]) for gap in gaps]
    return np.asarray(np.max(distances, axis=0))


def mobility_by_counting(mechanism: Mechanism) -> int:
    """Count the degrees of freedom of the mechanism by eq. (2), 3(n - 1) - 2(r + p) - o.

    n bodies including the stator, r rotary joints, p sliding joints, o general pairs (gear
    meshes). One branch gives 3(5 - 1) - 2(3 + 2) - 1 = 1. Two branches give 0 although they move:
    see `mobility_by_rank`.
    """
    branches = len(mechanism.branches)
    bodies = 3 + 2 * branches
    rotary, sliding, general = 2 + branches, 2 * branches, branches
    return 3 * (bodies - 1) - 2 * (rotary + sliding) - general


def constraint_jacobian(mechanism: Mechanism, rotor_angle: 'ArrayLike') -> Array:
    """Derivative of the constraints with respect to the coordinates, (..., 4 + 7 B, 3 (2 + 2 B)).

    Columns: (x, y, angle) of the rotor, then of satellite and coupling of each branch, then of the
    output shaft. Lengths are in units of the eccentricity, so that the rank depends on no unit.
    """
    state = solve(mechanism, rotor_angle)
    e = mechanism.eccentricity
    shape, count = state.output_angle.shape, len(mechanism.branches)
    jacobian = np.zeros((*shape, 4 + 7 * count, 3 * (2 + 2 * count)))
    rotor, output = 0, 3 * (1 + 2 * count)
    for row, body in ((0, rotor), (2, output)):
        jacobian[..., row, body] = jacobian[..., row + 1, body + 1] = 1.0
    cosine, sine = np.cos(state.output_turn_angle), np.sin(state.output_turn_angle)
    along_x = np.stack([cosine, sine], axis=-1)
    along_y = np.stack([-sine, cosine], axis=-1)
    for k in range(count):
        row, satellite, coupling = 4 + 7 * k, 3 + 6 * k, 6 + 6 * k
        centre, middle = state.satellite_centre[..., k, :] / e, state.oldham_centre[..., k, :] / e
        _rotary_joint(jacobian[..., row : row + 2, :], rotor, satellite, centre)
        # The satellite lets the coupling slide along x and holds it along y; the arm the other
        # way round.
        _sliding_joint(
            jacobian[..., row + 2 : row + 4, :], satellite, coupling, along_y, middle - centre
        )
        _sliding_joint(jacobian[..., row + 4 : row + 6, :], output, coupling, along_x, middle)
        # Rolling: at the pitch point the satellite has no velocity along the ring.
        tangent = np.stack([-centre[..., 1], centre[..., 0]], axis=-1)
        jacobian[..., row + 6, satellite : satellite + 2] = tangent
        jacobian[..., row + 6, satellite + 2] = mechanism.satellite_rolling_radius / e
    return jacobian


def mobility_by_rank(mechanism: Mechanism, rotor_angle: float = 0.0) -> int:
    """Degrees of freedom: columns minus rank of the constraint Jacobian at a rotor angle, rad."""
    jacobian = constraint_jacobian(mechanism, rotor_angle)
    return int(jacobian.shape[-1] - np.linalg.matrix_rank(jacobian))


def _rotary_joint(rows: Array, rotor: int, satellite: int, centre: Array) -> None:
    """Fix the satellite's centre to the rotor, at `centre` from the rotor's axis."""
    for axis in (0, 1):
        rows[..., axis, satellite + axis] = 1.0
        rows[..., axis, rotor + axis] = -1.0
    rows[..., 0, rotor + 2] = centre[..., 1]
    rows[..., 1, rotor + 2] = -centre[..., 0]


def _sliding_joint(rows: Array, guide: int, slider: int, normal: Array, arm: Array) -> None:
    """Fix the slider's angle, and its position along `normal`, to the guide.

    `normal` turns with the guide; `arm` points from the guide's centre to the slider's.
    """
    rows[..., 0, slider + 2], rows[..., 0, guide + 2] = 1.0, -1.0
    rows[..., 1, slider : slider + 2] = normal
    rows[..., 1, guide : guide + 2] = -normal
    rows[..., 1, guide + 2] = normal[..., 0] * arm[..., 1] - normal[..., 1] * arm[..., 0]
