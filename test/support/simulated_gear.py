# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A gear with both encoders, stepped through time; nothing of the package under test is used.

The backlash is followed by its contact (M. Nordin, P.-O. Gutman, Automatica 38 (2002) 1633): the
output stands still in the gap, held by friction, and moves with the flank that pushes it. The
wind-up by friction is P. Dahl's bristle (The Aerospace Corporation, TOR-158, 1968), a differential
equation over the travel. All gears of a set step together: arrays are (time, gears).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple

import numpy as np

RATE = 1000.0  # Hz


@dataclass(frozen=True)
class GearSet:
    """Gears that differ in their random errors; angles in rad at the output."""

    seeds: int
    ratio: float = -19.0
    ring_teeth: int = 80
    rotor_errors: tuple[float, ...] = (1e-3, 1e-3 / 3.0)
    """Amplitudes of the first, second ... order of the rotor."""
    output_error: float = 1.5e-3
    satellite_error: float = 5e-4
    tooth_error: float = 2e-4
    backlash: float = 1.2e-3
    """Between the flanks."""
    wind_up: float = 4e-4
    """By friction, when all bristles slide."""
    bristle_travel: float = 3e-3
    """After a reversal, in which the wind-up turns to 1 - 2/e of its new value."""
    compliance: float = 5e-5
    """rad/(N·m)."""
    load: float = 10.0
    """N·m, of a weight on an arm."""
    creep: float = 0.0
    """Share of the wind-up that comes late."""
    creep_time: float = 5.0
    load_friction: float = 0.0
    """Relative growth of the wind-up by friction at the full load."""
    white_noise: float = 1e-4
    coloured_noise: float = 1e-4
    colour_time: float = 0.1
    drift: float = 0.0
    """Standard deviation of the random walk over 100 s."""
    rotor_counts: int = 2**14
    output_counts: int = 2**17
    delay: float = 0.0
    """s, of the output's stamps."""
    effort_noise: float = 0.02


class Simulated(NamedTuple):
    """Recordings of a set of gears, (time, gears) unless said otherwise."""

    time: np.ndarray
    """(time,), s."""
    rotor: np.ndarray
    """What its encoder reads."""
    effort: np.ndarray
    output: np.ndarray
    """The true angle."""
    measured: np.ndarray
    """What the output's encoder reads, with the delay."""
    undelayed: np.ndarray
    """What the output's encoder would read without the delay."""
    noise: np.ndarray
    """(gears,): rms about its mean of what no calibration can predict."""


def strokes(
    duration: float,
    random: np.random.Generator,
    reach: float = 9.0,
    speed: float = 4.0,
    ends: Sequence[float] = (0.95, -0.95),
) -> np.ndarray:
    """Motion of the output, (time,), rad: strokes at random speeds, with pauses.

    The first ones go to the ends, which are shares of the reach, the others end anywhere.
    """
    goals = [reach * end for end in reversed(ends)]
    count = int(duration * RATE)
    velocity, position = [], 0.0
    while len(velocity) < count:
        goal = goals.pop() if goals else random.uniform(-reach, reach)
        top = random.uniform(0.2, 1.0) * speed
        ramp = int(0.2 * RATE)
        cruise = max(0, int(abs(goal - position) / top * RATE) - ramp)
        shape = np.concatenate([np.linspace(0, 1, ramp), np.ones(cruise), np.linspace(1, 0, ramp)])
        velocity += (np.sign(goal - position) * top * shape).tolist()
        velocity += [0.0] * int(random.uniform(0.0, 0.3) * RATE)
        position = goal
    return np.cumsum(velocity[:count]) / RATE


def wandering(duration: float, random: np.random.Generator) -> np.ndarray:
    """Smooth random motion of the output from -1.2 rad to 1.2 rad, at most, (time,).

    Within 1 s nothing changes much; the duration is in s.
    """
    count = int(duration * RATE)
    frequencies = np.fft.rfftfreq(count, 1.0 / RATE)
    spectrum = random.standard_normal(len(frequencies)) + 1j * random.standard_normal(
        len(frequencies)
    )
    motion = np.fft.irfft(spectrum * np.exp(-((frequencies * np.pi) ** 2)), count)
    return 1.2 * motion / np.abs(motion).max()


def gears(setting: GearSet, random: np.random.Generator) -> dict[str, np.ndarray]:
    """The random properties of each gear: amplitudes and phases."""
    count = 3 + len(setting.rotor_errors)
    amplitude = random.uniform(0.5, 1.5, (count, setting.seeds))
    phase = random.uniform(-np.pi, np.pi, (count, setting.seeds))
    return {'amplitude': amplitude, 'phase': phase}


def simulate(
    setting: GearSet, gear: dict[str, np.ndarray], motion: np.ndarray, random: np.random.Generator
) -> Simulated:
    """Record gears along a motion of the rotor, given as output angle (time,) or (time, gears)."""
    s = setting
    shape = len(motion), s.seeds
    ideal = np.broadcast_to(motion.reshape(len(motion), -1), shape)
    rotor = ideal * s.ratio
    time = np.arange(len(motion)) / RATE
    torque = s.load * np.sin(ideal)
    growth = s.load_friction if s.load else 0.0
    lost = _lost_motion(
        ideal.tobytes(), s.seeds, 0.5 * s.backlash, s.wind_up, growth, s.bristle_travel
    )
    twist = s.compliance * torque
    if s.creep:
        twist = twist + s.creep * _late(twist, s.creep_time)
    cam = abs(s.ratio)
    amplitude, phase = gear['amplitude'], gear['phase']
    errors = (
        *((size, multiple) for multiple, size in enumerate(s.rotor_errors, 1)),
        (s.output_error, 1.0 / cam),
        (s.satellite_error, 1.0 + 1.0 / cam),
        (s.tooth_error, float(s.ring_teeth)),
    )
    output = ideal + lost - twist
    for k, (size, cycles) in enumerate(errors):
        output = output + size * amplitude[k] * np.sin(cycles * rotor + phase[k])
    noise = s.white_noise * random.standard_normal(shape)
    noise += s.coloured_noise * _coloured(shape, s.colour_time, random)
    walk = np.cumsum(random.standard_normal(shape), axis=0)
    noise += s.drift * walk / np.sqrt(100.0 * RATE)
    zero = random.uniform(-np.pi, np.pi, s.seeds)
    rotor_step, output_step = 2 * np.pi / s.rotor_counts, 2 * np.pi / s.output_counts

    def read(angle: np.ndarray) -> np.ndarray:
        return np.round((angle + zero + noise) / output_step) * output_step

    late = (
        np.stack([np.interp(time - s.delay, time, column) for column in output.T], axis=1)
        if s.delay
        else output
    )
    read_rotor = np.round(rotor / rotor_step) * rotor_step
    unpredictable = read(output) - output - (read_rotor - rotor) / s.ratio
    effort = torque / s.ratio + s.effort_noise * random.standard_normal(shape)
    return Simulated(
        time, read_rotor, effort, output, read(late), read(output), unpredictable.std(axis=0)
    )


@lru_cache(maxsize=10)
def _lost_motion(
    motion: bytes, seeds: int, half: float, wind_up: float, growth: float, travel: float
) -> np.ndarray:
    """Output less input: by the backlash, and by the bristles' wind-up.

    Sets of gears that differ in other things share it: one seed moves all of them in the same way.

    Args:
        motion: ideal angle, (time, gears).
        seeds: number of gears.
        half: of the backlash.
        wind_up: when all bristles slide, without a load.
        growth: relative, under the full load.
        travel: of the bristles.
    """
    ideal = np.frombuffer(motion).reshape(-1, seeds)
    tops = wind_up * (1.0 + growth * np.abs(np.sin(ideal)))
    lost = np.zeros(ideal.shape)
    for number in range(seeds):
        gap = bristle = 0.0  # gap: input less output, in ±half
        steps, column = np.diff(ideal[:, number]).tolist(), []
        for step, top in zip(steps, tops[1:, number].tolist(), strict=True):
            gap += step
            if not -half <= gap <= half:  # the flank takes the output along
                pushing, gap = gap, half if gap > 0.0 else -half
                moved = pushing - gap
                # d bristle/d travel = (top · direction - bristle)/length, solved over the step
                share = -math.expm1(-abs(moved) / travel)
                bristle += ((top if moved > 0.0 else -top) - bristle) * share
            column.append(-gap - bristle)
        lost[1:, number] = column
    lost.flags.writeable = False
    return lost


def _late(values: np.ndarray, time: float) -> np.ndarray:
    """A lag of first order."""
    late = np.zeros_like(values)
    share = 1.0 / (time * RATE)
    for k in range(1, len(values)):
        late[k] = late[k - 1] + share * (values[k] - late[k - 1])
    return late


def _coloured(shape: tuple[int, int], time: float, random: np.random.Generator) -> np.ndarray:
    """Noise of first order with standard deviation 1."""
    keep = math.exp(-1.0 / (time * RATE))
    values = random.standard_normal(shape)
    values[1:] *= math.sqrt(1.0 - keep * keep)
    # Of single numbers, which take a tenth of the time of rows with one number for each gear.
    columns = values.T.tolist()
    return np.array(
        [[*accumulate(column, lambda before, new: keep * before + new)] for column in columns]
    ).T
