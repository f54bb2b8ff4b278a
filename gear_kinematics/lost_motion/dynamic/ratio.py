"""The gear ratio from recorded angles of rotor and output, and the gears that may have it."""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.gear_ratio import GearRatio, simplest_fraction, tooth_pairs
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.recorded.motion import Motion, MotionError
from gear_kinematics.state.uncertainty import Estimate, student_t

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
_FAR = 2.0
"""Expanded uncertainties within which a fraction or a tooth pair may be the true ratio."""
_WRONG = 3.0
"""Expanded uncertainties from which on an assumed ratio is wrong."""
_ECCENTRICITY = 0.01
"""Slope of the error that an eccentricity may have over less than a turn: no more is made."""
MOST_PAIRS = 10
"""Tooth pairs that are named."""
_NEAR = 1e-3
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
    def ratio(self) -> GearRatio:
        """The simplest fraction, unless it may be there by coincidence; else the estimate."""
        if self.chance < _BY_CHANCE:
            return GearRatio(self.simplest)
        return GearRatio(simplest_fraction(*_interval(self.measured, _NEAR)))


def fit_ratio(motion: Motion, assumed: GearRatio) -> RatioEstimate:
    """Estimate the ratio from a recording that was read with another one.

    Args:
        motion: the recording.
        assumed: the ratio with which it was read. Between samples, the output may turn at most
            half a turn more or less than by this ratio.

    Raises:
        MotionError: see `estimate_ratio`.
    """
    rotor = motion.angle * float(assumed)
    return estimate_ratio(rotor, motion.angle + np.unwrap(motion.error))


def check_ratio(motion: Motion, assumed: GearRatio) -> str | None:
    """Compare a recording with the ratio it was read with; return what is wrong in a sentence.

    Raises:
        MotionError: if the errors cover a whole turn; within the turn they then mean nothing.
    """
    found = _other_ratio(motion, assumed)
    cause = (
        _wrong(found, assumed) if found else 'the ratio is wrong, or an encoder counts backwards'
    )
    if float(np.ptp(motion.error)) >= 0.5 * TURN:
        raise MotionError(
            'the measured output angle does not follow the rotor: the errors cover a whole turn; '
            f'{cause}'
        )
    return f'The recording does not have the ratio {assumed}: {cause}.' if found else None


def _other_ratio(motion: Motion, assumed: GearRatio) -> RatioEstimate | None:
    """The ratio of a recording, if it is not the assumed one."""
    ideal = motion.angle - np.mean(motion.angle)
    error = np.unwrap(motion.error)
    travel = float(np.ptp(ideal))
    if not travel:
        return None
    slope = float(ideal @ error / (ideal @ ideal))
    rest = float(np.ptp(np.quantile(error - slope * ideal, [0.01, 0.99])))
    if abs(slope) * travel <= rest or slope == -1.0:
        return None
    if travel * abs(1.0 + slope) >= TURN:
        with suppress(MotionError):
            found = fit_ratio(motion, assumed)
            away = abs(found.measured.value - assumed)
            return found if away > _WRONG * (found.measured.uncertainty or 0.0) else None
    if abs(slope) <= _ECCENTRICITY or abs(slope) * travel <= _WRONG * rest:
        return None
    value = assumed / (1.0 + slope)
    standard = abs(value) * _ECCENTRICITY / student_t(_BLOCKS)
    return with_candidates(Estimate(value, standard, _BLOCKS, 1))


def _wrong(found: RatioEstimate, assumed: GearRatio) -> str:
    measured = f'the recorded ratio is {found.plus_minus}, not {assumed}'
    if abs(found.measured.value + assumed) <= _WRONG * (found.measured.uncertainty or 0.0):
        return f'{measured}: an encoder counts backwards, or --ratio={-assumed} is right'
    named = f'--ratio={found.simplest} is the simplest'
    if pairs := found.tooth_pairs:
        shown = ', '.join(f'{ring}/{satellite}' for ring, satellite in pairs[:MOST_PAIRS])
        named += f', with ring gear/satellite teeth such as {shown}'
    return f'{measured}; {named}'


def estimate_ratio(rotor: Array, output: Array) -> RatioEstimate:
    """Estimate the ratio by least squares, and its uncertainty by leaving out block after block.

    Play and the errors once per turn of the output and of the rotor are fitted as well. Blocks are
    contiguous in time, so that the uncertainty is right for errors that are correlated over less
    than a block. Below about one turn of the output it is large, as an error once per turn can
    hardly be told from another ratio.

    Args:
        rotor: (n,), rad, counting turns, in the order of time.
        output: (n,), rad, counting turns.

    Raises:
        MotionError: if there are too few samples, or the output does not follow the rotor.
    """
    if len(rotor) < _BLOCKS * _LEAST_SAMPLES:
        raise MotionError(
            f'{len(rotor)} samples are too few to estimate the ratio, which takes at least '
            f'{_BLOCKS * _LEAST_SAMPLES}'
        )
    travel = float(np.ptp(rotor))
    if not travel:
        raise MotionError('the rotor does not turn')
    x, y = (rotor - np.mean(rotor)) / travel, output - np.mean(output)
    # The measured angle must not explain itself, as its sine would over less than a turn.
    phase = x * float(x @ y / (x @ x))
    columns = [x, np.ones(len(x)), np.cos(phase), np.sin(phase)]
    if travel >= _CYCLES * TURN:
        columns += [np.cos(rotor), np.sin(rotor)]
    direction = _direction(rotor)
    if np.ptp(direction):
        columns.append(direction)
    sums = np.array([
        [[left[part] @ right[part] for right in (*columns, y)] for left in columns]
        for part in _blocks(len(x))
    ])  # fmt: skip
    slope = _slope(sums.sum(axis=0))
    without = np.array([_slope(sums.sum(axis=0) - block) for block in sums])
    scatter = float(np.sum((without - np.mean(without)) ** 2)) * (_BLOCKS - 1) / _BLOCKS
    rounding = float(np.spacing(max(np.abs(output).max(), abs(slope))))
    standard, freedom = math.hypot(math.sqrt(scatter), rounding), _BLOCKS - len(columns)
    if not _FAR * student_t(freedom) * standard < abs(slope):
        raise MotionError('the output does not follow the rotor: no ratio fits')
    value = travel / slope
    return with_candidates(Estimate(value, abs(value / slope) * standard, freedom, _BLOCKS))


def _blocks(count: int) -> Iterator[slice]:
    edges = np.linspace(0, count, _BLOCKS + 1).astype(int)
    yield from (slice(*edge) for edge in pairwise(edges))


def _slope(sums: Array) -> float:
    """The first coefficient of a fit, from the sums of products of its columns."""
    return float(np.linalg.lstsq(sums[:, :-1], sums[:, -1], rcond=None)[0][0])


def _direction(rotor: Array) -> Array:
    """1 or -1 at each sample; at a standstill that of the last motion."""
    sign = np.sign(np.diff(rotor, prepend=rotor[0]))
    moving = np.maximum.accumulate(np.where(sign != 0.0, np.arange(len(sign)), 0))
    direction: Array = sign[moving]
    return direction


def with_candidates(measured: Estimate) -> RatioEstimate:
    """Find the simple fraction and the tooth pairs that fit a measured ratio."""
    low, high = _interval(measured, _FAR)
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
