# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio from recorded angles of rotor and output."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import count, islice
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.transmission_error import Direction
from gear_kinematics.kinematics.gear_ratio import GearRatio, simplest_fraction
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.recording import Encoders, RecordingError
from gear_kinematics.measurement.wording import plus_minus
from gear_kinematics.statistics.uncertainty import Component, Estimate, jackknife

Array = NDArray[np.float64]

ENCODER_ERROR = math.radians(1.0)
"""rad. Magnetic encoders deviate by ±1° over a turn (datasheets of ams AS5046 and AS5600), and
printed gears by about as much: that of the rotor's encoder, and of gear and output's encoder."""
_ACCURACY = math.radians(2.0 / 3600.0) / math.sqrt(3.0)
"""rad, standard deviation. Few encoders are accurate to ±2″ over the travel, and a gear on its
springs follows its errors a little more the faster it turns."""
_BLOCKS = 23
"""Prime, as blocks of whole cycles of an error would not differ."""
_SAMPLES = 230, 10_000
"""At least and at most: more tell no more of errors that are correlated."""
_ORDERS = 48, 4
"""Of output and rotor: as 1/k, they add up to a random walk, as of pitch errors. With 24, 3 of 200
simulated recordings of 340° were outside of twice the interval."""
_ROTOR_SHARE = 0.1
"""Of the error, at the output, that the gear may have once per turn of the rotor."""
_TO_STANDARD = math.sqrt(-2.0 * math.log(0.05))
"""Amplitude that 95 % do not exceed, over the standard deviation of its sine and cosine."""
_PLAY, _DELAY = 0.1, 0.05
"""Standard deviations, rad and s, that hardly bind play and delay; 1 rad those of the travel."""
_LAG = 6e-5
"""Standard deviation, s², of the lag by the acceleration: inertia over stiffness of the output, or
1/ω² of one that oscillates at 20 Hz on the springs of its gear, as arms of robots do."""
_SETTLED, _MOST_PLAY = 0.05, math.radians(2.0)
"""After a reversal, left out, as play is crossed: share of the whole travel, and at most, rad."""
_LEAST_NOISE = 1e-9
"""rad: less than the step of any encoder."""
_STEP = 0.01
"""s around a sample, for its speed; of a row without times."""
_ONE_TURN = 390
"""deg of the output: more than a turn, as hardly anything repeats in just one."""
_MOST_TURNED = 3600
"""deg of the output that can be asked for."""
_BY_CHANCE = 0.05
"""Probability below which a simple fraction in the interval is no coincidence."""
_MAX_DISTANCE = 2
"""Expanded uncertainties within which a fraction may be the true ratio: of 20 recordings, one has
it beyond a single one."""
_CANDIDATES = 10


@dataclass(frozen=True, slots=True)
class RatioEstimate:
    """A gear ratio as it was measured."""

    measured: Estimate
    candidates: tuple[Fraction, ...]
    """Fractions that may be the ratio by denominator, the nearest first; the one that is taken."""
    taken: GearRatio | None = None
    """The simplest fraction, if it is in the interval and no other is as simple around it."""
    advice: str = ''
    """How far to turn the output to tell the ratio; empty if it is taken."""

    def fits(self, ratio: Fraction) -> bool:
        """Return whether this may be the true ratio."""
        return abs(self.measured.value - ratio) <= _MAX_DISTANCE * self.measured.expanded

    @property
    def plus_minus(self) -> str:
        """The measured ratio ± its expanded uncertainty."""
        return plus_minus(self.measured)


def check_ratio(encoders: Encoders, assumed: GearRatio) -> str:
    """Compare a recording with a ratio; return what is wrong in a sentence, or nothing.

    Raises:
        RecordingError: if the errors cover a whole turn; within the turn they then mean nothing.
    """
    error, wrong = encoders.error(assumed), wrong_ratio(encoders, assumed)
    if float(np.ptp(np.remainder(error - error[0] + 0.5 * TURN, TURN))) >= 0.5 * TURN:
        why = wrong or 'the ratio is wrong, or an encoder counts backwards'
        raise RecordingError(f'the output does not follow the rotor: {why}')
    return f'The recording does not have the ratio {assumed}: {wrong}.' if wrong else ''


def wrong_ratio(encoders: Encoders, assumed: Fraction) -> str:
    """Say in a clause which ratio a recording has, if it is clearly not the assumed one.

    It is found if, between samples, the output turns at most half a turn more or less than by the
    assumed one.
    """
    found = _estimated(encoders, assumed)
    if found and found.fits(assumed):
        return ''
    upside_down = _estimated(encoders, 1 / assumed)
    for ratio in (1 / assumed, -1 / assumed):
        if upside_down and upside_down.fits(ratio):
            measured = f'the recorded ratio is {upside_down.plus_minus}, not {assumed}'
            meant = 'the speed of the rotor by that of the output'
            return f'{measured}, which is upside down: give --ratio={ratio}, {meant}'
    if not found:
        return ''
    measured = f'the recorded ratio is {found.plus_minus}, not {assumed}'
    if found.fits(-assumed):
        return f'{measured}: an encoder counts backwards, or --ratio={-assumed} is right'
    such = '' if found.taken else ' it, such as'
    return f'{measured}; gearkin commission finds it, or give{such} --ratio={found.candidates[0]}'


def _estimated(encoders: Encoders, assumed: Fraction) -> RatioEstimate | None:
    """Estimate the ratio from one by which the output turns about as far, if that is possible."""
    ideal = encoders.at_measured(encoders.ideal(assumed))
    time = encoders.seconds if encoders.timed else None
    output = ideal + encoders.error(assumed)
    try:
        return estimate_ratio(ideal * float(assumed), output, time, encoders.interpolated)
    except RecordingError:
        return None


def estimate_ratio(
    rotor: Array, output: Array, time: Array | None = None, period: float = 0.0
) -> RatioEstimate:
    """Estimate the ratio by least squares that expect errors of a bounded size.

    The output angle is slope · rotor angle + offset + play by direction + delay · speed + errors
    that repeat with each turn of output or rotor: for k cycles a turn, their amplitude is at most
    `ENCODER_ERROR`/k, with a probability of 95 %. What less than a turn leaves open of them is in
    the uncertainty; over more, they are fitted. So is by how much the ratio changes if a lag by
    the acceleration is fitted, as of an inertia on springs, or what is lost by interpolation. All
    else is in the scatter of the
    estimates with one block of successive samples left out.

    Args:
        rotor: (n,), rad, counting turns, in the order of time.
        output: (n,), rad, counting turns.
        time: (n,), s.
        period: s between the samples between which the rotor is interpolated; 0 if it is not.

    Raises:
        RecordingError: if there are too few samples, or the output hardly turns with the rotor, or
            more than it.
    """
    for angle, body in ((rotor, 'rotor'), (output, 'output')):
        if not np.ptp(angle):
            raise RecordingError(f'the {body} does not turn')
    centred = (rotor - np.mean(rotor)) / np.ptp(rotor)
    slope = float(centred @ (output - np.mean(output)) / (centred @ centred) / np.ptp(rotor))
    late = 0.0
    times = np.asarray(_STEP * np.arange(len(rotor)) if time is None else time, float)
    direction = Direction(min(_SETTLED * abs(slope) * float(np.ptp(rotor)), _MOST_PLAY))
    steps = (slope * np.diff(rotor, prepend=rotor[0])).tolist()
    way = np.array([direction.move(step) for step in steps], float)
    for _ in range(3):  # again with the slope and the delay that were found
        kept = np.flatnonzero(way * (times - late >= times[0]) * (times - late <= times[-1]))
        kept = kept[:: -(-len(kept) // _SAMPLES[1]) or 1]
        if len(kept) < _SAMPLES[0]:
            few = f'{len(kept)} samples in motion are too few'
            raise RecordingError(f'{few}; turn the output until there are {_SAMPLES[0]}')
        around = (times[kept] - late + k * _STEP for k in (-2, -1, 0, 1, 2))
        first, early, at, after, last = (np.interp(when, times, rotor) for when in around)
        # The measured angle must not explain itself: errors are periodic in that of the rotor.
        columns = _columns(at, slope, way[kept], slope * (after - early))
        rest = output[kept] - slope * at
        fit = _fitted(columns, rest)
        travel = float(np.ptp(at))
        slope, late = slope + fit.terms[0] / travel, late - _DELAY * fit.terms[3]
    # Nor must its error: the reading of the rotor is not in its acceleration.
    acceleration = slope * (first - early - after + last) / (3.0 * _STEP**2)
    # Between samples the rotor is taken to move evenly: twice where there is a delay, too.
    curved = _fitted(columns, rest + period**2 / 4.0 * acceleration)
    lagging = _fitted(np.column_stack([columns, _LAG * acceleration]), rest)
    parts = (
        Component(fit.spread / travel),
        Component(_ACCURACY / travel),
        Component((lagging.terms[0] - fit.terms[0]) / travel / math.sqrt(3.0)),
        Component((curved.terms[0] - fit.terms[0]) / travel / math.sqrt(3.0)),
    )
    measured = jackknife(slope + _changes(fit) / travel, *parts)
    if not _MAX_DISTANCE * measured.expanded < abs(slope):
        raise RecordingError('the output does not follow the rotor, or turns too little')
    measured = measured.inverse()
    if abs(measured.value) + measured.expanded < 1.0:
        raise RecordingError('the output turns more than the rotor: exchange the two')
    return _judged(measured, math.degrees(abs(slope) * travel))


def _columns(rotor: Array, slope: float, way: Array, step: Array) -> Array:
    """Each term as large as it may be: (n, terms); slope, offset, play and delay are first."""
    x = (rotor - np.mean(rotor)) / np.ptp(rotor)
    columns = [x, np.ones(len(x)), _PLAY * way, _DELAY / (2.0 * _STEP) * step]
    amplitudes = ENCODER_ERROR, (abs(slope) + _ROTOR_SHARE) * ENCODER_ERROR
    for angle, amplitude, most in zip((slope * rotor, rotor), amplitudes, _ORDERS, strict=True):
        power = once = np.exp(1j * angle)  # cos + j sin of k times the angle
        for k in range(1, most + 1):
            size = amplitude / (_TO_STANDARD * k)
            columns += [size * power.real, size * power.imag]
            power = power * once
    return np.stack(columns, axis=1)


class _Fit(NamedTuple):
    """Terms by least squares, each expected to be about as large as it may be."""

    terms: list[float]
    spread: float
    """Standard uncertainty of the first term by noise, and by what terms leave open."""
    sums: Array
    """(blocks, terms + 1, terms + 1): of products of columns and of what they are fitted to."""
    noise: float
    """Variance of a sample."""


def _fitted(columns: Array, rest: Array) -> _Fit:
    rest = left = rest - np.mean(rest)
    blocks = np.array_split(np.column_stack([columns, rest]), _BLOCKS)
    sums = np.array([block.T @ block for block in blocks])
    squares, products = _parts(sums.sum(axis=0))
    eigen = np.linalg.eigh(squares)
    for _ in range(5):  # with the noise that the one before left; with 3, ± is 50 % off
        noise = max(_noise(left), _LEAST_NOISE**2)
        fitted, spread = _solve(*eigen, products, noise)
        left = rest - columns @ fitted
    return _Fit(fitted.tolist(), spread, sums, noise)


def _changes(fit: _Fit) -> Array:
    """Changes of the first term: 0 with all blocks, then those without each, (1 + blocks,)."""
    squares, products = _parts(fit.sums.sum(axis=0) - fit.sums)
    each = zip(*np.linalg.eigh(squares), products, strict=True)
    without = [_solve(*one, fit.noise)[0][0] - fit.terms[0] for one in each]
    return np.array([0.0, *without])


def _parts(sums: Array) -> tuple[Array, Array]:
    """Products among the columns, and with what they are fitted to."""
    return sums[..., :-1, :-1], sums[..., :-1, -1]


def _solve(values: Array, vectors: Array, products: Array, noise: float) -> tuple[Array, float]:
    """The coefficients, and the standard uncertainty of the first."""
    known, left = values > 1e-14 * values[-1], noise / (np.abs(values) + noise)
    fitted: Array = vectors @ (np.where(known, left / noise, 0.0) * (vectors.T @ products))
    return fitted, math.sqrt(float(vectors[0] ** 2 @ np.where(known, left, 1.0)))


def _noise(residual: Array) -> float:
    """Variance of a sample; of correlated ones, the one that the scatter of means implies."""
    most, means, size = 0.0, residual, 1
    while len(means) >= _SAMPLES[0] // 2 or size == 1:
        most = max(most, size * float(np.mean(means**2)))
        means, size = (means[:-1:2] + means[1::2]) / 2.0, 2 * size
    return most


def _judged(measured: Estimate, turned: float) -> RatioEstimate:
    """Take the simplest fraction that may be the ratio, or say by how many degrees to turn."""
    value, spread = measured.value, measured.expanded
    around = _MAX_DISTANCE * spread
    low, high = Fraction(value - around), Fraction(value + around)
    simplest = simplest_fraction(low, high)
    # Fewer than q (q + 1)/2 fractions per unit have a denominator of at most q.
    q = simplest.denominator
    enough = _BY_CHANCE / (_MAX_DISTANCE * q * (q + 1))
    if abs(value - simplest) <= spread < enough:
        return RatioEstimate(measured, (simplest,), GearRatio(simplest))
    # Over a turn, the uncertainty falls as it grows.
    more = 90 * math.ceil(spread / enough * turned / 90.0)
    more = more if turned >= _ONE_TURN else _ONE_TURN
    advice = f'turn the output by {more}° or more'
    if not turned < more <= _MOST_TURNED:
        advice = 'turning further hardly helps: sample both encoders at once, and more often'
    candidates = islice(_fractions(low, high, q, value), _CANDIDATES)
    return RatioEstimate(measured, tuple(candidates), advice=advice)


def _fractions(low: Fraction, high: Fraction, least: int, value: float) -> Iterator[Fraction]:
    """Fractions in an interval by denominator, the nearest to a value first."""
    for q in count(least):
        whole = range(math.ceil(low * q), math.floor(high * q) + 1)
        for p in sorted(whole, key=lambda p: abs(p - value * q)):
            if math.gcd(p, q) == 1:
                yield Fraction(p, q)
