# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The rotor's motion over time: recorded, or at a constant speed."""

import math
from typing import NamedTuple, Self

import numpy as np

from gear_kinematics.kinematics import Mechanism, MotionState, solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.wire.batches import Array

MOST_TURNS = 1000  #: rotor turns at a constant speed; animations cannot show more
_PER_TURN = 360  # samples
_ROUNDING = 1e-9  # relative excess by which the last interval may pass the end


class Trajectory(NamedTuple):
    """The rotor angle φ2 over time; arrays (n,)."""

    time: Array  #: time from the start, s, ascending
    turns: Array  #: whole turns of the rotor
    angle: Array  #: angle beyond the turns, rad: φ2 is 2π turns + angle
    velocity: Array  #: rate of φ2, rad/s
    referenced: bool = True  #: whether the number of turns is known

    @classmethod
    def at_constant_speed(cls, speed: float, turns: int) -> Self:
        """Create a motion from φ2 = 0 on at a speed, rad/s, sampled for smooth curves.

        Raises ValueError if there are more turns of the rotor than `MOST_TURNS`.
        """
        if turns > MOST_TURNS:
            raise ValueError(f'{turns} turns of the rotor are more than {MOST_TURNS}')
        time = np.linspace(0.0, turns * TURN / abs(speed), _PER_TURN * turns + 1)
        return cls(time, *split_turns(speed * time), np.full(len(time), speed))

    def state(self, mechanism: Mechanism) -> MotionState:
        """Compute the motion of all bodies, (n, ...)."""
        with np.errstate(over='ignore'):  # of accelerations, which no plot shows
            return solve(mechanism, self.angle, self.velocity, rotor_turns=self.turns)

    def between(self, start: float, end: float) -> Self:
        """Select the samples between two times, s; ValueError if there are none."""
        inside = (self.time >= start) & (self.time <= end)
        if not inside.any():
            until = 'on' if end == np.inf else f'to {end:g} s'
            there = f'they are from 0 s to {self.time[-1]:g} s'
            raise ValueError(f'no rotor states from {start:g} s {until}; {there}')
        time, turns, angle, velocity = (column[inside] for column in self[:4])
        return type(self)(time, turns, angle, velocity, self.referenced)

    def every(self, interval: float, *, closed: bool = False) -> Self:
        """Interpolate at even intervals, s.

        A `closed` motion is periodic: the intervals divide its duration, and its end is left out.
        """
        duration = self.time[-1] - self.time[0]
        if closed:
            count = max(1, round(duration / interval))
            interval = duration / count
        else:
            count = math.floor(duration / interval * (1.0 + _ROUNDING)) + 1
        time = self.time[0] + interval * np.arange(count)
        position = np.interp(time, self.time, self.turns * TURN + self.angle)
        turns, angle = split_turns(position)
        return type(self)(time, turns, angle, np.interp(time, self.time, self.velocity))
