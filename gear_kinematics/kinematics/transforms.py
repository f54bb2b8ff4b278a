# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""4×4 homogeneous transforms of the frames of the mechanism.

T_ab takes the coordinates of a point in frame a to those in frame b: r_b = T_ab r_a with
r = [x, y, z, 1]ᵀ (eq. 4). Frames: 1 stator, 2 rotor, 3k satellite, 4k Oldham coupling of branch
k, 5 output shaft. All functions broadcast over the shape `(...)` of their arguments.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.mechanism import Mechanism

Array = NDArray[np.float64]


def rotation_z(angle: 'ArrayLike') -> Array:
    """Rotation by `angle` (rad) about z, (..., 4, 4)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    transform = np.zeros((*np.shape(angle), 4, 4))
    transform[..., 0, 0] = transform[..., 1, 1] = cosine
    transform[..., 0, 1], transform[..., 1, 0] = -sine, sine
    transform[..., 2, 2] = transform[..., 3, 3] = 1.0
    return transform


def translation(x: 'ArrayLike', y: 'ArrayLike', z: 'ArrayLike' = 0.0) -> Array:
    """Translation by (x, y, z), m, (..., 4, 4)."""
    x, y, z = np.broadcast_arrays(x, y, z)
    transform = np.zeros((*x.shape, 4, 4))
    transform[...] = np.eye(4)
    transform[..., 0, 3], transform[..., 1, 3], transform[..., 2, 3] = x, y, z
    return transform


def cam_translation(mechanism: Mechanism) -> Array:
    """Translation e u(α_k) from the rotor's axis to the centres of its cams, (B, 4, 4)."""
    phase = np.array([branch.cam_phase for branch in mechanism.branches])
    position = np.array([branch.axial_position for branch in mechanism.branches])
    e = mechanism.eccentricity
    return translation(-e * np.sin(phase), e * np.cos(phase), position)


def satellite_turn(mechanism: Mechanism, rotor_angle: 'ArrayLike') -> Array:
    """Turn φ3_2 = φ5 - φ2 of the satellites on their cams (eqs. 5 and 6), (...), rad."""
    angle: Array = np.asarray(rotor_angle, dtype=np.float64)
    return output_turn(mechanism, angle) - angle


def output_turn(mechanism: Mechanism, rotor_angle: 'ArrayLike') -> Array:
    """Output angle φ5 = φ2/i (eq. 5), (...), rad."""
    ratio = mechanism.gear_ratio
    angle: Array = np.asarray(rotor_angle, dtype=np.float64)
    turn: Array = angle * ratio.denominator / ratio.numerator
    return turn
