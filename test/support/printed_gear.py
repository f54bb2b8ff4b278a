# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""COMPAct's printed gear and its twin: the recorded loop, and the one that is simulated.

`gearkin lost-motion` has hysteresis and stiffnesses of a single loop, but not the friction, nor
the curve of the spring. Both are taken from the middle line here, for which the loop is completed
by its own image: a gear that is alike in both directions would fall as it rises.
"""

import math
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.csv_files import Sources
from gear_kinematics.measurement.loops import Loop, find_ramps
from gear_kinematics.measurement.middle_line import MiddleLine
from gear_kinematics.measurement.reading import read
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear

RECORDING = 'dual_encoders/transmission_stiffness_sspg.csv'
_RATIO = '36/5'
_POINTS = 11  # of the curve of the spring
_TORQUES = np.linspace(-19.9, 19.9, 797)  # N·m, at which loops are compared


class Loops(NamedTuple):
    """Torque, N·m, and angles from the centre of the recorded loop, rad, (n,) each."""

    torque: np.ndarray
    recorded: np.ndarray
    simulated: np.ndarray
    curve: np.ndarray
    """(2, points): angle and load of the spring of the twin."""
    friction: float
    """N·m, of the twin."""

    @property
    def scatter(self) -> float:
        """rad, rms: the recorded way up less the way down, turned about the centre of the loop."""
        return float(np.sqrt(np.mean(self._asymmetry**2)))

    @property
    def scatter_once_loaded(self) -> float:
        """The same from -20 N·m to 0, without the first loading from an unknown rest."""
        return float(np.sqrt(np.mean(self._asymmetry[_TORQUES <= 0.0] ** 2)))

    @property
    def _asymmetry(self) -> np.ndarray:
        up, down = self._ways(self.recorded)
        return up + down[::-1]

    @property
    def off(self) -> float:
        """rad, rms: the simulated loop less the recorded one, at equal torques."""
        ways = zip(self._ways(self.simulated), self._ways(self.recorded), strict=True)
        return float(np.sqrt(np.mean([(ours - theirs) ** 2 for ours, theirs in ways])))

    def _ways(self, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Angles at `_TORQUES`: up, of the first ramp from 0 on, and down."""
        top, bottom = int(np.argmax(self.torque)), int(np.argmin(self.torque))
        parts = slice(top + 1), slice(top, bottom + 1), slice(bottom, None)
        first, down, last = (
            np.interp(
                _TORQUES,
                *(each[part][:: -1 if part.start == top else 1] for each in (self.torque, angle)),
            )
            for part in parts
        )
        return np.where(_TORQUES > 0.0, first, last), down


def loops(recording: Path) -> Loops:
    """Simulate the recorded ramp with a gear that has the middle line of its loop."""
    parameters = replace(NodeParameters.load(), gear_ratio=_RATIO)
    recorded = read(recording, parameters, Sources(on_rotor=True)).loading(
        parameters.gear.gear_ratio
    )
    [ramps] = find_ramps(recorded.torque, recorded.angle)
    [loop] = ramps.loops
    centre = 0.5 * (loop.fall.angle[0] + loop.fall.angle[-1])
    image = replace(loop.fall, torque=-loop.fall.torque, angle=2.0 * centre - loop.fall.angle)
    line = MiddleLine.of(Loop(loop.fall, image))
    angle = np.linspace(0.0, line.angle[-1] - centre, _POINTS)
    load = np.interp(angle, line.angle - centre, line.load)
    load[0] = 0.0
    friction = float(np.mean(line.friction))
    slopes = np.diff(load) / np.diff(angle)
    gear = TwinGear(
        parameters=replace(parameters, loads=replace(parameters.loads, rotor_inertia=1e-5)),
        stiffness=tuple(np.diff(slopes, prepend=0.0).tolist()),
        shaft_stiffness=math.inf,
        interference=0.0,
        play=0.0,
        friction=friction,
        output_inertia=1e-3,
    )
    # A bent spring is many branches that touch one after another.
    object.__setattr__(gear, 'dead_bands', tuple((-each, each) for each in angle[:-1].tolist()))
    return Loops(
        recorded.torque,
        recorded.angle - centre,
        _ramped(gear, recorded.torque),
        np.array([angle, load]),
        friction,
    )


def _ramped(gear: TwinGear, torque: np.ndarray) -> np.ndarray:
    """Ramp the torque once more than recorded, as the gear was not at rest in its middle."""
    model, angles = FastModel(gear), []
    model.rotor_locked = True
    for applied in [*torque, *torque]:
        model.advance(5e-3, 0.0, float(applied))
        angles.append(model.output_angle)
    return np.array(angles[len(torque) :])
