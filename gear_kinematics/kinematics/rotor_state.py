# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Both directions through a gear of ratio i, without losses or elasticity.

================  ===========  ============  ============
direction         effort       velocity      position
================  ===========  ============  ============
rotor to output   τ5 = i τ2    ω5 = ω2 / i   φ5 = φ2 / i
output to rotor   τ2 = τ5 / i  ω2 = i ω5     φ2 = i φ5
================  ===========  ============  ============

The driver of a rotor with direction d = ±1 has zero + d φ2, d ω2 and d τ2: a SimpleTransmission of
ROS's transmission_interface with the reduction d i and the joint offset -zero / (d i).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.mechanism import Gear
from gear_kinematics.kinematics.rotor_turns import TURN, nearest_turn, split_turns


class RotorState(NamedTuple):
    """State of a rotor as its driver gives it, in floats or arrays."""

    turns: Any
    angle: Any  # rad, in [-π, π], beyond the turns
    velocity: Any
    effort: Any

    @property
    def position(self) -> Any:
        """2π turns + angle, rad, rounded."""
        return TURN * self.turns + self.angle


def rotor_state_for(
    gear: Gear, angle: Any, velocity: Any = None, effort: Any = None, *,
    turns: Any = 0, direction: int = 1, zero: float = 0.0,
) -> RotorState:  # fmt: skip
    """Find the state of the rotor from that of the output: φ5 in rad, ω5, τ5; floats or arrays.

    `turns`, shaped like `angle`, are added to it; those of the rotor are exact up to 2^52.
    `direction` and `zero` (rad) are the node's `rotor_direction` and `rotor_zero`.

    Raises:
        ValueError: if a float angle is beyond ±`LARGEST_ANGLE` or not finite; arrays give NaN.
    """
    xp = np if isinstance(angle, np.ndarray) else math
    whole, rest = split_turns(angle)
    whole, rest = GearRatio(1 / gear.gear_ratio).output_angle(turns + whole, rest, xp)
    zero_turns, zero_rest = split_turns(zero)
    whole, rest = nearest_turn(direction * whole, direction * rest + zero_rest, xp)
    i = direction * float(gear.gear_ratio)
    velocity = None if velocity is None else i * velocity
    effort = None if effort is None else effort / i
    return RotorState(whole + zero_turns, rest, velocity, effort)
