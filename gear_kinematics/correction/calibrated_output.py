"""The calibrated output during operation, and how well the calibration fits a measured angle."""

import math
from collections import deque
from collections.abc import Iterable
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.corrector import Correction, Corrector
from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.correction.window import SlidingWindow
from gear_kinematics.kinematics import RotorSample
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[Any]

_DEPTH = 8192  # predictions that are kept
_SHARE = 0.05  # of samples that may be outside of a 95 % interval
_TOLERATED = 0.07  # since the width of an interval is known to a few percent (docs/calibration.md)
# Standard deviations that chance exceeds with 1 % in a single judgement, and with 0.1 % where one
# follows the other, as in the node.
_UNLIKELY_ONCE, _UNLIKELY = 2.326, 3.090


class CalibrationFit(NamedTuple):
    """How the measured transmission error compares with the calibration."""

    samples: int
    explained: float | None
    """Share of the variance of the error; None if the error is constant."""
    outside: float
    """Share of samples outside of the 95 % interval, apart from the encoder's zero."""
    fits: bool
    """Whether that many would be outside of a true interval by chance, or hardly more are."""
    independent: float
    """Number of independent samples, of whether they are outside."""

    @property
    def outside_uncertainty(self) -> float:
        """Expanded uncertainty (95 %) of the share that would be outside in the long run."""
        # Agresti and Coull's estimate, which is not 0 where no sample is outside.
        share = (self.outside * self.independent + 2.0) / (self.independent + 4.0)
        return 2.0 * math.sqrt(share * (1.0 - share) / (self.independent + 4.0))

    @classmethod
    def of(cls, error: Array, residual: Array, half_width: Array, *, once: bool = False) -> Self:
        """Judge samples, (n,) each, rad.

        The zero of the encoder is not known, so the means are taken out.

        Args:
            error: measured minus ideal output angle.
            residual: measured minus corrected output angle.
            half_width: of the interval.
            once: whether this is the only judgement, not one of many.
        """
        error, residual = (column - column[0] for column in (error, residual))  # rounds less
        error, residual = error - error.mean(), residual - residual.mean()
        variance = float(error @ error)
        is_outside = np.abs(residual) > half_width
        outside = float(np.mean(is_outside))
        independent = independent_samples(is_outside - outside)
        return cls(
            len(error),
            1.0 - float(residual @ residual) / variance if variance else None,
            outside,
            outside <= _TOLERATED
            or 2.0 * math.sqrt(independent) * _excess(outside)
            <= (_UNLIKELY_ONCE if once else _UNLIKELY),
            independent,
        )


class CalibratedOutput:
    """Corrects the output sample by sample, and compares the correction with measured errors."""

    def __init__(self, calibration: Calibration) -> None:
        self.corrector = Corrector(calibration)
        """Its `max_acceleration` can change any time."""
        self._referenced = True
        self.reset()

    def reset(self) -> None:
        """Forget the motion and the comparison, as after homing."""
        self.corrector.reset()
        self._predicted: deque[tuple[int, float, float]] = deque(maxlen=_DEPTH)
        # The error, the error minus the deviation, the half width; rad.
        self._compared = SlidingWindow(3)

    def correct(self, sample: RotorSample, *, segment: int, referenced: bool) -> Correction:
        """Compute the correction at the next sample; the arguments are those of `Corrector`."""
        if referenced != self._referenced:  # the turns were homed
            self.reset()
            self._referenced = referenced
        correction = self.corrector.correct(sample, segment=segment, referenced=referenced)
        if self._predicted and sample.stamp <= (last := self._predicted[-1][0]):
            if last - sample.stamp <= CLOCK_RESET:
                return correction
            self._predicted.clear()
        self._predicted.append((sample.stamp, correction.deviation, correction.half_width))
        return correction

    def compare(self, errors: Iterable[ErrorSample]) -> None:
        """Compare measured errors, in the order of their stamps, with the corrections so far."""
        predicted = self._predicted
        for stamp, error, *_ in errors:
            while len(predicted) > 1 and predicted[1][0] < stamp:
                predicted.popleft()
            if len(predicted) < 2 or stamp < predicted[0][0]:  # noqa: PLR2004, both sides of it
                continue
            start, deviation, half_width = predicted[0]
            end, next_deviation, next_half_width = predicted[1]
            share = (stamp - start) / (end - start)
            deviation += share * (next_deviation - deviation)
            self._compared.add(stamp, error, error - deviation, max(half_width, next_half_width))

    def fit(self, window: float) -> CalibrationFit | None:
        """Judge the samples within a window, s, and forget older ones; None without any."""
        columns = self._compared.columns(round(window * SECOND))
        return CalibrationFit.of(*columns) if columns.size else None


def _excess(outside: float) -> float:
    """How much more than 5 % are outside, in units of 1/(2 √n) that scatter of n samples has.

    The arc sine of the root of a binomial share is about normal, with the variance 1/(4 n)
    (M. S. Bartlett, Journal of the Royal Statistical Society, Supplement 3 (1936) 68).
    """
    return math.asin(math.sqrt(outside)) - math.asin(math.sqrt(_SHARE))


def independent_samples(residual: Array) -> float:
    """The number of independent samples that a series is worth, at least 1.

    Args:
        residual: (n,), with a mean of 0.

    Returns:
        n/τ, with the autocorrelation time τ from the initial positive autocorrelations (Geyer).
    """
    count = len(residual)
    size = 1 << (2 * count - 1).bit_length()
    spectrum = np.fft.rfft(residual, size)
    correlation = np.fft.irfft(spectrum * spectrum.conj(), size)[:count]
    if not correlation[0] > 0.0:
        return float(count)
    correlation /= correlation[0]
    ends = np.flatnonzero(correlation <= 0.0)
    positive = correlation[1 : ends[0] if len(ends) else count]
    return max(1.0, count / (1.0 + 2.0 * float(positive.sum())))
