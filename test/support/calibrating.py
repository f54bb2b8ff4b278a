# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Calibrations of simulated gears, judged on a recording that was not used."""

from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from gear_recordings import encoders
from simulated_gear import GearSet, Simulated, gears, simulate, strokes

from gear_kinematics.correction.corrector import Corrector
from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.measurement.calibration import Fit, fit
from gear_kinematics.measurement.recording import Recording

LIMITED = GearSet(
    1, rotor_errors=(2e-3, 1e-3, 5e-4), output_error=2.5e-3, satellite_error=0.0, tooth_error=0.0,
    backlash=1.5e-3, load=0.0, white_noise=2e-4, coloured_noise=2e-4,
)  # fmt: skip
"""A geared joint that turns less than once."""
COUNTS = 2**24
"""A turn of encoders whose steps do not matter."""
MECHANISM = Mechanism(80, 76, 0.0011, (Branch('a'),))
IN_CLASS = {
    'usual': GearSet(1),
    'late stamps': GearSet(1, delay=2e-3),
    'noisy': GearSet(1, white_noise=5e-4, coloured_noise=3e-4),
    'coloured noise': GearSet(1, white_noise=5e-5, coloured_noise=3e-4, colour_time=0.5),
    'drift': GearSet(1, drift=3e-4),
    'coarse encoders': GearSet(1, rotor_counts=2**10, output_counts=2**13),
    'no load': GearSet(1, load=0.0),
    'play': GearSet(1, backlash=3e-3, wind_up=0.0),
    'friction': GearSet(1, backlash=0.0, wind_up=1.5e-3, bristle_travel=2e-2),
}
"""Scenarios that the model can describe."""
OUT_OF_CLASS = {
    'creep': GearSet(1, creep=0.1, compliance=1e-4),
    'friction grows with load': GearSet(1, load_friction=0.5, wind_up=1e-3, backlash=0.0),
}
"""Scenarios that it cannot describe."""
HARD_WHEN_SLOW = ('late stamps', 'coloured noise', 'drift')
"""Scenarios in which few strokes tell less."""
MOTIONS = {'fast': strokes, 'slow': partial(strokes, reach=14.0, speed=2.0, ends=())}


class Judged(NamedTuple):
    """What a calibration is worth on a recording that was not used."""

    relative_rms: float
    """The rms of the corrected error, over that of what no calibration can predict."""
    coverage: float
    """Share of samples within the interval."""
    fit: Fit


def recorded(simulated: Simulated, gear: int, *, timed: bool = True) -> Recording:
    """What the encoders of one gear read."""
    stamp = np.round(simulated.time * 1e9).astype(np.int64) if timed else None
    angles = (
        np.ascontiguousarray(of[:, gear])
        for of in (simulated.rotor, simulated.measured, simulated.effort)
    )
    rotor, measured, effort = angles
    both = encoders(rotor, measured, stamp, COUNTS, COUNTS)
    both = replace(both, rotor=both.rotor._replace(effort=effort))
    path = Path(__file__)  # of no importance but for its hash
    return Recording(path, f'gear {gear}', (), len(rotor), both)


def halves(simulated: Simulated) -> tuple[Simulated, Simulated]:
    """Divide a recording in the middle of its time."""
    half = len(simulated.time) // 2
    first, second = (
        simulated._replace(
            **{name: getattr(simulated, name)[part] for name in Simulated._fields[:-1]}
        )
        for part in (slice(half), slice(half, None))
    )
    return first, second._replace(time=second.time - second.time[0])


def judge(result: Fit, simulated: Simulated, gear: int) -> Judged:
    """Correct another recording as the node does."""
    rotor = recorded(simulated, gear).both.rotor
    count = len(rotor.stamp)
    correction = Corrector(result.calibration).correct_batch(
        rotor.stamp, rotor.turns, rotor.angle, np.full(count, np.nan), rotor.effort,
        np.zeros(count, int),
    )  # fmt: skip
    ideal = simulated.rotor[:, gear] / float(result.calibration.gear_ratio)
    error = simulated.undelayed[:, gear] - ideal - correction.deviation
    error -= error.mean()
    return Judged(
        float(error.std() / simulated.noise[gear]),
        float(np.mean(np.abs(error) <= correction.half_width)),
        result,
    )


def judged(
    setting: GearSet, count: int, duration: float = 60.0, motion: str = 'fast', seed: int = 7
) -> list[Judged]:
    """Calibrate gears from one recording each, and judge each on another one."""
    random = np.random.default_rng(seed)
    setting = replace(setting, seeds=count)
    gear = gears(setting, random)

    def again() -> Simulated:
        motions = [MOTIONS[motion](duration, random) for _ in range(count)]
        return simulate(setting, gear, np.stack(motions, axis=1), random)

    first, second = again(), again()
    return [
        judge(fit([recorded(first, k)], Fraction(-19), MECHANISM), second, k) for k in range(count)
    ]
