# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Verdicts on the readings of an encoder, and on velocities."""

import math
from collections.abc import Mapping
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


def velocity_factors(output_factor: float) -> Mapping[VelocityMeaning, float]:
    """Return by what the velocities of the rotor are multiplied in a field of each known meaning.

    The velocity of the output is the rotor's times the `output_factor`.
    """
    return {
        VelocityMeaning.ZERO: 0.0,
        VelocityMeaning.RPM: 30.0 / math.pi,
        VelocityMeaning.TURNS: 0.5 / math.pi,
        VelocityMeaning.DEGREES: 180.0 / math.pi,
        VelocityMeaning.OUTPUT: output_factor,
        VelocityMeaning.OPPOSITE: -1.0,
        VelocityMeaning.OF_TURNS: 2.0 * math.pi,
        VelocityMeaning.OF_DEGREES: math.pi / 180.0,
        VelocityMeaning.OF_OUTPUT: 1.0 / output_factor,
    }
