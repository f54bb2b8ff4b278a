"""Tests of what a model leaves of the middle lines: whether it is chance."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gear_kinematics.lost_motion.static.ramps import Array
from gear_kinematics.state.uncertainty import student_tail


@dataclass(frozen=True, slots=True)
class ResidualTest:
    """One way in which residuals can differ from chance."""

    name: str
    statistic: float
    expected: float
    """Of the statistic, by chance."""
    probability: float
    """Of a statistic as far from that by chance."""


def residual_tests(rest: Array, load: Array, pace: Array) -> tuple[ResidualTest, ...]:
    """Test residuals for runs, and for a dependence on the load, the speed and the time.

    The residuals of a loop are correlated from angle to angle. Each loop therefore counts once,
    except for the runs, which show just that correlation in the mean of all loops.

    Args:
        rest: (loops, angles), N·m, in order of time.
        load: of the same shape, N·m.
        pace: of the same shape, s/rad; 0 without times.

    Returns:
        Empty without at least three loops.
    """
    if len(rest) < 3:  # noqa: PLR2004, degrees of freedom
        return ()
    found = [_runs(np.mean(rest, axis=0)), *_by_loop(rest, load, pace)]
    return tuple(test for test in found if test)


def _runs(values: Array) -> ResidualTest | None:
    """Count runs of one sign: A. Wald, J. Wolfowitz, Ann. Math. Statist. 11 (1940) 147."""
    above = values > np.median(values)
    many, few = int(np.sum(above)), int(np.sum(~above))
    total = many + few
    product = 2.0 * many * few
    expected = product / total + 1.0
    variance = product * (product - total) / (total * total * (total - 1.0))
    if variance <= 0.0:
        return None
    count = 1 + int(np.count_nonzero(np.diff(above)))
    far = abs(count - expected) / math.sqrt(variance)
    return ResidualTest('runs along the angle', count, expected, math.erfc(far / math.sqrt(2.0)))


def _by_loop(rest: Array, load: Array, pace: Array) -> Iterator[ResidualTest | None]:
    """Correlate residuals and their scatter with load, speed and time."""
    size = np.abs(load)
    scatter = np.abs(rest - np.mean(rest, axis=0))
    yield _mean_slope('scatter over the load', scatter, size)
    yield _mean_slope('residual over the load', rest * np.sign(load), size)
    # By rank, as the gear jumps where it hardly holds.
    speed = np.argsort(np.argsort(-pace, axis=1), axis=1).astype(float)
    if np.any(pace):
        yield _mean_slope('residual over the speed', rest * np.sign(load), speed)
    yield _trend('scatter over time', np.sqrt(np.mean(rest**2, axis=1)))


def _mean_slope(name: str, values: Array, over: Array) -> ResidualTest | None:
    """Whether the correlation in each loop differs from zero in the mean of all loops."""
    found = np.array([_correlation(v, x) for v, x in zip(values, over, strict=True)])
    spread = float(np.std(found, ddof=1)) / math.sqrt(len(found))
    if not spread:
        return None
    mean = float(np.mean(found))
    return ResidualTest(name, mean, 0.0, student_tail(mean / spread, len(found) - 1))


def _trend(name: str, values: Array) -> ResidualTest | None:
    """Whether values change from loop to loop."""
    value = _correlation(values, np.arange(len(values), dtype=float))
    rest = 1.0 - value * value
    if rest <= 0.0:
        return None
    degrees = len(values) - 2
    return ResidualTest(name, value, 0.0, student_tail(value * math.sqrt(degrees / rest), degrees))


def _correlation(values: Array, over: Array) -> float:
    """Pearson's coefficient; 0 where one of both is constant."""
    a, b = values - np.mean(values), over - np.mean(over)
    scale = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / scale if scale else 0.0
