# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Kinematics of the anti-backlash planetary gear: numpy and the standard library, no ROS."""

from gear_kinematics.kinematics.errors import MechanismError
from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.mechanism import Branch, Gear, Mechanism
from gear_kinematics.kinematics.motion import MotionState, solve
from gear_kinematics.kinematics.rotor_state import RotorState, rotor_state_for
from gear_kinematics.kinematics.rotor_turns import (
    RotorPosition,
    RotorSample,
    RotorTurns,
    split_turns,
)

__all__ = [
    'Branch',
    'Gear',
    'GearRatio',
    'Mechanism',
    'MechanismError',
    'MotionState',
    'RotorPosition',
    'RotorSample',
    'RotorState',
    'RotorTurns',
    'rotor_state_for',
    'solve',
    'split_turns',
]
