# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Check of a calibration by recordings that it was not made from."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.calibration_fit import CalibrationFit
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.calibration.model import GearModel, without_delays
from gear_kinematics.measurement.calibration.terms import Samples
from gear_kinematics.measurement.ratio import wrong_ratio
from gear_kinematics.measurement.recording import Array, Recording, RecordingError
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.statistics.uncertainty import Estimate
from gear_kinematics.wire.cdr import SECOND

_STEP = 0.01  # s before and after a sample, for its speed
_PER_TURN = 'once', 'twice', '3 times', '4 times'  # orders of output and rotor that are tried
_MOST = 0.5  # share of the variance from which on an order explains the remaining error


@dataclass(frozen=True, eq=False, slots=True)
class Judgement:
    """A calibration compared with a recording; arrays are (n,), of the measured angles, in rad."""

    name: str  # name of the recording
    holds: bool  # whether the error is smaller with the correction, and within the interval
    fits: bool  # whether it is within the interval
    rms_before: float  # root mean square error without the correction, rad
    rms_after: float  # root mean square error with the correction, rad
    rms_before_with_delay: float  # `rms_before` if the delay is not removed, rad
    rms_after_with_delay: float  # `rms_after` if the delay is not removed, rad
    delay: Estimate | None  # of the output's angles, s; removed if clear, None if unknown
    within_interval: float  # share of the samples
    within_interval_uncertainty: float  # expanded uncertainty (95 %) of that share
    uncalibrated: float  # share of samples outside the calibrated spans, or of unknown history
    samples: int
    left_order: tuple[float, str] | None  # main remaining error: amplitude, rad, and how often
    remarks: Sequence[str]
    output: Array  # ideal output angle
    before: Array  # measured minus ideal output angle, without delay and mean
    after: Array  # measured minus corrected output angle, without delay and mean


def judge(recording: Recording, calibration: Calibration) -> Judgement:
    """Correct the output of a recording as the node does, and compare it with the measured one.

    The recording's zero and the delay of its stamps are not the gear's, and are removed.

    Raises:
        RecordingError: if the recording has another gear ratio.
    """
    encoders, ratio = recording.both, calibration.gear_ratio
    rotor = encoders.rotor
    if wrong := wrong_ratio(encoders, ratio):
        raise RecordingError(f'{recording.name}: {wrong}')
    seconds, velocity = rotor.seconds, np.full(len(rotor.stamp), np.nan)
    if encoders.timed:
        before, after = (np.interp(seconds + t, seconds, rotor.turned) for t in (-_STEP, _STEP))
        velocity = (after - before) / (2.0 * _STEP)
    stamp = rotor.stamp if encoders.timed else rotor.stamp // SECOND  # without gaps
    # Any motion is possible in a gap of a recording.
    unbounded = replace(NodeParameters.load(), max_rotor_acceleration=math.inf)
    corrector = GearState(unbounded, calibration).corrector
    assert corrector  # noqa: S101, there is a calibration
    correction = corrector.correct_batch(
        stamp, rotor.turns, rotor.angle, velocity, rotor.effort, rotor.segment
    )

    def samples_of(shift: float) -> Samples:
        return Samples(recording, ratio, shift, correction)

    model, (delay,) = without_delays(lambda shifts: GearModel([samples_of(*shifts)], []), 1)
    delayed, (samples,) = samples_of(0.0), model.samples
    both = samples.error + samples.known, samples.error
    before, after = (error - error.mean() for error in both)
    half_width = samples.encoders.at_measured(correction.half_width)
    found = CalibrationFit.of(before, after, half_width, once=True)
    rms = float(np.std(before)), float(np.std(after))
    return Judgement(
        recording.name,
        rms[1] < rms[0] and found.fits,
        found.fits,
        *rms,
        float(np.std(delayed.error + delayed.known)),
        float(np.std(delayed.error)),
        delay,
        1.0 - found.outside,
        found.outside_uncertainty,
        float(np.mean(half_width > calibration.half_width)),
        found.samples,
        None if found.fits else _left_order(samples, after),
        recording.sentences,
        samples.output,
        before,
        after,
    )


def _left_order(samples: Samples, left: Array) -> tuple[float, str] | None:
    """Find the order that explains most of the remaining error: amplitude, rad, and how often."""
    found = [(_MOST * np.var(left), 0.0, '')]
    for body, angle in (('output', samples.output), ('rotor', TURN * samples.rotor_turns)):
        for multiple, often in enumerate(_PER_TURN, start=1):
            phase = multiple * angle
            if np.ptp(phase) >= TURN:
                design = np.stack([np.ones(len(phase)), np.cos(phase), np.sin(phase)], axis=1)
                fit = np.linalg.lstsq(design, left, rcond=None)[0]
                amplitude = float(np.hypot(*fit[1:]))
                found.append((np.var(design @ fit), amplitude, f'{often} per {body} turn'))
    _, amplitude, words = max(found)
    return (amplitude, words) if words else None
