"""The step of an encoder, found in its readings.

Readings of an encoder are multiples of its step, plus an offset: a lattice. They are recorded as
decimals or in single precision, which are lattices as well, and may be finer or coarser. So a step
is sought that all readings fit to a fraction of it, and which is coarser than their recording.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN

Array = NDArray[np.float64]

UNITS = {'rad': 1.0, 'mrad': 1e-3, 'deg': math.radians(1.0), 'rev': TURN}
"""Units of angle in which readings may have been recorded, rad."""
_DIGITS = 12
"""Most decimals that are recognised."""
_ROUNDING = 8.0
"""Rounding errors of a reading, in its spacing."""
_FITS = 0.15
"""Greatest root mean square distance from a lattice, in its steps; 0.29 without a lattice."""
_COARSER = 1.9
"""A step is at least this many times the resolution of the recording: twice, less rounding."""
_CHANCE = 1e-3
"""Greatest probability with which readings without a lattice fit one."""
_BINS = 2**15
"""Bins of a histogram of levels, whose spectrum shows the lattices."""
_NARROWER = 32
"""Ratio of the widths of histograms."""
_FINER = 8
"""Frequencies of the spectrum in the least that the histogram resolves."""
_LEAST, _FEW = 4, 24
"""Least number of levels of an encoder; number of levels of a histogram, if there are as many."""
_CYCLES = 1.5
"""Least number of steps in a histogram."""
_MOST = 20_000
"""Levels that a lattice is fitted to."""
_HARMONIC = 1.5
"""Ratio of frequencies of a lattice and of one that is finer."""
_FAR = 1000.0
"""Ratio of the greatest to the least gap between levels, and of that to rounding errors."""
_EVEN = 0.98
"""From this share of equal changes on, levels are those of an even motion, not of an encoder."""
_EXACT, _BETTER = 1e-3, 0.3
"""Distance from a lattice, in its steps, below which no finer one is sought; share of the distance
from a lattice within which a finer one has to fit."""


class Source(StrEnum):
    """Where the step of an encoder comes from."""

    GIVEN = 'given'
    FOUND = 'found'
    """In the readings."""
    RECORDING = 'recording'
    """It is not determinable; the resolution of the recorded numbers takes its place."""
    UNKNOWN = 'unknown'
    """It is not determinable."""


@dataclass(frozen=True, slots=True)
class Step:
    """The step between the readings of an encoder."""

    size: float
    """In the unit of the readings; 0 if unknown."""
    source: Source

    def scaled(self, factor: float) -> 'Step':
        """The step of readings that are multiplied by a factor."""
        return Step(self.size * abs(factor), self.source)

    def joined(self, other: 'Step') -> 'Step':
        """The step of a difference of readings, whose variance is the sum of both."""
        worse = max(self, other, key=lambda step: list(Source).index(step.source))
        return Step(math.hypot(self.size, other.size), worse.source)


def step_of(counts: int | None, readings: Array) -> Step:
    """The step of an encoder, rad, from its counts per turn, or from its readings."""
    return Step(TURN / counts, Source.GIVEN) if counts else find_step(readings)


def find_step(readings: Array) -> Step:
    """Find the step of an encoder.

    Args:
        readings: (n,), rad, in the order of time.
    """
    levels = np.unique(readings)
    floor = _recording_resolution(levels)
    best, spread = 0.0, math.inf
    found = {lattice.step: lattice for lattice in _lattices(levels)}
    for step, lattice in sorted(found.items(), reverse=True):
        if step < _COARSER * floor or spread < _EXACT:
            break
        # A finer lattice always fits the readings; it has to fit them better.
        nearer = lattice.spread(_thinned(levels))
        if nearer < _BETTER * spread and lattice.is_of_encoder(_thinned(levels), readings):
            best, spread = step, nearer
    if best:
        return Step(best, Source.FOUND)
    return Step(floor, Source.RECORDING) if floor else Step(0.0, Source.UNKNOWN)


def _recording_resolution(levels: Array) -> float:
    """Distance of the recorded numbers, where decimals or single precision show; else 0."""
    # Distances of floating-point numbers are those of the greatest.
    large = _thinned(levels[2.0 * np.abs(levels) > np.max(np.abs(levels), initial=0.0)])
    if len(levels) < _LEAST or not len(large):
        return 0.0
    found = 0.0
    for unit in UNITS.values():
        values = large / unit
        steps = (large - large[0]) / unit  # an offset is no decimal
        rounding = _ROUNDING * np.spacing(np.abs(values))
        single = values.astype(np.float32)
        if np.all(np.abs(values - single) <= rounding):
            found = max(found, unit * float(np.max(np.spacing(np.abs(single)))))
        for digits in range(_DIGITS + 1):
            scale = 10.0**digits
            scaled, error = steps * scale, rounding * scale
            if np.max(error) > 1.0 / _ROUNDING**2:
                break
            if np.all(np.abs(scaled - np.round(scaled)) <= error):
                found = max(found, unit / scale)
                break
    return found


@dataclass(frozen=True, slots=True)
class _Lattice:
    """Multiples of a step from a zero."""

    zero: float
    step: float

    def numbers(self, values: Array) -> Array:
        return np.round((values - self.zero) / self.step)

    def fitted(self, values: Array) -> '_Lattice':
        """The lattice with the least squares of the distances of these values."""
        numbers, centre = self.numbers(values), float(values.mean())
        away = numbers - numbers.mean()
        if not away.any():
            return self
        step = float(away @ (values - centre) / (away @ away))
        return _Lattice(centre - step * float(numbers.mean()), step)

    def spread(self, values: Array) -> float:
        """Root mean square distance from the nearest multiple, in steps."""
        places = (values - self.zero) / self.step
        return math.sqrt(float(np.mean((places - np.round(places)) ** 2)))

    def is_of_encoder(self, levels: Array, readings: Array) -> bool:
        """Whether levels fit by more than chance, as steps of an encoder do."""
        spread = self.spread(levels)
        places = len(np.unique(self.numbers(levels)))
        # Without a lattice, a value is that near with this probability. The zero and the step have
        # been chosen, the step among as many as there are frequencies in a spectrum.
        near = max(math.sqrt(12.0) * spread, np.finfo(float).eps)
        if spread > _FITS or math.log(_BINS) + (places - 2) * math.log(near) > math.log(_CHANCE):
            return False
        large = levels[2.0 * np.abs(levels) > np.max(np.abs(levels))]
        doubled = _Lattice(0.0, 2.0 * self.step)
        return not (self._is_even_motion(readings) or doubled.spread(large) < _FITS)

    def _is_even_motion(self, readings: Array) -> bool:
        """Whether nearly all changes are the same, as at an even speed without steps."""
        changes = np.abs(np.diff(self.numbers(readings)))
        values, counts = np.unique(changes, return_counts=True)
        usual = int(np.argmax(counts))
        return bool(values[usual] and counts[usual] >= _EVEN * len(changes))


def _lattices(levels: Array) -> Iterator[_Lattice]:
    """Yield lattices that may be the encoder's: of all gaps, and of histograms of any width."""
    if len(levels) < _LEAST:
        return
    divisor = _common_divisor(levels)
    if divisor:
        yield _Lattice(float(levels[0]), divisor).fitted(_thinned(levels))
    few = min(_FEW, len(levels))
    densest = int(np.argmin(levels[few - 1 :] - levels[: len(levels) - few + 1])) + few // 2
    finest = 4.0 * _BINS * float(np.spacing(np.max(np.abs(levels))))
    for middle in {float(levels[densest]), float(levels[len(levels) // 2])}:
        width = 2.0 * float(np.ptp(levels))
        while width > finest:
            near = _within(levels, middle, 0.5 * width)
            if len(near) < few:
                break
            for step in _steps(_thinned(near)):
                yield _extended(levels, middle, step)
            width /= _NARROWER


def _common_divisor(levels: Array) -> float:
    """Return the greatest common divisor of the gaps, by Euclid's algorithm; 0 without any."""
    rounding = _ROUNDING * float(np.spacing(np.max(np.abs(levels))))
    gaps = np.diff(levels)
    gaps = gaps[gaps > rounding]
    gaps = gaps[gaps <= _FAR * np.min(gaps, initial=np.inf)]
    step = 0.0
    while len(gaps):
        step = float(np.min(gaps))
        if step < _FAR * rounding:
            return 0.0
        wholes = np.round(gaps / step)
        rest = np.abs(gaps - wholes * step)
        gaps = rest[rest > rounding * (1.0 + wholes)]
    return step


def _steps(levels: Array) -> Iterator[float]:
    """Yield the greatest step that levels fit nearly, then finer ones that fit best."""
    counts, _ = np.histogram(levels, _BINS)
    frequencies = np.arange(_FINER * _BINS // 2 + 1) / _FINER
    spectrum = np.abs(np.fft.rfft(counts, _FINER * _BINS)) / len(levels)
    spectrum /= np.sinc(frequencies / _BINS)  # the width of the bins
    # What a normal distribution about a lattice leaves of the amplitude.
    fit = math.exp(-2.0 * (math.pi * _FITS) ** 2)
    spectrum[frequencies < _CYCLES] = 0.0
    peak = int(np.argmax(spectrum >= fit))
    while peak + 1 < len(spectrum) and spectrum[peak + 1] > spectrum[peak]:
        peak += 1
    while spectrum[peak] >= fit:
        yield float(np.ptp(levels)) / frequencies[peak]
        finer = math.ceil(_HARMONIC * peak)
        if finer >= len(spectrum):
            return
        peak = finer + int(np.argmax(spectrum[finer:]))


def _extended(levels: Array, middle: float, step: float) -> _Lattice:
    """Fit a lattice with a level in the middle to more and more levels."""
    lattice = _Lattice(middle, step)
    width = 4.0 * step
    while width < 4.0 * float(np.ptp(levels)):
        inside = _within(levels, middle, width)
        if len(inside) > 1:
            lattice = lattice.fitted(_thinned(inside))
        width *= 2.0
    return lattice


def _within(levels: Array, middle: float, distance: float) -> Array:
    start, stop = np.searchsorted(levels, [middle - distance, middle + distance])
    return levels[start : stop + 1]


def _thinned(levels: Array) -> Array:
    """As many levels as a fit needs, at random: every second one would be a lattice of its own."""
    if len(levels) <= _MOST:
        return levels
    return levels[np.sort(np.random.default_rng(0).integers(len(levels), size=_MOST))]
