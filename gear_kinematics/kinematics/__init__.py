"""Kinematics of the anti-backlash planetary gear: numpy and the standard library, no ROS."""

from gear_kinematics.kinematics.errors import MechanismError
from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.mechanism import Branch, Gear, Mechanism, gear_from_mapping
from gear_kinematics.kinematics.motion import MotionState, solve
from gear_kinematics.kinematics.rotor_turns import RotorPosition, RotorTurns, split_turns

__all__ = [
    'Branch',
    'Gear',
    'GearRatio',
    'Mechanism',
    'MechanismError',
    'MotionState',
    'RotorPosition',
    'RotorTurns',
    'gear_from_mapping',
    'solve',
    'split_turns',
]
