# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the calibration of a gear consists of, beside the content of its file."""

from collections.abc import Mapping
from typing import NamedTuple

from gear_kinematics.correction.calibration_file import Calibration, Compliance, Order, Stop
from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.calibration.spectrum import Spectrum
from gear_kinematics.measurement.calibration.terms import Samples, Term
from gear_kinematics.measurement.recording import Array


class FittedTerm(NamedTuple):
    """A term of the calibration."""

    term: Term
    entry: Order | Stop | Compliance
    """With its coefficients."""
    amplitude: Estimate
    """rad; of a stop operator and of the wind-up with its sign."""


class FittedRecording(NamedTuple):
    """The error of one recording less its zero and delay, (n,) each, of the used samples, rad."""

    samples: Samples
    before: Array
    """Without the correction."""
    after: Array
    """With the correction that was fitted without the half that holds the sample."""
    zero: float
    """rad: what the encoder's zero adds."""
    delay: Estimate | None
    """s: by how much the output's angles are late; taken out if clear; None if not separable."""


class Fit(NamedTuple):
    """The result."""

    calibration: Calibration
    """Its constant makes the mean deviation zero; its errors are of samples left out."""
    helps: bool
    """Whether the correction reduces the error by more than a standard error."""
    terms: tuple[FittedTerm, ...]
    recordings: tuple[FittedRecording, ...]
    spectra: tuple[Spectrum | None, ...]
    """Before and after."""
    refused: Mapping[str, str]
    """Terms that the recordings cannot determine, with the cause."""
