# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Orders in the residuals: amplitudes over cycles per turn of the rotor."""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics.gear_ratio import simplest_fraction
from gear_kinematics.measurement.calibration.terms import CYCLES
from gear_kinematics.measurement.recording import Array

_HIGHEST = 256.0  # cycles per turn of the rotor that are looked for
_BINS = 4.0  # bins of the rotor's angle in the shortest cycle
_LARGEST = 2**22  # bins in all
_MULTIPLE = 0.25  # share of the resolution within which an order counts as a multiple
_LARGEST_DENOMINATOR = 64
_NEIGHBOURS = 64  # orders whose median is taken as noise
_FALSE = 0.01  # probability that noise looks like an order


class Spectrum(NamedTuple):
    """Amplitudes of all recordings together, (n,) each."""

    cycles: Array
    """Per turn of the rotor."""
    amplitude: Array
    """rad."""
    resolution: float
    """Cycles per turn of the rotor: the reciprocal of the longest travel."""

    def peaks(self, most: int, lowest: float) -> list[float]:
        """At most so many orders above the noise, of two cycles or more, the greatest first.

        Noise exceeds the limit anywhere in the spectrum with a probability of 1 %.
        """
        left, inner, right = self.amplitude[:-2], self.amplitude[1:-1], self.amplitude[2:]
        # The power of noise has an exponential distribution.
        limit = self._background() * math.log(len(self.cycles) / _FALSE)
        high = (inner >= left) & (inner > right) & (np.square(inner) > limit[1:-1])
        high &= self.cycles[1:-1] >= max(CYCLES * self.resolution, lowest)
        places = np.flatnonzero(high)
        # The tops of parabolas through the peaks and their neighbours.
        left, top, right = left[places], inner[places], right[places]
        shift = 0.5 * (left - right) / (left - 2.0 * top + right)
        tops = self.cycles[1 + places] + shift * (self.cycles[1] - self.cycles[0])
        found: list[float] = []
        for cycles in tops[np.argsort(-top, kind='stable')].tolist():
            if len(found) < most and all(abs(cycles - o) > self.resolution for o in found):
                found.append(cycles)
        return found

    def _background(self) -> Array:
        """Mean power of the noise, from medians of neighbouring orders, (n,)."""
        power = np.square(self.amplitude)
        # Narrow at low orders, where the noise of drift is steep.
        edges = [0, 8, 16, 32, *range(64, len(power) - _NEIGHBOURS // 2, _NEIGHBOURS)]
        edges = [*(edge for edge in edges if edge < len(power)), len(power)]
        parts = np.split(power, edges[1:-1])
        medians = [float(np.median(part)) for part in parts]
        centres = 0.5 * (np.array(edges[1:]) + edges[:-1])
        return np.interp(np.arange(len(power)), centres, medians) / math.log(2.0)


def spectrum(angles: Sequence[Array], errors: Sequence[Array]) -> Spectrum | None:
    """Compute the amplitudes of orders in irregular samples, by projection.

    Args:
        angles: of the rotor in each recording, turns.
        errors: of each recording, rad; their means do not count.

    Returns:
        None if the rotor turned too little.
    """
    errors = [error - error.mean() for error in errors]
    travel = max(float(np.ptp(angle)) for angle in angles)
    path = sum(float(np.abs(np.diff(angle)).sum()) for angle in angles)
    samples = sum(len(angle) for angle in angles)
    if travel <= 0.0:
        return None
    highest = min(_HIGHEST, 0.25 * samples / path, _LARGEST / (_BINS * 4.0 * travel))
    if highest * travel < CYCLES:
        return None
    bins = 2 ** math.ceil(math.log2(_BINS * highest * travel))
    width = travel * (1.0 + 1e-9) / bins
    power = np.zeros(bins + 1)
    for angle, error in zip(angles, errors, strict=True):
        place = ((angle - angle.min()) / width).astype(np.intp)
        sums = np.bincount(place, error, minlength=bins)
        power += np.abs(np.fft.rfft(sums, 2 * bins)) ** 2 * (4.0 / len(error) / samples)
    cycles = np.arange(bins + 1) / (2.0 * travel)
    shown = cycles <= highest
    return Spectrum(cycles[shown], np.sqrt(power[shown]), 1.0 / travel)


def as_fraction(cycles: float, resolution: float, output: Fraction) -> Fraction:
    """The simplest exact order near one from a spectrum, 0 if there is no simple one.

    Multiples of the rotor come first, then those of the output, then simple fractions; all are in
    cycles per turn of the rotor.
    """
    near = _MULTIPLE * resolution
    for unit in (Fraction(1), output, Fraction(1, output.denominator)):
        multiple = round(cycles / unit) * unit
        if multiple > 0 and abs(float(multiple) - cycles) <= near:
            return multiple
    exact, around = Fraction(cycles), Fraction(0.5 * near)
    simplest = simplest_fraction(exact - around, exact + around)
    return simplest if simplest.denominator <= _LARGEST_DENOMINATOR else Fraction(0)
