"""The closed form of the motion: eqs. (5)-(22) of the paper and their time derivatives.

Every formula stands here once, in functions that take numpy arrays and plain floats alike:
`solve` applies them to arrays of any shape, the node to one sample of plain floats.

Symbols: φ2 rotor angle, φ5 output angle, α_k cam phase, θ_k = φ2 + α_k, e eccentricity,
u(q) = (-sin q, cos q), i gear ratio, p/q = (zk - zs)/zs = -1/i in lowest terms.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.mechanism import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN, split_turns, whole_turns

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class MotionState:
    """The motion of all bodies. `...` is the broadcast shape of the inputs, B the branches.

    All arrays are float64 and read-only; lengths in m, angles in rad, in the stator frame.
    """

    output_angle: Array
    """φ5, (...): the angle of the output shaft, satellites and couplings; counts turns (eq. 5)."""
    output_velocity: Array
    """(...), rad/s."""
    output_acceleration: Array
    """(...), rad/s²."""
    output_turn_angle: Array
    """(...): `output_angle` less its whole turns, in [-π, π]; exact however many there are."""
    satellite_centre: Array
    """O3, (..., B, 2), eqs. (9), (10)."""
    satellite_velocity: Array
    """(..., B, 2), m/s."""
    satellite_acceleration: Array
    """(..., B, 2), m/s²."""
    oldham_centre: Array
    """O4, (..., B, 2), eqs. (21), (22)."""
    oldham_velocity: Array
    """(..., B, 2), m/s."""
    oldham_acceleration: Array
    """(..., B, 2), m/s²."""
    satellite_slide: Array
    """x_k, (..., B): the coupling along x of the satellite frame, eq. (19)."""
    satellite_slide_velocity: Array
    """(..., B), m/s."""
    arm_slide: Array
    """y_k, (..., B): the coupling along y of the output shaft's frame, eq. (20)."""
    arm_slide_velocity: Array
    """(..., B), m/s."""

    def __post_init__(self) -> None:
        """Take what is array-like as read-only arrays."""
        for field in fields(self):
            array = np.asarray(getattr(self, field.name)).view()
            array.flags.writeable = False
            object.__setattr__(self, field.name, array)

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
        """Gather a state from arrays whose first axis is the order of the derivative.

        Derivatives that an array leaves out are zero, and take no memory.
        """
        zero = np.broadcast_to(0.0, satellite.shape[1:])
        outputs = (*output, zero[..., 0, 0], zero[..., 0, 0])
        satellites, oldhams = (*satellite, zero, zero), (*oldham, zero, zero)
        satellite_slides = (*satellite_slide, zero[..., 0])
        arm_slides = (*arm_slide, zero[..., 0])
        return cls(
            output_angle=outputs[0],
            output_velocity=outputs[1],
            output_acceleration=outputs[2],
            output_turn_angle=output_turn_angle,
            satellite_centre=satellites[0],
            satellite_velocity=satellites[1],
            satellite_acceleration=satellites[2],
            oldham_centre=oldhams[0],
            oldham_velocity=oldhams[1],
            oldham_acceleration=oldhams[2],
            satellite_slide=satellite_slides[0],
            satellite_slide_velocity=satellite_slides[1],
            arm_slide=arm_slides[0],
            arm_slide_velocity=arm_slides[1],
        )


class BranchPosition(NamedTuple):
    """Where the bodies of one branch are, m: complex numbers or arrays of them."""

    satellite: Any
    """O3 as x + iy."""
    oldham: Any
    """O4 as x + iy."""
    slides: Any
    """y_k + i x_k: the slide on the arm, and i times the slide on the satellite."""


class BranchRates(NamedTuple):
    """The time derivatives of a `BranchPosition`, m/s and m/s²."""

    satellite_velocity: Any
    oldham_velocity: Any
    slide_velocities: Any
    satellite_acceleration: Any
    oldham_acceleration: Any


class ClosedForm:
    """The formulas with the constants of one mechanism; `xp` is `math` for floats, else numpy.

    Vectors in the plane are complex numbers x + iy here. Turning by an angle q multiplies them
    by exp(iq), so that u(q) = i exp(iq), whose time derivative is i q' u(q).
    """

    def __init__(self, mechanism: Mechanism) -> None:
        """Take what the formulas need from the mechanism."""
        ratio = -1 / mechanism.gear_ratio
        self._p, self._q = ratio.numerator, ratio.denominator
        self._eccentricity = mechanism.eccentricity
        self._cams = tuple(  # u(α)
            complex(-math.sin(b.cam_phase), math.cos(b.cam_phase)) for b in mechanism.branches
        )
        self._slide_ratio = mechanism.ring_teeth / mechanism.satellite_teeth
        self._kappa = -2.0 * float(ratio) - 1.0

    def output_angle(self, turns: Any, angle: Any, xp: ModuleType) -> tuple[Any, Any]:
        """φ5 = φ2/i (eq. 5) in whole turns and the rest in [-π, π], for φ2 = 2π turns + angle.

        Of the whole turns only their remainder by q counts within the turn, so nothing cancels.
        """
        p, q = self._p, self._q
        cycles = xp.trunc(turns / q)
        steps = p * (turns - q * cycles)
        whole = xp.ceil(steps / q - 0.5)
        rest = (TURN * (steps - q * whole) + p * angle) / -q
        wraps = xp.floor(rest / TURN + 0.5)
        return wraps - (p * cycles + whole), rest - TURN * wraps

    def output_rate(self, rotor_rate: Any) -> Any:
        """ω5 = ω2/i (eq. 3), and likewise for the acceleration."""
        return -self._p * rotor_rate / self._q

    def branches(self, angle: Any, output_angle: Any, xp: ModuleType) -> list[BranchPosition]:
        """Positions of the bodies, branch by branch; both angles within their turn."""
        e = self._eccentricity
        rotor, arm = _direction(angle, xp), 1j * _direction(output_angle, xp)
        from_arm = arm.conjugate()
        positions = []
        for cam in self._cams:
            turned = rotor * cam  # u(θ)
            satellite = e * turned  # eqs. (9), (10)
            slides = e * (turned * from_arm)  # eqs. (19), (20): e exp(iβ), β = θ - φ5
            oldham = slides.real * arm  # eqs. (21), (22): y u(φ5)
            positions.append(BranchPosition(satellite, oldham, slides))
        return positions

    def rates(self, positions: Iterable[BranchPosition], w: Any, a: Any) -> Iterator[BranchRates]:
        """Yield the rates of each branch for the rotor velocity w and acceleration a.

        O4 is the sum of two vectors, which turn with θ and with 2 φ5 - θ: at w and at κ w.
        """
        kappa = self._kappa
        first = 1j * w
        square = first * first
        second = 1j * a + square  # u(θ)' = first u(θ), u(θ)'' = second u(θ)
        for position in positions:
            along = 0.5 * position.satellite  # (e/2) u(θ)
            counter = kappa * (position.oldham - along)  # κ (e/2) u(2 φ5 - θ)
            both = along + counter
            yield BranchRates(
                satellite_velocity=position.satellite * first,
                oldham_velocity=both * first,
                slide_velocities=self.slide_velocities(position, w),
                satellite_acceleration=position.satellite * second,
                oldham_acceleration=both * second + (kappa - 1.0) * counter * square,
            )

    def slide_velocities(self, position: BranchPosition, w: Any) -> Any:
        """y' + i x', m/s, for the rotor velocity w: β' = w zk/zs."""
        return 1j * self._slide_ratio * w * position.slides


def _direction(angle: Any, xp: ModuleType) -> Any:
    """exp(i angle)."""
    if xp is math:
        return complex(math.cos(angle), math.sin(angle))
    direction = np.empty(angle.shape, np.complex128)
    np.cos(angle, out=direction.real)
    np.sin(angle, out=direction.imag)
    return direction


@lru_cache
def closed_form(mechanism: Mechanism) -> ClosedForm:
    """The formulas of a mechanism, made once."""
    return ClosedForm(mechanism)


_CHUNK = 8192  # samples: what a chunk needs stays in the processor's cache


@np.errstate(invalid='ignore')  # what is not finite gives NaN
def solve(
    mechanism: Mechanism,
    rotor_angle: ArrayLike,
    rotor_velocity: ArrayLike = 0.0,
    rotor_acceleration: ArrayLike = 0.0,
    *,
    rotor_turns: ArrayLike = 0,
) -> MotionState:
    """Solve the motion of all bodies in closed form.

    Args:
        mechanism: the mechanism.
        rotor_angle: φ2, rad. Inputs broadcast to any shape `(...)`. What is not finite, or beyond
            ±`LARGEST_ANGLE`, gives NaN.
        rotor_velocity: rad/s.
        rotor_acceleration: rad/s².
        rotor_turns: whole turns to be added to `rotor_angle`, integers up to ±`MOST_TURNS`: the
            way to large angles without loss.

    Raises:
        ValueError: if `rotor_turns` are no such integers.
    """
    form = closed_form(mechanism)
    moving = bool(np.any(rotor_velocity) or np.any(rotor_acceleration))
    inputs = (whole_turns(rotor_turns), rotor_angle, rotor_velocity, rotor_acceleration)
    arrays = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) for value in inputs))
    shape, branches = arrays[0].shape, len(mechanism.branches)
    turns, angle, velocity, acceleration = (array.reshape(-1) for array in arrays)

    # The first axis is the order of the derivative.
    orders, size = 3 if moving else 1, angle.size
    output, turn_angle = np.empty((orders, size)), np.empty(size)
    satellite, oldham = np.empty((2, orders, size, branches), np.complex128)
    slides = np.empty((min(orders, 2), size, branches), np.complex128)
    for start in range(0, size, _CHUNK):
        part = slice(start, start + _CHUNK)
        own_turns, rest = split_turns(angle[part])
        output_turns, output_rest = form.output_angle(turns[part] + own_turns, rest, np)
        turn_angle[part] = output_rest
        output[0, part] = TURN * output_turns + output_rest
        positions = form.branches(rest, output_rest, np)
        for k, position in enumerate(positions):
            satellite[0, part, k] = position.satellite
            oldham[0, part, k] = position.oldham
            slides[0, part, k] = position.slides
        if not moving:
            continue
        w, a = velocity[part], acceleration[part]
        output[1, part], output[2, part] = form.output_rate(w), form.output_rate(a)
        for k, rates in enumerate(form.rates(positions, w, a)):
            satellite[1, part, k] = rates.satellite_velocity
            satellite[2, part, k] = rates.satellite_acceleration
            oldham[1, part, k] = rates.oldham_velocity
            oldham[2, part, k] = rates.oldham_acceleration
            slides[1, part, k] = rates.slide_velocities

    vectors = (orders, *shape, branches, 2)
    slides = slides.reshape(len(slides), *shape, branches)
    return MotionState.from_orders(
        output=output.reshape(orders, *shape),
        output_turn_angle=turn_angle.reshape(shape),
        satellite=satellite.view(np.float64).reshape(vectors),
        oldham=oldham.view(np.float64).reshape(vectors),
        satellite_slide=slides.imag,
        arm_slide=slides.real,
    )
