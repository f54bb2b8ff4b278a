# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Both directions through a gear of ratio i, without losses or elasticity.

================  ===========  ============  ============
direction         effort       velocity      position
================  ===========  ============  ============
rotor to output   τ5 = i τ2    ω5 = ω2 / i   φ5 = φ2 / i
output to rotor   τ2 = τ5 / i  ω2 = i ω5     φ2 = i φ5
================  ===========  ============  ============

A driver of direction d = ±1 has zero + d φ2, d ω2 and d τ2: a SimpleTransmission of ROS's
transmission_interface with the reduction d i and the joint offset -zero / (d i).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.mechanism import Gear
from gear_kinematics.kinematics.rotor_turns import TURN, lists_as_arrays, split_turns


class RotorState(NamedTuple):
    """State of a rotor, in floats or arrays."""

    turns: Any
    angle: Any  #: rad, in [-π, π], beyond the turns
    velocity: Any
    effort: Any

    @property
    def position(self) -> Any:
        """2π turns + angle, rad, rounded."""
        return TURN * self.turns + self.angle


def rotor_state_for(
    gear: Gear, angle: Any, velocity: Any = None, effort: Any = None, *, turns: Any = 0
) -> RotorState:
    """Find the state of the rotor from that of the output: φ5 (rad), ω5, τ5, numbers or arrays.

    `turns`, shaped like `angle`, are added to it; those of the rotor are exact up to 2^52.

    Raises:
        ValueError: if a float angle is beyond ±`LARGEST_ANGLE` or not finite; arrays give NaN.
    """
    angle, velocity, effort, turns = map(lists_as_arrays, (angle, velocity, effort, turns))
    whole, rest = split_turns(angle)
    xp, i = np if isinstance(angle, np.ndarray) else math, float(gear.gear_ratio)
    position = GearRatio(1 / gear.gear_ratio).output_angle(turns + whole, rest, xp)
    velocity = None if velocity is None else i * velocity
    effort = None if effort is None else effort / i
    return RotorState(*position, velocity, effort)
