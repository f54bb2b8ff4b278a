"""Orders in the residuals: amplitudes over cycles per turn of the rotor."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from gear_kinematics.calibration.normal import Array

_HIGHEST = 256.0
"""Cycles per turn of the rotor that are looked for."""
_BINS = 4.0
"""Bins of the rotor's angle in the shortest cycle."""
_LARGEST = 2**22
"""Bins in all."""
_NEAR = 0.25
"""Share of the resolution within which an order counts as a multiple."""
_LARGEST_DENOMINATOR = 64
_NEIGHBOURS = 64
"""Orders whose median is taken as noise."""
_FALSE = 0.01
"""Probability that noise looks like an order."""


@dataclass(frozen=True, eq=False, slots=True)
class Spectrum:
    """Amplitudes of all recordings together, (n,) each."""

    cycles: Array
    """Per turn of the rotor."""
    amplitude: Array
    """rad."""
    resolution: float
    """Cycles per turn of the rotor: the reciprocal of the longest travel."""

    def peaks(self, most: int, lowest: float) -> list[float]:
        """Orders above the noise with the greatest amplitudes, of two cycles or more.

        Args:
            most: number of orders.
            lowest: cycles per turn of the rotor.

        Noise exceeds the limit anywhere in the spectrum with a probability of 1 %.
        """
        inner = self.amplitude[1:-1]
        local = (inner >= self.amplitude[:-2]) & (inner > self.amplitude[2:])
        local &= self.cycles[1:-1] >= max(2.0 * self.resolution, lowest)
        # The power of noise has an exponential distribution.
        limit = self._background() * math.log(len(self.cycles) / _FALSE)
        local &= np.square(inner) > limit[1:-1]
        places = 1 + np.flatnonzero(local)
        places = places[np.argsort(-self.amplitude[places], kind='stable')]
        found: list[float] = []
        for place in places.tolist():
            if len(found) == most:
                break
            cycles = self._refined(place)
            if all(abs(cycles - other) > self.resolution for other in found):
                found.append(cycles)
        return found

    def _background(self) -> Array:
        """Mean power of the noise, from medians of neighbouring orders, (n,)."""
        power = np.square(self.amplitude)
        # Narrow at low orders, where the noise of drift is steep.
        edges = [0, *(2**k for k in range(3, 7))]
        edges += range(edges[-1] + _NEIGHBOURS, len(power) - _NEIGHBOURS // 2, _NEIGHBOURS)
        parts = np.split(power, [edge for edge in edges[1:] if edge < len(power)])
        medians = [float(np.median(part)) for part in parts]
        ends = np.cumsum([len(part) for part in parts])
        centres = ends - 0.5 * np.array([len(part) for part in parts])
        return np.interp(np.arange(len(power)), centres, medians) / math.log(2.0)

    def _refined(self, place: int) -> float:
        """The top of a parabola through a peak and its neighbours."""
        left, top, right = self.amplitude[place - 1 : place + 2].tolist()
        bend = left - 2.0 * top + right
        shift = 0.5 * (left - right) / bend if bend else 0.0
        return float(self.cycles[place] + shift * (self.cycles[1] - self.cycles[0]))


def spectrum(angles: Sequence[Array], errors: Sequence[Array]) -> Spectrum | None:
    """Compute the amplitudes of orders in irregular samples, by projection.

    Args:
        angles: of the rotor in each recording, turns.
        errors: rad, the same, with zero mean.

    Returns:
        None if the rotor turned too little.
    """
    travel = max(float(np.ptp(angle)) for angle in angles)
    path = sum(float(np.abs(np.diff(angle)).sum()) for angle in angles)
    samples = sum(len(angle) for angle in angles)
    if travel <= 0.0:
        return None
    highest = min(_HIGHEST, 0.25 * samples / path, _LARGEST / (_BINS * 4.0 * travel))
    if highest * travel < 2.0:  # noqa: PLR2004, cycles
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


def as_fraction(cycles: float, resolution: float, output: Fraction) -> Fraction | None:
    """The simplest exact order near one from a spectrum, None if there is no simple one.

    Multiples of the rotor come first, then those of the output, then simple fractions.

    Args:
        cycles: per turn of the rotor.
        resolution: of the spectrum.
        output: cycles of the output per turn of the rotor.
    """
    near = _NEAR * resolution
    for unit in (Fraction(1), output, Fraction(1, output.denominator)):
        multiple = round(cycles / unit) * unit
        if multiple > 0 and abs(float(multiple) - cycles) <= near:
            return multiple
    for denominator in range(2, _LARGEST_DENOMINATOR + 1):
        fraction = Fraction(round(cycles * denominator), denominator)
        if fraction > 0 and abs(float(fraction) - cycles) <= 0.5 * near:
            return fraction
    return None
