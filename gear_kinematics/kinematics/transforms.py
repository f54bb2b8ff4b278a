"""4×4 homogeneous transforms of the frames of the mechanism.

T_ab takes the coordinates of a point in frame a to those in frame b: r_b = T_ab r_a with
r = [x, y, z, 1]ᵀ (eq. 4). Frames: 1 stator, 2 rotor, 3k satellite, 4k Oldham coupling of branch
k, 5 output shaft. All functions broadcast over the shape `(...)` of their arguments.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.mechanism import Mechanism

Array = NDArray[np.float64]


def rotation_z(angle: ArrayLike) -> Array:
    """Rotation by `angle` (rad) about z, (..., 4, 4)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    transform = np.zeros((*np.shape(angle), 4, 4))
    transform[..., 0, 0] = transform[..., 1, 1] = cosine
    transform[..., 0, 1], transform[..., 1, 0] = -sine, sine
    transform[..., 2, 2] = transform[..., 3, 3] = 1.0
    return transform


def translation(x: ArrayLike, y: ArrayLike, z: ArrayLike = 0.0) -> Array:
    """Translation by (x, y, z), m, (..., 4, 4)."""
    x, y, z = np.broadcast_arrays(x, y, z)
    transform = np.zeros((*x.shape, 4, 4))
    transform[...] = np.eye(4)
    transform[..., 0, 3], transform[..., 1, 3], transform[..., 2, 3] = x, y, z
    return transform


def apply(transform: Array, point: ArrayLike) -> Array:
    """Coordinates of `point` (..., 3) after the transform (..., 4, 4), eq. (4)."""
    point = np.asarray(point, dtype=np.float64)
    extended = np.concatenate([point, np.ones((*point.shape[:-1], 1))], axis=-1)
    moved: Array = np.einsum('...ij,...j->...i', transform, extended)
    return moved[..., :3]


def cam_translation(mechanism: Mechanism) -> Array:
    """Trans(e u(α_k)): from the rotor's axis to the centres of its cams, (B, 4, 4)."""
    phase = np.array([branch.cam_phase for branch in mechanism.branches])
    position = np.array([branch.axial_position for branch in mechanism.branches])
    e = mechanism.eccentricity
    return translation(-e * np.sin(phase), e * np.cos(phase), position)


def satellite_turn(mechanism: Mechanism, rotor_angle: ArrayLike) -> Array:
    """φ3_2 = φ5 - φ2: the turn of the satellites on their cams (eqs. 5 and 6), (...), rad."""
    angle: Array = np.asarray(rotor_angle, dtype=np.float64)
    return output_turn(mechanism, angle) - angle


def output_turn(mechanism: Mechanism, rotor_angle: ArrayLike) -> Array:
    """φ5 = φ2/i (eq. 5), (...), rad."""
    ratio = mechanism.gear_ratio
    angle: Array = np.asarray(rotor_angle, dtype=np.float64)
    turn: Array = angle * ratio.denominator / ratio.numerator
    return turn


@dataclass(frozen=True, eq=False, slots=True)
class Frames:
    """The transforms between all frames, (..., 4, 4) or, branch by branch, (..., B, 4, 4)."""

    rotor_to_stator: Array
    """T_21, figs. 5-12."""
    output_to_stator: Array
    """T_51."""
    satellite_to_rotor: Array
    """T_3k,2."""
    satellite_to_stator: Array
    """T_3k,1 = T_21 T_3k,2."""
    oldham_to_satellite: Array
    """T_4k,3k."""
    oldham_to_output: Array
    """T_4k,5."""
    oldham_to_stator: Array
    """T_4k,1 = T_21 T_3k,2 T_4k,3k (eq. 11)."""


def frames(
    mechanism: Mechanism, rotor_angle: ArrayLike, satellite_slide: ArrayLike, arm_slide: ArrayLike
) -> Frames:
    """All frames at a rotor angle (...), with the couplings at their slides (..., B)."""
    rotor_to_stator = rotation_z(rotor_angle)
    satellite_rotation = rotation_z(satellite_turn(mechanism, rotor_angle))
    satellite_to_rotor = cam_translation(mechanism) @ satellite_rotation[..., np.newaxis, :, :]
    satellite_to_stator = rotor_to_stator[..., np.newaxis, :, :] @ satellite_to_rotor
    oldham_to_satellite = translation(satellite_slide, 0.0)
    axial = [branch.axial_position for branch in mechanism.branches]
    return Frames(
        rotor_to_stator=rotor_to_stator,
        output_to_stator=rotation_z(output_turn(mechanism, rotor_angle)),
        satellite_to_rotor=satellite_to_rotor,
        satellite_to_stator=satellite_to_stator,
        oldham_to_satellite=oldham_to_satellite,
        oldham_to_output=translation(0.0, arm_slide, axial),
        oldham_to_stator=satellite_to_stator @ oldham_to_satellite,
    )
