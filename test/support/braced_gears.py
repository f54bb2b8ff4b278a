# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Gears whose two branches are braced against each other; nothing of the package is used.

Each branch is a spring that only pushes. The torque over the angle is summed up and inverted by
interpolation; friction holds the load back as a dead band.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BracedGear:
    """A gear whose preload grows with its setting."""

    push: float = 320.0  # N·m/rad, of the branch that resists positive torque
    pull: float = 280.0  # N·m/rad, of the other one
    backlash: float = 0.012  # rad, at the setting 0
    closing: float = 0.005  # rad of backlash per unit of the setting
    friction: float = 0.8  # N·m
    rubbing: float = 0.05  # N·m of friction per N·m of preload

    def squeeze(self, setting: float) -> float:
        """Twist of both branches by the preload, rad; negative: play."""
        return self.closing * setting - self.backlash

    def preload(self, setting: float) -> float:
        """N·m in both branches."""
        return max(self.squeeze(setting), 0.0) * self.push * self.pull / (self.push + self.pull)

    def drag(self, setting: float) -> float:
        """Friction, N·m."""
        return self.friction + self.rubbing * self.preload(setting)

    def least(self, load: float) -> float:
        """Setting from which on both branches push under a load of either sign, by bisection."""
        low, high = 0.0, self.backlash / self.closing + 100.0
        for _ in range(100):
            middle = 0.5 * (low + high)
            if self._both_push(middle, load) and self._both_push(middle, -load):
                high = middle
            else:
                low = middle
        return high

    def _both_push(self, setting: float, load: float) -> bool:
        squeeze, angle = self.squeeze(setting), self.turn(np.array([load]), setting)[0]
        ahead = squeeze * self.pull / (self.push + self.pull)
        return angle + ahead > 0.0 and squeeze - ahead - angle > 0.0

    def turn(self, load: np.ndarray, setting: float) -> np.ndarray:
        """Angle of the output under loads, rad."""
        squeeze = self.squeeze(setting)
        ahead = squeeze * (self.pull / (self.push + self.pull) if squeeze > 0.0 else 0.5)
        reach = 2.0 * np.abs(load).max() / min(self.push, self.pull) + abs(squeeze)
        angle = np.linspace(-reach, reach, 20_001)
        push = self.push * np.maximum(angle + ahead, 0.0)
        pull = self.pull * np.maximum(squeeze - ahead - angle, 0.0)
        torque = push - pull + 1e-9 * angle  # in the play, any angle is as good
        return np.interp(load, torque, angle)

    def angles(self, torque: np.ndarray, setting: float) -> np.ndarray:
        """Angles while the torque changes slowly, rad."""
        load, drag = np.empty_like(torque), self.drag(setting)
        carried = 0.0
        for row, value in enumerate(torque):
            carried = min(max(carried, value - drag), value + drag)
            load[row] = carried
        return self.turn(load, setting)
