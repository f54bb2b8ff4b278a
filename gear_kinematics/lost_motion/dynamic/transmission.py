"""The transmission error of a recording over the output angle: accuracy, lost motion, orders.

An order is a number of cycles per turn of the output.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear, Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.recorded.motion import Motion
from gear_kinematics.state.reversals import Pair, Reversals, separate
from gear_kinematics.state.uncertainty import Component, Estimate, resolution

Array = NDArray[np.float64]

_LEVELS = 200
"""Number of angles at which two runs over the same range are compared."""
_LONG = 0.5
"""Runs of at least this share of the longest one are repeats of it."""
_CYCLES = 2.0
"""Minimum cycles of an order in a run."""
_SAMPLES = 4.0
"""Minimum samples in a cycle."""
_BINS = 8.0
"""Interpolated samples in the spectrum's shortest cycle."""
_MOST_TEETH = 100
"""Greatest number of teeth in mesh per turn of the rotor of an unknown gear."""
_BLOCK = 16_384
"""Samples that are fitted at a time."""


@dataclass(frozen=True, slots=True)
class Order:
    """A marked order of the spectrum."""

    name: str
    cycles: Fraction
    """Cycles per turn of the output."""
    forward: Estimate | None
    """Amplitude, rad; None where the motion is too short or the samples too far apart."""
    backward: Estimate | None


@dataclass(frozen=True, eq=False, slots=True)
class Spectrum:
    """Amplitudes over orders, (n,) each, in one direction."""

    orders: Array
    amplitude: Array
    """rad."""


@dataclass(frozen=True, eq=False, slots=True)
class TransmissionFigures:
    """Results from a recording of both encoders."""

    samples: int
    travel: float
    """rad, from the least to the greatest output angle."""
    offset: float
    """rad, the mean error: the offset of the encoders' zeros."""
    forward: Estimate | None
    """Transmission accuracy, rad: peak-to-peak error of forward motion without a reversal."""
    backward: Estimate | None
    reversals: Estimate | None
    """rad: error of the backward minus the forward run at the same angles; None without any."""
    lost_motion: Estimate | None
    """rad: the same at no speed; None where it cannot be told from a delay."""
    delay: Estimate | None
    """s, or rows of a file without times, by which the stamps of the output are late; None if it
    cannot be told. The other figures are without it."""
    orders: tuple[Order, ...]
    spectra: tuple[Spectrum | None, Spectrum | None]
    """Forward and backward."""


class _Run:
    """Samples in one direction."""

    def __init__(self, angle: Array, error: Array, speed: Array) -> None:
        order = np.argsort(angle, kind='stable')
        self.angle, self.error, self._speed = angle[order], error[order], speed[order]
        self.low, self.high = float(self.angle[0]), float(self.angle[-1])

    @property
    def turns(self) -> float:
        """Length, turns of the output."""
        return (self.high - self.low) / TURN

    @property
    def spacing(self) -> float:
        """Distance between samples, 99th percentile, turns of the output."""
        return float(np.quantile(np.diff(self.angle), 0.99)) / TURN

    def mean_speed(self, edges: Array) -> Array:
        """Mean speeds between angles (n,): (n - 1,)."""
        sums = np.concatenate([[0.0], np.cumsum(self._speed)])
        rows = np.searchsorted(self.angle, edges)
        counts = np.diff(rows)
        single = np.interp(0.5 * (edges[1:] + edges[:-1]), self.angle, self._speed)
        return np.where(counts, np.diff(sums[rows]) / np.maximum(counts, 1), single)


def marked_orders(gear: Gear) -> dict[str, Fraction]:
    """The orders to look for, by name, in cycles per turn of the output.

    In a turn of the output, the rotor turns |i| times. In a mechanism, the cam turns |i| + 1 times
    against the satellite, as do its mesh and the Oldham coupling, and teeth mesh zk times per turn
    of the rotor.
    """
    rotor = abs(gear.gear_ratio)
    base = {'output': Fraction(1), 'rotor': rotor}
    if isinstance(gear, Mechanism):
        base |= {'satellite': rotor + 1, 'teeth': gear.ring_teeth * rotor}
    return {
        f'{name} × {multiple}': multiple * cycles
        for name, cycles in base.items()
        for multiple in (1, 2)
    }


def separate_delay(motion: Motion, delay: float | None) -> tuple[Reversals | None, Motion]:
    """Separate lost motion from a delay of the output's stamps, and take the delay out.

    Args:
        motion: of both encoders.
        delay: s or rows, if it is known; None estimates it, and takes out what is more than its
            uncertainty.
    """
    found = _reversals(motion, delay)
    taken = found.delay if found else None
    if delay is None and taken and abs(taken.value) > (taken.uncertainty or 0.0):
        # The error is in proportion to the delay only as long as the speed hardly changes in it.
        delay = taken.value
        rest = _reversals(motion.without_delay(delay), None)
        if rest and rest.delay and found:
            late = replace(rest.delay, value=delay + rest.delay.value)
            found = replace(found, lost_motion=rest.lost_motion, delay=late)
    return found, motion.without_delay(delay) if delay else motion


def figures(motion: Motion, gear: Gear, reversals: Reversals | None) -> TransmissionFigures:
    """Compute the figures of a recording.

    Args:
        motion: of both encoders, without delay.
        gear: whose orders to look for.
        reversals: the first result of `separate_delay`.
    """
    runs = list(_runs(motion))
    ways = [[run for sign, run in runs if sign == way] for way in (1, -1)]
    reading = Component(_reading(motion))
    both = Component(math.sqrt(2.0) * reading.standard)
    forward, backward = (_long(way) for way in ways)
    return TransmissionFigures(
        samples=len(motion.error),
        travel=float(np.ptp(motion.angle)),
        offset=float(np.mean(motion.error)),
        forward=_accuracy(forward, both),
        backward=_accuracy(backward, both),
        reversals=reversals.difference if reversals else None,
        lost_motion=reversals.lost_motion if reversals else None,
        delay=reversals.delay if reversals else None,
        orders=tuple(_orders(gear, forward, backward, reading)),
        spectra=(_spectrum(gear, forward), _spectrum(gear, backward)),
    )


def _reading(motion: Motion) -> float:
    """Standard uncertainty of an error by the steps of both encoders, rad."""
    return resolution(motion.rotor_step.joined(motion.output_step).size)


def _runs(motion: Motion) -> Iterable[tuple[int, _Run]]:
    """The runs between reversals, each with its direction."""
    if len(motion.stamp) < 2:  # noqa: PLR2004, no speed
        return
    speed = np.gradient(motion.angle, motion.time)
    known = np.flatnonzero(motion.direction)
    signs = motion.direction[known]
    for rows in np.split(known, np.flatnonzero(np.diff(signs)) + 1):
        if len(rows) > 1:
            run = _Run(motion.angle[rows], motion.error[rows], speed[rows])
            yield int(motion.direction[rows[0]]), run


def _long(runs: Sequence[_Run]) -> list[_Run]:
    longest = max((run.turns for run in runs), default=0.0)
    return [run for run in runs if run.turns >= _LONG * longest]


def _accuracy(runs: Sequence[_Run], reading: Component) -> Estimate | None:
    values = [float(np.ptp(run.error)) for run in runs]
    return Estimate.of_mean(values, reading) if values else None


def _reversals(motion: Motion, delay: float | None) -> Reversals | None:
    """Compare successive runs, in pairs of opposite direction, over their common angles."""
    pairs = [_pair(*two) for two in list(pairwise(_runs(motion)))[::2]]
    return separate(pairs, Component(math.sqrt(2.0) * _reading(motion)), delay=delay)


def _pair(first: tuple[int, _Run], second: tuple[int, _Run]) -> Pair:
    (sign, there), (_, back) = first, second
    low, high = max(there.low, back.low), min(there.high, back.high)
    if low >= high:
        return Pair(np.zeros(0), np.zeros(0))
    edges = np.linspace(low, high, _LEVELS + 1)
    at = 0.5 * (edges[1:] + edges[:-1])
    there_error, back_error = (np.interp(at, run.angle, run.error) for run in (there, back))
    speed = there.mean_speed(edges) - back.mean_speed(edges)
    return Pair(sign * (back_error - there_error), sign * speed)


# Orders


def _orders(
    gear: Gear, forward: Sequence[_Run], backward: Sequence[_Run], reading: Component
) -> Iterable[Order]:
    marked = marked_orders(gear)
    ways = [_amplitudes(runs, marked, reading) for runs in (forward, backward)]
    for name, cycles in marked.items():
        yield Order(name, cycles, *(way.get(name) for way in ways))


def _amplitudes(
    runs: Sequence[_Run], marked: Mapping[str, Fraction], reading: Component
) -> dict[str, Estimate]:
    """Amplitudes of the orders that every run resolves."""
    if not runs:
        return {}
    shortest, coarsest = min(run.turns for run in runs), max(run.spacing for run in runs)
    resolved: list[str] = []
    last = 0.0
    for name, cycles in sorted(marked.items(), key=lambda item: item[1]):
        order = float(cycles)
        apart = (order - last) * shortest >= 1.0
        if apart and order * shortest >= _CYCLES and order * coarsest * _SAMPLES <= 1.0:
            resolved.append(name)
            last = order
    if not resolved:
        return {}
    fits = [_fit(run, [float(marked[name]) for name in resolved]) for run in runs]
    return {
        name: Estimate.of_mean([f[k] for f in fits], reading) for k, name in enumerate(resolved)
    }


def _fit(run: _Run, orders: Sequence[float]) -> list[float]:
    """Amplitudes of a sum of sines, by least squares; the samples need not be evenly spaced."""
    size = 2 * len(orders) + 1
    normal, right = np.zeros((size, size)), np.zeros(size)
    for start in range(0, len(run.angle), _BLOCK):
        rows = slice(start, start + _BLOCK)
        phase = np.multiply.outer(run.angle[rows], orders)
        design = np.concatenate([np.ones((len(phase), 1)), np.cos(phase), np.sin(phase)], axis=1)
        normal += design.T @ design
        right += design.T @ run.error[rows]
    solution = np.linalg.lstsq(normal, right, rcond=None)[0][1:]
    cosines, sines = solution.reshape(2, -1)
    return [math.hypot(cosine, sine) for cosine, sine in zip(cosines, sines, strict=True)]


def _spectrum(gear: Gear, runs: Sequence[_Run]) -> Spectrum | None:
    """Amplitudes of all orders that the longest run resolves, with a Hann window."""
    run = max(runs, key=lambda run: run.turns, default=None)
    if run is None:
        return None
    teeth = gear.ring_teeth if isinstance(gear, Mechanism) else _MOST_TEETH
    highest = min(2.5 * float(teeth * abs(gear.gear_ratio)), 0.5 / run.spacing)
    if highest * run.turns < _CYCLES:
        return None
    count = math.ceil(_BINS * highest * run.turns)
    at = run.low + (np.arange(count) + 0.5) * (run.high - run.low) / count
    error = np.interp(at, run.angle, run.error)
    window = np.hanning(count)
    amplitude = 2.0 * np.abs(np.fft.rfft((error - error.mean()) * window)) / window.sum()
    orders = np.arange(len(amplitude)) / run.turns
    shown = orders <= highest
    return Spectrum(orders[shown], amplitude[shown])
