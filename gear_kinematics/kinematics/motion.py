# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The closed form of the motion: eqs. (5)-(22) of the paper and their time derivatives.

Each formula is written once, in functions that take numpy arrays and plain floats alike: `solve`
applies them to arrays of any shape, the node to one sample of plain floats.

Symbols: φ2 rotor angle, φ5 output angle, α_k cam phase, θ_k = φ2 + α_k, e eccentricity,
u(q) = (-sin q, cos q). The output angle is that of `GearRatio`.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.gear_ratio import whole_turns
from gear_kinematics.kinematics.mechanism import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN, split_turns

Array = NDArray[np.float64]


def read_only(results: Any) -> None:
    """Convert the fields of a frozen dataclass to read-only arrays."""
    for field in fields(results):
        array = np.asarray(getattr(results, field.name)).view()
        array.flags.writeable = False
        object.__setattr__(results, field.name, array)


@dataclass(frozen=True, eq=False, repr=False, slots=True)
class MotionState:
    """The motion of all bodies. `...` is the inputs' broadcast shape, B the number of branches.

    All arrays are float64 and read-only; lengths in m, angles in rad, in the stator frame.
    """

    output_angle: Array
    """Angle φ5 of output shaft, satellites and couplings with its whole turns, (...), eq. (5)."""
    output_velocity: Array
    """First time derivative of `output_angle`, (...), rad/s."""
    output_acceleration: Array
    """Second time derivative of `output_angle`, (...), rad/s²."""
    output_turn_angle: Array
    """Angle φ5 within a turn, in [-π, π], (...); its precision does not depend on the turns."""
    satellite_centre: Array
    """Centre O3 of each satellite, (..., B, 2), eqs. (9), (10)."""
    satellite_velocity: Array
    """Velocity of O3, (..., B, 2), m/s."""
    satellite_acceleration: Array
    """Acceleration of O3, (..., B, 2), m/s²."""
    oldham_centre: Array
    """Centre O4 of each Oldham coupling, (..., B, 2), eqs. (21), (22)."""
    oldham_velocity: Array
    """Velocity of O4, (..., B, 2), m/s."""
    oldham_acceleration: Array
    """Acceleration of O4, (..., B, 2), m/s²."""
    satellite_slide: Array
    """Slide x_k of the coupling along x of the satellite's frame, (..., B), eq. (19)."""
    satellite_slide_velocity: Array
    """Sliding speed of the coupling in the satellite, (..., B), m/s."""
    arm_slide: Array
    """Slide y_k of the coupling along y of the output shaft's frame, (..., B), eq. (20)."""
    arm_slide_velocity: Array
    """Sliding speed of the coupling in the arm, (..., B), m/s."""

    def __post_init__(self) -> None:
        """Convert the fields to read-only arrays."""
        read_only(self)

    def __repr__(self) -> str:
        """Describe the shape, and show the output angle at a few samples."""
        angle, branches = self.output_angle, self.satellite_centre.shape[-2]
        few = np.array2string(angle, precision=6, threshold=6, edgeitems=2, separator=', ')
        return f'MotionState(shape={angle.shape}, branches={branches}, output_angle={few} rad)'

    @property
    def poses(self) -> Array:
        """Poses (x, y, yaw) of each satellite, then of each coupling, (..., 2 B, 3), m and rad."""
        centres = np.concatenate([self.satellite_centre, self.oldham_centre], axis=-2)
        yaw = self.output_turn_angle[..., np.newaxis, np.newaxis]
        return np.append(centres, np.broadcast_to(yaw, (*centres.shape[:-1], 1)), axis=-1)

    @classmethod
    def from_orders(
        cls,
        *,
        output: Array,
        output_turn_angle: Array,
        satellite: Array,
        oldham: Array,
        satellite_slide: Array,
        arm_slide: Array,
    ) -> Self:
        """Create a state from arrays whose first axis is the order of the derivative.

        Missing derivatives are zero and take no memory.
        """
        zero = np.broadcast_to(0.0, satellite.shape[1:])
        columns = (
            *(*output, zero[..., 0, 0], zero[..., 0, 0])[:3],
            output_turn_angle,
            *(*satellite, zero, zero)[:3],
            *(*oldham, zero, zero)[:3],
            *(*satellite_slide, zero[..., 0])[:2],
            *(*arm_slide, zero[..., 0])[:2],
        )
        return cls(*columns)  # in the order of the fields


class BranchPosition(NamedTuple):
    """Positions of the bodies of one branch, m, as floats or arrays; points are pairs (x, y)."""

    satellite: tuple[Any, Any]
    """O3."""
    oldham: tuple[Any, Any]
    """O4."""
    satellite_slide: Any
    """x_k."""
    arm_slide: Any
    """y_k."""


class BranchRates(NamedTuple):
    """The time derivatives of a `BranchPosition`, m/s and m/s²."""

    satellite_velocity: tuple[Any, Any]
    oldham_velocity: tuple[Any, Any]
    satellite_slide_velocity: Any
    arm_slide_velocity: Any
    satellite_acceleration: tuple[Any, Any]
    oldham_acceleration: tuple[Any, Any]


class ClosedForm:
    """The formulas with the constants of one mechanism; `xp` is `math` for floats, else numpy.

    Floats and arrays give the same results to the bit. Complex numbers would not: some processors
    let numpy round their products once, where Python rounds twice.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self._eccentricity = mechanism.eccentricity
        self._cams = tuple(branch.cam_direction for branch in mechanism.branches)
        self._slide_ratio = mechanism.ring_teeth / mechanism.satellite_teeth
        self._kappa = float(2 / mechanism.gear_ratio) - 1.0

    def branches(self, angle: Any, output_angle: Any, xp: ModuleType) -> list[BranchPosition]:
        """Positions of the bodies of each branch; both angles in [-π, π]."""
        e, cosine, sine = self._eccentricity, xp.cos(angle), xp.sin(angle)
        arm_x, arm_y = -xp.sin(output_angle), xp.cos(output_angle)  # u(φ5)
        positions = []
        for cam_x, cam_y in self._cams:
            x, y = -sine, cosine  # u(θ)
            if cam_x or cam_y != 1.0:  # else θ = φ2
                x, y = cosine * cam_x - sine * cam_y, sine * cam_x + cosine * cam_y
            satellite_slide = e * (y * arm_x - x * arm_y)  # eq. (19): e sin β, β = θ - φ5
            arm_slide = e * (x * arm_x + y * arm_y)  # eq. (20): e cos β
            oldham = arm_slide * arm_x, arm_slide * arm_y  # eqs. (21), (22): y u(φ5)
            # The satellite's centre: eqs. (9), (10).
            positions.append(BranchPosition((e * x, e * y), oldham, satellite_slide, arm_slide))
        return positions

    def rates(self, positions: Iterable[BranchPosition], w: Any, a: Any) -> Iterator[BranchRates]:
        """Yield the rates of each branch for the rotor velocity w and acceleration a.

        O4 is the sum of two vectors, at the angles θ and 2 φ5 - θ, which turn at w and κ w.
        """
        kappa, square, minus_w, minus_a = self._kappa, w * w, -w, -a
        for position in positions:
            (x, y), (oldham_x, oldham_y) = position.satellite, position.oldham
            along_x, along_y = 0.5 * x, 0.5 * y  # (e/2) u(θ)
            counter_x = kappa * (oldham_x - along_x)  # κ (e/2) u(2 φ5 - θ)
            counter_y = kappa * (oldham_y - along_y)
            rate_x, rate_y = along_x + counter_x, along_y + counter_y
            yield BranchRates(
                (minus_w * y, w * x),
                (minus_w * rate_y, w * rate_x),
                *self.slide_velocities(position, w),
                (minus_a * y - square * x, a * x - square * y),
                (
                    minus_a * rate_y - square * (along_x + kappa * counter_x),
                    a * rate_x - square * (along_y + kappa * counter_y),
                ),
            )

    def slide_velocities(self, position: BranchPosition, w: Any) -> tuple[Any, Any]:
        """x' and y', m/s, for the rotor velocity w: β' = w zk/zs."""
        beta_rate = self._slide_ratio * w
        return beta_rate * position.arm_slide, -beta_rate * position.satellite_slide


@lru_cache
def closed_form(mechanism: Mechanism) -> ClosedForm:
    """The formulas of a mechanism, created once."""
    return ClosedForm(mechanism)


_CHUNK = 12288  # samples, so that the arrays of a chunk fit into the processor's cache


@np.errstate(invalid='ignore')  # values that are not finite give NaN
def solve(
    mechanism: Mechanism,
    rotor_angle: 'ArrayLike',
    rotor_velocity: 'ArrayLike' = 0.0,
    rotor_acceleration: 'ArrayLike' = 0.0,
    *,
    rotor_turns: 'ArrayLike' = 0,
) -> MotionState:
    """Solve the motion of all bodies in closed form.

    Args:
        mechanism: the mechanism.
        rotor_angle: φ2, rad. Inputs broadcast to any shape `(...)`. Angles that are not
            finite, or beyond ±`LARGEST_ANGLE`, give NaN.
        rotor_velocity: rad/s.
        rotor_acceleration: rad/s².
        rotor_turns: whole turns added to `rotor_angle` without loss of precision, integers up to
            ±`MOST_TURNS`.

    Raises:
        TypeError: if `mechanism` is no Mechanism; the message says what to call for a GearRatio.
        ValueError: if `rotor_turns` are not integers up to ±`MOST_TURNS`.
    """
    if not isinstance(mechanism, Mechanism):
        raise TypeError(
            f'solve needs a Mechanism, not a {type(mechanism).__name__}; for a GearRatio, '
            'call output_angle(*split_turns(rotor_angle), numpy)'
        )
    form, ratio = closed_form(mechanism), mechanism.gear_ratio
    moving = bool(np.any(rotor_velocity) or np.any(rotor_acceleration))
    inputs = (whole_turns(rotor_turns), rotor_angle, rotor_velocity, rotor_acceleration)
    arrays = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) for value in inputs))
    shape, branches = arrays[0].shape, len(mechanism.branches)
    turns, angle, velocity, acceleration = (array.reshape(-1) for array in arrays)

    # The first axis is the order of the derivative, the last the sample: rows are written fastest.
    orders, size = 3 if moving else 1, angle.size
    output, turn_angle = np.empty((orders, size)), np.empty(size)
    satellite, oldham = np.empty((2, orders, branches, 2, size))
    satellite_slide, arm_slide = np.empty((2, min(orders, 2), branches, size))

    def fill(part: slice) -> None:
        own_turns, rest = split_turns(angle[part])
        output_turns, output_rest = ratio.output_angle(turns[part] + own_turns, rest, np)
        turn_angle[part] = output_rest
        np.add(TURN * output_turns, output_rest, out=output[0, part])
        positions = form.branches(rest, output_rest, np)
        for k, position in enumerate(positions):
            for axis in (0, 1):  # one by one: numpy would first copy a pair into an array
                satellite[0, k, axis, part] = position.satellite[axis]
                oldham[0, k, axis, part] = position.oldham[axis]
            satellite_slide[0, k, part] = position.satellite_slide
            arm_slide[0, k, part] = position.arm_slide
        if not moving:
            return
        w, a = velocity[part], acceleration[part]
        output[1, part], output[2, part] = ratio.output_rate(w), ratio.output_rate(a)
        for k, rates in enumerate(form.rates(positions, w, a)):
            satellite[1, k, :, part] = rates.satellite_velocity
            satellite[2, k, :, part] = rates.satellite_acceleration
            oldham[1, k, :, part] = rates.oldham_velocity
            oldham[2, k, :, part] = rates.oldham_acceleration
            satellite_slide[1, k, part] = rates.satellite_slide_velocity
            arm_slide[1, k, part] = rates.arm_slide_velocity

    for start in range(0, size, _CHUNK):
        fill(slice(start, start + _CHUNK))  # returning frees the arrays of the chunk
    return MotionState.from_orders(
        output=output.reshape(orders, *shape),
        output_turn_angle=turn_angle.reshape(shape),
        satellite=_samples_first(satellite, shape),
        oldham=_samples_first(oldham, shape),
        satellite_slide=_samples_first(satellite_slide, shape),
        arm_slide=_samples_first(arm_slide, shape),
    )


def _samples_first(rows: Array, shape: tuple[int, ...]) -> Array:
    """View (order, ..., sample) as (order, *shape, ...)."""
    inner, whole = rows.ndim - 2, rows.reshape(*rows.shape[:-1], *shape)
    return whole.transpose(0, *range(inner + 1, whole.ndim), *range(1, inner + 1))
