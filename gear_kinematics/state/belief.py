# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Verdicts on the readings of an encoder."""

from enum import Enum
from typing import NamedTuple


class Belief(Enum):
    """The verdict on a reading."""

    BELIEVED = 'believed'
    IMPLAUSIBLE = 'implausible'
    JUMP = 'jump'


BELIEVED = Belief.BELIEVED  # an attribute of an enum is slow for what each message takes


class Jump(NamedTuple):
    """A step of the readings that the rotor did not make."""

    stamp: int  # ns, of the first reading behind it
    size: float  # rad, as far as it was not expected; of a single-turn encoder, within its range
