"""The closed form of the motion: eqs. (5)-(22) of the paper and their time derivatives.

Every formula stands here once, in functions that take numpy arrays and plain floats alike:
`solve` applies them to arrays of any shape, the node to one sample of plain floats.

Symbols: φ2 rotor angle, φ5 output angle, α_k cam phase, θ_k = φ2 + α_k, e eccentricity,
u(q) = (-sin q, cos q), i gear ratio, p/q = (zk - zs)/zs = -1/i in lowest terms.
"""

import math
from dataclasses import dataclass, fields
from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gear_kinematics.kinematics.mechanism import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN, split_turns

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
        """Gather a state from arrays whose first axis is the order of the derivative."""
        return cls(
            output_angle=output[0],
            output_velocity=output[1],
            output_acceleration=output[2],
            output_turn_angle=output_turn_angle,
            satellite_centre=satellite[0],
            satellite_velocity=satellite[1],
            satellite_acceleration=satellite[2],
            oldham_centre=oldham[0],
            oldham_velocity=oldham[1],
            oldham_acceleration=oldham[2],
            satellite_slide=satellite_slide[0],
            satellite_slide_velocity=satellite_slide[1],
            arm_slide=arm_slide[0],
            arm_slide_velocity=arm_slide[1],
        )


class BranchPosition(NamedTuple):
    """Where the bodies of one branch are, m: floats or arrays."""

    satellite_x: Any
    satellite_y: Any
    oldham_x: Any
    oldham_y: Any
    satellite_slide: Any
    arm_slide: Any


class BranchDerivative(NamedTuple):
    """The first (m/s) or second (m/s²) time derivative of the centres of one branch."""

    satellite_x: Any
    satellite_y: Any
    oldham_x: Any
    oldham_y: Any


class ClosedForm:
    """The formulas with the constants of one mechanism; `xp` is `math` for floats, else numpy."""

    def __init__(self, mechanism: Mechanism) -> None:
        """Take what the formulas need from the mechanism."""
        ratio = -1 / mechanism.gear_ratio
        self._p, self._q = ratio.numerator, ratio.denominator
        self._eccentricity = mechanism.eccentricity
        self._cams = tuple(
            (math.cos(b.cam_phase), math.sin(b.cam_phase)) for b in mechanism.branches
        )
        self._slide_ratio = mechanism.ring_teeth / mechanism.satellite_teeth
        self._kappa = -2.0 * float(ratio) - 1.0

    def output_angle(self, turns: Any, angle: Any, xp: ModuleType) -> tuple[Any, Any]:
        """φ5 = φ2/i (eq. 5) in whole turns and the rest in [-π, π], for φ2 = 2π turns + angle.

        Of the whole turns only their remainder by q counts within the turn, so nothing cancels.
        """
        p, q = self._p, self._q
        cycles, part = turns // q, turns % q
        step = part * p % q
        step = step - q * (2 * step > q)
        rest = -(TURN * step + p * angle) / q
        wraps = xp.floor(rest / TURN + 0.5)
        return wraps - (cycles * p + (part * p - step) // q), rest - TURN * wraps

    def output_rate(self, rotor_rate: Any) -> Any:
        """ω5 = ω2/i (eq. 3), and likewise for the acceleration."""
        return -self._p * rotor_rate / self._q

    def branches(self, angle: Any, output_angle: Any, xp: ModuleType) -> list[BranchPosition]:
        """Positions of the bodies, branch by branch; both angles within their turn."""
        e = self._eccentricity
        sin2, cos2 = xp.sin(angle), xp.cos(angle)
        sin5, cos5 = xp.sin(output_angle), xp.cos(output_angle)
        positions = []
        for cos_cam, sin_cam in self._cams:
            sin_theta = sin2 * cos_cam + cos2 * sin_cam
            cos_theta = cos2 * cos_cam - sin2 * sin_cam
            arm_slide = e * (cos_theta * cos5 + sin_theta * sin5)  # eq. (20): e cos(θ - φ5)
            positions.append(
                BranchPosition(
                    satellite_x=-e * sin_theta,  # eq. (9)
                    satellite_y=e * cos_theta,  # eq. (10)
                    oldham_x=-arm_slide * sin5,  # eq. (21)
                    oldham_y=arm_slide * cos5,  # eq. (22)
                    satellite_slide=e * (sin_theta * cos5 - cos_theta * sin5),  # eq. (19)
                    arm_slide=arm_slide,
                )
            )
        return positions

    def slide_velocities(self, position: BranchPosition, w: Any) -> tuple[Any, Any]:
        """x' = y w zk/zs and y' = -x w zk/zs, m/s, for the rotor velocity w."""
        rate = self._slide_ratio * w
        return position.arm_slide * rate, -position.satellite_slide * rate

    def velocity(self, position: BranchPosition, w: Any) -> BranchDerivative:
        """O3' and O4'. O4 is the sum of two vectors that turn with θ and with 2 φ5 - θ.

        Turning with angle q, a vector (x, y) changes by q'·(-y, x); (2 φ5 - θ)' = κ w.
        """
        along_x, along_y, counter_x, counter_y = self._turning_parts(position)
        return BranchDerivative(
            -position.satellite_y * w,
            position.satellite_x * w,
            -(along_y + self._kappa * counter_y) * w,
            (along_x + self._kappa * counter_x) * w,
        )

    def acceleration(self, position: BranchPosition, w: Any, a: Any) -> BranchDerivative:
        """O3'' and O4'' for the rotor velocity w and acceleration a."""
        along_x, along_y, counter_x, counter_y = self._turning_parts(position)
        tangential = self.velocity(position, a)
        w2 = w * w
        kappa2 = self._kappa * self._kappa
        return BranchDerivative(
            tangential.satellite_x - position.satellite_x * w2,
            tangential.satellite_y - position.satellite_y * w2,
            tangential.oldham_x - (along_x + kappa2 * counter_x) * w2,
            tangential.oldham_y - (along_y + kappa2 * counter_y) * w2,
        )

    @staticmethod
    def _turning_parts(position: BranchPosition) -> tuple[Any, Any, Any, Any]:
        """(e/2) u(θ) and (e/2) u(2 φ5 - θ), whose sum is O4."""
        along_x, along_y = 0.5 * position.satellite_x, 0.5 * position.satellite_y
        return along_x, along_y, position.oldham_x - along_x, position.oldham_y - along_y


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
        rotor_angle: φ2, rad. Inputs broadcast to any shape `(...)`. What is not finite gives NaN.
        rotor_velocity: rad/s.
        rotor_acceleration: rad/s².
        rotor_turns: whole turns to be added to `rotor_angle`, integers up to ±2^53: the way to
            large angles without loss.
    """
    form = closed_form(mechanism)
    inputs = (rotor_turns, rotor_angle, rotor_velocity, rotor_acceleration)
    arrays = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) for value in inputs))
    shape, branches = arrays[0].shape, len(mechanism.branches)
    turns, angle, velocity, acceleration = (array.reshape(-1) for array in arrays)
    moving = bool(np.any(velocity) or np.any(acceleration))

    # The first axis is the order of the derivative. What stays zero is never touched again.
    output, turn_angle = np.zeros((3, angle.size)), np.zeros(angle.size)
    satellite, oldham = np.zeros((2, 3, angle.size, branches, 2))
    slide, arm_slide = np.zeros((2, 2, angle.size, branches))
    for start in range(0, angle.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        w, a = velocity[part], acceleration[part]
        own_turns, rest = split_turns(angle[part])
        output_turns, output_rest = form.output_angle(turns[part] + own_turns, rest, np)
        turn_angle[part] = output_rest
        output[0, part] = TURN * output_turns + output_rest
        if moving:
            output[1, part], output[2, part] = form.output_rate(w), form.output_rate(a)
        for k, position in enumerate(form.branches(rest, output_rest, np)):
            centres = [position[:4]]
            slide[0, part, k], arm_slide[0, part, k] = position[4:]
            if moving:
                centres += [form.velocity(position, w), form.acceleration(position, w, a)]
                slide[1, part, k], arm_slide[1, part, k] = form.slide_velocities(position, w)
            for order, (satellite_x, satellite_y, oldham_x, oldham_y) in enumerate(centres):
                satellite[order, part, k, 0] = satellite_x
                satellite[order, part, k, 1] = satellite_y
                oldham[order, part, k, 0] = oldham_x
                oldham[order, part, k, 1] = oldham_y

    vectors = (3, *shape, branches, 2)
    slides = (2, *shape, branches)
    return MotionState.from_orders(
        output=output.reshape(3, *shape),
        output_turn_angle=turn_angle.reshape(shape),
        satellite=satellite.reshape(vectors),
        oldham=oldham.reshape(vectors),
        satellite_slide=slide.reshape(slides),
        arm_slide=arm_slide.reshape(slides),
    )
