# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What both models of a simulated actuator do."""

from typing import Protocol

from gear_kinematics.twin.gear import TwinGear


class Model(Protocol):
    """Moves a gear through time; angles count turns, and are those of the kinematics."""

    gear: TwinGear
    """It may be replaced at any time by one with the same mechanism."""
    rotor_angle: float
    """φ2, rad."""
    rotor_velocity: float
    """rad/s."""
    output_angle: float
    """φ5 of the output shaft, rad."""
    output_velocity: float
    """rad/s."""
    branch_torques: tuple[float, ...]
    """T_k, N·m, that each branch gives the output shaft; 0 out of mesh."""
    output_locked: bool
    """The output shaft stays where it is."""
    rotor_locked: bool
    """The rotor stays where it is."""

    def advance(self, duration: float, rotor_torque: float, load_torque: float) -> None:
        """Let time pass.

        Args:
            duration: s.
            rotor_torque: of the motor, N·m.
            load_torque: on the output shaft from outside, N·m.
        """
