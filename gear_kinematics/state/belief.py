# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Verdicts on the readings of an encoder, and on velocities."""

from enum import Enum, StrEnum


class Belief(Enum):
    """The verdict on a reading."""

    BELIEVED = 'believed'
    IMPLAUSIBLE = 'implausible'
    JUMP = 'jump'


BELIEVED = Belief.BELIEVED  # an attribute of an enum is slow for what each message takes


class VelocityMeaning(StrEnum):
    """The content of a field with velocities."""

    UNDECIDED = ''
    RIGHT = 'rad/s'
    ZERO = '0'
    RPM = 'rpm'
    TURNS = 'turns/s'
    DEGREES = 'deg/s'
    OUTPUT = 'the velocity of the output'
    OPPOSITE = 'the velocity with the opposite sign'
    OF_TURNS = 'rad/s, and the positions turns'
    OF_DEGREES = 'rad/s, and the positions degrees'
    OF_OUTPUT = 'those of the rotor, and the positions those of the output'
    STUCK = 'stuck at one value'
    UNKNOWN = 'an unknown quantity'
