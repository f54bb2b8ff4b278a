# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Checks a calibration by recordings that it was not made from."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.calibration_fit import CalibrationFit
from gear_kinematics.correction.corrector import Corrector
from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.calibration.selection import jackknife
from gear_kinematics.measurement.calibration.terms import Samples
from gear_kinematics.measurement.ratio import wrong_ratio
from gear_kinematics.measurement.recording import Array, Encoders, Recording, RecordingError
from gear_kinematics.wire.cdr import SECOND

_BLOCKS = 24  # blocks of successive samples from which the uncertainty of a delay is estimated
_ROUNDS = 4  # estimates of the delay, each of what the ones before left
_PER_TURN = 'once', 'twice', '3 times', '4 times'  # the orders of output and rotor that are told
_MOST = 0.5  # share of the variance that makes an order what is left of the error
_VARIES = 0.05  # scatter of the speed over the greatest one that tells a delay from a zero


class Judgement(NamedTuple):
    """A calibration compared with a recording; arrays are (n,), of the measured angles, in rad."""

    samples: Samples
    """Less the delay, if that is clear."""
    before: Array
    """Measured minus ideal output angle less its mean, without the delay."""
    after: Array
    """Measured minus corrected output angle less its mean, without the delay."""
    with_delay: tuple[float, float]
    """rms before and after with the delay left in."""
    half_width: Array
    """Of the interval."""
    uncalibrated: float
    """Share of samples in conditions that were not calibrated, or with an unknown history."""
    delay: Estimate | None
    """s: by how much the output's angles are late; taken out if clear; None if not known."""
    fit: CalibrationFit

    @property
    def rms_before(self) -> float:
        """Of the error without the correction."""
        return float(np.std(self.before))

    @property
    def rms_after(self) -> float:
        """Of the error with the correction."""
        return float(np.std(self.after))

    @property
    def holds(self) -> bool:
        """Whether the error is less with the correction, and within its interval."""
        return self.rms_after < self.rms_before and self.fit.fits


def judge(recording: Recording, encoders: Encoders, calibration: Calibration) -> Judgement:
    """Correct the output of a recording as the node does, and compare it with the measured one.

    The zero of the recording and the delay of its stamps are taken out: they are not the gear's.

    Raises:
        RecordingError: if the recording has another gear ratio.
    """
    rotor, ratio = encoders.rotor, calibration.gear_ratio
    if wrong := wrong_ratio(encoders, ratio):
        raise RecordingError(f'{recording.name}: {wrong}')
    if not encoders.timed:
        calibration = replace(calibration, spans=replace(calibration.spans, speed=None))
    unknown = np.full(len(rotor.turns), np.nan)
    effort = unknown if rotor.effort is None else rotor.effort
    segment = np.zeros(len(unknown), np.int64) if rotor.segment is None else rotor.segment
    stamp = rotor.stamp if encoders.timed else rotor.stamp // SECOND  # no row is a gap
    correction = Corrector(calibration).correct_batch(
        stamp, rotor.turns, rotor.angle, unknown, effort, segment
    )

    def errors(of: Encoders) -> tuple[Samples, Array, Array]:
        samples = Samples(recording, of, ratio)
        left = samples.error - of.at_measured(correction.deviation)
        return samples, samples.error - samples.error.mean(), left - left.mean()

    samples, before, after = errors(encoders)
    with_delay = float(np.std(before)), float(np.std(after))
    delay = None
    for _ in range(_ROUNDS if encoders.timed else 0):
        delay = _delay(samples.speed, after, delay.value if delay else 0.0)
        shift = delay.value if delay and delay.clear else 0.0
        samples, before, after = errors(encoders.earlier(shift) if shift else encoders)
        if not shift:
            break
    half_width = samples.encoders.at_measured(correction.half_width)
    uncalibrated = float(np.mean(half_width > calibration.half_width))
    fit = CalibrationFit.of(before, after, half_width, once=True)
    return Judgement(samples, before, after, with_delay, half_width, uncalibrated, delay, fit)


def left_order(samples: Samples, left: Array) -> tuple[float, str] | None:
    """What is left of the error if it is mostly one order: its amplitude, rad, and how often."""
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


def _delay(speed: Array, residual: Array, shift: float) -> Estimate | None:
    """Estimate a delay, s, by least squares with the zero; None at a constant speed.

    Args:
        speed: of the output, rad/s.
        residual: measured minus corrected output angle, rad.
        shift: part of the delay that has been taken out already, s.
    """
    if not np.std(speed) > _VARIES * np.max(np.abs(speed)):
        return None
    columns = np.stack([-speed, np.ones(len(speed)), residual], axis=1)
    sums = np.array([block.T @ block for block in np.array_split(columns, _BLOCKS)])
    whole = sums.sum(axis=0)
    fits = (np.linalg.lstsq(s[:2, :2], s[:2, 2], rcond=None)[0] for s in (whole, *(whole - sums)))
    return jackknife(shift + np.array([delay for delay, _ in fits]))
