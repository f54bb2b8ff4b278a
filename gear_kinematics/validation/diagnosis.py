"""Causes of deviations: an offset, another mechanism, unit or shaft, another order of poses."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.uncertainty import student_t
from gear_kinematics.kinematics import Gear, GearRatio, Mechanism
from gear_kinematics.kinematics.gear_ratio import tooth_pairs
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.validation.report import Finding

Array = NDArray[np.float64]
Stamps = NDArray[np.int64]

_MAX_TEETH = 1000
_MIN_TURNING = 0.1  # rad of the rotor, to determine a ratio
_MAX_BLOCKS, _MIN_BLOCKS = 32, 4
"""Numbers of blocks; with many samples there are at least half of the greatest number."""
_ROUNDING = 1e-9
"""Relative rounding of the sums."""
_CLEAR_DEVIATION = 2.0
"""In expanded uncertainties."""
_MAX_BODIES = 6
"""Number of bodies up to which all orders are tried."""
_MAX_SCATTER = 1e-5
"""Greatest deviation of all values together from a constant factor, relative to them."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A value with its uncertainty."""

    value: float
    uncertainty: float
    """Expanded, with a coverage of 95 %."""

    def __str__(self) -> str:
        return f'{self.value:.9g} ± {self.uncertainty:.2g}'

    def is_near(self, other: float) -> bool:
        """Whether another value is no clear deviation."""
        return abs(self.value - other) <= _CLEAR_DEVIATION * self.uncertainty


class AngleFit:
    """Slope of recorded output angles over rotor angles, and their mean error, from running sums.

    Uncertainties are those of the jackknife over blocks of successive samples. The slope is that
    within blocks, so that an angle that steps, as by homing, changes the offset alone.
    """

    def __init__(self) -> None:
        self.count = 0
        self.lowest_error, self.highest_error = math.inf, -math.inf
        self._origin = (0.0, 0.0)
        self._blocks = np.zeros((0, 6))
        """Sums of 1, x, y, x², xy and the error."""
        self._size = 1

    def update(self, rotor_angle: Array, recorded: Array, error: Array) -> None:
        """Add samples (n,), rad; `error` is recorded minus recomputed."""
        if not len(recorded):
            return
        if not self.count:
            self._origin = (float(rotor_angle[0]), float(recorded[0]))
        self.lowest_error = min(self.lowest_error, float(error.min()))
        self.highest_error = max(self.highest_error, float(error.max()))
        with np.errstate(over='ignore', invalid='ignore'):  # of garbage, which has no slope
            x, y = rotor_angle - self._origin[0], recorded - self._origin[1]
            self._add(np.stack([np.ones(len(x)), x, y, x * x, x * y, error], axis=1))
        self.count += len(recorded)

    def _add(self, products: Array) -> None:
        """Add products of samples to the sums of their blocks, and merge blocks in pairs."""
        numbers = (self.count + np.arange(len(products))) // self._size
        blocks, starts = np.unique(numbers, return_index=True)
        sums = np.add.reduceat(products, starts)
        if blocks[0] < len(self._blocks):
            sums[0] += self._blocks[-1]
        self._blocks = np.concatenate([self._blocks[: blocks[0]], sums])
        while len(self._blocks) > _MAX_BLOCKS:
            self._blocks = np.add.reduceat(self._blocks, np.arange(0, len(self._blocks), 2))
            self._size *= 2

    def offset(self, tolerance: float) -> float | None:
        """Return the constant offset of all errors, rad, or None if they are not constant."""
        if not self.count or self.highest_error - self.lowest_error > 2.0 * tolerance:
            return None
        offset = 0.5 * (self.lowest_error + self.highest_error)
        return offset if abs(offset) > tolerance else None

    def mean_error(self) -> Measured | None:
        """Return the mean error, rad; None of too few samples."""
        return _ratio_of_sums(self._blocks[:, 5], self._blocks[:, 0])

    def slope(self) -> Measured | None:
        """Return output angle / rotor angle; None without motion, or of garbage."""
        with np.errstate(over='ignore', invalid='ignore'):
            n, x, y, xx, xy, _ = self._blocks.T
            within = xx - x * x / n
            if not within.sum() >= self.count * (_MIN_TURNING / _MAX_BLOCKS) ** 2:
                return None
            found = _ratio_of_sums(xy - x * y / n, within)
        return None if found is None or found.is_near(0.0) else found


def _ratio_of_sums(above: Array, below: Array) -> Measured | None:
    """Return the quotient of two sums over blocks."""
    blocks = len(above)
    if blocks < _MIN_BLOCKS:
        return None
    with np.errstate(over='ignore', invalid='ignore', divide='ignore'):
        value = float(above.sum() / below.sum())
        without = (above.sum() - above) / (below.sum() - below)
        scatter = float(np.sum((without - without.mean()) ** 2)) * (blocks - 1) / blocks
    if not math.isfinite(value + scatter):
        return None
    spread = student_t(blocks - 1) * math.sqrt(scatter)
    return Measured(value, spread + _ROUNDING * abs(value))


def diagnose(gear: Gear, fit: AngleFit, tolerance: float) -> str | None:
    """Describe a systematic deviation of the recorded output angles, or return None.

    Args:
        gear: the assumed gear.
        fit: of the recorded output angles.
        tolerance: of the output angles, rad.
    """
    offset = fit.offset(tolerance)
    if offset is not None:
        return (
            f'the recorded output angle is off by a constant {offset:.12g} rad; '
            '--allow-offset accepts it'
        )
    slope = fit.slope()
    if slope is None:
        return None
    if not slope.is_near(float(1 / gear.gear_ratio)):
        return _another_ratio(gear, slope)
    mean = fit.mean_error()
    if mean and abs(mean.value) > tolerance and not mean.is_near(0.0):
        return (
            f'the recorded output angle is off by {mean} rad on average, and scatters from '
            f'{fit.lowest_error:.3g} to {fit.highest_error:.3g} rad'
        )
    return None


def _another_ratio(gear: Gear, slope: Measured) -> str:
    relative = slope.uncertainty / abs(slope.value)
    ratio = Measured(1.0 / slope.value, relative / abs(slope.value))
    if slope.is_near(-float(1 / gear.gear_ratio)):
        return (
            'the sign is flipped: the recorded output turns the other way (rotor_direction?), '
            f'with a ratio of {ratio}'
        )
    spread = _CLEAR_DEVIATION * slope.uncertainty
    if isinstance(gear, Mechanism) and (pair := _tooth_pair(gear, abs(slope.value), spread)):
        ring, satellite = pair
        flipped = ' with the sign flipped' if slope.value > 0.0 else ''
        return (
            f'the recorded ratio is {ratio}, as that of ring_teeth {ring}, satellite_teeth '
            f'{satellite} ({Fraction(-satellite, ring - satellite)}){flipped}, not of '
            f'{gear.ring_teeth}, {gear.satellite_teeth} ({gear.gear_ratio})'
        )
    return f'the recorded ratio is {ratio}, not {gear.gear_ratio}'


def _tooth_pair(mechanism: Mechanism, slope: float, uncertainty: float) -> tuple[int, int] | None:
    """The tooth numbers (zk, zs) nearest to the assumed ones that turn the output like this."""
    least, greatest = (Fraction(slope) + sign * Fraction(uncertainty) for sign in (-1, 1))
    if least <= 0:
        return None
    zk, zs = mechanism.ring_teeth, mechanism.satellite_teeth
    return min(
        tooth_pairs(-1 / least, -1 / greatest, max(_MAX_TEETH, 2 * zk)),
        key=lambda pair: abs(pair[0] - zk) + abs(pair[1] - zs),
        default=None,
    )


class FactorFit:
    """The constant factor between recorded and expected values of a field, from running sums."""

    def __init__(self) -> None:
        self._sums = np.zeros(3)  # of expected², expected · recorded, recorded²

    def update(self, recorded: Array, expected: Array) -> None:
        """Add values (n,); those that are not finite are left out."""
        usable = np.isfinite(recorded) & np.isfinite(expected)
        x, y = expected[usable], recorded[usable]
        with np.errstate(over='ignore'):
            self._sums += (x @ x, x @ y, y @ y)

    def factor(self) -> float | None:
        """Return recorded / expected; None if it is not constant, or 1."""
        with np.errstate(all='ignore'):  # garbage has no factor
            xx, xy, yy = self._sums
            factor = float(xy / xx)
            scatter = yy - factor * xy
        if not (abs(factor - 1.0) > _MAX_SCATTER and scatter <= _MAX_SCATTER**2 * yy):
            return None
        return factor if math.isfinite(factor) else None


def describe_factor(field: str, factor: float, ratio: GearRatio) -> str:
    """Say by which factor the velocity or the effort is wrong, and why.

    Args:
        field: `velocity` or `effort`.
        factor: recorded / expected.
        ratio: of the gear.
    """
    of_rotor = float(ratio) if field == 'velocity' else 1.0 / float(ratio)
    reasons = {
        -1.0: 'the sign is flipped',
        of_rotor: 'it is that of the rotor',
        -of_rotor: 'it is that of the rotor, with the sign flipped',
    }
    if field == 'velocity':
        reasons |= {
            math.degrees(1.0): 'it is in degrees per second',
            60.0 / TURN: 'it is in revolutions per minute',
            1.0 / TURN: 'it is in revolutions per second',
        }
    near = (text for known, text in reasons.items() if math.isclose(factor, known, rel_tol=1e-4))
    reason = next(near, '')
    return f'the recorded {field} is {factor:.6g} times the expected one{reason and ": "}{reason}'


class PoseOrder:
    """Detects recorded poses that are the expected ones in another order."""

    def __init__(self, bodies: list[str], tolerance: float) -> None:
        """Start with no poses.

        Args:
            bodies: names of the bodies in the expected order.
            tolerance: m.
        """
        self._bodies = bodies
        self._tolerance = tolerance
        self._found: dict[tuple[int, ...], tuple[int, int]] = {}  # number of messages, first stamp

    def update(self, recorded: Array, expected: Array, error: Array, stamp: Stamps) -> None:
        """Add positions (n, bodies, 3) and the greatest error of each message (n,), m."""
        wrong = np.flatnonzero(error > self._tolerance)
        if not len(wrong) or len(self._bodies) > _MAX_BODIES:
            return
        worst = int(np.argmax(np.where(np.isfinite(error), error, -1.0)))
        for order in permutations(range(len(self._bodies))):
            if self._fits(recorded[worst], expected[worst, order]):
                fits = self._fits(recorded[wrong], expected[wrong][:, order])
                count, first = self._found.get(order, (0, int(stamp[worst])))
                self._found[order] = count + int(np.count_nonzero(fits)), first
                return

    def causes(self, messages: int) -> Iterator[Finding]:
        """Describe the orders found in a number of messages."""
        for order, (count, first) in self._found.items():
            names = ', '.join(self._bodies[k] for k in order)
            text = f'the poses are in another order: {names}'
            if count == messages:
                yield Finding(text, cause=True)
            else:
                text = f'in {count} of {messages} messages {text}'
                yield Finding(text, cause=True, stamp=first, when='one at')

    def _fits(self, recorded: Array, expected: Array) -> NDArray[np.bool_]:
        return np.asarray(np.abs(recorded - expected).max(axis=(-2, -1)) <= self._tolerance)
