# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The interface of both models of a simulated actuator."""

from typing import Protocol

from gear_kinematics.twin.gear import TwinGear


class TwinModel(Protocol):
    """Moves a gear through time; angles count turns, and are those of the kinematics."""

    gear: TwinGear  # the gear, which may be replaced at any time by one with the same mechanism
    rotor_angle: float  # rotor angle φ2, rad
    rotor_velocity: float  # velocity of the rotor, rad/s
    output_angle: float  # angle φ5 of the output shaft, rad
    output_velocity: float  # velocity of the output shaft, rad/s
    output_locked: bool  # whether the output shaft is locked
    rotor_locked: bool  # whether the rotor is locked
    notice: str  # how the motion has differed from that of the gear since this was cleared; or ''

    @property
    def branch_torques(self) -> tuple[float, ...]:
        """Torque T_k of each branch on the output shaft, N·m; 0 out of mesh."""

    def advance(self, duration: float, rotor_torque: float, load_torque: float) -> None:
        """Advance by a time, s, with torques of the motor and on the output shaft, N·m."""
