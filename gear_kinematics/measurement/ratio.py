# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio from recorded angles of rotor and output, and the gears that may have it."""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.uncertainty import Estimate, deviation, pseudo_values, student_t
from gear_kinematics.kinematics.gear_ratio import GearRatio, simplest_fraction, tooth_pairs
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.recording import Encoders, RecordingError
from gear_kinematics.report.document import number

Array = NDArray[np.float64]

MOST_TEETH = 200
"""Teeth of the ring gears that are considered; any pair can be multiplied."""
_BLOCKS = 23
"""Prime, as blocks of whole cycles of an error would not differ."""
_LEAST_SAMPLES = 10
"""Samples in a block."""
_CYCLES = 2.0
"""Turns of the rotor from which on its periodic error is fitted."""
_BY_CHANCE = 0.05
"""Probability below which a simple fraction in the interval is no coincidence."""
_MAX_DISTANCE = 2.0
"""Expanded uncertainties within which a fraction or a tooth pair may be the true ratio."""
_MIN_WRONG = 3.0
"""Expanded uncertainties from which on an assumed ratio is wrong."""
_ECCENTRICITY = 0.01
"""Slope of the error that an eccentricity may have over less than a turn: no more is made."""
_SHOWN = 10
"""Tooth pairs that are named."""
_ROUNDED = 1e-3
"""Expanded uncertainties within which the estimate itself is rounded to a fraction."""


@dataclass(frozen=True, slots=True)
class RatioEstimate:
    """A gear ratio as it was measured."""

    measured: Estimate
    simplest: Fraction
    """The fraction of the least denominator within twice the expanded uncertainty."""
    chance: float
    """Probability that one as simple or simpler is there by coincidence, at most 1."""
    tooth_pairs: tuple[tuple[int, int], ...]
    """Teeth (zk, zs) of ring gear and satellite that have a ratio within twice the expanded
    uncertainty, by rising zk up to `MOST_TEETH`."""

    @property
    def plus_minus(self) -> str:
        """The measured ratio ± its expanded uncertainty, to two digits of that."""
        spread = self.measured.uncertainty or 0.0
        decimals = max(0, 1 - math.floor(math.log10(spread)))
        return f'{self.measured.value:.{decimals}f} ± {spread:.{decimals}f}'

    @property
    def teeth(self) -> str:
        """The first tooth pairs, in words; empty without any."""
        return ', '.join(f'{ring}/{satellite}' for ring, satellite in self.tooth_pairs[:_SHOWN])

    @property
    def ratio(self) -> GearRatio:
        """The simplest fraction, unless it may be there by coincidence; else the estimate."""
        if self.chance < _BY_CHANCE:
            return GearRatio(self.simplest)
        return GearRatio(simplest_fraction(*_interval(self.measured, _ROUNDED)))


def fit_ratio(
    encoders: Encoders, assumed: Fraction, eccentric_turns: float = 0.0
) -> RatioEstimate:
    """Estimate the ratio from a recording.

    Args:
        encoders: of rotor and output.
        assumed: a ratio that is near. Between samples, the output may turn at most half a turn
            more or less than by this ratio.
        eccentric_turns: turns of the output from which on an error once per turn is fitted.

    Raises:
        RecordingError: see `estimate_ratio`.
    """
    ideal = encoders.at_measured(encoders.ideal(assumed))
    output = ideal + encoders.error(assumed)
    eccentric = bool(np.ptp(output) >= eccentric_turns * TURN)
    return estimate_ratio(ideal * float(assumed), output, eccentric=eccentric)


def check_ratio(encoders: Encoders, assumed: GearRatio) -> str:
    """Compare a recording with a ratio; return what is wrong in a sentence, or nothing.

    Raises:
        RecordingError: if the errors cover a whole turn; within the turn they then mean nothing.
    """
    error, wrong = encoders.error(assumed), wrong_ratio(encoders, assumed)
    if float(np.ptp(np.remainder(error - error[0] + 0.5 * TURN, TURN))) >= 0.5 * TURN:
        raise RecordingError(
            'the measured output angle does not follow the rotor: the errors cover a whole turn; '
            f'{wrong or "the ratio is wrong, or an encoder counts backwards"}'
        )
    return f'The recording does not have the ratio {assumed}: {wrong}.' if wrong else ''


def wrong_ratio(encoders: Encoders, assumed: Fraction) -> str:
    """Say in a clause which ratio a recording has, if it is clearly not the assumed one."""
    found = _other_ratio(encoders, assumed)
    if found is None:
        return ''
    measured = f'the recorded ratio is {found.plus_minus}, not {assumed}'
    if _within(found.measured, -assumed):
        return f'{measured}: an encoder counts backwards, or --ratio={-assumed} is right'
    teeth = f', with ring gear/satellite teeth such as {found.teeth}' if found.teeth else ''
    return f'{measured}; --ratio={found.simplest} is the simplest{teeth}'


def _within(measured: Estimate, ratio: Fraction) -> bool:
    return abs(measured.value - ratio) <= _MIN_WRONG * (measured.uncertainty or 0.0)


def _other_ratio(encoders: Encoders, assumed: Fraction) -> RatioEstimate | None:
    """The ratio of a recording if it is not the assumed one; rough over less than a turn."""
    ideal = encoders.at_measured(encoders.ideal(assumed))
    ideal, error = ideal - np.mean(ideal), encoders.error(assumed)
    travel = float(np.ptp(ideal))
    slope = float(ideal @ error / (ideal @ ideal)) if travel else 0.0
    rest = float(np.ptp(np.quantile(error - slope * ideal, [0.01, 0.99])))
    if abs(slope) * travel <= rest or slope == -1.0:
        return None
    if travel * abs(1.0 + slope) >= TURN:
        with suppress(RecordingError):
            found = fit_ratio(encoders, assumed)
            return None if _within(found.measured, assumed) else found
    steep = _ECCENTRICITY
    if travel * abs(assumed) < TURN:  # an error of the rotor's order may be as steep as that
        steep *= max(1.0, abs(float(assumed)))
    if abs(slope) <= steep or abs(slope) * travel <= _MIN_WRONG * rest:
        return None
    value = float(assumed) / (1.0 + slope)
    standard = abs(value) * _ECCENTRICITY / student_t(_BLOCKS)
    return _with_candidates(Estimate(value, standard, _BLOCKS, 1))


def estimate_ratio(rotor: Array, output: Array, *, eccentric: bool = True) -> RatioEstimate:
    """Estimate the ratio by least squares, and its uncertainty by leaving out block after block.

    Play and the errors once per turn of the output and of the rotor are fitted as well. Blocks are
    contiguous in time, so that the uncertainty is right for errors that are correlated over less
    than a block. Below about one turn of the output it is large, as an error once per turn can
    hardly be told from another ratio.

    Args:
        rotor: (n,), rad, counting turns, in the order of time.
        output: (n,), rad, counting turns.
        eccentric: whether an error once per turn of the output is fitted; otherwise it becomes
            part of the ratio.

    Raises:
        RecordingError: if there are too few samples, or the output does not follow the rotor.
    """
    if len(rotor) < _BLOCKS * _LEAST_SAMPLES:
        raise RecordingError(
            f'{len(rotor)} samples are too few to estimate the ratio, which takes at least '
            f'{_BLOCKS * _LEAST_SAMPLES}'
        )
    travel = float(np.ptp(rotor))
    if not travel:
        raise RecordingError('the rotor does not turn')
    x, y = (rotor - np.mean(rotor)) / travel, output - np.mean(output)
    # The measured angle must not explain itself, as its sine would over less than a turn.
    phase = x * float(x @ y / (x @ x))
    columns = [x, np.ones(len(x))]
    if eccentric:
        columns += [np.cos(phase), np.sin(phase)]
    if travel >= _CYCLES * TURN:
        columns += [np.cos(rotor), np.sin(rotor)]
    sign = np.sign(np.diff(rotor, prepend=rotor[0]))
    moving = np.where(sign, np.arange(len(sign)), 0)
    direction = sign[np.maximum.accumulate(moving)]  # at a standstill that of the last motion
    if np.ptp(direction):
        columns.append(direction)
    sums = np.array([
        [[left[part] @ right[part] for right in (*columns, y)] for left in columns]
        for part in np.array_split(np.arange(len(x)), _BLOCKS)
    ])  # fmt: skip
    whole = sums.sum(axis=0)
    fits = [
        float(np.linalg.lstsq(rows[:, :-1], rows[:, -1], rcond=None)[0][0])
        for rows in (whole, *(whole - sums))
    ]
    slope, scatter = fits[0], deviation(pseudo_values(fits).tolist()) / math.sqrt(_BLOCKS)
    rounding = float(np.spacing(max(np.abs(output).max(), abs(slope))))
    standard, freedom = math.hypot(scatter, rounding), _BLOCKS - len(columns)
    if not _MAX_DISTANCE * student_t(freedom) * standard < abs(slope):
        raise RecordingError('the output does not follow the rotor: no ratio fits')
    value = travel / slope
    return _with_candidates(Estimate(value, abs(value / slope) * standard, freedom, _BLOCKS))


def _with_candidates(measured: Estimate) -> RatioEstimate:
    """Find the simple fraction and the tooth pairs that fit a measured ratio."""
    low, high = _interval(measured, _MAX_DISTANCE)
    simplest = simplest_fraction(low, high)
    small, width = simplest.denominator, high - low
    if abs(simplest) < 1:  # a gear to a higher speed is judged by the inverse of its ratio
        small, width = abs(simplest.numerator), 1 / low - 1 / high
    # Fewer than q (q + 1)/2 fractions per unit have a denominator of at most q.
    chance = min(1.0, float(width) * small * (small + 1) / 2)
    pairs = tooth_pairs(low, high, MOST_TEETH) if high < 0 else ()
    return RatioEstimate(measured, simplest, chance, tuple(pairs))


def _interval(measured: Estimate, factor: float) -> tuple[Fraction, Fraction]:
    """The interval around a value, as wide as the expanded uncertainty times a factor."""
    value, around = Fraction(measured.value), Fraction(factor * (measured.uncertainty or 0.0))
    return value - around, value + around


def ratio_remarks(fitted: RatioEstimate) -> Iterator[str]:
    """Describe an estimated ratio, in sentences."""
    yield f'The gear ratio is estimated as {fitted.plus_minus}, and taken as {fitted.ratio}.'
    yield (
        f'{fitted.simplest} is the simplest fraction within twice that uncertainty; one as simple '
        f'is there by coincidence with a probability of at most {number(fitted.chance, 2)}.'
    )
    if fitted.teeth:
        yield f'Teeth of ring gear/satellite with such a ratio are, for example, {fitted.teeth}.'
