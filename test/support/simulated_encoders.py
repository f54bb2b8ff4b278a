# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Readings of encoders at rotor and output of a known gear, as functions of time.

Nothing of the code under test is used. Play is the motion of a block between two stops.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

TURN = 2.0 * math.pi
ARC_MINUTE = TURN / 360.0 / 60.0
MS = 10**6
START = 1_700_000_000 * 10**9

Profile = Callable[[np.ndarray], np.ndarray]
"""Ideal output angle, rad, at times, s."""


def even_strokes(stroke: float, seconds: float) -> Profile:
    """Strokes of a length, rad, at one speed, there and back in `seconds` each."""
    return lambda t: stroke * np.abs((t / seconds + 1.0) % 2.0 - 1.0)


def sine_strokes(stroke: float, seconds: float) -> Profile:
    """Strokes of a sine."""
    return lambda t: 0.5 * stroke * (1.0 - np.cos(math.pi * t / seconds))


def ramped_strokes(stroke: float, seconds: float, ramp: float) -> Profile:
    """Strokes with a trapezoidal speed, which rises and falls for `ramp`, s."""
    fine = np.linspace(0.0, 1.0, 20_001)
    speed = np.clip(np.minimum(fine, 1.0 - fine) * seconds / ramp, 0.0, 1.0)
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))])
    way *= stroke / way[-1]

    def angle(t: np.ndarray) -> np.ndarray:
        place = np.asarray(t) / seconds
        back = np.floor(place) % 2 == 1
        done = np.interp(place % 1.0, fine, way)
        return np.where(back, stroke - done, done)

    return angle


def with_play(angle: np.ndarray, play: float) -> np.ndarray:
    """Return output angles that stay until the play is crossed, starting in its middle."""
    out, at = [], angle[0]
    ends = (angle - 0.5 * play).tolist(), (angle + 0.5 * play).tolist()
    for least, most in zip(*ends, strict=True):
        if not least <= at <= most:
            at = least if at < least else most
        out.append(at)
    return np.array(out)


@dataclass(frozen=True)
class Drive:
    """A gear with its encoders."""

    play: float = 3.0 * ARC_MINUTE  # rad
    errors: Mapping[float, float] = field(default_factory=dict)
    """Amplitudes of sines, rad, by cycles per turn of the output."""
    delay: float = 0.0  # s, by which the output's stamps are late
    noise: float = 0.0  # rad, standard deviation, of the output encoder
    rotor_step: float = 0.0  # rad of the rotor
    output_step: float = 0.0  # rad
    ratio: float = -19.0

    def output(self, ideal: np.ndarray) -> np.ndarray:
        """Output angles that result from ideal ones, starting in the middle of the play."""
        errors = sum(a * np.sin(order * ideal + order) for order, a in self.errors.items())
        return with_play(ideal, self.play) + errors

    def readings(
        self, profile: Profile, seconds: float, rate: float = 1000.0, seed: int = 1
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times, s, rotor and output readings, rad, at the same stamps."""
        times = np.arange(round(seconds * rate)) / rate
        rotor = self.ratio * profile(times)
        # The output's reading belongs to an earlier time than its stamp says.
        output = self.output(profile(times - self.delay))
        output = output + np.random.default_rng(seed).normal(0.0, 1.0, len(times)) * self.noise
        return times, stepped(rotor, self.rotor_step), stepped(output, self.output_step)


def stepped(values: np.ndarray, step: float) -> np.ndarray:
    return np.round(values / step) * step if step else values


def stamps(times: np.ndarray) -> np.ndarray:
    return START + np.round(times * 1e9).astype(np.int64)
