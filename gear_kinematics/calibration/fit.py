"""The calibration of a gear: what its output angle deviates by, fitted to recordings.

deviation = constant + Σ orders of the rotor's angle + Σ stop operators + wind-up by the torque.

It is linear in its coefficients. Terms are selected by the prediction of blocks left out, from
which the interval comes as well; the coefficients' uncertainties are those of the jackknife over
the same blocks (B. Efron, C. Stein, Annals of Statistics 9 (1981) 586). Neither needs white noise.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from gear_kinematics.calibration.fitting import Fitting
from gear_kinematics.calibration.recording import Recording, thinned
from gear_kinematics.calibration.result import Fit, is_certain
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.dynamic.ratio import (
    RatioEstimate,
    estimate_ratio,
    with_candidates,
)
from gear_kinematics.state.uncertainty import Estimate

_SHIFTS = 4
"""Corrections of the delays, each for what the ones before left."""
_CLOSE = 0.2
"""Share of its uncertainty to which a delay is corrected."""


def fit(
    recordings: Sequence[Recording],
    ratio: Fraction,
    mechanism: Mechanism | None = None,
    *,
    fit_ratio: bool = False,
) -> Fit:
    """Calibrate a gear.

    Args:
        recordings: at least one.
        ratio: i, exact. With `fit_ratio` it need only be so near that, between samples, the output
            turns at most half a turn more or less than by this ratio.
        mechanism: for the orders of satellite and teeth, if it is known.
        fit_ratio: whether to fit the ratio too.

    Raises:
        RecordingError: if the recordings do not suffice.
        MotionError: if the output does not follow the rotor.
    """
    recordings, estimate = thinned(recordings), None
    if fit_ratio:
        ratio = _first_estimate(recordings, ratio).ratio
    recordings, delays = _undelayed(recordings, ratio, mechanism, fit_ratio=fit_ratio)
    if fit_ratio:
        fitting = Fitting(recordings, ratio, mechanism, fit_ratio=True)
        fitting.select()
        estimate = with_candidates(fitting.ratio())
        ratio = estimate.ratio
    fitting = Fitting(recordings, ratio, mechanism)
    fitting.select()
    result = fitting.result()
    residuals = tuple(
        replace(r, delay=delay) for r, delay in zip(result.recordings, delays, strict=True)
    )
    # What the delays leave is the same in all blocks, so that leaving some out does not show it.
    left = math.sqrt(np.mean([r.delay_half_width**2 for r in residuals]))
    half_width = math.hypot(result.half_width, left)
    return replace(
        result,
        half_width=half_width,
        outside_half_width=max(half_width, result.outside_half_width),
        recordings=residuals,
        fitted_ratio=estimate,
    )


def _first_estimate(recordings: Sequence[Recording], assumed: Fraction) -> RatioEstimate:
    """The ratio from the recording with the longest travel."""
    longest = max(recordings, key=lambda r: float(np.ptp(r.rotor.turns)))
    turns, angle = longest.position()
    rotor = (turns - turns[0]) * TURN + angle
    output = longest.at_measured(longest.ideal(assumed)) + longest.error(assumed)
    return estimate_ratio(rotor, output)


def _undelayed(
    recordings: Sequence[Recording],
    ratio: Fraction,
    mechanism: Mechanism | None,
    *,
    fit_ratio: bool,
) -> tuple[list[Recording], list[Estimate | None]]:
    """Estimate the delays of the output's stamps, and correct those that are certain."""
    delays: list[Estimate | None] = [None] * len(recordings)
    if not any(recording.separate for recording in recordings):
        return list(recordings), delays
    shifts = [0.0] * len(recordings)
    shifted = list(recordings)
    for _ in range(_SHIFTS):
        left = Fitting(shifted, ratio, mechanism, fit_ratio=fit_ratio).delays()
        delays = [
            d and replace(d, value=d.value + shift) for d, shift in zip(left, shifts, strict=True)
        ]
        before, shifts = shifts, [d.value if d and is_certain(d) else 0.0 for d in delays]
        if all(
            abs(now - shift) <= _CLOSE * ((d and d.uncertainty) or 0.0)
            for now, shift, d in zip(shifts, before, delays, strict=True)
        ):
            break
        shifted = [
            recording.earlier(shift) if shift else recording
            for recording, shift in zip(recordings, shifts, strict=True)
        ]
    return shifted, delays
