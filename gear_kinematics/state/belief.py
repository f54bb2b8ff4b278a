# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Verdicts on the readings of an encoder."""

from enum import Enum


class Belief(Enum):
    """The verdict on a reading."""

    BELIEVED = 'believed'
    IMPLAUSIBLE = 'implausible'
    JUMP = 'jump'


BELIEVED = Belief.BELIEVED  # an attribute of an enum is slow for what each message takes
