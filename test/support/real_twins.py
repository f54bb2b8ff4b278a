# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Loops of real gears, and those of their twins, whose figures `gearkin lost-motion` measured.

The real gears had their output locked, and were loaded by their motors. The twin has its rotor
locked, as its friction acts on the output. Wind-ups are compared at equal torques of the gear. The
zero of an encoder is arbitrary: the mean of each difference is taken out.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.answer import Limits
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.document import document
from gear_kinematics.measurement.loops import Loop, Ramps
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.json import to_json
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.measured import measured
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.twin.parameters import TwinParameters

PRINTED = 'dual_encoders/transmission_stiffness_sspg.csv'
READ_PRINTED = {'ratio': '36/5', 'on_rotor': True}
_INNER = 0.97  # of the amplitude: what all loops reach
_STEPS = 400  # of 2 ms, from peak to peak


class Loops(NamedTuple):
    """Wind-ups, rad, at torques that rise and then fall."""

    torque: np.ndarray
    """(2 n,), N·m."""
    recorded: np.ndarray
    """(loops, 2 n); NaN where not recorded."""
    simulated: np.ndarray
    """(2 n,)."""

    @property
    def image(self) -> np.ndarray:
        """The first recorded loop, turned about its centre."""
        return -np.roll(self.recorded[0], len(self.torque) // 2)

    @property
    def scatter(self) -> float:
        """rad, rms: one loop less another; of a single one, less its image."""
        loops = self.recorded if len(self.recorded) > 1 else (*self.recorded, self.image)
        return _rms([one - other for one, other in combinations(loops, 2)])

    @property
    def off(self) -> float:
        """rad, rms: the simulated loop less the recorded ones."""
        return _rms(self.simulated - self.recorded)


def _rms(differences: Sequence[np.ndarray]) -> float:
    return float(np.sqrt(np.mean(np.nanvar(differences, axis=1))))


def real_gear(
    recording: Path, report: Path, ratio: str = '-19', *, on_rotor: bool = False
) -> tuple[TwinGear, tuple[Ramps, ...]]:
    """Make the twin of a recorded gear, by a report of its own, and find its recorded ramps."""
    config = replace(NodeParameters.load(), gear_ratio=ratio)
    found = measure(read(recording, config, Sources(on_rotor=on_rotor)), config)
    report.write_text(to_json(document([found], None, Limits())), 'utf-8')
    gear = TwinGear.of(
        NodeParameters.of(
            {'branches': ['a'], 'loads.rotor_inertia': 1e-5, 'branch_stiffness': [1e3]}
        ),
        TwinParameters.of(
            {'play': 0.0, 'friction': 0.0, 'rotor_damping': 0.0, 'output_inertia': 2e-4}
        ),
    )
    gear, notes = measured(gear, [report])
    assert notes == []
    return gear, found.figures.ramps


def loops(gear: TwinGear, ramps: Ramps) -> Loops:
    """Simulate recorded ramps."""
    torque = _INNER * ramps.amplitude * np.linspace(-1.0, 1.0, _STEPS + 1)
    falls, rises = zip(*ramps.loops, strict=True)
    high, low = (float(np.mean([half.start for half in ways])) for ways in (falls, rises))
    fall, rise = ramped(FastModel(gear), high, low)
    return Loops(
        np.concatenate([torque, torque[::-1]]),
        np.array([_wind_ups(loop, torque) for loop in ramps.loops]),
        np.concatenate([np.interp(torque, *rise), np.interp(torque[::-1], *fall[:, ::-1])]),
    )


def ramped(model: TwinModel, high: float, low: float) -> tuple[np.ndarray, np.ndarray]:
    """Torque of the gear and its wind-up, (2, n), from peak to peak and back."""
    model.rotor_locked = True
    ways = []
    for begin, end in pairwise((0.0, high, low, high)):
        steps = round(_STEPS * abs(end - begin) / (high - low))
        torques = np.linspace(begin, end, steps + 1)
        wind_ups = []
        for torque in torques.tolist():
            model.advance(2e-3, 0.0, -torque)
            wind_ups.append(-model.output_angle)
        ways.append(np.array([torques, wind_ups]))
    _, fall, rise = ways
    return fall, rise


def _wind_ups(loop: Loop, torque: np.ndarray) -> np.ndarray:
    """Give the wind-up of both ways, (2 n,), from the middle of the fall."""
    centre = 0.5 * (loop.fall.angle[0] + loop.fall.angle[-1])
    ways = (loop.rise, torque), (loop.fall, torque[::-1])
    return np.concatenate(
        [
            np.where([*map(half.reaches, torques)], half.angle_at(torques) - centre, np.nan)
            for half, torques in ways
        ]
    )
