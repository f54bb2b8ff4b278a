# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads of all bodies: reactions of mesh, cam and both slots, and the torque of the rotor.

Newton-Euler for each satellite (m3, J3 about O3) and each Oldham coupling (m4, J4 about O4), with
the accelerations a3, a4 of the closed form and the torque T that the branch gives the output
shaft; lossless. u(q) = (-sin q, cos q), u'(q) = (-cos q, -sin q), x and y are the slides of the
coupling, so that O4 - O3 = -x u'(φ5) and O4 = y u(φ5); rs = e zs/(zk - zs). For each branch:

    N3 = m4 a4·u(φ5)                     satellite on coupling, along u(φ5): across its slot
    N5 = m4 a4·u'(φ5)                    arm on coupling, along u'(φ5): across its slot
    C5 = -T - y N5                       couple of the arm on the coupling, about O4
    C3 = J4 φ5'' - C5                    couple of the satellite on the coupling, about O4
    F_t = (J3 φ5'' + C3 + x N3)/rs       ring on satellite at the pitch point, along u'(θ)
    F = F_t u'(θ) - abs(F_t) tan(αw) u(θ)    the same with its radial part, away from the ring
    F_cam = m3 a3 + N3 u(φ5) - F         cam on satellite, at O3

and for the rotor, with φ2'' = i φ5'', O3 × F_cam = m3 e² φ2'' - x N3 - e F_t and rs = -i e:

    τ2 = J2 φ2'' + Σ O3 × F_cam

At rest or without mass: N3 = N5 = 0, C3 = -C5 = T, F_t = T/rs and i τ2 = Σ T. Forces and torques
are those that the body named first exerts; the other body exerts the opposite ones. The torque of
the output shaft's own inertia is no part of T: the shaft passes on Σ T minus J5 φ5''.

How the branches share the torque of the output is statically indeterminate: `TorqueSharing`.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import reduce
from numbers import Real
from operator import add
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.kinematics.errors import MechanismError
from gear_kinematics.kinematics.mechanism import Mechanism
from gear_kinematics.kinematics.motion import Array, BranchPosition, MotionState, read_only
from gear_kinematics.kinematics.preload import Pair, Preload, braced
from gear_kinematics.kinematics.rotor_turns import lists_as_arrays

_GREATEST_TWIST = 1.0  # rad, at the output, by a preload: more is one in another unit


@dataclass(frozen=True, slots=True)
class Bodies:
    """Masses, inertias and pressure angle of the bodies; bodies of one kind are identical.

    Raises:
        MechanismError: listing every value that is not finite or negative, and a pressure angle
            of π/2 or more.
    """

    satellite_mass: float = 0.0
    """Mass m3 of a satellite, kg; its centre of mass is O3."""
    satellite_inertia: float = 0.0
    """Moment of inertia J3 of a satellite about O3, kg·m²."""
    coupling_mass: float = 0.0
    """Mass m4 of an Oldham coupling, kg; its centre of mass is O4."""
    coupling_inertia: float = 0.0
    """Moment of inertia J4 of an Oldham coupling about O4, kg·m²."""
    rotor_inertia: float = 0.0
    """Moment of inertia J2 of the rotor, kg·m², about the motor's axis.

    The rotor with its cams is balanced on this axis.
    """
    pressure_angle: float = 0.0
    """Working pressure angle αw, rad, with cos αw = cos α m (zk - zs)/(2 e)."""

    def __post_init__(self) -> None:
        """List all faults."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        faults = [
            f'{name} must be finite and not negative, not {value!r}'
            for name, value in given.items()
            if not (isinstance(value, Real) and 0.0 <= float(value) < math.inf)
        ]
        if not faults and self.pressure_angle >= math.pi / 2.0:
            faults = [f'pressure_angle must be less than π/2, not {self.pressure_angle!r}']
        if faults:
            raise MechanismError(faults)

    @property
    def without_mass(self) -> bool:
        """Whether all masses and inertias are 0, so that accelerations cause no loads."""
        return not any(getattr(self, field.name) for field in fields(self)[:-1])


@dataclass(frozen=True, eq=False, slots=True)
class Loads:
    """The loads of all bodies. `...` is the inputs' broadcast shape, B the number of branches.

    All arrays are float64 and read-only; forces in N, in the stator frame, couples in N·m.
    """

    mesh_tangential: Array
    """Force F_t of the ring on the satellite at the pitch point, along u'(θ), (..., B)."""
    mesh_force: Array
    """Total force F of the ring on the satellite, (..., B, 2); its magnitude is F_n."""
    cam_force: Array
    """Force F_cam of the cam on the satellite at O3, (..., B, 2)."""
    satellite_slot_force: Array
    """Force N3 u(φ5) of the satellite on the coupling at O4, (..., B, 2)."""
    arm_slot_force: Array
    """Force N5 u'(φ5) of the arm on the coupling at O4, (..., B, 2)."""
    satellite_couple: Array
    """Couple C3 of the satellite on the coupling about O4, (..., B)."""
    arm_couple: Array
    """Couple C5 of the arm on the coupling about O4, (..., B)."""
    rotor_torque: Array
    """Torque τ2 that the motor has to supply, N·m, (...)."""

    def __post_init__(self) -> None:
        """Convert the fields to read-only arrays."""
        read_only(self)


BranchLoads = tuple[Any, Pair, Pair, Pair, Pair, Any, Any]
"""The loads of one branch, floats or arrays, in the order of the fields of `Loads`."""
Inertia = tuple[Pair, Pair, Pair, Any, Any, Any, Any]
"""Inertial parts of the loads of a branch: N3 u, N5 u', F + F_cam, C3, C5, F_t rs, O3 × F_cam."""
AT_REST: Inertia = (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), 0.0, 0.0, 0.0, 0.0


class LoadEquations:
    """The equations with the constants of one mechanism and its bodies, for floats and arrays.

    Floats and arrays give the same results to the bit.
    """

    def __init__(self, mechanism: Mechanism, bodies: Bodies) -> None:
        self._bodies = bodies
        self._massless = bodies.without_mass
        self._eccentricity = mechanism.eccentricity
        self._radius = mechanism.satellite_rolling_radius
        self._ratio = float(mechanism.gear_ratio)
        self._tangent = math.tan(bodies.pressure_angle)

    def inertia(
        self, position: BranchPosition, arm: Pair, output_acceleration: Any, a3: Pair, a4: Pair
    ) -> Inertia:
        """Inertial loads of a branch, from the arm u(φ5), φ5'' in rad/s², a3 and a4 in m/s²."""
        if self._massless:
            return AT_REST
        bodies, e, (_, _, x, y) = self._bodies, self._eccentricity, position
        (ux, uy), (a3x, a3y), (a4x, a4y) = arm, a3, a4
        N3 = bodies.coupling_mass * (a4x * ux + a4y * uy)
        N5 = bodies.coupling_mass * (a4y * ux - a4x * uy)
        slot_x, slot_y = N3 * ux, N3 * uy
        C5 = -y * N5
        C3 = bodies.coupling_inertia * output_acceleration - C5
        moment = bodies.satellite_inertia * output_acceleration + C3 + x * N3
        orbit = bodies.satellite_mass * e**2 * self._ratio * output_acceleration
        return (
            (slot_x, slot_y),
            (-N5 * uy, N5 * ux),
            (bodies.satellite_mass * a3x + slot_x, bodies.satellite_mass * a3y + slot_y),
            C3,
            C5,
            moment,
            orbit - x * N3 - e * moment / self._radius,
        )

    def branches(
        self,
        positions: Iterable[BranchPosition],
        torques: Iterable[Any],
        inertias: Iterable[Inertia],
    ) -> list[BranchLoads]:
        """Compute the loads of the branches that exert the torques T, N·m, on the output shaft."""
        e, radius, tangent, found = self._eccentricity, self._radius, self._tangent, []
        for position, T, inertia in zip(positions, torques, inertias, strict=True):
            (x, y), _, _, _ = position
            slot, arm_slot, (pull_x, pull_y), C3, C5, moment, _ = inertia
            F_t = (moment + T) / radius
            along = F_t / e  # as (x, y) = e u(θ)
            away = abs(along) * tangent
            mesh_x, mesh_y = 0.0 - along * y - away * x, along * x - away * y
            mesh, cam = (mesh_x, mesh_y), (pull_x - mesh_x, pull_y - mesh_y)
            found.append((F_t, mesh, cam, slot, arm_slot, C3 + T, C5 - T))
        return found

    def rotor_torque(
        self, shares: Iterable[Any], output_acceleration: Any, torque: Any = 0.0
    ) -> Any:
        """Compute τ2, N·m, from O3 × F_cam of each branch's masses, rotor inertia and Σ T."""
        inertial = self._bodies.rotor_inertia * self._ratio * output_acceleration
        # From Python 3.12 on, `sum` rounds floats otherwise than arrays.
        return reduce(add, shares, inertial) + torque / self._ratio


@np.errstate(invalid='ignore')  # values that are not finite give NaN
def solve(
    mechanism: Mechanism,
    state: MotionState,
    branch_torques: 'ArrayLike',
    bodies: Bodies = Bodies(),
) -> Loads:
    """Solve the loads of all bodies.

    Args:
        mechanism: the mechanism.
        state: its motion, of shape (...), with accelerations if the bodies have mass.
        branch_torques: torque T that each branch exerts on the output shaft, N·m, (..., B);
            broadcast with the state.
        bodies: masses, inertias and pressure angle.

    Raises:
        ValueError: if `branch_torques` or the state do not fit the mechanism or each other.
    """
    torques = np.asarray(branch_torques, dtype=np.float64)
    count, of_state = len(mechanism.branches), state.satellite_slide.shape
    if not of_state[-1:] == torques.shape[-1:] == (count,):
        given = f'not of the shapes {of_state} and {torques.shape}'
        raise ValueError(f'state and branch_torques must be of {count} branches, {given}')
    shape = np.broadcast_shapes(of_state, torques.shape)[:-1]
    equations = LoadEquations(mechanism, bodies)
    angle = state.output_turn_angle[..., np.newaxis]
    acceleration = state.output_acceleration[..., np.newaxis]
    position = BranchPosition(
        _pair(state.satellite_centre),
        _pair(state.oldham_centre),
        state.satellite_slide,
        state.arm_slide,
    )
    inertia = equations.inertia(
        position,
        (-np.sin(angle), np.cos(angle)),
        acceleration,
        _pair(state.satellite_acceleration),
        _pair(state.oldham_acceleration),
    )
    (branches,) = equations.branches([position], [torques], [inertia])  # all at once
    shares = np.moveaxis(_joined(inertia[-1], (*shape, count)), -1, 0)
    rotor = equations.rotor_torque(shares, state.output_acceleration, torques.sum(axis=-1))
    arrays = [_joined(value, (*shape, count)) for value in branches]
    arrays.append(_joined(rotor, shape))
    return Loads(*arrays)  # in the order of the fields


class TorqueSharing:
    """Distribution of the output's torque among the branches.

    Two branches with a preload carry T_A and -T_B, as `preload` splits the external torque -Σ T,
    also beyond the thresholds. Branches without a preload carry equal shares. Floats and arrays
    give the same results to the bit.

    Args:
        mechanism: determines the number of branches.
        preload: the preload of two branches; None for equal shares.
        direction: 1 if ring gear A is turned against ring gear B in the positive direction, so
            that branch A pushes the output in the positive direction; -1 if in the negative one.

    Raises:
        ValueError: if a `preload` twists the output by more than 1 rad or there are not two
            branches, or `direction` is neither 1 nor -1.
    """

    def __init__(
        self, mechanism: Mechanism, preload: Preload | None = None, direction: int = 1
    ) -> None:
        if direction not in (1, -1):
            raise ValueError(f'direction must be 1 or -1, not {direction!r}')
        if preload is not None:
            braced(mechanism)
            if (twist := preload.interference) > _GREATEST_TWIST:
                limit = f'a gear takes at most {_GREATEST_TWIST:g} rad'
                raise MechanismError(
                    [f'the preload twists the output by {twist:.3g} rad: {limit}']
                )
        self._count, self._preload = len(mechanism.branches), preload
        self._direction = float(direction)

    def branches(self, torque: Any) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Divide the total torque Σ T on the output shaft, N·m, which is i × τ2 at rest.

        Returns:
            The torque T of each branch, N·m, and the angle between its flanks, rad at the
            output, which is 0 in mesh. Each has the shape of Σ T.
        """
        torque = lists_as_arrays(torque)
        if self._preload is None:
            return (torque / self._count,) * self._count, (0.0,) * self._count
        sign = self._direction
        (torque_a, torque_b), stand_offs = self._preload.contacts(-sign * torque)
        return (sign * torque_a + 0.0, 0.0 - sign * torque_b), stand_offs  # no -0.0

    def margin(self, torque: Any) -> Any:
        """Remaining preload as in `Preload.margin`, N·m, at an output torque; NaN without one."""
        torque = lists_as_arrays(torque)
        if self._preload is None:
            return torque * math.nan
        return self._preload.margin(-self._direction * torque)


def _pair(points: Array) -> Pair:
    return points[..., 0], points[..., 1]


def _joined(value: Any, shape: tuple[int, ...]) -> Array:
    """Broadcast a value to a shape, or several of them to one array with a last axis."""
    if isinstance(value, tuple):
        return np.stack([np.broadcast_to(each, shape) for each in value], axis=-1)
    return np.broadcast_to(value, shape)
