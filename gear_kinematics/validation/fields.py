# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Errors of the fields of an output topic, and their record over time for plots."""

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.report import FieldReport, Series
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

_MAX_SAMPLES = 2000
"""Samples of the record, which is halved when there are more."""


class Occurrences:
    """Number of messages to which something happened, and the stamp of the first."""

    def __init__(self) -> None:
        self.count = 0
        self.first: int | None = None
        """Stamp of the one that was added first, ns."""

    def add(self, stamps: Array) -> None:
        """Add occurrences at stamps, (n,), ns."""
        if self.first is None and len(stamps):
            self.first = int(stamps[0])
        self.count += len(stamps)

    def add_all(self, others: 'Occurrences') -> None:
        """Add the occurrences of another object."""
        if self.first is None:
            self.first = others.first
        self.count += others.count


class FieldSamples(NamedTuple):
    """A field of compared messages."""

    error: Array
    """(n,): recorded minus expected, or its magnitude; infinite where the recorded value is not
    finite, NaN where the field is absent."""
    one_sided: Array = np.zeros(0, np.intp)
    """(m,): indices of the messages with the field in input or output only."""
    recorded: Array = np.zeros(0)
    """(n,), the recorded value, where a field is one number; NaN where it is absent."""
    expected: Array = np.zeros(0)
    """(n,), the expected value; NaN as in `recorded`."""


class FieldErrors:
    """Statistics of the errors of one field, collected batch by batch."""

    def __init__(self, name: str, unit: str, tolerance: float) -> None:
        self.name, self.tolerance = name, tolerance
        self.non_finite = Occurrences()
        self.absent = Occurrences()
        self._worst = FieldReport(name, unit, tolerance)
        self._compared = 0
        self._squares = 0.0

    def update(self, samples: FieldSamples, stamp: Array, rotor_angle: Array) -> None:
        """Add samples of messages, with their stamps, ns, and rotor angles, rad, (n,)."""
        error = np.abs(samples.error)
        self.absent.add(stamp[samples.one_sided])
        self.non_finite.add(stamp[error == np.inf])
        finite = np.isfinite(error)
        if not finite.all():
            error, stamp, rotor_angle = error[finite], stamp[finite], rotor_angle[finite]
        if not len(error):
            return
        self._compared += len(error)
        self._squares += float(error @ error)
        worst = int(np.argmax(error))
        if error[worst] > self._worst.max_error:
            self._worst = replace(
                self._worst,
                max_error=float(error[worst]),
                worst_stamp=int(stamp[worst]),
                worst_rotor_angle=float(rotor_angle[worst]),
            )

    def report(self) -> FieldReport:
        """Report on everything so far."""
        return replace(
            self._worst,
            compared=self._compared + self.non_finite.count,
            non_finite=self.non_finite.count,
            absent=self.absent.count,
            rms_error=math.sqrt(self._squares / self._compared) if self._compared else 0.0,
            first_non_finite=self.non_finite.first,
            first_absent=self.absent.first,
        )


class SeriesRecorder:
    """Keeps the worst error of each field in each interval of messages."""

    def __init__(self, fields: Sequence[FieldErrors]) -> None:
        """Start without samples of these fields."""
        self._fields = fields
        self._start: int | None = None  # stamp of the first message, ns
        self._kept = np.zeros((2 + len(fields), 0))
        """Rows with times since then, s, rotor angles, rad, and the errors of each field."""
        self._interval = 1

    def update(self, stamp: NDArray[np.int64], rotor_angle: Array, *fields: FieldSamples) -> None:
        """Add compared messages (n,): stamps, ns, rotor angles, rad, and their fields."""
        if not len(stamp):
            return
        self._start = int(stamp[0]) if self._start is None else self._start
        time = (stamp - self._start) / SECOND
        rows = np.stack([time, rotor_angle, *(field.error for field in fields)])
        self._kept = np.hstack([self._kept, self._thinned(rows, self._interval)])
        while self._kept.shape[1] > _MAX_SAMPLES:
            self._kept = self._thinned(self._kept, 2)
            self._interval *= 2

    def series(self, topic: str, start: int) -> Series | None:
        """Return the record, with the time 0 at a stamp, ns; None if nothing was compared."""
        if self._start is None:
            return None
        time, rotor_angle, *errors = self._kept
        time = time + (self._start - start) / SECOND
        compared = {
            field.name: error.tolist()
            for field, error in zip(self._fields, errors, strict=True)
            if not np.isnan(error).all()
        }
        return Series(topic, time.tolist(), rotor_angle.tolist(), compared)

    def _thinned(self, rows: Array, interval: int) -> Array:
        """Keep the moment at which most of a tolerance was used, and the worst of each field."""
        tolerance = [[max(field.tolerance, sys.float_info.min)] for field in self._fields]
        # Errors of absent values are less than any other.
        size = np.where(np.isnan(rows[2:]), -1.0, np.abs(rows[2:]))
        share = (size / tolerance).max(axis=0, keepdims=True)
        moment = _greatest(share, interval)[0]
        error = np.take_along_axis(rows[2:], _greatest(size, interval), axis=1)
        return np.concatenate([rows[:2, moment], error])


def _greatest(size: Array, interval: int) -> Array:
    """Find the indices of the greatest sizes, (fields, n), of each interval."""
    fields, count = size.shape
    padded = np.pad(size, ((0, 0), (0, -count % interval)), constant_values=-np.inf)
    within = padded.reshape(fields, -1, interval).argmax(axis=2)
    return np.asarray(np.arange(0, count, interval) + within)
