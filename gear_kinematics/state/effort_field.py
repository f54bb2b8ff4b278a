# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges whether the efforts in a driver's messages can be torques of the rotor, N·m."""

import math

import numpy as np

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.wire.batches import Array

_MOTION = 0.05  # rad: noise of any encoder; beyond, the rotor has moved
_MOTOR = 100.0  # N·m: motors of more weigh 10 kg and above, as those of vehicles
_SHEAR = 5e8  # Pa: where shafts of hardened steel yield


class EffortField:
    """Finds meaningless efforts: an effort of 0 throughout a motion was not measured."""

    def __init__(self) -> None:
        self.real = False  # whether one was not 0: from then on, 0 is a torque
        self._most = 0.0  # N·m: the greatest torque that was noted
        self._least, self._greatest = math.inf, -math.inf  # rad: positions with an effort of 0

    @property
    def absent(self) -> bool:
        """Whether the effort was 0 throughout a motion."""
        return not self.real and self._greatest - self._least > _MOTION

    @property
    def zeros(self) -> bool:
        """Whether there was an effort of 0 before any other."""
        return self._least <= self._greatest

    @property
    def doubt(self) -> Fact | None:
        """Why the efforts can hardly be torques, if so."""
        return Condition.EFFORT_IS_ZERO() if self.absent else questioned(self._most)

    def note(self, torques: Array) -> None:
        """Note the torques of the rotor that the efforts are, N·m, (n,), NaN for none."""
        self._most = float(np.fmax.reduce(np.abs(torques), initial=self._most))

    def believed(self, position: float, effort: float) -> float | None:
        """Take the next position, rad, and effort; returns None for an effort without meaning."""
        if effort:
            self.real = True
            return effort
        self._least, self._greatest = min(self._least, position), max(self._greatest, position)
        return None if self.absent else effort

    def all_believed(self, positions: Array, efforts: Array) -> Array:
        """Take the next positions and efforts, (n,), NaN for none, as `believed` one by one."""
        if self.real or not len(efforts):
            return efforts
        others = np.flatnonzero((efforts != 0.0) & ~np.isnan(efforts))
        zero = np.flatnonzero(efforts[: others[0] if len(others) else None] == 0.0)
        self.real = len(others) > 0
        if not len(zero):
            return efforts
        least = np.minimum.accumulate(np.append(self._least, positions[zero]))[1:]
        greatest = np.maximum.accumulate(np.append(self._greatest, positions[zero]))[1:]
        self._least, self._greatest = float(least[-1]), float(greatest[-1])
        efforts = efforts.copy()
        efforts[zero[greatest - least > _MOTION]] = np.nan
        return efforts


def questioned(effort: float, mechanism: Mechanism | None = None) -> Fact | None:
    """Question a torque of the rotor, N·m, that is implausibly large.

    A mechanism bears no more at its output than a solid steel shaft as large as a satellite.
    """
    bearable, whose = _MOTOR, 'the motor of a geared drive has'
    if mechanism:
        teeth = mechanism.satellite_teeth / (mechanism.ring_teeth - mechanism.satellite_teeth)
        radius = mechanism.eccentricity * teeth
        ratio = abs(float(mechanism.gear_ratio))
        if (most := 0.5 * math.pi * _SHEAR * radius**3 / ratio) < _MOTOR:
            bearable, whose = most, 'a mechanism of this size bears'
    if not abs(effort) > bearable:
        return None
    return Condition.EFFORT_TOO_LARGE(effort=abs(effort), whose=whose, bearable=bearable)
