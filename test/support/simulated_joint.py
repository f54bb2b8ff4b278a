# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Joints with an encoder on both sides, by the geometry of their errors: no sines of orders."""

import math
from typing import NamedTuple

import numpy as np

TURN = 2.0 * math.pi
MOTIONS = 'sweep', 'there and back', 'sine', 'jog', 'hand'


class Joint(NamedTuple):
    """Recorded columns, (n,) each."""

    rotor: np.ndarray
    output: np.ndarray
    time: np.ndarray


def moved(travel, motion, time, random):
    """Output angles of a motion, rad."""
    share, span = time / time[-1], time[-1]
    if motion == 'sweep':
        ideal = share
    elif motion == 'there and back':
        ideal = 1.0 - np.abs(2.0 * share - 1.0)
    elif motion == 'sine':
        ideal = np.sin(TURN * random.uniform(1.5, 6.5) * share + random.uniform(0.0, TURN))
    elif motion == 'jog':  # from place to place, and standstill
        places = np.concatenate([[0.0, 1.0], random.uniform(size=random.integers(5, 12))])
        ideal = np.interp(share, np.linspace(0.0, 1.0, 2 * len(places)), np.repeat(places, 2))
        width = max(3, int(0.1 * len(time) / span))
        ideal = np.convolve(np.pad(ideal, width, 'edge'), np.full(width, 1.0 / width), 'same')
        ideal = ideal[width:-width]
    else:
        walk = np.cumsum(np.cumsum(random.normal(size=len(time) // 20 + 2)))
        ideal = np.interp(np.arange(len(time)), 20.0 * np.arange(len(walk)), walk)
    return travel * (ideal - ideal.min()) / np.ptp(ideal) + random.uniform(-3.0, 3.0)


def encoder_error(angle, amplitude, kind, phase):
    """Compute the error of an eccentric disc, or of unequal, shifted signals of a magnet, rad."""
    unequal = kind == 'elliptic'
    shift = (0.5 if unequal else 1.0) * math.sin(amplitude)
    gain = (1.0 + amplitude) / (1.0 - amplitude) if unequal else 1.0
    true = angle + phase
    read = np.arctan2(gain * np.sin(true), np.cos(true) - shift)
    return np.remainder(read - true + math.pi, TURN) - math.pi


def pitch_error(angle, steps):
    """Cumulative error of teeth, a random walk that closes after a turn; its peak is 1."""
    walk = np.cumsum(steps)
    walk -= np.linspace(0.0, walk[-1], len(walk))
    walk = np.append(walk, walk[0]) - walk.mean()
    places = np.mod(angle, TURN) / TURN * len(steps)
    return np.interp(places, np.arange(len(walk)), walk / np.abs(walk).max())


def with_play(angle, play):
    """Return output angles that stay until the play is crossed, starting in its middle."""
    out, at = [], angle[0]
    for driven in angle.tolist():
        at = min(max(at, driven - 0.5 * play), driven + 0.5 * play)
        out.append(at)
    return np.array(out)


def recorded(ratio, travel, error, random, motion=None):
    """Record a joint; its errors over a turn, of gear and encoder together, are at most `error`.

    The travel and the error are in rad.
    """
    rate, seconds = float(random.choice([100, 250, 500, 1000])), random.uniform(8.0, 40.0)
    motion = motion or str(random.choice(MOTIONS))
    time = np.arange(int(rate * seconds)) / rate
    ideal = moved(travel, motion, time, random)
    rotor = float(ratio) * ideal
    output = with_play(ideal, random.uniform(0.0, 0.5) * error)
    kinds = random.choice(['eccentric', 'elliptic'], 2)
    phases = random.uniform(0.0, TURN, 4)
    teeth, sag = random.normal(size=random.integers(20, 90)), random.uniform(0.0, 0.5)
    share = random.uniform()

    def periodic(angle):  # the sag is wind-up by gravity
        encoder = encoder_error(angle, error, kinds[0], phases[0]) / error
        return encoder + share * pitch_error(angle, teeth) + sag * np.sin(angle + phases[1])

    peak = 0.5 * np.ptp(periodic(np.linspace(0.0, TURN, 2000)))
    twice = random.uniform(0.0, 0.1) * error * np.sin(2.0 * rotor + phases[2])
    measured = output + twice + random.uniform(0.5, 1.0) * error * periodic(output) / peak
    rotor = rotor + encoder_error(rotor, random.uniform(0.3, 1.0) * error, kinds[1], phases[3])
    delay = random.choice([0.0, random.uniform(-0.004, 0.004)])
    measured = np.interp(time - delay, time, measured)
    stamps = np.maximum.accumulate(time + random.normal(scale=2e-4, size=len(time)))
    read = []
    for angle, bits in ((rotor, random.choice([12, 14, 17])), (measured, random.choice([12, 20]))):
        step = TURN / 2.0**bits
        read.append(step * np.round(angle / step + random.normal(scale=0.3, size=len(angle))))
    inside = slice(int(0.02 * rate) + 1, -int(0.02 * rate) - 1)  # without the ends of the delay
    return Joint(read[0][inside], read[1][inside], stamps[inside])
