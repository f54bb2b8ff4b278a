# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a simulated actuator is made of.

The branches and the shaft between their arms are springs. Branch k winds up by

    x_k = φ2/i + error(φ2) - ψ_k

with ψ_k the angle of its arm, and gives the arm the torque T_k: none within its dead band, the
play of its flanks, whose place is the preload, and that of its spring beyond it. The output shaft
is the arm of the last branch. Friction acts between the output shaft and the stator.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.parameters import NodeParameters


class Spring(NamedTuple):
    """A spring that acts beyond a distance from the dead band; several of them add up."""

    beyond: float
    """rad at the output, at least 0."""
    stiffness: float
    """N·m/rad."""


class Slider(NamedTuple):
    """Friction that holds like a spring until it slides, as of Jenkins or Prandtl."""

    stiffness: float
    """N·m/rad."""
    torque: float
    """N·m, at which it slides."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinGear:
    """A gear to be simulated; angles and torques are those of the output."""

    parameters: NodeParameters
    """Of its mechanism, bodies and encoders."""
    springs: tuple[Spring, ...]
    """Of each branch; the first one acts from the flanks on."""
    shaft_stiffness: float
    """N·m/rad, between both arms; infinite: rigid."""
    interference: float
    """rad: the twist of the loop at the arms by the preload; if negative, the play that is left."""
    play: float
    """rad: between the flanks of a branch, at least the play that is left."""
    friction: tuple[Slider, ...] = ()
    """They add up."""
    errors: tuple[Order, ...] = ()
    """Of the output angle, by the rotor angle."""
    rotor_damping: float = 0.0
    """N·m·s/rad."""
    output_inertia: float
    """kg·m²."""

    @property
    def dead_bands(self) -> tuple[tuple[float, float], ...]:
        """Least and greatest x_k without torque, for each branch, rad."""
        raise NotImplementedError

    def worn(self, angle: float) -> Self:
        """The same gear with flanks that wore off by an angle of the output, rad, together."""
        return replace(self, interference=self.interference - angle, play=self.play + angle)

    def error(self, rotor_angle: float) -> float:
        """The deviation of the output angle, rad."""
        return math.fsum(
            order.cos * math.cos(order.cycles * rotor_angle)
            + order.sin * math.sin(order.cycles * rotor_angle)
            for order in self.errors
        )
